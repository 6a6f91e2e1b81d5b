//! The table of formats: one module each, named here and nowhere else.

mod astm;
mod bird;
mod fred;
mod lumos;
mod matrix;
mod merl;
mod zemax;

use super::format::{Format, Reader};
use super::options::ReadOptions;
use super::raw::RawScan;
use super::{bytes, table};
use crate::error::Error;

/// All formats in the order in which they are tried; a table is what is left, and comes last.
pub static ALL: [Format; 8] = [
    merl::FORMAT,
    bird::FORMAT,
    astm::FORMAT,
    fred::FORMAT,
    lumos::FORMAT,
    zemax::FORMAT,
    matrix::FORMAT,
    table::FORMAT,
];

/// The scans in a file, as they stand there, and its format.
///
/// # Errors
/// The format is not known, or the file breaks its rules.
pub fn scans(file: &[u8], options: &ReadOptions) -> Result<(Format, Vec<RawScan>), Error> {
    let (format, mut scans) = read(file, options)?;
    if let Some(thin) = options.thin {
        for scan in &mut scans {
            scan.rows = scan.rows.iter().step_by(thin as usize).copied().collect();
        }
    }
    Ok((format, scans))
}

fn read(file: &[u8], options: &ReadOptions) -> Result<(Format, Vec<RawScan>), Error> {
    let asked = options.input_format;
    for format in ALL {
        if let Reader::Bytes { is, read } = format.reader
            && (asked == Some(format) || asked.is_none() && is(file))
        {
            return Ok((format, read(file, options)?));
        }
    }
    let text = bytes::text(file)?;
    for format in ALL {
        if let Reader::Text { is, read } = format.reader
            && (asked == Some(format) || asked.is_none() && is(&text))
        {
            return Ok((format, read(&text, options)?));
        }
    }
    Err(Error::new("the format is not known").help("take --input-format"))
}
