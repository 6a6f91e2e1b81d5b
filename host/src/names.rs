//! The words for what the engine was asked for and how it ended.

use brdfit_core::lm::Stop;

use crate::engine::{Method, Precision};

/// `default` or `paper`.
pub fn method(method: Method) -> &'static str {
    match method {
        Method::Default => "default",
        Method::Paper => "paper",
    }
}

/// `f64` or `f32`.
pub fn precision(precision: Precision) -> &'static str {
    match precision {
        Precision::F64 => "f64",
        Precision::F32 => "f32",
    }
}

/// The way a fit ended, as a word of the JSON contract.
pub fn stop(stop: Stop) -> &'static str {
    match stop {
        Stop::Cost => "cost",
        Stop::Step => "step",
        Stop::Passes => "passes",
        Stop::NotFinite => "not_finite",
    }
}

/// What that means, for people.
pub fn stop_meaning(stop: Stop) -> &'static str {
    match stop {
        Stop::Cost => "converged: no step promises less",
        Stop::Step => "converged as far as rounding allows",
        Stop::Passes => "NOT converged: all passes were used",
        Stop::NotFinite => "FAILED: the model is not finite at the start",
    }
}
