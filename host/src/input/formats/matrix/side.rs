//! The angles along one side of a matrix.

use crate::error::{Error, shown};
use crate::input::facts;
use crate::input::rows::{self, Decimal};
use crate::input::units::Angles;
use crate::number::shortest;
use crate::plain::some_of;

/// The numbers along one side.
pub struct Side {
    /// As they stand there.
    pub angles: Vec<f64>,
    /// True if each has a unit or the name of an angle beside it.
    pub sure: bool,
    /// True if they are named as angles of incidence.
    pub incidence: bool,
    /// The line of the first.
    pub line: u64,
}

impl Side {
    /// One without angles, whose first is to stand on this line.
    pub fn new(line: u64) -> Side {
        Side {
            angles: Vec::new(),
            sure: true,
            incidence: false,
            line,
        }
    }

    /// True if one is beyond the horizon, as azimuths are.
    pub fn has_azimuths(&self, unit: Angles) -> bool {
        // A polar angle is within 90 degrees, or beyond 270 where a file counts from 0 to 360.
        let is_azimuth = |angle: f64| (angle.abs() + 1e-9) % 360.0 > 90.1 && angle.abs() % 360.0 < 269.9;
        self.angles.iter().any(|&angle| is_azimuth(unit.degrees(angle)))
    }

    pub fn has_negative(&self) -> bool {
        self.angles.iter().any(|&angle| angle < 0.0)
    }

    pub fn largest(&self) -> f64 {
        self.angles.iter().map(|angle| angle.abs()).fold(0.0, f64::max)
    }

    /// The same numbers, for people.
    pub fn shown(&self) -> String {
        some_of(&self.angles.iter().map(|&angle| shortest(angle)).collect::<Vec<_>>())
    }
}

/// Adds the angle in a cell to those of its side.
///
/// # Errors
/// The cell has no angle, or one in another unit than the corner says.
pub fn add_angle(side: &mut Side, unit: Option<Angles>, cells: &[&str], column: usize, line: u64) -> Result<(), Error> {
    let cell = cells[column];
    let at = |error: Error| error.at_line(line).at_column(column as u64 + 1);
    let bare = rows::parse(cell, Decimal::Unknown).is_some();
    let found = angle(cell).filter(|angle| angle.abs() <= 360.0).ok_or_else(|| {
        at(Error::new(format!("'{}' is not an angle", shown(cell))).help("write it in degrees, like 20 or 20 deg"))
    })?;
    if !bare && unit == Some(Angles::Rad) {
        let what = "some angles are in degrees and some in radians";
        return Err(at(
            Error::new(what).help("give all in one unit, and name it in the corner")
        ));
    }
    side.sure &= !bare;
    side.incidence |= !bare && cell.starts_with(char::is_alphabetic);
    side.angles.push(found);
    Ok(())
}

/// The angle in a cell, degrees: `20`, `22,5`, `20°`, `20 deg`, `AOI = 20`.
pub fn angle(cell: &str) -> Option<f64> {
    rows::parse(cell, Decimal::Unknown)
        .filter(|angle| angle.is_finite())
        .or_else(|| facts::angle_in(cell))
}
