//! What a reader understood of a file, for those who check it.

use serde::Serialize;

use super::facts;
use super::options::ReadOptions;
use super::raw::RawScan;
use super::source::Source;
use super::units::Angles;
use crate::error::Error;
use crate::plain::some_of;

/// What a reader understood, beside the numbers.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct About {
    /// What kind of file it is, as far as its numbers need checks.
    pub kind: Kind,
    /// The columns that are used, in order.
    pub columns: Vec<Used>,
    /// The columns that are not, by name.
    pub unused: Vec<String>,
    /// Where the angle of incidence is from.
    pub theta_i: ThetaI,
    /// True if the file has one angle of incidence, which no column gives.
    pub one_angle: bool,
    /// True if the program wrote the file, so that there is no doubt about it.
    pub settled: bool,
    /// True if a name or an option gives the unit of the angles.
    pub angles_named: bool,
    /// What the values are divided by before they are what their name says: 100 for percent.
    pub divisor: f64,
    /// The standard deviation of ln f that a weight of 1 stands for, if the file gives it beside weights.
    pub sigma_ln: Option<f64>,
    /// What was done to the numbers, such as angles of a full turn that became negative.
    pub notes: Vec<String>,
    /// What may be wrong with the file; this is among the notes too.
    pub doubts: Vec<String>,
    /// The files of the scan, in order.
    pub sources: Vec<Source>,
    /// What the user said about them.
    pub asked: ReadOptions,
}

impl About {
    /// The columns that are not used, for people; of very many only the first.
    pub fn unused(&self) -> String {
        some_of(&self.unused)
    }
}

impl Default for About {
    fn default() -> Self {
        About {
            kind: Kind::Own,
            columns: Vec::new(),
            unused: Vec::new(),
            theta_i: ThetaI::Column,
            one_angle: false,
            settled: false,
            angles_named: true,
            divisor: 1.0,
            sigma_ln: None,
            notes: Vec::new(),
            doubts: Vec::new(),
            sources: Vec::new(),
            asked: ReadOptions::default(),
        }
    }
}

/// What kind of file it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A table of columns, whose units and signs are anybody's.
    Table,
    /// A matrix, the same.
    Matrix,
    /// A format that fixes units and signs.
    Own,
}

/// A column that is used.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Used {
    /// Its number, from 1.
    pub number: usize,
    /// Its name; empty if it has none.
    pub name: String,
    /// What it was taken for.
    pub holds: String,
}

/// Where the angle of incidence is from.
#[derive(Clone, Debug, PartialEq)]
pub enum ThetaI {
    /// The rows have it.
    Column,
    /// It is still to be found.
    Missing {
        /// What a remark says, degrees.
        remark: Option<f64>,
        /// The names of the columns, for a message.
        names: Vec<String>,
    },
}

/// Gives the rows of a scan their angle of incidence, if the table has none: from the option, a remark, or the file's name.
///
/// # Errors
/// None of these has it, or the option gives what the table has too.
pub fn give_theta_i(file: &str, scan: &mut RawScan, options: &ReadOptions) -> Result<(), Error> {
    let given = options.theta_i.first().copied();
    let (named, names) = match (&scan.about.theta_i, given) {
        (ThetaI::Column, None) => return Ok(()),
        (ThetaI::Column, Some(_)) => {
            return Err(
                Error::new("--theta-i gives an angle of incidence, and the file has its own")
                    .help("leave one out: --ignore takes the number or name of a column"),
            );
        }
        (ThetaI::Missing { remark, names }, _) => (*remark, names),
    };
    let (degrees, from) = match (given, named) {
        (Some(degrees), _) => (degrees, "--theta-i"),
        (None, Some(degrees)) => (degrees, "a remark"),
        (None, None) => match facts::theta_i_of_name(file)? {
            Some(degrees) => (degrees, "the name of the file"),
            None => return Err(facts::missing_theta_i(names)),
        },
    };
    let angle = match options.angles.unwrap_or(scan.angles) {
        Angles::Deg => degrees,
        Angles::Rad => degrees.to_radians(),
    };
    scan.rows.iter_mut().for_each(|row| row.theta_i = angle);
    scan.about.theta_i = ThetaI::Column;
    scan.about.one_angle = true;
    scan.about
        .notes
        .push(format!("theta_i is {degrees} degrees, from {from}"));
    Ok(())
}
