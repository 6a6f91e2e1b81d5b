//! The parameters of a model: what values they can have, and bounds.

use crate::engine::models::MODELS;
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
        Error::new(format!("there is no parameter '{}'", shown(name)))
            .help(format!("the parameters are {}", names_of(model)))
    })
}

/// The names of the parameters of a model, with commas between.
pub fn names_of(model: &Model) -> String {
    let names: Vec<&str> = model.parameters.iter().map(|parameter| parameter.name).collect();
    names.join(", ")
}

/// The word for terms or a model that the scan chooses.
pub const AUTO: &str = "auto";

/// The one model of this name.
///
/// # Errors
/// No such name, or there are several to choose from.
pub fn model(name: &str) -> Result<&'static Model, Error> {
    if name.trim() == AUTO || name.contains(',') {
        return Err(
            Error::new("this command takes one model").help("name one; brdfit compare shows which a scan needs")
        );
    }
    Model::find(name.trim()).ok_or_else(|| {
        let names: Vec<&str> = MODELS.iter().map(|model| model.name).collect();
        Error::new(format!("there is no model '{}'", shown(name))).help(format!("the models are {}", names.join(", ")))
    })
}

/// The models of a list with commas between, each once; all models for `auto`.
///
/// # Errors
/// A name is unknown, or given twice.
pub fn models(list: &str) -> Result<Vec<&'static Model>, Error> {
    if list.trim() == AUTO {
        return Ok(MODELS.iter().collect());
    }
    let mut models: Vec<&'static Model> = Vec::new();
    for name in list.split(',') {
        if name.trim() == AUTO {
            return Err(Error::new("auto is all models").help("give it alone, or name models"));
        }
        let model = model(name)?;
        if models.contains(&model) {
            return Err(Error::new(format!("the model {} is given twice", model.name)).help("give it once"));
        }
        models.push(model);
    }
    Ok(models)
}
