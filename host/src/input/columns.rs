//! Where the columns of a scan are, and what each holds.

use super::head::Head;
use super::role::Role;
use super::units::{Angles, Quantity};

/// Where the columns of a scan are, counted from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// Angle of incidence; none if it is not in the table.
    pub theta_i: Option<usize>,
    /// Scattering angle; none if the heads give it.
    pub theta_s: Option<usize>,
    /// The azimuth; without it the scan is in plane.
    pub azimuth: Option<Azimuth>,
    /// The unit of all angles.
    pub angles: Angles,
    /// True if a name or an option gives that unit.
    pub angles_named: bool,
    /// Wavelength of the row.
    pub wavelength: Option<usize>,
    /// Polarisation of the row.
    pub polarisation: Option<usize>,
    /// Other columns whose rows are scans of their own for each content: the sample, and what the user asks for.
    pub splits: Vec<usize>,
    /// Unit of the value in the row.
    pub unit: Option<usize>,
    /// The standard deviation of ln f that a weight of 1 stands for, which the program writes beside weights.
    pub sigma_ln: Option<usize>,
    /// The absolute and the relative part of the standard deviations that these weights are from.
    pub own_sigma: Option<[usize; 2]>,
    /// The columns of values, each a scan of its own; at least one.
    pub values: Vec<Value>,
    /// Columns that are not used, with what they look like.
    pub unused: Vec<(usize, Role)>,
    /// The heads of all columns.
    pub heads: Vec<Head>,
}

/// Where azimuths stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Azimuth {
    /// The difference in one column.
    Difference(usize),
    /// That of scattering, and that of incidence, which is 0 without a column.
    Of(usize, Option<usize>),
}

/// A column of values.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// Where it is.
    pub column: usize,
    /// What tells it from other columns of values; none if there are no others.
    pub name: Option<String>,
    /// What it holds.
    pub quantity: Quantity,
    /// What its numbers are divided by: 100 for percent.
    pub divisor: f64,
    /// Its standard deviation or weight, and which of these it is.
    pub weight: Option<(usize, WeightKind)>,
    /// The angle that its head gives, in the unit of the angles, and which it is.
    pub angle: Option<(Polar, f64)>,
    /// Which scan of a group of rows it belongs to.
    pub scan: usize,
}

impl Value {
    /// Does its head give the angle of incidence?
    pub fn gives_theta_i(&self) -> bool {
        matches!(self.angle, Some((Polar::Incidence, _)))
    }
}

/// A polar angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Polar {
    /// That of incidence.
    Incidence,
    /// That of scattering.
    Scattering,
}

impl Polar {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Polar::Incidence => "theta_i",
            Polar::Scattering => "theta_s",
        }
    }
}

/// What a column says of the uncertainty of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WeightKind {
    /// Standard deviation in the unit of the value, times a coverage factor.
    Sigma(f64),
    /// Standard deviation over the value, times a coverage factor.
    RelativeSigma(f64),
    /// The same in percent.
    PercentSigma(f64),
    /// Factor of the residual.
    Factor,
}
