//! Numbers that go through a formula side by side.

use core::ops::{Add, Div, Mul, Sub};

/// Does something for each of the places below `K`; written out for the first, as the compiler takes far longer to see through thousands of short loops.
macro_rules! each {
    ($count:ident, |$k:ident| $done:expr) => {
        each!($count, $k, $done, 0, 1, 2, 3, 4, 5);
        if const { $count > 6 } {
            for $k in 6..$count {
                $done;
            }
        }
    };
    ($count:ident, $k:ident, $done:expr, $($place:literal),+) => {
        $(if const { $count > $place } {
            let $k = $place;
            $done;
        })+
    };
}

pub(crate) use each;

/// `K` numbers; each operation is made for all of them before the next.
///
/// A processor looks only some hundred instructions ahead: the links of one long chain leave it idle, those of `K` chains in turn do not.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pack<R, const K: usize>(pub [R; K]);

impl<R: Copy + Default, const K: usize> Pack<R, K> {
    /// The same number everywhere.
    #[inline(always)]
    pub fn splat(x: R) -> Self {
        Pack([x; K])
    }
    /// The function of each place. (That of arrays in the standard library is a chain of functions that the compiler may leave as calls, which no vector instructions pass.)
    #[inline(always)]
    pub fn from_fn(f: impl Fn(usize) -> R) -> Self {
        let mut all = [R::default(); K];
        each!(K, |k| all[k] = f(k));
        Pack(all)
    }
    /// One of each `L / K` of a row, from `lane` on.
    #[inline(always)]
    pub fn gather<const L: usize>(row: &[R; L], lane: usize) -> Self {
        Self::from_fn(|k| row[lane + k * (L / K)])
    }
    /// One function of each.
    #[inline(always)]
    pub fn map(mut self, f: impl Fn(R) -> R) -> Self {
        each!(K, |k| self.0[k] = f(self.0[k]));
        self
    }
    /// One function of each pair.
    #[inline(always)]
    pub fn zip(mut self, other: Self, f: impl Fn(R, R) -> R) -> Self {
        each!(K, |k| self.0[k] = f(self.0[k], other.0[k]));
        self
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl<R: Copy + Default + $trait<Output = R>, const K: usize> $trait for Pack<R, K> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, R::$method)
            }
        }
        impl<R: Copy + Default + $trait<Output = R>, const K: usize> $trait<R> for Pack<R, K> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: R) -> Self {
                self.map(|x| x.$method(other))
            }
        }
    };
}
operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);
