//! Texts.

use core::ffi::{CStr, c_char};

use brdfit_core::real::Real;

/// pi: the delta_phi of samples in the plane of incidence; (float)BRDFIT_PI in single precision.
// The header needs the digits.
#[allow(clippy::approx_constant)]
pub const BRDFIT_PI: f64 = 3.141592653589793;

const _: () = assert!(BRDFIT_PI == <f64 as Real>::PI && BRDFIT_PI as f32 == <f32 as Real>::PI);

/// The version of the library, such as "0.2.0".
#[unsafe(no_mangle)]
pub extern "C" fn brdfit_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// What a brdfit_error means, in a few words; any other number gives "unknown error".
#[unsafe(no_mangle)]
pub extern "C" fn brdfit_error_text(error: i32) -> *const c_char {
    let text: &CStr = match error {
        0 => c"no error",
        -1 => c"a pointer is null",
        -2 => c"a pointer is not aligned",
        -3 => c"a length is zero, or larger than memory",
        -4 => c"no room for a further sample",
        -5 => c"a number is NaN or infinite",
        -6 => c"an angle is at or beyond the horizon",
        -7 => c"a BRDF or a weight is not positive",
        -8 => c"a parameter has a value that it cannot have",
        -9 => c"the bounds are the wrong way round, or not values of their parameters",
        -10 => c"no such model, or none of just these terms",
        -11 => c"a tolerance, the damping or a count is out of range",
        -12 => c"fewer samples than parameters",
        -13 => c"scan, fit or search was not begun",
        -14 => c"no start gives a finite model",
        -15 => c"not a saved search of this kind, or damaged",
        -16 => c"the memory of a search is too small",
        _ => c"unknown error",
    };
    text.as_ptr()
}

/// What a brdfit_stop means, in a few words; any other number gives "unknown stop".
#[unsafe(no_mangle)]
pub extern "C" fn brdfit_stop_text(stop: i32) -> *const c_char {
    let text: &CStr = match stop {
        0 => c"not ended",
        1 => c"converged in cost",
        2 => c"converged in steps",
        3 => c"largest number of passes made",
        4 => c"model not finite at the start",
        _ => c"unknown stop",
    };
    text.as_ptr()
}
