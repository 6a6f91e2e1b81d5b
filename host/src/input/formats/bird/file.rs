//! The arrays of a BiRD file, and their numbers.

use serde::Deserialize;
use serde_json::value::RawValue;

use crate::error::{Error, shown};
use crate::input::bytes::Lines;
use crate::input::unit::Unit;

/// The parts of a file that are read.
#[derive(Deserialize)]
pub(super) struct File<'a> {
    #[serde(borrow)]
    pub(super) metadata: Option<&'a RawValue>,
    pub(super) data: Data<'a>,
}

/// Its arrays.
#[derive(Deserialize)]
pub(super) struct Data<'a> {
    #[serde(borrow)]
    pub(super) theta_i: Variable<'a>,
    pub(super) phi_i: Variable<'a>,
    pub(super) theta_r: Variable<'a>,
    pub(super) phi_r: Variable<'a>,
    #[serde(rename = "BRDF")]
    pub(super) brdf: Variable<'a>,
    #[serde(rename = "uBRDF")]
    pub(super) u_brdf: Option<Variable<'a>>,
    pub(super) wavelength_i: Option<Variable<'a>>,
    pub(super) wavelength_r: Option<Variable<'a>>,
    pub(super) polarization_i: Option<Variable<'a>>,
    pub(super) polarization_r: Option<Variable<'a>>,
}

/// A named array; polarisations have a notation in place of a unit.
#[derive(Deserialize)]
pub(super) struct Variable<'a> {
    #[serde(default)]
    pub(super) unit: String,
    #[serde(borrow)]
    pub(super) values: Vec<&'a RawValue>,
    pub(super) uncertainty: Option<&'a RawValue>,
}

/// The number at a place of the text; null is no value.
pub(super) fn number(raw: &RawValue, text: &str, lines: &Lines) -> Result<f64, Error> {
    if raw.get() == "null" {
        return Ok(f64::NAN);
    }
    raw.get().parse().map_err(|_| {
        let (line, column) = lines.place(text, raw.get());
        Error::new(format!("'{}' is not a number", shown(raw.get())))
            .at_line(line)
            .at_column(column)
            .help("write a number, or null and use --drop-invalid if there is no value")
    })
}

/// What makes degrees of this angle.
pub(super) fn in_degrees(name: &str, angle: &Variable) -> Result<fn(f64) -> f64, Error> {
    match Unit::parse(&angle.unit) {
        Some(Unit::Deg) => Ok(|angle| angle),
        Some(Unit::Rad) => Ok(f64::to_degrees),
        _ => Err(Error::new(format!("the unit of {name} is '{}'", shown(&angle.unit))).help("give deg, ° or rad")),
    }
}
