//! The formats of files, and how one is known by its content.

use clap::ValueEnum;
use serde::Serialize;

use super::options::ReadOptions;
use super::raw::RawScan;
use super::{astm, bird, bytes, fred, lumos, matrix, merl, table, zemax};
use crate::error::Error;

/// A format of files with scans.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Format {
    /// Named columns: CSV, TSV, semicolons or spaces
    Table,
    /// Angles of incidence in the first row, scattering angles in the first column
    Matrix,
    /// ASTM E1392 or E2387 text
    Astm,
    /// EURAMET BiRD universal BRDF JSON
    Bird,
    /// Zemax tabular BSDF
    Zemax,
    /// FRED text
    Fred,
    /// LUMOS or ScatterWorks text
    Lumos,
    /// MERL binary
    Merl,
}

impl Format {
    /// What people call it.
    pub fn title(self) -> &'static str {
        match self {
            Format::Table => "table with named columns",
            Format::Matrix => "matrix",
            Format::Astm => "ASTM E1392",
            Format::Bird => "BiRD JSON",
            Format::Zemax => "Zemax tabular BSDF",
            Format::Fred => "FRED text",
            Format::Lumos => "LUMOS text",
            Format::Merl => "MERL binary",
        }
    }
}

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
        Format::Matrix => matrix::read(text)?,
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
