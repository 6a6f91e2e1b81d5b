//! The parameters of a model: what values they can have, and bounds.

use crate::engine::{FitOptions, Model};
use crate::error::{Error, shown};
use crate::number::shortest;
use crate::terms::term_names;

/// A permitted range of one parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Place among the parameters of the model.
    pub index: usize,
    /// Least value.
    pub lower: f64,
    /// Largest value; equal to `lower` it holds the parameter fixed.
    pub upper: f64,
}

/// Refuses a value that parameter `index` of the model cannot have.
///
/// # Errors
/// The value is NaN or outside the parameter's domain.
pub fn check(model: &Model, index: usize, value: f64) -> Result<(), Error> {
    let parameter = &model.parameters[index];
    let (least, largest) = parameter.domain;
    if value >= least && value <= largest {
        return Ok(());
    }
    Err(Error::new(format!("{} cannot be {}", parameter.name, shortest(value)))
        .help(format!("take a number from {least} to {largest}")))
}

/// Narrows or widens the bounds of the model's parameters to `ranges`.
///
/// # Errors
/// A parameter is named twice, or is not part of the terms.
pub fn apply(ranges: &[Range], options: &mut FitOptions) -> Result<(), Error> {
    for (place, range) in ranges.iter().enumerate() {
        let name = options.model.parameters[range.index].name;
        if ranges[..place].iter().any(|other| other.index == range.index) {
            return Err(Error::new(format!("{name} is bounded or fixed twice")).help("keep one of the options"));
        }
        if options.model.left_out(options.terms, range.index) {
            let names = term_names(options.terms).join(",");
            return Err(Error::new(format!("{name} is not a parameter of the terms {names}"))
                .help("leave out its --bounds or --fix, or take more --terms"));
        }
        options.lower[range.index] = range.lower;
        options.upper[range.index] = range.upper;
    }
    Ok(())
}

/// The place of a parameter of the model.
///
/// # Errors
/// No such name.
pub fn parameter(model: &Model, name: &str) -> Result<usize, Error> {
    model.place(name.trim()).ok_or_else(|| {
        let names: Vec<&str> = model.parameters.iter().map(|parameter| parameter.name).collect();
        Error::new(format!("there is no parameter '{}'", shown(name)))
            .help(format!("the parameters are {}", names.join(", ")))
    })
}

/// The model of this name.
///
/// # Errors
/// No such name.
pub fn model(name: &str) -> Result<&'static Model, Error> {
    Model::find(name.trim()).ok_or_else(|| {
        let names: Vec<&str> = crate::engine::models::MODELS.iter().map(|model| model.name).collect();
        Error::new(format!("there is no model '{}'", shown(name))).help(format!("the models are {}", names.join(", ")))
    })
}
