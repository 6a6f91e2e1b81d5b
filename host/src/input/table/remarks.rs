//! Remarks that say what columns say too, or what no column can take.

use super::sorter::Scan;
use crate::error::{Error, shown};
use crate::input::columns::Columns;
use crate::input::facts::Facts;
use crate::input::head::Head;
use crate::input::options::ReadOptions;
use crate::input::role::{self, Role};
use crate::input::sheet::Sheet;
use crate::input::{polarisation, rows, wavelength};
use crate::number::shortest;

/// Angles that people write with one digit are one within this, degrees.
const SAME: f64 = 0.05;

/// What the remarks say and the scans do not take, for people: one line each.
pub fn not_taken(facts: &Facts, columns: &Columns, scans: &[Scan], options: &ReadOptions) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(column) = columns.theta_i {
        let angles = options.angles.unwrap_or(columns.angles);
        let said = distinct(facts.theta_i.iter().map(|(_, angle)| *angle));
        // Most files say nothing, and have many rows.
        let rows = scans.iter().filter(|_| !said.is_empty());
        let rows = rows.flat_map(|scan| &scan.raw.rows);
        let found = distinct(rows.map(|row| angles.degrees(row.theta_i)));
        let same = said.len() == found.len() && said.iter().zip(&found).all(|(a, b)| (a - b).abs() < SAME);
        if !said.is_empty() && !same {
            lines.push(format!(
                "a remark says that theta_i is {} degrees, and the column '{}' has {}: the column is taken",
                range(&said),
                shown(&columns.heads[column].text),
                range(&found)
            ));
        }
    }
    let others = |name: &str| scans.iter().any(|scan| !scan.raw.names.iter().any(|own| own == name));
    if let (Some(column), Some(nanometres)) = (columns.wavelength, facts.wavelength)
        && others(&wavelength::name(nanometres))
    {
        lines.push(format!(
            "a remark says that the wavelength is {}, and the column '{}' has others: the column is taken",
            wavelength::name(nanometres),
            shown(&columns.heads[column].text)
        ));
    }
    if let (Some(column), Some(said)) = (columns.polarisation, &facts.polarisation)
        && others(&polarisation::name(said))
    {
        lines.push(format!(
            "a remark says that the polarisation is '{}', and the column '{}' has others: the column is taken",
            shown(said),
            shown(&columns.heads[column].text)
        ));
    }
    let out_of_plane = facts.azimuths.iter().find(|(_, azimuth)| azimuth % 180.0 != 0.0);
    if let (None, Some((line, azimuth))) = (columns.azimuth, out_of_plane) {
        lines.push(format!(
            "a remark on line {line} names an azimuth of {} degrees, and no column does: all rows are taken as in plane",
            shortest(*azimuth)
        ));
    }
    lines
}

/// Refuses a remark between the rows that names other columns than the header, or in another order.
///
/// # Errors
/// There is one, at its line.
pub fn refuse_renamed(sheet: &Sheet) -> Result<(), Error> {
    // Most files have none between their rows, and many rows.
    if memchr::memchr(b'#', sheet.rows.as_bytes()).is_none() || sheet.heads.iter().all(|head| head.text.is_empty()) {
        return Ok(());
    }
    let other = |(own, name): (&Head, &&str)| {
        let head = Head::new(name);
        let (role, known) = (role::role(&head), role::role(own));
        let unit = head.unit.is_some() && own.unit.is_some() && head.unit != own.unit;
        unit || role != known || matches!(role, Role::Unknown(_)) && head.plain != own.plain
    };
    let remarks = rows::lines(sheet.rows).filter(|(_, _, line)| line.trim_start().starts_with('#'));
    for (number, _, line) in remarks {
        let names = sheet.names_in(line);
        if names.is_some_and(|names| sheet.heads.iter().zip(&names).any(other)) {
            return Err(Error::new(format!(
                "a remark between the rows names other columns than the header: '{}'",
                shown(line.trim())
            ))
            .at_line(sheet.first_line + number - 1)
            .help("give each table a file of its own, or all rows the order of the header"));
        }
    }
    Ok(())
}

/// Different finite numbers in order.
fn distinct(numbers: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut all: Vec<f64> = numbers.filter(|number| number.is_finite()).collect();
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() < SAME);
    all
}

/// One number, or the first and the last of several.
fn range(sorted: &[f64]) -> String {
    match sorted {
        [] => "none".to_string(),
        [one] => shortest(*one),
        [first, .., last] => format!("{} to {}", shortest(*first), shortest(*last)),
    }
}
