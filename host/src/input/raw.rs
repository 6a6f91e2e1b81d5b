//! A scan as a reader gives it: numbers as they stand in the file.

use super::about::About;
use super::head::plain;
use super::left_out::Counts;
use super::units::{Angles, Quantity};
use super::wavelength;
use super::weight::Deviation;
use crate::error::{Error, shown};
use crate::plain::some_of;

/// A scan as it stands in the file; nothing is checked or converted.
#[derive(Clone, Debug, PartialEq)]
pub struct RawScan {
    /// What tells it from the other scans of the file, such as a column or a wavelength; may be empty.
    pub names: Vec<String>,
    /// The unit of its angles.
    pub angles: Angles,
    /// What its values are, as far as the file tells; [`Quantity::Brdf`] if it does not.
    pub quantity: Quantity,
    /// Where its numbers stand in a line.
    pub places: Places,
    /// Its rows, in order.
    pub rows: Vec<Row>,
    /// What the reader understood.
    pub about: About,
    /// What the reader left out of it.
    pub left_out: Counts,
}

impl RawScan {
    /// A scan without rows, whose values are a BRDF; `names` tells it from others of the file.
    pub fn new(names: Vec<String>, angles: Angles) -> RawScan {
        RawScan {
            names,
            angles,
            quantity: Quantity::Brdf,
            places: Places::default(),
            rows: Vec::new(),
            about: About::default(),
            left_out: Counts::default(),
        }
    }
}

/// Columns of a table, counted from 1; none where a file is no table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Places {
    /// Of the angle of incidence.
    pub theta_i: Option<u64>,
    /// Of the scattering angle.
    pub theta_s: Option<u64>,
    /// Of the azimuth.
    pub phi: Option<u64>,
    /// Of the value.
    pub value: Option<u64>,
    /// Of the standard deviation or the weight.
    pub weight: Option<u64>,
}

/// One value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Angle of incidence.
    pub theta_i: f64,
    /// Scattering angle, signed in plane.
    pub theta_s: f64,
    /// Azimuth of scattering less that of incidence; none in plane.
    pub delta_phi: Option<f64>,
    /// The value.
    pub value: f64,
    /// What is known of its uncertainty.
    pub weight: Weight,
    /// Its line, from 1; 0 if the file has none.
    pub line: u64,
}

/// What a file says of a value's uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weight {
    /// Nothing.
    Unknown,
    /// The standard deviation, in the unit of the value.
    Sigma(f64),
    /// The standard deviation over the value.
    RelativeSigma(f64),
    /// A factor of the residual.
    Factor(f64),
    /// The same, of the program's own table, with the standard deviation that it is from.
    Own(f64, Deviation),
}

/// The scans that the user wants: those of which a name is in `wanted`, or all if that is empty.
///
/// # Errors
/// A wanted name is not there.
pub fn select(scans: Vec<RawScan>, wanted: &[String]) -> Result<Vec<RawScan>, Error> {
    let is = |scan: &RawScan, name: &String| {
        let length = wavelength::of_name(name);
        let same_length = |other: &String| length.is_some() && wavelength::of_name(other) == length;
        let named = |other: &String| plain(other) == plain(name) || same_length(other);
        scan.names.iter().any(named) || named(&scan.names.join(" "))
    };
    if let Some(missing) = wanted.iter().find(|name| !scans.iter().any(|scan| is(scan, name))) {
        let names: Vec<String> = scans.iter().map(|scan| shown(&scan.names.join(" "))).collect();
        let names = some_of(&names);
        let there = if names.is_empty() { "one without a name" } else { &names };
        return Err(Error::new(format!("there is no scan '{}'", shown(missing)))
            .help(format!("--column takes names of the file's scans: {there}")));
    }
    let chosen = |scan: &RawScan| wanted.is_empty() || wanted.iter().any(|name| is(scan, name));
    Ok(scans.into_iter().filter(chosen).collect())
}
