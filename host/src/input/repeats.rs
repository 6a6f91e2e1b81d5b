//! Directions that occur twice.

use std::collections::HashMap;

use super::columns::Columns;
use super::raw::{RawScan, Row};
use super::sheet::Sheet;
use crate::error::{Error, shown};

/// A direction as it stands in the file; 0 has one sign.
type Direction = [u64; 3];

fn direction(row: &Row) -> Direction {
    [row.theta_i, row.theta_s, row.delta_phi.unwrap_or(0.0)].map(|angle| (angle + 0.0).to_bits())
}

/// Refuses a scan in which a direction occurs twice at different values, unless one of the columns `tells_apart` differs there.
///
/// # Errors
/// At the second row of the first such direction.
pub fn refuse(scan: &RawScan, sheet: &Sheet, columns: &Columns, tells_apart: &[usize]) -> Result<(), Error> {
    let Some(found) = twice(scan, columns.theta_i.is_some()) else {
        return Ok(());
    };
    let [before, here] = [found.first, found.second].map(|row| cells_of(sheet, row.line));
    if tells_apart.iter().any(|&column| before.get(column) != here.get(column)) {
        return Ok(());
    }
    let other = columns
        .unused
        .iter()
        .find(|&&(column, _)| before.get(column) != here.get(column));
    let help = match other {
        Some(&(column, _)) => format!(
            "the column '{}' differs: --split {} makes scans of it; --repeats takes such rows as repeated measurements",
            shown(&columns.heads[column].text),
            column + 1
        ),
        None => "give a column that tells them apart and name it with --split, or take them as repeated measurements with --repeats".to_string(),
    };
    Err(found.error(&help))
}

/// Two rows of one direction.
pub struct Twice {
    first: Row,
    second: Row,
    /// How many such rows there are.
    count: usize,
}

impl Twice {
    /// What is said of it, and what to do.
    pub fn error(&self, help: &str) -> Error {
        let more = if self.count == 1 {
            String::new()
        } else {
            format!(" (and {} rows more)", self.count - 1)
        };
        Error::new(format!(
            "a direction occurs twice at different values, {} on line {} and {} here{more}",
            self.first.value, self.first.line, self.second.value
        ))
        .at_line(self.second.line)
        .help(help)
    }
}

/// The first direction that occurs twice at different values; the angle of incidence counts if it is known.
pub fn twice(scan: &RawScan, has_theta_i: bool) -> Option<Twice> {
    if is_ordered(scan) {
        return None;
    }
    let mut seen: HashMap<Direction, &Row> = HashMap::with_capacity(scan.rows.len());
    let mut first = None;
    let mut count = 0;
    // Rows that are no samples are another fault, which is said of them later.
    let has_angles = |row: &Row| {
        // The angle of incidence of a whole file is not known yet.
        let theta_i = has_theta_i.then_some(row.theta_i);
        let angles = [theta_i, Some(row.theta_s), row.delta_phi];
        angles.into_iter().flatten().all(f64::is_finite)
    };
    let is_sample = |row: &&Row| {
        row.value.is_finite() && has_angles(row) && (row.value > 0.0 || scan.quantity.is_logarithm().is_some())
    };
    for row in scan.rows.iter().filter(is_sample) {
        let known = *seen.entry(direction(row)).or_insert(row);
        if known.value != row.value {
            count += 1;
            first.get_or_insert((*known, *row));
        }
    }
    first.map(|(first, second)| Twice { first, second, count })
}

/// True if the rows are sweeps that do not meet, which most are, and so need no search.
fn is_ordered(scan: &RawScan) -> bool {
    let mut swept: HashMap<(u64, u64), Vec<(f64, f64)>> = HashMap::new();
    let key = |row: &Row| {
        let [theta_i, _, phi] = direction(row);
        (theta_i, phi)
    };
    let mut rows = scan.rows.iter().peekable();
    while let Some(first) = rows.next() {
        let (mut low, mut high) = (first.theta_s, first.theta_s);
        let mut upwards = None;
        while let Some(next) = rows.peek() {
            let up = next.theta_s > high;
            if key(next) != key(first) || !(up || next.theta_s < low) || *upwards.get_or_insert(up) != up {
                break;
            }
            (low, high) = (low.min(next.theta_s), high.max(next.theta_s));
            rows.next();
        }
        if low.is_nan() {
            return false;
        }
        // Thousands of scans may have one sweep each.
        if swept.is_empty() && rows.peek().is_none() {
            return true;
        }
        let others = swept.entry(key(first)).or_default();
        // A file whose rows are in no order has as many sweeps as rows.
        if others.len() > 16 || others.iter().any(|&(from, to)| low <= to && from <= high) {
            return false;
        }
        others.push((low, high));
    }
    true
}

/// The cells of a line.
fn cells_of(sheet: &Sheet, line: u64) -> Vec<String> {
    let mut found = Vec::new();
    // The error only ends the search.
    let _ = sheet.for_each(|here, cells| {
        if here < line {
            return Ok(());
        }
        found = cells.iter().map(|cell| cell.to_string()).collect();
        Err(Error::new("found"))
    });
    found
}
