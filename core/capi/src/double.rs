//! The functions of C in `f64`.
//!
//! Safety, of all: what the top of the header asks of pointers.

use crate::types::*;
use crate::{fit, options, scan};

fn code(done: Result<(), brdfit_error>) -> brdfit_error {
    match done {
        Ok(()) => brdfit_error::None,
        Err(error) => error,
    }
}

/// Sets all options to their usual values.
///
/// Errors: NULL, MISALIGNED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_options_init_f64(options: *mut brdfit_options<f64>) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { options::options_init(options) })
}

/// Begins a scan without samples in `count` blocks, which stay the caller's, and must live as long as the scan.
///
/// Errors: NULL, MISALIGNED, LENGTH.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_scan_init_f64(
    scan: *mut brdfit_scan<f64>,
    blocks: *mut brdfit_block<f64>,
    count: usize,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { scan::scan_init(scan, blocks, count) })
}

/// Adds samples. After an error those before the bad one have been added; scan->samples tells how many there are.
///
/// Errors: NULL, MISALIGNED, LENGTH, FULL, NOT_FINITE, BEYOND_HORIZON, NOT_POSITIVE, NOT_BEGUN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_scan_add_f64(
    scan: *mut brdfit_scan<f64>,
    samples: *const brdfit_sample<f64>,
    count: usize,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { scan::scan_add(scan, samples, count) })
}

/// The BRDF of Eq. 14 with all terms, sr^-1, at least the smallest normal number; angles in radians as in brdfit_sample.
///
/// Errors: NULL, MISALIGNED, NOT_FINITE, BEYOND_HORIZON, PARAMS.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_brdf_f64(
    theta_i: f64,
    theta_s: f64,
    delta_phi: f64,
    params: *const brdfit_params<f64>,
    brdf: *mut f64,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { scan::brdf(BRDFIT_MODEL_BECKMANN, [theta_i, theta_s, delta_phi], params, brdf) })
}

/// The same of any model: BRDFIT_MODEL_BECKMANN or BRDFIT_MODEL_GGX.
///
/// Errors: those of brdfit_brdf_f64(), and TERMS where there is no such model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_model_brdf_f64(
    model: u32,
    theta_i: f64,
    theta_s: f64,
    delta_phi: f64,
    params: *const brdfit_params<f64>,
    brdf: *mut f64,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { scan::brdf(model, [theta_i, theta_s, delta_phi], params, brdf) })
}

/// A start worth a fit: number `index` of the sequence of options->seed, with the weights that fit best there. One pass. Null options are the usual ones.
///
/// Errors: NULL, MISALIGNED, BOUNDS, TERMS, OPTIONS, TOO_FEW, NOT_BEGUN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_candidate_f64(
    scan: *const brdfit_scan<f64>,
    options: *const brdfit_options<f64>,
    index: u64,
    start: *mut brdfit_params<f64>,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { fit::candidate(scan, options, index, start) })
}

/// Begins a fit at the point within the bounds that is nearest to `start`. One pass. Null options are the usual ones; they are copied into the fit.
///
/// Errors: NULL, MISALIGNED, NOT_FINITE, BOUNDS, TERMS, OPTIONS, TOO_FEW, NOT_BEGUN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_fit_begin_f64(
    fit: *mut brdfit_fit<f64>,
    scan: *const brdfit_scan<f64>,
    start: *const brdfit_params<f64>,
    options: *const brdfit_options<f64>,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { fit::fit_begin(fit, scan, start, options) })
}

/// Goes on with a fit for at most `passes` further passes (UINT32_MAX: until it ends), with the scan that it began with. A fit made in pieces ends with the same bits as one made at once. Nothing happens to a fit that has ended.
///
/// Errors: NULL, MISALIGNED, TOO_FEW, NOT_BEGUN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_fit_run_f64(
    fit: *mut brdfit_fit<f64>,
    scan: *const brdfit_scan<f64>,
    passes: u32,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { fit::fit_run(fit, scan, passes) })
}

/// Where a fit is: at any moment the best so far.
///
/// Errors: NULL, MISALIGNED, NOT_BEGUN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_fit_result_f64(
    fit: *const brdfit_fit<f64>,
    result: *mut brdfit_result<f64>,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { fit::fit_result(fit, result) })
}

/// Searches the global optimum, and writes the distinct minima that it met, best first and at most `capacity`. Without interest in them, give null and 0. Null options are the usual ones.
///
/// This needs more stack than all others, whatever the number of samples: see README.md.
///
/// Errors: NULL, MISALIGNED, LENGTH, BOUNDS, TERMS, OPTIONS, TOO_FEW, NOT_BEGUN, NO_FIT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_search_f64(
    scan: *const brdfit_scan<f64>,
    options: *const brdfit_options<f64>,
    minima: *mut brdfit_minimum<f64>,
    capacity: usize,
    found: *mut brdfit_found<f64>,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { fit::search(scan, options, minima, capacity, found) })
}
