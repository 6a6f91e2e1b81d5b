//! JSON and rows of tables as they are written: numbers with all their digits, and all that is in foreign text to be seen.

use std::io::Write;

use serde::Serialize;

use crate::plain;

/// JSON of several lines, in which each character can be seen.
pub fn json(value: &impl Serialize) -> String {
    // Only maps with other keys than strings, and failing writers, can make this fail.
    let written = serde_json::to_string_pretty(value).unwrap_or_default();
    plain::json(&written).into_owned() + "\n"
}

/// Writes a row of a table whose cells show all that is in them, and are not formulas.
///
/// # Errors
/// The stream breaks.
pub fn write_row(writer: &mut csv::Writer<impl Write>, row: &[impl AsRef<str>]) -> csv::Result<()> {
    writer.write_record(row.iter().map(|text| plain::cell(text.as_ref()).into_owned()))
}
