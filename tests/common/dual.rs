//! Dual numbers: a value with its exact derivatives by `P` parameters, and least-squares problems written in them; the same bits everywhere.
#![allow(clippy::suspicious_arithmetic_impl, reason = "the product and quotient rules")]

use std::ops::{Add, Div, Mul, Neg, Sub};

use brdfit_core::lm::{Linearization, Problem};

/// A value and its gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const P: usize> {
    /// The value.
    pub v: f64,
    /// Its derivatives.
    pub d: [f64; P],
}

impl<const P: usize> Dual<P> {
    /// The parameters themselves.
    pub fn variables(x: &[f64; P]) -> [Self; P] {
        std::array::from_fn(|i| Dual {
            v: x[i],
            d: std::array::from_fn(|j| f64::from(i == j)),
        })
    }

    fn chain(self, v: f64, slope: f64) -> Self {
        Dual {
            v,
            d: self.d.map(|d| slope * d),
        }
    }

    pub fn exp(self) -> Self {
        let e = libm::exp(self.v);
        self.chain(e, e)
    }
    /// 1 - e^x without cancellation.
    pub fn one_less_exp(self) -> Self {
        self.chain(-libm::expm1(self.v), -libm::exp(self.v))
    }
    pub fn ln(self) -> Self {
        self.chain(libm::log(self.v), 1.0 / self.v)
    }
    pub fn sqrt(self) -> Self {
        let root = self.v.sqrt();
        self.chain(root, 0.5 / root)
    }
    pub fn sin(self) -> Self {
        self.chain(libm::sin(self.v), libm::cos(self.v))
    }
    pub fn cos(self) -> Self {
        self.chain(libm::cos(self.v), -libm::sin(self.v))
    }
    pub fn atan(self) -> Self {
        self.chain(libm::atan(self.v), 1.0 / (1.0 + self.v * self.v))
    }
    pub fn square(self) -> Self {
        self.chain(self.v * self.v, 2.0 * self.v)
    }
    pub fn powf(self, p: f64) -> Self {
        self.chain(libm::pow(self.v, p), p * libm::pow(self.v, p - 1.0))
    }
    /// A positive base to a dual power.
    pub fn pow(self, power: Self) -> Self {
        (power * self.ln()).exp()
    }
    /// |x|, with the slope of the side on which x is.
    pub fn abs(self) -> Self {
        if self.v < 0.0 { -self } else { self }
    }
}

impl<const P: usize> From<f64> for Dual<P> {
    fn from(v: f64) -> Self {
        Dual { v, d: [0.0; P] }
    }
}

impl<const P: usize> Add for Dual<P> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Dual {
            v: self.v + other.v,
            d: std::array::from_fn(|i| self.d[i] + other.d[i]),
        }
    }
}
impl<const P: usize> Neg for Dual<P> {
    type Output = Self;
    fn neg(self) -> Self {
        self.chain(-self.v, -1.0)
    }
}
impl<const P: usize> Sub for Dual<P> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}
impl<const P: usize> Mul for Dual<P> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Dual {
            v: self.v * other.v,
            d: std::array::from_fn(|i| self.v * other.d[i] + self.d[i] * other.v),
        }
    }
}
impl<const P: usize> Div for Dual<P> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let v = self.v / other.v;
        Dual {
            v,
            d: std::array::from_fn(|i| (self.d[i] - v * other.d[i]) / other.v),
        }
    }
}

macro_rules! with_number {
    ($($operator:ident $method:ident),*) => {$(
        impl<const P: usize> $operator<f64> for Dual<P> {
            type Output = Self;
            fn $method(self, other: f64) -> Self {
                self.$method(Self::from(other))
            }
        }
        impl<const P: usize> $operator<Dual<P>> for f64 {
            type Output = Dual<P>;
            fn $method(self, other: Dual<P>) -> Dual<P> {
                Dual::from(self).$method(other)
            }
        }
    )*};
}
with_number!(Add add, Sub sub, Mul mul, Div div);

/// Residuals as a function of the parameters.
pub struct LeastSquares<F>(pub F);

impl<const P: usize, F: Fn(&[Dual<P>; P]) -> Vec<Dual<P>>> Problem<f64, P> for LeastSquares<F> {
    fn bend(&self, _x: &[f64; P], _step: &[f64; P], to: [f64; P]) -> [f64; P] {
        to
    }
    fn cost(&self, x: &[f64; P]) -> f64 {
        (self.0)(&Dual::variables(x)).iter().map(|r| r.v * r.v).sum()
    }

    fn linearize(&self, x: &[f64; P]) -> Linearization<f64, P> {
        let mut sums = Linearization {
            cost: 0.0,
            gradient: [0.0; P],
            hessian: [[0.0; P]; P],
        };
        for r in (self.0)(&Dual::variables(x)) {
            sums.cost += r.v * r.v;
            for i in 0..P {
                sums.gradient[i] += r.d[i] * r.v;
                for j in 0..P {
                    sums.hessian[i][j] += r.d[i] * r.d[j];
                }
            }
        }
        sums
    }
}
