//! The parameters of the model: their names, what values they can have, and bounds.

use brdfit_core::brdf::{NAMES, Params, has};

use crate::error::{Error, shown};
use crate::terms::term_names;

/// A permitted range of one parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Place in [`NAMES`].
    pub index: usize,
    /// Least value.
    pub lower: f64,
    /// Largest value; equal to `lower` it holds the parameter fixed.
    pub upper: f64,
}

/// The least and the largest value that parameter `index` of [`NAMES`] can have at all.
///
/// Physics gives rho >= 0, m > 0, n >= 1 and kappa >= 0; the other ends keep the arithmetic of `f32` finite.
pub fn domain(index: usize) -> (f64, f64) {
    const LARGEST: f64 = 1e6;
    match NAMES[index] {
        "m" => (1e-6, LARGEST),
        "n" => (1.0, LARGEST),
        _ => (0.0, LARGEST),
    }
}

/// Refuses a value that parameter `index` can not have.
///
/// # Errors
/// The value is NaN or outside [`domain`].
pub fn check(index: usize, value: f64) -> Result<(), Error> {
    let (least, largest) = domain(index);
    if value >= least && value <= largest {
        return Ok(());
    }
    Err(Error::new(format!("{} can not be {value}", NAMES[index]))
        .help(format!("take a number from {least} to {largest}")))
}

/// Narrows or widens the bounds of the model's parameters to `ranges`.
///
/// # Errors
/// A parameter is named twice, or is not part of `terms`.
pub fn apply(ranges: &[Range], terms: u8, lower: &mut Params<f64>, upper: &mut Params<f64>) -> Result<(), Error> {
    let (mut least, mut largest) = (lower.to_array(), upper.to_array());
    for (place, range) in ranges.iter().enumerate() {
        let name = NAMES[range.index];
        if ranges[..place].iter().any(|other| other.index == range.index) {
            return Err(Error::new(format!("{name} is bounded or fixed twice")).help("keep one of the options"));
        }
        if !has(terms, range.index) {
            let names = term_names(terms).join(",");
            return Err(Error::new(format!("{name} is no parameter of the terms {names}"))
                .help("leave out its --bounds or --fix, or take more --terms"));
        }
        least[range.index] = range.lower;
        largest[range.index] = range.upper;
    }
    (*lower, *upper) = (Params::from_array(least), Params::from_array(largest));
    Ok(())
}

/// The place of a parameter in [`NAMES`].
///
/// # Errors
/// There is none of this name.
pub fn parameter(name: &str) -> Result<usize, Error> {
    let known = NAMES.iter().position(|known| *known == name.trim());
    known.ok_or_else(|| {
        Error::new(format!("there is no parameter '{}'", shown(name)))
            .help(format!("the parameters are {}", NAMES.join(", ")))
    })
}
