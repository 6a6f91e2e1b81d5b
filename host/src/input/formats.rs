//! The table of formats: one module each, named here and nowhere else.

mod alta;
mod astm;
mod bird;
mod fred;
mod lighttools;
mod lumos;
mod matrix;
mod merl;
mod openmaterial;
mod pabopto;
mod rgl;
mod speos;
mod ssdd;
mod xlsx;
mod zemax;

mod foreign;
mod grid;
pub(crate) mod tensor;
pub(crate) mod warp;
mod words;

use super::format::{Format, NamedText, Reader};
use super::options::ReadOptions;
use super::raw::RawScan;
use super::{bytes, table};
use crate::error::{Error, shown};
use crate::plain::some_of;

/// All formats in the order in which they are tried; a table is what is left, and comes last.
static ALL: [Format; 16] = [
    merl::FORMAT,
    rgl::FORMAT,
    ssdd::FORMAT,
    xlsx::FORMAT,
    speos::FORMAT,
    openmaterial::FORMAT,
    bird::FORMAT,
    astm::FORMAT,
    fred::FORMAT,
    alta::FORMAT,
    lumos::FORMAT,
    pabopto::FORMAT,
    zemax::FORMAT,
    lighttools::FORMAT,
    matrix::FORMAT,
    table::FORMAT,
];

/// All formats, in the order in which they are tried.
pub fn all() -> &'static [Format] {
    &ALL
}

/// The format of a name, if one is asked for.
fn named(name: Option<&str>) -> Result<Option<Format>, Error> {
    let Some(name) = name else { return Ok(None) };
    let known = ALL.iter().find(|format| format.name == name);
    known.copied().map(Some).ok_or_else(|| {
        let names: Vec<&str> = ALL.iter().map(|format| format.name).collect();
        Error::new(format!("there is no format '{}'", shown(name)))
            .help(format!("--input-format takes {}", names.join(", ")))
    })
}

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
    let asked = named(options.input_format.as_deref())?;
    for format in ALL {
        let is_it = |is: fn(&[u8]) -> bool| asked == Some(format) || asked.is_none() && is(file);
        match format.reader {
            Reader::Bytes { is, read } if is_it(is) => return Ok((format, read(file, options)?)),
            Reader::Sheets { is, texts } if is_it(is) => {
                return Ok((format, of_sheets(&texts(file, options)?, options)?));
            }
            _ => {}
        }
    }
    let text = bytes::text(file).map_err(|error| foreign::named(file).unwrap_or(error))?;
    of_text(&text, asked, options)
}

/// The scans of each sheet, whose name tells them apart if there are several.
fn of_sheets(sheets: &[NamedText], options: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let several = sheets.len() > 1;
    let mut scans = Vec::new();
    for NamedText { name, text } in sheets {
        let (_, found) = of_text(text, None, options).map_err(|error| {
            if !several {
                return error;
            }
            let names: Vec<String> = sheets.iter().map(|sheet| shown(&sheet.name)).collect();
            let choice = format!("--sheet chooses among {}", some_of(&names));
            let help = match &error.help {
                Some(help) => format!("{help}; {choice}"),
                None => choice,
            };
            let what = format!("sheet {}: {}", shown(name), error.what);
            Error { what, ..error }.help(help)
        })?;
        scans.extend(found.into_iter().map(|mut scan| {
            scan.names.splice(0..0, several.then(|| name.clone()));
            scan
        }));
    }
    Ok(scans)
}

/// The scans in a text, of the format that is asked for or that it looks like.
fn of_text(text: &str, asked: Option<Format>, options: &ReadOptions) -> Result<(Format, Vec<RawScan>), Error> {
    for format in ALL {
        let Reader::Text { is, read } = format.reader else {
            continue;
        };
        if asked == Some(format) {
            return Ok((format, read(text, options)?));
        }
        if asked.is_some() || !is(text) {
            continue;
        }
        if format == table::FORMAT
            && let Some(error) = foreign::named(text.as_bytes()).or_else(|| foreign::no_table(text))
        {
            return Err(error);
        }
        return Ok((format, read(text, options)?));
    }
    Err(Error::new("the format is not known").help("take --input-format"))
}
