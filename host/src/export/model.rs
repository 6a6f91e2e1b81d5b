//! The model that is exported, from a result or from parameters.

use std::path::Path;

use brdfit_core::brdf::{NAMES, Params};
use brdfit_core::geometry::Geometry;
use brdfit_core::real::Real;
use serde_json::Value;

use crate::engine::ln_f;
use crate::error::Error;
use crate::parameters::check;

/// A model, and what is known about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// What it is called: the scan's file, by default.
    pub name: String,
    /// Its parameters.
    pub params: Params<f64>,
    /// Their standard errors, as far as they are known.
    pub stderr: [Option<f64>; 6],
    /// Where it comes from, in one line.
    pub origin: String,
}

impl Model {
    /// From parameters alone.
    pub fn of_params(params: Params<f64>) -> Model {
        Model {
            name: "material".into(),
            params,
            stderr: [None; 6],
            origin: format!("parameters given to brdfit {}", env!("CARGO_PKG_VERSION")),
        }
    }

    /// From a result of `brdfit fit --format json`, of which `index` (from 1) chooses one if there are several.
    ///
    /// # Errors
    /// It is none, there are several and none is chosen, or its parameters have no BRDF.
    pub fn of_json(bytes: &[u8], index: Option<usize>) -> Result<Model, Error> {
        let none = |what: &str| Error::new(what).help("give what brdfit fit --format json has written");
        let all: Value =
            serde_json::from_slice(bytes).map_err(|error| none("this is no JSON").at_line(error.line() as u64))?;
        let results = match &all {
            Value::Array(results) => results.as_slice(),
            one => std::slice::from_ref(one),
        };
        let result = match (results, index) {
            ([one], None) => one,
            (several, None) => {
                return Err(Error::new(format!("there are {} results", several.len()))
                    .help("choose one with --index N, from 1 on"));
            }
            (several, Some(index)) => index
                .checked_sub(1)
                .and_then(|place| several.get(place))
                .ok_or_else(|| {
                    Error::new(format!(
                        "there are {} results, so none is number {index}",
                        several.len()
                    ))
                    .help("count from 1")
                })?,
        };
        let mut values = [0.0; NAMES.len()];
        for (place, name) in NAMES.into_iter().enumerate() {
            let value = result["parameters"][name].as_f64();
            values[place] = value.ok_or_else(|| none(&format!("there is no parameters.{name}")))?;
        }
        for (place, &value) in values.iter().enumerate() {
            check(place, value)?;
        }
        let text = |key: &str| result[key].as_str();
        let file = text("file").unwrap_or("material");
        let name = text("scan").map_or(file.to_string(), |scan| format!("{file} {scan}"));
        let mut origin = format!("brdfit {}, fitted to {name}", env!("CARGO_PKG_VERSION"));
        if let Some(rms) = result["rms_ln"].as_f64() {
            origin += &format!(", rms of ln f {rms:.3}");
        }
        let stderr = NAMES.map(|name| result["uncertainty"]["stderr"][name].as_f64());
        Ok(Model {
            name,
            params: Params::from_array(values),
            stderr,
            origin: origin.replace(['\n', '\r'], " "),
        })
    }

    /// f in sr^-1; angles in radians, 0 beyond the horizon.
    pub fn f(&self, theta_i: f64, theta_s: f64, delta_phi: f64) -> f64 {
        Geometry::new(theta_i, theta_s, delta_phi).map_or(0.0, |geometry| Real::exp(ln_f(&self.params, &geometry)))
    }
}

/// The model's name as a word of a program: letters, digits and underscores.
pub(super) fn word(name: &str) -> String {
    let stem = Path::new(name)
        .file_stem()
        .map_or(String::new(), |stem| stem.to_string_lossy().into_owned());
    let word: String = stem
        .chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() {
                c.to_ascii_lowercase()
            } else {
                '_'
            }
        })
        .collect();
    if word.starts_with(|c: char| c.is_ascii_alphabetic()) {
        word
    } else {
        format!("brdf_{word}")
    }
}
