//! The functions of C in `f32`.
//!
//! Safety, of all: what the top of the header asks of pointers.

use crate::types::*;
use crate::{fit, options, scan, search};

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
pub unsafe extern "C" fn brdfit_options_init_f32(options: *mut brdfit_options<f32>) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { options::options_init(options) })
}

/// Begins a scan without samples in `count` blocks, which stay the caller's, and must live as long as the scan.
///
/// Errors: NULL, MISALIGNED, LENGTH.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_scan_init_f32(
    scan: *mut brdfit_scan<f32>,
    blocks: *mut brdfit_block<f32>,
    count: usize,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { scan::scan_init(scan, blocks, count) })
}

/// Adds samples. After an error those before the bad one have been added; scan->samples tells how many there are.
///
/// Errors: NULL, MISALIGNED, LENGTH, FULL, NOT_FINITE, BEYOND_HORIZON, NOT_POSITIVE, NOT_BEGUN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_scan_add_f32(
    scan: *mut brdfit_scan<f32>,
    samples: *const brdfit_sample<f32>,
    count: usize,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { scan::scan_add(scan, samples, count) })
}

/// The BRDF of Eq. 14 with all terms, sr^-1, at least the smallest normal number; angles in radians as in brdfit_sample.
///
/// Errors: NULL, MISALIGNED, NOT_FINITE, BEYOND_HORIZON, PARAMS.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_brdf_f32(
    theta_i: f32,
    theta_s: f32,
    delta_phi: f32,
    params: *const brdfit_params<f32>,
    brdf: *mut f32,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { scan::brdf(BRDFIT_MODEL_BECKMANN, [theta_i, theta_s, delta_phi], params, brdf) })
}

/// The same of any model: BRDFIT_MODEL_BECKMANN or BRDFIT_MODEL_GGX.
///
/// Errors: those of brdfit_brdf_f32(), and TERMS where there is no such model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_model_brdf_f32(
    model: u32,
    theta_i: f32,
    theta_s: f32,
    delta_phi: f32,
    params: *const brdfit_params<f32>,
    brdf: *mut f32,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { scan::brdf(model, [theta_i, theta_s, delta_phi], params, brdf) })
}

/// A start worth a fit: number `index` of the sequence of options->seed, with the weights that fit best there. One pass. Null options are the usual ones.
///
/// Errors: NULL, MISALIGNED, BOUNDS, TERMS, OPTIONS, TOO_FEW, NOT_BEGUN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_candidate_f32(
    scan: *const brdfit_scan<f32>,
    options: *const brdfit_options<f32>,
    index: u64,
    start: *mut brdfit_params<f32>,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { fit::candidate(scan, options, index, start) })
}

/// Begins a fit at the point within the bounds that is nearest to `start`. One pass. Null options are the usual ones; they are copied into the fit.
///
/// Errors: NULL, MISALIGNED, NOT_FINITE, BOUNDS, TERMS, OPTIONS, TOO_FEW, NOT_BEGUN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_fit_begin_f32(
    fit: *mut brdfit_fit<f32>,
    scan: *const brdfit_scan<f32>,
    start: *const brdfit_params<f32>,
    options: *const brdfit_options<f32>,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { fit::fit_begin(fit, scan, start, options) })
}

/// Goes on with a fit for at most `passes` further passes (UINT32_MAX: until it ends), with the scan that it began with. A fit made in pieces ends with the same bits as one made at once. Nothing happens to a fit that has ended.
///
/// Errors: NULL, MISALIGNED, TOO_FEW, NOT_BEGUN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_fit_run_f32(
    fit: *mut brdfit_fit<f32>,
    scan: *const brdfit_scan<f32>,
    passes: u32,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { fit::fit_run(fit, scan, passes) })
}

/// Where a fit is: at any moment the best so far.
///
/// Errors: NULL, MISALIGNED, NOT_BEGUN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_fit_result_f32(
    fit: *const brdfit_fit<f32>,
    result: *mut brdfit_result<f32>,
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
pub unsafe extern "C" fn brdfit_search_f32(
    scan: *const brdfit_scan<f32>,
    options: *const brdfit_options<f32>,
    minima: *mut brdfit_minimum<f32>,
    capacity: usize,
    found: *mut brdfit_found<f32>,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { fit::search(scan, options, minima, capacity, found) })
}

