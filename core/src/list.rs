//! Lists of a fixed capacity, in an array or in memory of the caller.

use core::ops::{Deref, DerefMut};

/// Memory of a list: an array, or a slice that the caller lends.
///
/// Its items are always values, so no list needs `unsafe`; those beyond the list's end mean nothing.
pub trait Memory {
    /// What the list holds.
    type Item: Copy;
    /// All of it; always the same number of items.
    fn items(&self) -> &[Self::Item];
    /// The same, to be changed.
    fn items_mut(&mut self) -> &mut [Self::Item];
}

impl<T: Copy, const N: usize> Memory for [T; N] {
    type Item = T;
    fn items(&self) -> &[T] {
        self
    }
    fn items_mut(&mut self) -> &mut [T] {
        self
    }
}

impl<T: Copy> Memory for &mut [T] {
    type Item = T;
    fn items(&self) -> &[T] {
        self
    }
    fn items_mut(&mut self) -> &mut [T] {
        self
    }
}

/// At most as many items as its memory holds.
#[derive(Clone, Debug)]
pub(crate) struct List<S> {
    len: usize,
    memory: S,
}

impl<S: Memory> List<S> {
    /// An empty list.
    pub const fn new(memory: S) -> Self {
        List { len: 0, memory }
    }

    /// How many items it can hold.
    pub fn capacity(&self) -> usize {
        self.memory.items().len()
    }

    /// Its memory, and how many items of it are the list.
    pub fn parts(&mut self) -> (&mut [S::Item], &mut usize) {
        (self.memory.items_mut(), &mut self.len)
    }

    /// Goes on in other memory, which has the same items.
    pub fn moved(&mut self, memory: S) {
        self.memory = memory;
    }

    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Leaves the last item out.
    pub fn shorten(&mut self) {
        self.len = self.len.saturating_sub(1);
    }

    /// Makes it so long; what it held before there is of no meaning. False if there is no room.
    pub fn set_len(&mut self, len: usize) -> bool {
        let fits = len <= self.capacity();
        if fits {
            self.len = len;
        }
        fits
    }

    /// Adds an item, if there is room.
    pub fn push(&mut self, item: S::Item) {
        let (items, len) = self.parts();
        if let Some(place) = items.get_mut(*len) {
            *place = item;
            *len += 1;
        }
    }
}

impl<S: Memory> Deref for List<S> {
    type Target = [S::Item];
    fn deref(&self) -> &[S::Item] {
        let items = self.memory.items();
        &items[..self.len.min(items.len())]
    }
}

impl<S: Memory> DerefMut for List<S> {
    fn deref_mut(&mut self) -> &mut [S::Item] {
        let items = self.memory.items_mut();
        let len = self.len.min(items.len());
        &mut items[..len]
    }
}
