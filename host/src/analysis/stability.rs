//! How much of the arithmetic's precision reaches the answer, and whether f32 is enough.

pub mod accuracy;
pub mod assess;
mod cases;
pub mod condition;
pub mod exact;

use crate::engine::FitOptions;
use assess::{Assessment, assess};

/// The assessment of every built-in case.
pub fn built_in() -> Vec<Assessment> {
    let cases = cases::all();
    let each = cases
        .iter()
        .map(|case| assess(case.name, &case.samples, &FitOptions::default()));
    each.map(|case| case.expect("the built-in cases are valid in both number types"))
        .collect()
}
