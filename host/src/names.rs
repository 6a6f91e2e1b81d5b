//! The words for what the engine was asked for and how it ended.

use brdfit_core::lm::Stop;

use crate::engine::{Method, Precision};

/// The methods of a search by name.
pub const METHODS: [(&str, Method); 2] = [("default", Method::Default), ("paper", Method::Paper)];

/// The number types by name.
pub const PRECISIONS: [(&str, Precision); 2] = [("f64", Precision::F64), ("f32", Precision::F32)];

/// The name in [`METHODS`].
pub fn method(method: Method) -> &'static str {
    name(&METHODS, method)
}

/// The name in [`PRECISIONS`].
pub fn precision(precision: Precision) -> &'static str {
    name(&PRECISIONS, precision)
}

fn name<T: PartialEq>(names: &[(&'static str, T)], of: T) -> &'static str {
    names
        .iter()
        .find(|(_, known)| *known == of)
        .map_or("", |(name, _)| name)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_has_a_name() {
        let methods = [Method::Default, Method::Paper].map(method);
        let precisions = [Precision::F64, Precision::F32].map(precision);
        assert_eq!((methods, precisions), (["default", "paper"], ["f64", "f32"]));
    }
}
