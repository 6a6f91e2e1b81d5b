//! What the keyword arguments mean to the engine.

use brdfit::engine::{FitOptions, Model, TERM_SETS};
use brdfit::names::METHODS;
use brdfit::parameters::{Range, apply, check};
use brdfit::terms;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The keyword arguments of `fit` and `fit_many`, as `python/brdfit/__init__.py` puts them together.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Settings {
    terms: Vec<String>,
    bounds: Vec<(String, f64, f64)>,
    seed: u64,
    method: String,
    /// Leaves out samples that are not valid, instead of refusing the scan.
    pub drop_invalid: bool,
}

impl Settings {
    /// The options of the engine.
    ///
    /// # Errors
    /// `ValueError`, one line that names the argument.
    pub fn options(&self) -> PyResult<FitOptions> {
        let method = METHODS.iter().find(|(name, _)| *name == self.method);
        let &(_, method) = method.ok_or_else(|| {
            let names = METHODS.map(|(name, _)| format!("{name:?}")).join(" or ");
            refuse(
                &format!("there is no method {:?}", self.method),
                &format!("method is {names}"),
            )
        })?;
        let mut options = FitOptions {
            method,
            seed: self.seed,
            terms: terms(&self.terms)?,
            ..FitOptions::default()
        };
        let ranges: Vec<Range> = self.bounds.iter().map(range).collect::<PyResult<_>>()?;
        apply(&ranges, &mut options)
            .map_err(|error| refuse(&error.what, "leave it out of bounds, or take more terms"))?;
        Ok(options)
    }
}

fn terms(names: &[String]) -> PyResult<u8> {
    terms::terms(&names.join(",")).map_err(|error| {
        let sets: Vec<String> = TERM_SETS.iter().map(|&set| terms::term_names(set).join(",")).collect();
        refuse(&error.what, &format!("terms is one of: {}", sets.join(" | ")))
    })
}

fn range((name, lower, upper): &(String, f64, f64)) -> PyResult<Range> {
    let model = Model::paper();
    let index = model.place(name).ok_or_else(|| {
        let names: Vec<&str> = model.parameters.iter().map(|parameter| parameter.name).collect();
        let help = format!("the parameters are {}", names.join(", "));
        refuse(&format!("there is no parameter {name:?}"), &help)
    })?;
    let (lower, upper) = (*lower, *upper);
    for value in [lower, upper] {
        let (least, largest) = model.parameters[index].domain;
        let help = format!("bounds take numbers from {least} to {largest}");
        check(model, index, value).map_err(|error| refuse(&error.what, &help))?;
    }
    if lower > upper {
        let help = format!("write \"{name}\": ({upper}, {lower})");
        return Err(refuse(&format!("the bounds of {name} are the wrong way round"), &help));
    }
    Ok(Range { index, lower, upper })
}

fn refuse(what: &str, help: &str) -> PyErr {
    PyValueError::new_err(format!("{what}; {help}"))
}
