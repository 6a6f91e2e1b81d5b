//! Lists of a fixed capacity: those of `heapless`, which hold their items themselves, and those in memory of the caller.

use core::ops::{Deref, DerefMut};

use heapless::{Vec, VecView};

/// A list that cannot grow beyond its capacity.
pub trait List: DerefMut<Target = [Self::Item]> {
    /// What it holds.
    type Item: Copy;
    /// How many items it can hold.
    fn capacity(&self) -> usize;
    /// Makes it shorter, or longer by such items. False, and nothing is changed, if there is no room.
    fn resize(&mut self, len: usize, with: Self::Item) -> bool;
    /// Adds an item, if there is room.
    fn push(&mut self, item: &Self::Item);
    /// Leaves out what is beyond this length.
    fn truncate(&mut self, len: usize);
}

impl<T: Copy> List for VecView<T> {
    type Item = T;
    fn capacity(&self) -> usize {
        VecView::capacity(self)
    }
    fn resize(&mut self, len: usize, with: T) -> bool {
        VecView::resize(self, len, with).is_ok()
    }
    fn push(&mut self, item: &T) {
        let _ = VecView::push(self, *item);
    }
    fn truncate(&mut self, len: usize) {
        VecView::truncate(self, len);
    }
}

impl<T: Copy, const N: usize> List for Vec<T, N> {
    type Item = T;
    fn capacity(&self) -> usize {
        N
    }
    fn resize(&mut self, len: usize, with: T) -> bool {
        List::resize(self.as_mut_view(), len, with)
    }
    fn push(&mut self, item: &T) {
        List::push(self.as_mut_view(), item);
    }
    fn truncate(&mut self, len: usize) {
        self.as_mut_view().truncate(len);
    }
}

/// A list in a slice that the caller lends, of a length that is known when the program runs.
#[derive(Debug)]
pub struct Lent<'a, T> {
    /// The memory; what lies beyond the list's end means nothing.
    pub memory: &'a mut [T],
    /// How many of them are the list.
    pub len: usize,
}

impl<'a, T> Lent<'a, T> {
    /// An empty list.
    pub const fn new(memory: &'a mut [T]) -> Self {
        Lent { memory, len: 0 }
    }
}

impl<T> Deref for Lent<'_, T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        self.memory.get(..self.len).unwrap_or_default()
    }
}

impl<T> DerefMut for Lent<'_, T> {
    fn deref_mut(&mut self) -> &mut [T] {
        self.memory.get_mut(..self.len).unwrap_or_default()
    }
}

impl<T: Copy> List for Lent<'_, T> {
    type Item = T;
    fn capacity(&self) -> usize {
        self.memory.len()
    }
    fn resize(&mut self, len: usize, with: T) -> bool {
        let Some(list) = self.memory.get_mut(..len) else {
            return false;
        };
        list.iter_mut().skip(self.len).for_each(|item| *item = with);
        self.len = len;
        true
    }
    fn push(&mut self, item: &T) {
        if let Some(place) = self.memory.get_mut(self.len) {
            *place = *item;
            self.len += 1;
        }
    }
    fn truncate(&mut self, len: usize) {
        self.len = self.len.min(len);
    }
}
