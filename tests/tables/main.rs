//! Tables as people have them: read right, or refused with the option that settles the doubt.

mod columns;
mod files;
mod numbers;
mod wide;

use std::fs;

use brdfit_suite::program;
use brdfit_suite::scan::data;
use serde_json::Value;
use tempfile::TempDir;

/// A file of tests/data/read.
fn case(name: &str) -> String {
    data("read").join(name).to_str().expect("a path in UTF-8").to_string()
}

fn text_of(name: &str) -> String {
    fs::read_to_string(case(name)).expect("the case is there")
}

/// The fits of what is read, a list.
fn fits(arguments: &[&str]) -> Vec<Value> {
    let ran = program::brdfit(&[&["fit", "--format", "json"], arguments].concat(), b"");
    assert_eq!(ran.code, 0, "{arguments:?}: {}", ran.errors);
    match serde_json::from_str(&ran.output).expect("JSON") {
        Value::Array(fits) => fits,
        one => vec![one],
    }
}

/// The fit of the one scan that is read.
fn fit(arguments: &[&str]) -> Value {
    let mut fits = fits(arguments);
    assert_eq!(fits.len(), 1, "{arguments:?}");
    fits.remove(0)
}

fn parameter(fit: &Value, name: &str) -> f64 {
    fit["parameters"][name].as_f64().expect("a number")
}

/// Is a value the right one, to the digits that it is given with?
fn assert_is(fit: &Value, name: &str, right: f64, half_a_digit: f64) {
    let found = parameter(fit, name);
    assert!((found - right).abs() <= half_a_digit, "{name} is {found}, not {right}");
}

/// The scattering of f02: m 0.200, rho_d 0.300, rms 0.58 %.
fn assert_f02(fit: &Value) {
    assert_is(fit, "m", 0.200, 0.001);
    assert_is(fit, "rho_d", 0.300, 0.001);
    let rms = fit["rms_ln"].as_f64().expect("a number");
    assert!((rms - 0.0058).abs() < 0.0001, "{rms}");
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a folder")
}
