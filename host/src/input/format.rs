//! How the format of a file is known by its content, and which reader reads it.

use super::options::{Format, ReadOptions};
use super::raw::RawScan;
use super::{astm, bird, bytes, fred, lumos, matrix, merl, table, zemax};
use crate::error::Error;

/// The scans in a file, as they stand there, and its format.
///
/// # Errors
/// The format is not known, or the file breaks its rules.
pub fn scans(file: &[u8], options: &ReadOptions) -> Result<(Format, Vec<RawScan>), Error> {
    let binary = merl::is(file) && options.input_format.is_none();
    if binary || options.input_format == Some(Format::Merl) {
        return Ok((Format::Merl, merl::read(file, options)?));
    }
    let text = bytes::text(file)?;
    let format = options.input_format.unwrap_or_else(|| detect(text));
    let mut scans = match format {
        Format::Table | Format::Merl => table::read(text, options)?,
        Format::Matrix => matrix::read(text, options)?,
        Format::Astm => astm::read(text)?,
        Format::Bird => bird::read(text)?,
        Format::Zemax => zemax::read(text)?,
        Format::Fred => fred::read(text)?,
        Format::Lumos => lumos::read(text)?,
    };
    if let Some(thin) = options.thin {
        for scan in &mut scans {
            scan.rows = scan.rows.iter().step_by(thin as usize).copied().collect();
        }
    }
    Ok((format, scans))
}

/// The format of a text; a table if it is none of the others.
fn detect(text: &str) -> Format {
    if bird::is(text) {
        Format::Bird
    } else if astm::is(text) {
        Format::Astm
    } else if fred::is(text) {
        Format::Fred
    } else if lumos::is(text) {
        Format::Lumos
    } else if zemax::is(text) {
        Format::Zemax
    } else if matrix::is(text) {
        Format::Matrix
    } else {
        Format::Table
    }
}
