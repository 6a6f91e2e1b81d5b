//! Intervals of `f64` that are rounded outward.
//!
//! A result of IEEE `+ - * /` or sqrt is off by half a unit in the last place, one of [`Real::portable_exp`] or [`Real::portable_ln`] by less than one (tested against 50 digits).
//! Both ends are moved outward by at least twice that, so an interval contains every exact result of numbers in its operands.
//! Where infinite ends leave a result open, it is the whole line.

use std::ops::{Add, Mul, Neg, Sub};

use brdfit_core::real::Real;

/// All numbers from `lo` to `hi`, both included; `lo <= hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    pub lo: f64,
    pub hi: f64,
}

/// A number below every exact value that rounds to `x`.
#[inline(always)]
pub(crate) fn down(x: f64) -> f64 {
    x - (x.abs() * (2.0 * f64::EPSILON) + f64::MIN_POSITIVE)
}

/// A number above every exact value that rounds to `x`.
#[inline(always)]
pub(crate) fn up(x: f64) -> f64 {
    x + (x.abs() * (2.0 * f64::EPSILON) + f64::MIN_POSITIVE)
}

/// A number below e^x; 0 where e^x is too small.
#[inline(always)]
pub(crate) fn exp_down(x: f64) -> f64 {
    if x < -707.0 { 0.0 } else { down(Real::portable_exp(x)) }
}

/// A number above e^x.
#[inline(always)]
pub(crate) fn exp_up(x: f64) -> f64 {
    if x > 708.0 {
        f64::INFINITY
    } else {
        up(Real::portable_exp(x))
    }
}

/// A number below ln x; minus infinity where x is 0 or below every normal number.
#[inline(always)]
pub(crate) fn ln_down(x: f64) -> f64 {
    if x < f64::MIN_POSITIVE {
        f64::NEG_INFINITY
    } else if x == f64::INFINITY {
        709.0
    } else {
        down(Real::portable_ln(x))
    }
}

/// A number above ln x.
#[inline(always)]
pub(crate) fn ln_up(x: f64) -> f64 {
    if x == f64::INFINITY {
        x
    } else {
        up(Real::portable_ln(x.max(f64::MIN_POSITIVE)))
    }
}

impl Interval {
    /// The number `x` alone.
    #[inline(always)]
    pub fn point(x: f64) -> Self {
        Interval { lo: x, hi: x }
    }

    /// The numbers from `lo` to `hi`; an end that is NaN is infinite.
    #[inline(always)]
    pub fn new(lo: f64, hi: f64) -> Self {
        let lo = if lo.is_nan() { f64::NEG_INFINITY } else { lo };
        let hi = if hi.is_nan() { f64::INFINITY } else { hi };
        debug_assert!(lo <= hi, "{lo} > {hi}");
        Interval { lo, hi }
    }

    /// What two enclosures of the same number leave of it.
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        Interval::new(self.lo.max(other.lo), self.hi.min(other.hi))
    }

    /// What an enclosure of a number that is not negative leaves of it.
    #[inline(always)]
    pub fn not_negative(self) -> Self {
        Interval {
            lo: self.lo.max(0.0),
            hi: self.hi.max(0.0),
        }
    }

    /// The middle, to rounding.
    #[inline(always)]
    pub fn middle(self) -> f64 {
        self.lo + (self.hi - self.lo) * 0.5
    }

    /// The largest distance of a member from `x`.
    #[inline(always)]
    pub fn far_from(self, x: f64) -> f64 {
        up((self.hi - x).max(x - self.lo))
    }

    /// The square.
    #[inline(always)]
    pub fn square(self) -> Self {
        let (a, b) = (self.lo * self.lo, self.hi * self.hi);
        let least = if self.lo <= 0.0 && 0.0 <= self.hi {
            0.0
        } else {
            a.min(b)
        };
        Interval::new(down(least).max(0.0), up(a.max(b)))
    }

    /// The square root of numbers that are not negative, though their enclosure may reach below 0.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Interval::new(down(self.lo.max(0.0).sqrt()).max(0.0), up(self.hi.sqrt()))
    }

    /// The reciprocal of positive numbers, though their enclosure may reach beyond 0.
    #[inline(always)]
    pub fn reciprocal(self) -> Self {
        let hi = if self.lo > 0.0 {
            up(1.0 / self.lo)
        } else {
            f64::INFINITY
        };
        Interval::new(down(1.0 / self.hi).max(0.0), hi)
    }

    /// The logarithm of positive normal numbers, though their enclosure may reach below 0.
    #[inline(always)]
    pub fn ln(self) -> Self {
        Interval::new(ln_down(self.lo), ln_up(self.hi))
    }

    /// The exponential.
    #[inline(always)]
    pub fn exp(self) -> Self {
        Interval::new(exp_down(self.lo), exp_up(self.hi))
    }
}

impl Add for Interval {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Interval::new(down(self.lo + other.lo), up(self.hi + other.hi))
    }
}

impl Sub for Interval {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Interval::new(down(self.lo - other.hi), up(self.hi - other.lo))
    }
}

impl Neg for Interval {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Interval::new(-self.hi, -self.lo)
    }
}

impl Mul for Interval {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.lo * other.lo, self.lo * other.hi);
        let (c, d) = (self.hi * other.lo, self.hi * other.hi);
        if (a + b + c + d).is_nan() {
            // f64's min and max would drop the NaN of 0 times infinity.
            return Interval::new(f64::NEG_INFINITY, f64::INFINITY);
        }
        Interval::new(down(a.min(b).min(c.min(d))), up(a.max(b).max(c.max(d))))
    }
}

impl Mul<f64> for Interval {
    type Output = Self;
    #[inline(always)]
    fn mul(self, x: f64) -> Self {
        self * Interval::point(x)
    }
}
