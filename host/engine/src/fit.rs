//! Fits of one scan.

use brdfit_core::geometry::Sample;

use crate::error::FitError;
use crate::options::FitOptions;
use crate::outcome::Outcome;
use crate::values::Values;
use crate::{least_squares, robust};

/// Fits one scan; threads of the current rayon pool share the starts of the `paper` method, and change no bit.
///
/// # Errors
/// [`FitError`].
pub fn fit(samples: &[Sample<f64>], options: &FitOptions) -> Result<Outcome, FitError> {
    fit_from(samples, options, &[])
}

/// The same from values of the model's parameters that are known too: the fit ends no higher than they are.
///
/// # Errors
/// [`FitError`].
pub fn fit_from(samples: &[Sample<f64>], options: &FitOptions, known: &[Values]) -> Result<Outcome, FitError> {
    if options.robust {
        return least_squares::scaled(samples, options, known, robust::fit);
    }
    least_squares::fit(samples, options, known)
}
