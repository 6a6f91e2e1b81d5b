//! Fits of all samples of a scan, of whatever size and with whatever instrument.

use brdfit_core::geometry::Sample;

use crate::error::FitError;
use crate::options::FitOptions;
use crate::outcome::Outcome;
use crate::scale::Scale;
use crate::search::setup::Setup;
use crate::values::Values;
use crate::with_instrument;

/// Fits one scan by a search and from `known` values.
pub(crate) fn fit(samples: &[Sample<f64>], options: &FitOptions, known: &[Values]) -> Result<Outcome, FitError> {
    scaled(samples, options, known, |samples, options, known| {
        let outcome = if options.instrument.is_plain() {
            with_instrument::run(samples, options, &Setup::default(), known)
        } else {
            with_instrument::fit(samples, options, known)
        };
        outcome.map(|outcome| outcome.calibrated(options))
    })
}

/// What `fit` makes of samples of an ordinary size, in the unit of the scan.
pub(crate) fn scaled(
    samples: &[Sample<f64>],
    options: &FitOptions,
    known: &[Values],
    fit: impl FnOnce(&[Sample<f64>], &FitOptions, &[Values]) -> Result<Outcome, FitError>,
) -> Result<Outcome, FitError> {
    let Some(scale) = Scale::of(&[samples], options) else {
        return fit(samples, options, known);
    };
    let parameters = options.model.parameters;
    let known: Vec<Values> = known.iter().map(|values| scale.taken(parameters, values)).collect();
    let found = fit(&scale.samples(samples), &scale.options(options)?, &known)?;
    Ok(scale.outcome(found))
}

/// Fits from given points to convergence, in `f64` and without a search: the best end, its cost and its parameters; `None` if no start has a finite cost, or none leads below a limit.
///
/// # Errors
/// [`FitError::Terms`], [`FitError::Sample`] and [`FitError::Interrupted`].
pub fn descend(
    samples: &[Sample<f64>],
    options: &FitOptions,
    starts: &[Values],
) -> Result<Option<(f64, Values)>, FitError> {
    let model = options.model;
    let Some(scale) = Scale::of(&[samples], options) else {
        return with_instrument::descend(samples, options, starts);
    };
    let starts: Vec<Values> = starts
        .iter()
        .map(|values| scale.taken(model.parameters, values))
        .collect();
    let end = with_instrument::descend(&scale.samples(samples), &scale.options(options)?, &starts)?;
    Ok(end.map(|(cost, values)| (scale.cost(cost), scale.given(model.parameters, &values))))
}
