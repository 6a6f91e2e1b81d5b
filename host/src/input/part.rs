//! What the user says about single columns: `--columns theta_s=2,brdf=3`.

use serde::Serialize;

use super::head::{Head, plain};
use super::role::{self, Role};
use super::units::Quantity;
use crate::error::{Error, shown};
use crate::plain::some_of;

/// What a column is said to hold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// A role that a name could give too.
    Role(Role),
    /// Standard deviation in the unit of the value.
    Sigma,
    /// Standard deviation over the value, or percent of it if its head says so.
    RelativeSigma,
    /// Standard deviation in percent of the value.
    PercentSigma,
    /// Factor of the residual.
    Weight,
}

/// The names that `--columns` takes.
const NAMES: &str = "theta_i, theta_s, phi_i, phi_s, delta_phi, wavelength, polarisation, sample, brdf, ln_brdf, log10_brdf, brdf_cos, brf, \
     brf_cos, sigma, rel_sigma, percent_sigma, weight";

/// Reads `theta_s=2` or `theta_s=name`.
///
/// # Errors
/// Another form, or an unknown name.
pub fn parse(text: &str) -> Result<(Part, String), String> {
    let (part, column) = text.split_once('=').ok_or("write NAME=COLUMN, such as theta_s=2")?;
    if column.trim().is_empty() {
        return Err("give the number or the name of a column".to_string());
    }
    let part = match plain(part).as_str() {
        "thetai" => Part::Role(Role::ThetaI),
        "thetas" => Part::Role(Role::ThetaS),
        "phii" => Part::Role(Role::PhiI),
        "phis" => Part::Role(Role::PhiS),
        "deltaphi" => Part::Role(Role::DeltaPhi),
        "wavelength" => Part::Role(Role::Wavelength),
        "polarisation" | "polarization" => Part::Role(Role::Polarisation),
        "sample" => Part::Role(Role::Sample),
        "sigma" => Part::Sigma,
        "relsigma" => Part::RelativeSigma,
        "percentsigma" => Part::PercentSigma,
        "weight" => Part::Weight,
        other => match role::quantity(other) {
            Some(quantity) => Part::Role(Role::Value(quantity)),
            None => return Err(format!("'{}' is none of {NAMES}", part.trim())),
        },
    };
    Ok((part, column.trim().to_string()))
}

/// The place of a column that is given by its number, from 1, or by its name.
///
/// # Errors
/// There is none, or there are several.
pub fn place(column: &str, heads: &[Head], option: &str) -> Result<usize, Error> {
    let fail = |what: String| {
        let names: Vec<String> = heads.iter().map(|head| shown(&head.text)).collect();
        Err(Error::new(what).help(format!(
            "{option} takes the numbers 1 to {} or the names of columns: {}",
            heads.len(),
            some_of(&names)
        )))
    };
    if let Ok(number) = column.parse::<usize>() {
        return match number.checked_sub(1).filter(|&place| place < heads.len()) {
            Some(place) => Ok(place),
            None => fail(format!("there is no column {number}")),
        };
    }
    let exact = heads.iter().position(|head| head.text == column);
    let alike: Vec<usize> = (0..heads.len()).filter(|&k| heads[k].plain == plain(column)).collect();
    match (exact, &alike[..]) {
        (Some(place), _) | (None, &[place]) => Ok(place),
        (None, []) => fail(format!("there is no column '{}'", shown(column))),
        _ => fail(format!("there are several columns '{}'", shown(column))),
    }
}

/// The quantity of a role that is a value.
pub fn quantity(part: Part) -> Option<Quantity> {
    match part {
        Part::Role(Role::Value(quantity)) => Some(quantity),
        _ => None,
    }
}