/// What the model needs to know of a pair of directions, angles in radians as in brdfit_sample: for a table, so that firmware at known angles needs no trigonometry.
///
/// Errors: NULL, MISALIGNED, NOT_FINITE, BEYOND_HORIZON.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_geometry_init_f32(
    theta_i: f32,
    theta_s: f32,
    delta_phi: f32,
    geometry: *mut brdfit_geometry<f32>,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { scan::geometry([theta_i, theta_s, delta_phi], geometry) })
}

/// Adds a sample whose geometry is known; brdf and weight as in brdfit_sample.
///
/// Errors: NULL, MISALIGNED, FULL, NOT_FINITE, BEYOND_HORIZON, NOT_POSITIVE, NOT_BEGUN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_scan_add_at_f32(
    scan: *mut brdfit_scan<f32>,
    geometry: *const brdfit_geometry<f32>,
    brdf: f32,
    weight: f32,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { scan::scan_add_at(scan, geometry, brdf, weight) })
}

/// Begins a search in steps, which remembers so many minima and has at most so many fits under way at a time, in `size` bytes of memory, as BRDFIT_SEARCH says: for example `static brdfit_search_state_f32 search[BRDFIT_SEARCH(4, 4)];` and `sizeof search, 4, 4`. No pass. Fewer minima change nothing but the table of them; with fewer than 4 fits a minimum is missed more often, and more are of no use. Null options are the usual ones; they are copied into the search.
///
/// Errors: NULL, MISALIGNED, LENGTH (no minimum or more than 65535, no fit or more than 255), BOUNDS, OPTIONS, SMALL, TERMS.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_search_begin_f32(
    search: *mut brdfit_search_state<f32>,
    size: usize,
    minima: u32,
    fits: u32,
    options: *const brdfit_options<f32>,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { search::begin(search, size, minima, fits, options) })
}

/// Goes on with a search for at most `passes` passes over the scan, always the same one; sets `ended` to 1 if the search has ended, and else to 0. With all its steps it ends in the bits of brdfit_search_f32(). Nothing happens to a search that has ended.
///
/// Errors: NULL, MISALIGNED, TOO_FEW, NOT_BEGUN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_search_step_f32(
    search: *mut brdfit_search_state<f32>,
    scan: *const brdfit_scan<f32>,
    passes: u32,
    ended: *mut u32,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { search::step(search, scan, passes, ended) })
}

/// What a search has found so far, with minima as in brdfit_search_f32(); NO_FIT before its first fit.
///
/// Errors: NULL, MISALIGNED, LENGTH, NOT_BEGUN, NO_FIT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_search_found_f32(
    search: *mut brdfit_search_state<f32>,
    minima: *mut brdfit_minimum<f32>,
    capacity: usize,
    found: *mut brdfit_found<f32>,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { search::found(search, minima, capacity, found) })
}

/// Ends a search where it is; what it has found stays.
///
/// Errors: NULL, MISALIGNED, NOT_BEGUN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_search_abort_f32(search: *mut brdfit_search_state<f32>) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { search::abort(search) })
}

/// Writes the state of a search as bytes, with version and checksum, and how many they are: fewer than its memory has. LENGTH if there is no room for them; then bytes may have changed.
///
/// Errors: NULL, MISALIGNED, LENGTH, NOT_BEGUN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_search_save_f32(
    search: *mut brdfit_search_state<f32>,
    bytes: *mut u8,
    capacity: usize,
    length: *mut usize,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { search::save(search, bytes, capacity, length) })
}

/// Takes the state that was written, on this machine or another; minima, fits and options are those that the search began with. It goes on with the same bits. After an error the search is not begun.
///
/// Errors: NULL, MISALIGNED, LENGTH, BOUNDS, TERMS, OPTIONS, SMALL, SAVED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_search_restore_f32(
    search: *mut brdfit_search_state<f32>,
    size: usize,
    minima: u32,
    fits: u32,
    options: *const brdfit_options<f32>,
    bytes: *const u8,
    length: usize,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { search::restore(search, size, minima, fits, options, bytes, length) })
}

/// What a scan tells of parameters at their optimum `params`, with the options of the search or fit; null options are the usual ones. One pass.
///
/// Errors: NULL, MISALIGNED, NOT_FINITE, PARAMS, BOUNDS, TERMS, OPTIONS, TOO_FEW, NOT_BEGUN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_uncertainty_at_f32(
    scan: *const brdfit_scan<f32>,
    options: *const brdfit_options<f32>,
    params: *const brdfit_params<f32>,
    uncertainty: *mut brdfit_uncertainty<f32>,
) -> brdfit_error {
    // SAFETY: see the top.
    code(unsafe { search::uncertainty(scan, options, params, uncertainty) })
}
