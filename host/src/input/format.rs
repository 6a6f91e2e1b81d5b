//! The formats of files, and how one is known by its content.

use clap::ValueEnum;
use serde::Serialize;

use super::options::ReadOptions;
use super::raw::RawScan;
use super::{bytes, table};
use crate::error::Error;

/// A format of files with scans.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Format {
    /// Named columns: CSV, TSV, semicolons or spaces
    Table,
}

impl Format {
    /// What people call it.
    pub fn title(self) -> &'static str {
        match self {
            Format::Table => "table with named columns",
        }
    }
}

/// The scans in a file, as they stand there, and its format.
///
/// # Errors
/// The format is not known, or the file breaks its rules.
pub fn scans(file: &[u8], options: &ReadOptions) -> Result<(Format, Vec<RawScan>), Error> {
    let text = bytes::text(file)?;
    let format = options.input_format.unwrap_or(Format::Table);
    let scans = match format {
        Format::Table => table::read(text, options)?,
    };
    Ok((format, scans))
}
