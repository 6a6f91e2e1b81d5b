//! What fits of the same samples are compared by.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::chance::above_f;
use crate::engine::Precision;

/// How well a fit does, and what it takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criteria {
    /// Number of its free parameters.
    pub parameters: usize,
    /// Samples of weight above 0.
    pub samples: f64,
    /// Sum of squared residuals of ln f, by their correlation where that is seen, but at least what rounding leaves.
    cost: f64,
    /// Akaike's criterion with Hurvich and Tsai's correction; infinite with too few samples.
    pub aicc: f64,
    /// Schwarz's criterion.
    pub bic: f64,
}

/// Samples that count.
pub fn counted(samples: &[Sample<f64>]) -> usize {
    samples.iter().filter(|sample| sample.weight != 0.0).count()
}

impl Criteria {
    /// Of a fit of this cost with so many free parameters.
    pub fn new(samples: usize, parameters: usize, cost: f64, precision: Precision) -> Self {
        let samples = samples as f64;
        let cost = cost.max(rounding(samples, precision));
        // The variance of the residuals is a parameter too.
        let k = parameters as f64 + 1.0;
        let deviance = samples * Real::portable_ln(cost / samples);
        let room = samples - k - 1.0;
        Criteria {
            parameters,
            samples,
            cost,
            aicc: if room > 0.0 {
                deviance + 2.0 * k + 2.0 * k * (k + 1.0) / room
            } else {
                f64::INFINITY
            },
            bic: deviance + k * Real::portable_ln(samples),
        }
    }

    /// Probability by chance of at least the fall of the cost from `smaller`, a fit of a model within this one: the F test; `None` if that has as many parameters.
    pub fn p_value(&self, smaller: &Criteria) -> Option<f64> {
        let more = self
            .parameters
            .checked_sub(smaller.parameters)
            .filter(|&more| more > 0)? as f64;
        let left = self.samples - self.parameters as f64;
        let fall = smaller.cost.max(self.cost) - self.cost;
        let f = fall / more / (self.cost / left);
        above_f(f, more, left)
    }
}

/// A cost below this is rounding, of which no criterion may make anything.
fn rounding(samples: f64, precision: Precision) -> f64 {
    let residual = match precision {
        Precision::F64 => 1e-10,
        Precision::F32 => 1e-5,
    };
    samples * residual * residual
}
