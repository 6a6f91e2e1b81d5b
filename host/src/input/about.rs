//! What a reader understood of a file, for those who check it.

use std::sync::Arc;

use serde::Serialize;

use super::columns::Polar;
use super::kind::Kind;
use super::options::ReadOptions;
use super::source::Source;
use crate::error::shown;
use crate::plain::some_of;

/// What a reader understood, beside the numbers; the scans of a file share what may be long, for there may be thousands of them.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct About {
    /// What kind of file it is, as far as its numbers need checks.
    pub kind: Kind,
    /// The columns that are used, in order.
    pub columns: Arc<[Used]>,
    /// The columns that are not, by name.
    pub unused: Arc<[String]>,
    /// Where the angle of incidence is from.
    pub theta_i: ThetaI,
    /// True if the file has one angle of incidence, which no column gives.
    pub one_angle: bool,
    /// The angle that the heads of columns give, if they do; it has no unit in common with the other.
    pub angle_of_heads: Option<Polar>,
    /// True if the program wrote the file, so that there is no doubt about it.
    pub settled: bool,
    /// True if a name or an option gives the unit of the angles.
    pub angles_named: bool,
    /// What the values are divided by before they are what their name says: 100 for percent.
    pub divisor: f64,
    /// How theta_s of the file counts.
    pub counts: Counts,
    /// The standard deviation of ln f that a weight of 1 stands for, if the file gives it beside weights.
    pub sigma_ln: Option<f64>,
    /// The first cell that is no number, where the file has such.
    pub missing: Option<Missing>,
    /// What was done to the numbers, such as angles of a full turn that became negative.
    pub notes: Vec<String>,
    /// What may be wrong with the file; this is among the notes too.
    pub doubts: Vec<String>,
    /// The files of the scan, in order.
    pub sources: Arc<[Source]>,
    /// What the user said about them.
    pub asked: Arc<ReadOptions>,
}

impl About {
    /// The columns that are not used, for people; of very many only the first.
    pub fn unused(&self) -> String {
        some_of(&self.unused.iter().map(|name| shown(name)).collect::<Vec<_>>())
    }
}

impl Default for About {
    fn default() -> Self {
        About {
            kind: Kind::Own,
            columns: Arc::default(),
            unused: Arc::default(),
            theta_i: ThetaI::Column,
            one_angle: false,
            angle_of_heads: None,
            settled: false,
            angles_named: true,
            divisor: 1.0,
            counts: Counts::Forward,
            sigma_ln: None,
            missing: None,
            notes: Vec::new(),
            doubts: Vec::new(),
            sources: Arc::default(),
            asked: Arc::default(),
        }
    }
}

/// Which side of the surface normal is positive in theta_s of a file; in samples the forward one is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Counts {
    /// The forward one; so do angles from the normal with an azimuth, which have no sign.
    #[default]
    Forward,
    /// That of the source, at negative theta_i or where forward is negative: samples are mirrored.
    Backward,
    /// One in some rows and the other in others, as where theta_i has both signs.
    Both,
}

impl Counts {
    /// An angle that was fitted beside theta_s of the samples, as one beside theta_s of the file.
    pub fn of_file(self, angle: f64) -> f64 {
        match self {
            Counts::Forward | Counts::Both => angle,
            Counts::Backward => -angle,
        }
    }
}

/// A cell that is no number.
#[derive(Clone, Debug, PartialEq)]
pub struct Missing {
    /// Its line.
    pub line: u64,
    /// Its column, from 1.
    pub column: u64,
    /// What stands there.
    pub text: String,
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
        /// The names of the columns, for a message; the scans of a file share them.
        names: Arc<[String]>,
    },
}
