//! Enclosures of a function of two variables, its gradient and its second derivatives over a rectangle.

use std::ops::{Add, Mul, Sub};

use super::interval::Interval;

/// Value, first and second derivatives by the variables a and b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Jet {
    pub value: Interval,
    pub a: Interval,
    pub b: Interval,
    pub aa: Interval,
    pub ab: Interval,
    pub bb: Interval,
}

impl Jet {
    /// A number that does not depend on a and b.
    #[inline(always)]
    pub fn constant(value: Interval) -> Self {
        let zero = Interval::point(0.0);
        Jet {
            value,
            a: zero,
            b: zero,
            aa: zero,
            ab: zero,
            bb: zero,
        }
    }

    #[inline(always)]
    fn each(self, f: impl Fn(Interval) -> Interval) -> Self {
        Jet {
            value: f(self.value),
            a: f(self.a),
            b: f(self.b),
            aa: f(self.aa),
            ab: f(self.ab),
            bb: f(self.bb),
        }
    }

    #[inline(always)]
    fn both(self, other: Self, f: impl Fn(Interval, Interval) -> Interval) -> Self {
        Jet {
            value: f(self.value, other.value),
            a: f(self.a, other.a),
            b: f(self.b, other.b),
            aa: f(self.aa, other.aa),
            ab: f(self.ab, other.ab),
            bb: f(self.bb, other.bb),
        }
    }

    /// What two enclosures of the same function leave.
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        self.both(other, Interval::and)
    }

    /// f of this, from enclosures of f, f' and f'' over the values.
    #[inline(always)]
    fn chain(self, value: Interval, first: Interval, second: Interval) -> Self {
        Jet {
            value,
            a: first * self.a,
            b: first * self.b,
            aa: second * self.a.square() + first * self.aa,
            ab: second * (self.a * self.b) + first * self.ab,
            bb: second * self.b.square() + first * self.bb,
        }
    }

    /// The square root of a positive function.
    pub fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        let first = (root * 2.0).reciprocal();
        let second = -(first * (self.value * 2.0).reciprocal());
        self.chain(root, first, second)
    }

    /// The logarithm of a positive function.
    pub fn ln(self) -> Self {
        let first = self.value.reciprocal();
        self.chain(self.value.ln(), first, -first.square())
    }

    /// The reciprocal of a positive function.
    pub fn reciprocal(self) -> Self {
        let first = self.value.reciprocal();
        let second = first.square();
        self.chain(first, -second, second * first * 2.0)
    }
}

impl Add for Jet {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.both(other, |x, y| x + y)
    }
}

impl Sub for Jet {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.both(other, |x, y| x - y)
    }
}

impl Mul<Interval> for Jet {
    type Output = Self;
    #[inline(always)]
    fn mul(self, x: Interval) -> Self {
        self.each(|y| y * x)
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (x, y) = (self, other);
        Jet {
            value: x.value * y.value,
            a: x.a * y.value + x.value * y.a,
            b: x.b * y.value + x.value * y.b,
            aa: x.aa * y.value + x.a * y.a * 2.0 + x.value * y.aa,
            ab: x.ab * y.value + x.a * y.b + x.b * y.a + x.value * y.ab,
            bb: x.bb * y.value + x.b * y.b * 2.0 + x.value * y.bb,
        }
    }
}
