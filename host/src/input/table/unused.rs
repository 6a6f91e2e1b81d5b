//! Columns that are not used, and whether they could matter.

use crate::error::{Error, shown};
use crate::input::role::{Look, Role};
use crate::input::rows::{self, Decimal};

/// What was seen of a column that is not used.
pub struct Seen {
    /// Its place, from 0.
    pub column: usize,
    name: String,
    /// What it looks like.
    pub role: Role,
    ignored: bool,
    /// True of one that the user leaves out.
    left_out: bool,
    first: Option<String>,
    varies: bool,
    is_zero: bool,
    /// A cell that says that its row is of light that goes through.
    through: Option<String>,
}

impl Seen {
    /// The column at this place, of which nothing was seen; `left_out` if the user says so.
    pub fn new(column: usize, name: &str, role: Role, left_out: bool) -> Seen {
        Seen {
            column,
            name: name.to_string(),
            left_out,
            ignored: role == Role::Unknown(Look::Other),
            role,
            first: None,
            varies: false,
            is_zero: true,
            through: None,
        }
    }

    /// One more cell.
    pub fn see(&mut self, cell: &str) {
        if !self.left_out && self.through.is_none() && is_through(cell) {
            self.through = Some(cell.to_string());
        }
        if self.ignored || (self.varies && !self.is_zero) {
            return;
        }
        self.is_zero &= cell.is_empty() || rows::parse(cell, Decimal::Unknown) == Some(0.0);
        match &self.first {
            None => self.first = Some(cell.to_string()),
            Some(first) => self.varies |= first != cell,
        }
    }

    /// Refuses a column that could change what the scan is.
    ///
    /// # Errors
    /// It looks like an angle, and differs from row to row or from 0; or the like.
    pub fn refuse(&self) -> Result<(), Error> {
        if let Some(cell) = &self.through {
            let number = self.column + 1;
            return Err(Error::new(format!(
                "the column '{}' has rows that say '{}': they are of light that goes through, and no reflectance",
                shown(&self.name),
                shown(cell)
            ))
            .at_column(number as u64)
            .help(format!(
                "leave these rows out of the file, make scans of what stands there with --split {number}, or leave the column out with --ignore {number}"
            )));
        }
        let (matters, like) = match self.role {
            Role::ThetaI | Role::ThetaS | Role::Theta | Role::Unknown(Look::Angle) => (!self.is_zero, "an angle"),
            Role::PhiS | Role::DeltaPhi | Role::Phi => (!self.is_zero, "an azimuth"),
            // The plane of incidence may have any azimuth, if it is one plane.
            Role::PhiI => (self.varies, "an azimuth"),
            Role::Wavelength | Role::Unknown(Look::Wavelength) => (self.varies, "a wavelength"),
            Role::Polarisation | Role::Unknown(Look::Polarisation) => (self.varies, "a polarisation"),
            Role::Sample | Role::Unknown(Look::Sample) => (self.varies, "the name of a sample"),
            Role::Unit | Role::Unknown(Look::Unit) => (self.varies, "a unit"),
            Role::Repeat
            | Role::SigmaLn
            | Role::OwnAbsolute
            | Role::OwnRelative
            | Role::Value(_)
            | Role::Unknown(Look::Other) => (false, ""),
        };
        if !matters {
            return Ok(());
        }
        let (name, number) = (shown(&self.name), self.column + 1);
        Err(Error::new(format!("the column '{name}' looks like {like} and would not be used"))
            .at_column(number as u64)
            .help(format!(
                "say what it is with --columns NAME={number}, make scans of what stands in it with --split {number}, or leave it out with --ignore {number}"
            )))
    }
}

/// True of words for light that goes through a sample.
fn is_through(cell: &str) -> bool {
    const WORDS: [&str; 5] = ["btdf", "transmission", "transmitted", "transmittance", "transmissive"];
    // Numbers are most cells, and cost a look at one letter.
    cell.starts_with(['B', 'b', 'T', 't']) && WORDS.iter().any(|word| cell.eq_ignore_ascii_case(word))
}
