//! Excel workbooks (`.xlsx`): each sheet with numbers is read as the text that it would be as CSV.
//!
//! Only with the feature `xlsx`; without it they are refused by name.

use crate::error::Error;
use crate::input::format::{Format, NamedText, Reader};

/// This format.
pub const FORMAT: Format = Format {
    name: "xlsx",
    title: "Excel workbook",
    about: "Excel workbook, .xlsx (with the feature xlsx)",
    reader: Reader::Sheets { is, texts },
};

/// True of a ZIP archive with the parts of a workbook.
fn is(file: &[u8]) -> bool {
    file.starts_with(b"PK\x03\x04") && memchr::memmem::find(file, b"xl/workbook.xml").is_some()
}

#[cfg(not(feature = "xlsx"))]
fn texts(_: &[u8]) -> Result<Vec<NamedText>, Error> {
    Err(Error::new("this is an Excel workbook, which this build does not read")
        .help("save the sheet as CSV, or build with --features xlsx"))
}

/// The name and the text of each sheet that has any number.
#[cfg(feature = "xlsx")]
fn texts(file: &[u8]) -> Result<Vec<NamedText>, Error> {
    use calamine::{Reader as _, Xlsx};

    let fault = |what: String| Error::new(format!("as Excel workbook: {what}")).help("save the sheet as CSV");
    let mut workbook = Xlsx::new(std::io::Cursor::new(file)).map_err(|error| fault(error.to_string()))?;
    let mut sheets = Vec::new();
    for name in workbook.sheet_names() {
        let range = workbook
            .worksheet_range(&name)
            .map_err(|error| fault(error.to_string()))?;
        if let Some(text) = text(&range) {
            sheets.push(NamedText { name, text });
        }
    }
    if sheets.is_empty() {
        return Err(fault("there is no sheet with numbers".into()));
    }
    Ok(sheets)
}

/// The cells of a sheet with tabs between them, each row on its line of the sheet; none if no cell is a number.
#[cfg(feature = "xlsx")]
fn text(range: &calamine::Range<calamine::Data>) -> Option<String> {
    use calamine::Data;

    let is_number = |cell: &Data| match cell {
        Data::Float(_) | Data::Int(_) => true,
        Data::String(text) => text.trim().parse::<f64>().is_ok(),
        _ => false,
    };
    if !range.rows().flatten().any(is_number) {
        return None;
    }
    let cell = |cell: &Data| match cell {
        Data::Empty => String::new(),
        Data::Float(number) => number.to_string(),
        Data::Error(_) => "NaN".to_string(),
        other => other.to_string().replace(['\t', '\n', '\r', '"'], " "),
    };
    let (first, _) = range.start()?;
    let mut text = "\n".repeat(first as usize);
    for row in range.rows() {
        text += &row.iter().map(cell).collect::<Vec<_>>().join("\t");
        text.push('\n');
    }
    Some(text)
}

#[cfg(all(test, feature = "xlsx"))]
mod tests {
    use super::*;
    use crate::input::ReadOptions;
    use crate::input::formats::scans;
    use crate::input::raw::RawScan;

    fn data(name: &str) -> Vec<u8> {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/read/");
        std::fs::read(format!("{folder}{name}")).unwrap()
    }

    #[test]
    fn a_sheet_is_the_scan_of_its_csv() {
        // The workbook has notes on its first sheet, and two empty rows above the second.
        let file = data("workbook.xlsx");
        assert!(is(&file));
        let options = ReadOptions::default();
        let (_, scans) = scans(&file, &options).unwrap();
        let (_, csv) = crate::input::formats::scans(&data("f14_latin1_degree.csv"), &options).unwrap();
        assert_eq!(scans.len(), 1);
        let rows = |scan: &RawScan| -> Vec<(f64, f64, f64)> {
            scan.rows
                .iter()
                .map(|row| (row.theta_i, row.theta_s, row.value))
                .collect()
        };
        assert_eq!(rows(&scans[0]), rows(&csv[0]));
        assert_eq!((scans[0].rows[0].line, csv[0].rows[0].line), (4, 2));
    }

    #[test]
    fn a_broken_workbook_is_refused() {
        let mut file = data("workbook.xlsx");
        let end = file.len() - 100;
        file.truncate(end);
        let error = texts(&file).unwrap_err();
        assert!(
            error.what.starts_with("as Excel workbook: ") && !error.what.contains('\n'),
            "{error}"
        );
    }
}
