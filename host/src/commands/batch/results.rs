//! Records in order become the file of results.

use std::io::{self, Write};
use std::path::Path;

use clap::ValueEnum;

use crate::document::write_row;
use crate::error::Error;
use crate::input::STDIN;
use crate::records::record::{Record, Rows, RowsIn, Written, cells};
use crate::result::cell::{Cell, Kind};

/// The form of the file of results.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Form {
    /// A table, one row a scan.
    Csv,
    /// An array, one object a scan.
    Json,
    /// A columnar table, one row a scan.
    Parquet,
}

impl Form {
    /// The form that is asked for, or that the ending of a name means.
    ///
    /// # Errors
    /// There is no such form, or this program was built without it.
    pub fn of(out: &Path, asked: Option<Form>) -> Result<Form, Error> {
        let ending = out.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let form = match (asked, ending.as_deref()) {
            (Some(form), _) => form,
            (None, Some("csv")) => Form::Csv,
            (None, Some("json")) => Form::Json,
            (None, Some("parquet")) => Form::Parquet,
            (None, None) if out.as_os_str() == STDIN => Form::Csv,
            _ => {
                return Err(Error::new(format!(
                    "the name {} does not say in which form results are wanted",
                    out.display()
                ))
                .help("let it end in .csv, .json or .parquet, or add --format"));
            }
        };
        if form == Form::Parquet && !cfg!(feature = "parquet") {
            return Err(Error::new("this brdfit was built without Parquet")
                .help("write .csv or .json, or build it with --features parquet"));
        }
        Ok(form)
    }

    /// The form of its rows.
    pub fn rows(self) -> Rows {
        match self {
            Form::Csv | Form::Parquet => Rows::Cells,
            Form::Json => Rows::Objects,
        }
    }
}

/// Writes the rows of records, which come in order.
///
/// # Errors
/// A record is broken, or the output cannot be written.
pub fn write(
    form: Form,
    columns: &[(String, Kind)],
    records: &mut dyn Iterator<Item = Result<Record, Error>>,
    out: &mut (dyn Write + Send),
) -> io::Result<()> {
    let mut rows = records.flat_map(|record| match record {
        Ok(record) => record.scans.into_iter().map(|scan| Ok(scan.row)).collect(),
        Err(error) => vec![Err(io::Error::other(error))],
    });
    match form {
        Form::Csv => csv(columns, &mut rows, out),
        Form::Json => json(&mut rows, out),
        #[cfg(feature = "parquet")]
        Form::Parquet => super::parquet::write(columns, &mut rows, out),
        #[cfg(not(feature = "parquet"))]
        Form::Parquet => Err(io::ErrorKind::Unsupported.into()),
    }
}

fn csv(columns: &[(String, Kind)], rows: RowsIn, out: &mut dyn Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(out);
    let names: Vec<&String> = columns.iter().map(|(name, _)| name).collect();
    write_row(&mut writer, &names)?;
    for row in rows {
        let texts: Vec<String> = cells(row?)?.iter().map(Cell::text).collect();
        write_row(&mut writer, &texts)?;
    }
    writer.flush()
}

fn json(rows: RowsIn, out: &mut dyn Write) -> io::Result<()> {
    let mut before = "[\n  ";
    for row in rows {
        let Written::Object(object) = row? else {
            return Err(io::Error::other("a row of a table is no JSON object"));
        };
        write!(out, "{before}{}", object.replace('\n', "\n  "))?;
        before = ",\n  ";
    }
    out.write_all(if before.starts_with('[') { b"[]\n" } else { b"\n]\n" })
}
