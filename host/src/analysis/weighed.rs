//! Priors against samples that tell less than their number says.
//!
//! The engine weighs a prior against samples of independent errors. Where residuals are correlated, so many samples tell as much as one would alone, and each of them counts too much: a prior of 1 % that the scan knows to 2 % would be all but ignored, and its parameter come out worse than the prior.
//! So the standard deviation by which priors are weighed is raised by the root of that number: the likelihood of independence, to the power of one over the number, beside the prior (Pauli, Racugno and Ventura 2011).

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::misfit::inflation_of_best;
use crate::engine::robust::kept;
use crate::engine::{self, FitError, FitOptions, Outcome};

/// Fits with another weight at most.
pub const ROUNDS: usize = 10;
/// A weight is settled that grows by less.
pub const SETTLED: f64 = 1e-3;

/// The fit with priors that count as they should; `outcome` itself where it has none, or residuals are not surely correlated.
///
/// # Errors
/// [`FitError`].
pub fn fit(samples: &[Sample<f64>], options: &FitOptions, mut outcome: Outcome) -> Result<Outcome, FitError> {
    if options.instrument.sigma.is_some() {
        return Ok(outcome);
    }
    for _ in 0..ROUNDS {
        let Some(sigma) = outcome.sigma else { break };
        let kept = kept(samples, &outcome);
        let Some(inflation) = inflation_of_best(&kept, &[&outcome]) else {
            break;
        };
        let raised = outcome.uncertainty.scale * Real::sqrt(inflation.factor);
        if !(raised > sigma * (1.0 + SETTLED)) {
            break;
        }
        let mut settled = options.settled(&outcome);
        settled.instrument.sigma = Some(raised);
        outcome = Outcome {
            robust: outcome.robust.clone(),
            ..engine::fit_from(&kept, &settled, &[outcome.params])?
        };
    }
    Ok(outcome)
}
