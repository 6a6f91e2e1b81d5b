//! Values of a model's parameters.

use std::ops::{Deref, DerefMut};

/// Parameters of a model at most.
pub const MOST: usize = 12;

/// A number for each parameter of a model, in the order of [`crate::Model::parameters`].
#[derive(Clone, Copy)]
pub struct Values {
    list: [f64; MOST],
    count: usize,
}

impl Values {
    /// `count` numbers, each the function of its place.
    pub fn from_fn(count: usize, of: impl FnMut(usize) -> f64) -> Self {
        (0..count).map(of).collect()
    }
}

impl FromIterator<f64> for Values {
    /// The first [`MOST`] numbers.
    fn from_iter<I: IntoIterator<Item = f64>>(numbers: I) -> Self {
        let mut values = Values {
            list: [0.0; MOST],
            count: 0,
        };
        for (place, number) in values.list.iter_mut().zip(numbers) {
            *place = number;
            values.count += 1;
        }
        values
    }
}

impl<const N: usize> From<[f64; N]> for Values {
    fn from(numbers: [f64; N]) -> Self {
        numbers.into_iter().collect()
    }
}

impl From<&[f64]> for Values {
    fn from(numbers: &[f64]) -> Self {
        numbers.iter().copied().collect()
    }
}

impl Deref for Values {
    type Target = [f64];
    fn deref(&self) -> &[f64] {
        &self.list[..self.count]
    }
}

impl DerefMut for Values {
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.list[..self.count]
    }
}

impl PartialEq for Values {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl std::fmt::Debug for Values {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}
