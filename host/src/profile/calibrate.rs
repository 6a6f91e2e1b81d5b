//! How far the cost of copies of a scan rises at the parameter they were made with: what the F test assumes, measured.

use brdfit_core::brdf::Params;
use brdfit_core::geometry::Sample;
use rayon::prelude::*;

use super::{LEVELS, hold};
use crate::bootstrap::{Noise, copy, quantile};
use crate::engine::{self, FitError, FitOptions};

/// The rises of the cost, over the variance of a residual, that shares of [`LEVELS`] of the copies stay below when parameter `index` is held at what they were made with.
///
/// The `count` copies are of the model at `params`, with normal errors of ln f of standard deviation `scale`; threads of the current rayon pool share them, and change no bit.
/// Where bounds are near, or parameters can stand in for each other, the rise is less than F says: there are fewer ways to go.
///
/// # Errors
/// [`FitError`].
pub fn thresholds(
    samples: &[Sample<f64>],
    options: &FitOptions,
    index: usize,
    params: &Params<f64>,
    scale: f64,
    count: u32,
) -> Result<[f64; 2], FitError> {
    let value = params.to_array()[index];
    let one = |k: u32| {
        let copy = copy(samples, params, scale, &mut Noise::new(options.seed, u64::from(k)));
        let outcome = engine::fit(&copy, options)?;
        let held = hold(&copy, options, &outcome, index, value)?;
        let best = outcome.cost.min(held.cost);
        Ok((held.cost - best) / best * outcome.uncertainty.degrees_of_freedom as f64)
    };
    let rises: Vec<f64> = (0..count).into_par_iter().map(one).collect::<Result<_, _>>()?;
    Ok(LEVELS.map(|level| quantile(&rises, level)))
}
