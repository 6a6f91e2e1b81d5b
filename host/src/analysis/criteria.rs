//! What fits of the same samples are compared by.

use std::cmp::Ordering;

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::chance::above_f;
use super::misfit::Inflation;
use crate::engine::{Precision, uncertainty};

/// How well a fit does, and what it takes.
///
/// Correlated samples count as fewer independent ones, all by the same factor, so that of fits with as many parameters the one of least cost is the best; the deviance is over that factor and the sample size is the effective one (Burnham and Anderson 2002, section 2.5; Jones 2011).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criteria {
    /// Number of its free parameters.
    pub parameters: usize,
    /// Samples of weight above 0, over the factor of their correlation.
    pub samples: f64,
    /// There are not even three samples more than parameters: a fit is near to all of them whatever the model.
    pub saturated: bool,
    /// Mean squared residual of ln f, but at least what rounding leaves.
    variance: f64,
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
    pub fn new(
        samples: usize,
        inflation: Option<Inflation>,
        parameters: usize,
        cost: f64,
        precision: Precision,
    ) -> Self {
        let variance = (cost / samples as f64).max(rounding(precision));
        let saturated = samples < parameters + 3;
        let samples = samples as f64 / inflation.map_or(1.0, |inflation| inflation.factor);
        // The variance of the residuals is a parameter too.
        let k = parameters as f64 + 1.0;
        let deviance = samples * Real::portable_ln(variance);
        let room = samples - k - 1.0;
        Criteria {
            parameters,
            samples,
            saturated,
            variance,
            aicc: if room > 0.0 {
                deviance + 2.0 * k + 2.0 * k * (k + 1.0) / room
            } else {
                f64::INFINITY
            },
            bic: deviance + k * Real::portable_ln(samples),
        }
    }

    /// Which is the better: of those that are not saturated before the others, the lower BIC.
    pub fn order(&self, other: &Criteria) -> Ordering {
        let saturated = self.saturated.cmp(&other.saturated);
        saturated.then(self.bic.total_cmp(&other.bic))
    }

    /// Probability by chance of at least the fall of the cost from `smaller`, a fit of a model within this one: the F test; `None` if that has as many parameters, or samples leave no degree of freedom.
    pub fn p_value(&self, smaller: &Criteria) -> Option<f64> {
        let more = self
            .parameters
            .checked_sub(smaller.parameters)
            .filter(|&more| more > 0)? as f64;
        let left = self.samples - self.parameters as f64;
        let fall = smaller.variance.max(self.variance) - self.variance;
        let f = fall / more / (self.variance / left);
        above_f(f, more, left)
    }
}

/// A mean square below this is rounding, of which no criterion may make anything.
fn rounding(precision: Precision) -> f64 {
    let residual = uncertainty::rounding(precision);
    residual * residual
}
