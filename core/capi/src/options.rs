//! Options: the usual ones, and whether the caller's make sense.

use brdfit_core::brdf::Params;
use brdfit_core::lm::{Bounds, Options};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::search::CANDIDATES;

use crate::Done;
use crate::memory::{optional, output};
use crate::types::*;

/// Table 1, Eq. 14 with all terms, and the tolerances of the core.
fn default_options<R: Real>() -> brdfit_options<R> {
    let of = |array: [f64; 6]| Params::from_array(array.map(R::of)).into();
    let options = Options::<R>::default();
    brdfit_options {
        seed: 0,
        terms: BRDFIT_ALL,
        model: BRDFIT_MODEL_BECKMANN,
        candidates: CANDIDATES,
        max_passes: options.max_passes,
        lower: of([0.0, 0.0, 0.0, 1e-5, 1.0, 0.0]),
        upper: of([1.0, 100.0, 100.0, 10.0, 100.0, 100.0]),
        cost_tolerance: options.cost_tolerance,
        step_tolerance: options.step_tolerance,
        damping: options.damping,
    }
}

/// Refuses values that the parameters cannot have.
pub fn check_params<R: Real>(params: &brdfit_params<R>) -> Done {
    let least = [0.0, 0.0, 0.0, 1e-6, 1.0, 0.0].map(R::of);
    for (value, least) in Params::from(*params).to_array().into_iter().zip(least) {
        if !value.is_finite() {
            return Err(brdfit_error::NotFinite);
        }
        if value < least || value > R::of(1e6) {
            return Err(brdfit_error::Params);
        }
    }
    Ok(())
}

/// The caller's options, or the usual ones.
///
/// # Safety
/// As for `memory::optional`.
pub unsafe fn options_at<R: Real>(options: *const brdfit_options<R>) -> Result<brdfit_options<R>, brdfit_error> {
    // SAFETY: as asked of the caller.
    let options = match unsafe { optional(options) }? {
        None => return Ok(default_options()),
        Some(options) => *options,
    };
    let (lower, upper) = (
        Params::from(options.lower).to_array(),
        Params::from(options.upper).to_array(),
    );
    let ordered = lower.into_iter().zip(upper).all(|(lower, upper)| lower <= upper);
    if !ordered || check_params(&options.lower).is_err() || check_params(&options.upper).is_err() {
        return Err(brdfit_error::Bounds);
    }
    let tolerable = |tolerance: R| tolerance.is_finite() && tolerance >= R::ZERO;
    let damped = options.damping.is_finite() && options.damping > R::ZERO;
    let counted = options.candidates > 0 && options.max_passes > 0;
    if !(tolerable(options.cost_tolerance) && tolerable(options.step_tolerance) && damped && counted) {
        return Err(brdfit_error::Options);
    }
    Ok(options)
}

/// What of them is the solver's.
pub fn lm_options<R: Real>(options: &brdfit_options<R>) -> Options<R> {
    Options {
        cost_tolerance: options.cost_tolerance,
        step_tolerance: options.step_tolerance,
        max_passes: options.max_passes,
        damping: options.damping,
    }
}

/// What of them are the bounds.
pub fn bounds<R: Real, const TERMS: u8, const P: usize>(options: &brdfit_options<R>) -> Bounds<R, P> {
    Scan::<R, TERMS, P>::bounds(&options.lower.into(), &options.upper.into())
}

pub unsafe fn options_init<R: Real>(options: *mut brdfit_options<R>) -> Done {
    // SAFETY: the contract of the header.
    unsafe { output(options) }?.write(default_options());
    Ok(())
}
