//! How far the cost may rise before a value is refuted: by the F test, or as copies of the scan show it.

use brdfit_core::geometry::Sample;

use super::hold::hold;
use crate::analysis::bootstrap::{Noise, copy, quantile, redrawn};
use crate::analysis::chance::within_t;
use crate::engine::threads;
use crate::engine::{self, FitError, FitOptions, Values};

/// Confidence of the intervals: one standard error of a normal distribution, and 95 %.
pub const LEVELS: [f64; 2] = [0.682_689_492_137_085_9, 0.95];

/// The rise of the cost over the variance of a residual that ends an interval of this level: the square of Student's t (F of 1 and `degrees_of_freedom`).
pub fn threshold(level: f64, degrees_of_freedom: f64) -> f64 {
    let t = within_t(level, degrees_of_freedom);
    t * t
}

/// The rises of the cost, over the variance of a residual, that shares of [`LEVELS`] of the copies stay below when parameter `index` is held at what they were made with.
///
/// The `count` copies are of the model at `params`, through the aperture and without an offset, with normal errors of ln f of standard deviation `scale`; threads of the current rayon pool share them, and change no bit.
/// Where bounds are near, or parameters can stand in for each other, the rise is less than F says: there are fewer ways to go.
///
/// # Errors
/// [`FitError`].
pub fn thresholds(
    samples: &[Sample<f64>],
    options: &FitOptions,
    index: usize,
    params: &Values,
    scale: f64,
    count: u32,
) -> Result<[f64; 2], FitError> {
    let view = options.view(*params);
    let one = |k: u32| {
        let mut noise = Noise::new(options.seed, u64::from(k));
        let copy = copy(samples, view, scale, &mut noise);
        let options = &redrawn(options, params, &mut noise);
        let outcome = engine::fit_from(&copy, options, &[*params])?;
        let held = hold(&copy, options, &outcome, index, params[index])?;
        // What is free begins where what is held ended, and so never costs more.
        let best = engine::descend(&copy, options, &[outcome.params, held.params])?;
        let best = best.map_or(outcome.cost, |(cost, _)| cost.min(held.cost));
        Ok((held.cost - best) / best * outcome.uncertainty.degrees_of_freedom as f64)
    };
    let rises = threads::try_each(count as usize, &|k| one(k as u32))?;
    Ok(LEVELS.map(|level| quantile(&rises, level)))
}
