//! Numbers that a formula is written in once: plain ones, and dual numbers, which carry exact derivatives along.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::real::Real;

/// What a formula computes with: a plain `R`, or a [`Dual`].
pub trait Number<R>:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<R, Output = Self>
    + Sub<R, Output = Self>
    + Mul<R, Output = Self>
    + Div<R, Output = Self>
{
    /// A constant.
    fn of(value: R) -> Self;
    /// The value alone.
    fn value(self) -> R;
    /// Exponential.
    fn exp(self) -> Self;
    /// Natural logarithm of a positive number.
    fn ln(self) -> Self;
    /// Square root; its derivative at 0 counts as 0.
    fn sqrt(self) -> Self;
    /// A positive number to a power.
    fn pow(self, exponent: Self) -> Self {
        (self.ln() * exponent).exp()
    }
    /// The square.
    fn squared(self) -> Self {
        self * self
    }
}

impl<R: Real> Number<R> for R {
    fn of(value: R) -> Self {
        value
    }
    fn value(self) -> R {
        self
    }
    fn exp(self) -> Self {
        Real::portable_exp(self)
    }
    fn ln(self) -> Self {
        Real::portable_ln(self)
    }
    fn sqrt(self) -> Self {
        Real::sqrt(self)
    }
}

/// A value with its derivatives by `P` parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Dual<R, const P: usize> {
    /// The value.
    pub value: R,
    /// Its derivatives.
    pub slopes: [R; P],
}

impl<R: Real, const P: usize> Dual<R, P> {
    /// The parameters themselves.
    pub fn variables(x: &[R; P]) -> [Self; P] {
        core::array::from_fn(|i| Dual {
            value: x[i],
            slopes: core::array::from_fn(|j| if i == j { R::ONE } else { R::ZERO }),
        })
    }

    /// A function of this number, from its value and its derivative here.
    fn chain(self, value: R, slope: R) -> Self {
        Dual {
            value,
            slopes: self.slopes.map(|own| own * slope),
        }
    }

    /// A function of two numbers, from its value and its derivatives by both.
    fn join(self, by_self: R, other: Self, by_other: R, value: R) -> Self {
        Dual {
            value,
            slopes: core::array::from_fn(|k| self.slopes[k] * by_self + other.slopes[k] * by_other),
        }
    }
}

impl<R: Real, const P: usize> Number<R> for Dual<R, P> {
    fn of(value: R) -> Self {
        Dual {
            value,
            slopes: [R::ZERO; P],
        }
    }
    fn value(self) -> R {
        self.value
    }
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }
    fn ln(self) -> Self {
        self.chain(self.value.ln(), R::ONE / self.value)
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        let slope = if root > R::ZERO { R::of(0.5) / root } else { R::ZERO };
        self.chain(root, slope)
    }
}

impl<R: Real, const P: usize> Add for Dual<R, P> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.join(R::ONE, other, R::ONE, self.value + other.value)
    }
}
impl<R: Real, const P: usize> Sub for Dual<R, P> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.join(R::ONE, other, -R::ONE, self.value - other.value)
    }
}
impl<R: Real, const P: usize> Mul for Dual<R, P> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.join(other.value, other, self.value, self.value * other.value)
    }
}
impl<R: Real, const P: usize> Div for Dual<R, P> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let (quotient, inverse) = (self.value / other.value, R::ONE / other.value);
        self.join(inverse, other, -(quotient * inverse), quotient)
    }
}
impl<R: Real, const P: usize> Neg for Dual<R, P> {
    type Output = Self;
    fn neg(self) -> Self {
        self.chain(-self.value, -R::ONE)
    }
}
impl<R: Real, const P: usize> Add<R> for Dual<R, P> {
    type Output = Self;
    fn add(self, other: R) -> Self {
        self.chain(self.value + other, R::ONE)
    }
}
impl<R: Real, const P: usize> Sub<R> for Dual<R, P> {
    type Output = Self;
    fn sub(self, other: R) -> Self {
        self.chain(self.value - other, R::ONE)
    }
}
impl<R: Real, const P: usize> Mul<R> for Dual<R, P> {
    type Output = Self;
    fn mul(self, other: R) -> Self {
        self.chain(self.value * other, other)
    }
}
impl<R: Real, const P: usize> Div<R> for Dual<R, P> {
    type Output = Self;
    fn div(self, other: R) -> Self {
        self.chain(self.value / other, R::ONE / other)
    }
}
