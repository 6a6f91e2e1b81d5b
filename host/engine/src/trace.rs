//! The course of a search.

use brdfit_core::geometry::Sample;
use brdfit_core::search::Evaluations;

use crate::compiled;
use crate::error::FitError;
use crate::options::FitOptions;
use crate::scale::Scale;
pub use crate::search::watched::{Record, Trace};

/// Work in units of a pass with derivatives: one without them counts half.
pub fn passes(evaluations: Evaluations) -> f64 {
    f64::from(evaluations.linearize) + 0.5 * f64::from(evaluations.cost)
}

/// Searches on one thread, and watches.
///
/// The time begins when the scan stands in blocks, and each new best adds a look at the clock.
///
/// # Errors
/// [`FitError`]; [`FitError::Trace`] where the options tell of an instrument.
pub fn trace(samples: &[Sample<f64>], options: &FitOptions) -> Result<Trace, FitError> {
    if !options.instrument.is_plain() {
        return Err(FitError::Trace);
    }
    let Some(scale) = Scale::of(&[samples], options) else {
        let (set, options) = compiled::set_of(options)?;
        return set.trace(samples, &options);
    };
    let (set, options) = compiled::set_of(&scale.options(options)?)?;
    let course = set.trace(&scale.samples(samples), &options)?;
    Ok(scale.trace(options.model.parameters, course))
}
