//! Scans of any size: powers of two taken out of the BRDF and of the weights before anything is squared, and put back into what was found.
//!
//! f is linear in the weights of a model (rho_d, rho_s, ...), so that a scan in another unit has the same fit with its weights in that unit.
//! A power of two changes no digit of a number, and scans of an ordinary size are left alone: they keep their bits.

use brdfit_core::geometry::Sample;
use brdfit_core::model::Parameter;

use crate::values::Values;

/// A largest BRDF or weight within 2^-30 and 2^30, about 1e-9 and 1e9, is of an ordinary size; nothing darker or brighter has been measured.
pub(crate) const ORDINARY: i32 = 30;
/// The largest BRDF is put between 2^-3 and 2^-2 sr^-1, where rho_d of a matt surface is below 1.
pub(crate) const LARGEST: i32 = -2;

/// Exponents of the powers of two that are taken out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scale {
    /// Of the BRDF, and so of the weights of the model.
    pub brdf: i32,
    /// Of the weights of the samples, and so of their residuals.
    pub weight: i32,
}

impl Scale {
    /// Is the BRDF of a size that no surface has, so that its unit is not 1/sr?
    pub fn is_of_another_unit(self) -> bool {
        self.brdf != 0 && (self.brdf + LARGEST).abs() > ORDINARY
    }

    /// The samples without the scale.
    pub fn samples(self, samples: &[Sample<f64>]) -> Vec<Sample<f64>> {
        let one = |sample: &Sample<f64>| Sample {
            brdf: libm::ldexp(sample.brdf, -self.brdf),
            weight: libm::ldexp(sample.weight, -self.weight),
            ..*sample
        };
        samples.iter().map(one).collect()
    }

    /// Values without the scale.
    pub fn taken(self, parameters: &[Parameter], values: &Values) -> Values {
        self.scaled(parameters, values, -1)
    }

    /// Values with the scale.
    pub fn given(self, parameters: &[Parameter], values: &Values) -> Values {
        self.scaled(parameters, values, 1)
    }

    fn scaled(self, parameters: &[Parameter], values: &Values, sign: i32) -> Values {
        Values::from_fn(values.len(), |place| {
            libm::ldexp(values[place], sign * self.exponent(parameters, place))
        })
    }

    /// That of a parameter.
    pub(crate) fn exponent(self, parameters: &[Parameter], place: usize) -> i32 {
        if parameters[place].is_weight() { self.brdf } else { 0 }
    }

    /// A sum of squared residuals.
    pub fn cost(self, cost: f64) -> f64 {
        libm::ldexp(cost, 2 * self.weight)
    }

    pub(crate) fn residual(self, residual: f64) -> f64 {
        libm::ldexp(residual, self.weight)
    }
}

/// Values of a model with weights of an ordinary size, and the exponent of what f was divided by for that.
pub(crate) fn ordinary(parameters: &[Parameter], values: &[f64]) -> (Values, i32) {
    let weights = values.iter().zip(parameters);
    let weights = weights.filter(|(_, parameter)| parameter.is_weight());
    let largest = weights.map(|(weight, _)| *weight).fold(0.0, f64::max);
    let exponent = libm::frexp(largest).1;
    if exponent.abs() <= 2 * ORDINARY || !largest.is_finite() {
        return (values.into(), 0);
    }
    let scale = Scale {
        brdf: exponent,
        weight: 0,
    };
    (scale.taken(parameters, &values.into()), exponent)
}
