//! Excel workbooks (`.xlsx`): each sheet with numbers is read as the text that it would be as CSV.
//!
//! Only with the feature `xlsx`; without it they are refused by name.

use crate::error::Error;
use crate::input::format::{Format, NamedText, Reader};
use crate::input::options::ReadOptions;

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
fn texts(_: &[u8], _: &ReadOptions) -> Result<Vec<NamedText>, Error> {
    Err(Error::new("this is an Excel workbook, which this build does not read")
        .help("save the sheet as CSV, or build with --features xlsx"))
}

/// The name and the text of the sheets that are asked for, or of each, that have any number.
#[cfg(feature = "xlsx")]
fn texts(file: &[u8], options: &ReadOptions) -> Result<Vec<NamedText>, Error> {
    use calamine::{Reader as _, Xlsx};

    let fault = |what: String| Error::new(format!("as Excel workbook: {what}")).help("save the sheet as CSV");
    let mut workbook = Xlsx::new(std::io::Cursor::new(file)).map_err(|error| fault(error.to_string()))?;
    let all = workbook.sheet_names();
    let wanted = wanted(&all, &options.sheet)?;
    let mut sheets = Vec::new();
    for name in wanted {
        let range = workbook
            .worksheet_range(&name)
            .map_err(|error| fault(error.to_string()))?;
        let merged = workbook
            .merge_cells_by_sheet_name(&name)
            .map_err(|error| fault(error.to_string()))?;
        if let Some(text) = text(&range, &merged) {
            sheets.push(NamedText { name, text });
        }
    }
    if sheets.is_empty() {
        return Err(fault("there is no sheet with numbers".into()));
    }
    Ok(sheets)
}

/// The sheets that are asked for by name or number, or all.
#[cfg(feature = "xlsx")]
fn wanted(all: &[String], asked: &[String]) -> Result<Vec<String>, Error> {
    if asked.is_empty() {
        return Ok(all.to_vec());
    }
    let one = |name: &String| {
        let named = all.iter().find(|sheet| *sheet == name);
        let alike = || all.iter().find(|sheet| sheet.trim().eq_ignore_ascii_case(name.trim()));
        let numbered = || {
            name.parse::<usize>()
                .ok()
                .and_then(|number| all.get(number.checked_sub(1)?))
        };
        named.or_else(alike).or_else(numbered).cloned().ok_or_else(|| {
            Error::new(format!("there is no sheet '{}'", crate::error::shown(name))).help(format!(
                "--sheet takes the names of sheets, or their numbers from 1: {}",
                shown_all(all)
            ))
        })
    };
    asked.iter().map(one).collect()
}

/// The names of sheets, for people.
#[cfg(feature = "xlsx")]
fn shown_all(names: &[String]) -> String {
    let shown: Vec<String> = names.iter().map(|name| crate::error::shown(name)).collect();
    crate::plain::some_of(&shown)
}

/// The cells of a sheet with tabs between them, each row on its line of the sheet; none if no cell is a number.
///
/// All of merged cells have the content of the first, unless they are a title over the whole width.
#[cfg(feature = "xlsx")]
fn text(range: &calamine::Range<calamine::Data>, merged: &[calamine::Dimensions]) -> Option<String> {
    use calamine::Data;

    let is_number = |cell: &Data| match cell {
        Data::Float(_) | Data::Int(_) => true,
        Data::String(text) => text.trim().parse::<f64>().is_ok(),
        _ => false,
    };
    if !range.rows().flatten().any(is_number) {
        return None;
    }
    let (begin, end) = (range.start()?, range.end()?);
    let mut range = range.clone();
    // Merged cells do not overlap, so a workbook of which more are merged than there are is a broken one.
    let mut left = range.get_size().0 * range.get_size().1;
    for region in merged {
        let (top, bottom) = (region.start.0.max(begin.0), region.end.0.min(end.0));
        let (first, last) = (region.start.1.max(begin.1), region.end.1.min(end.1));
        let is_title = top == bottom && (first, last) == (begin.1, end.1);
        if top > bottom || first > last || is_title || region.start != (top, first) {
            continue;
        }
        let count = (bottom - top + 1) as usize * (last - first + 1) as usize;
        let Some(fewer) = left.checked_sub(count) else { break };
        left = fewer;
        let content = range.get_value(region.start).cloned().unwrap_or_default();
        for row in top..=bottom {
            for column in first..=last {
                range.set_value((row, column), content.clone());
            }
        }
    }
    let cell = |cell: &Data| match cell {
        Data::Empty => String::new(),
        Data::Float(number) => number.to_string(),
        Data::Error(_) => "NaN".to_string(),
        other => other.to_string().replace(['\t', '\n', '\r', '"'], " "),
    };
    let mut text = "\n".repeat(begin.0 as usize);
    for row in range.rows() {
        text += &row.iter().map(cell).collect::<Vec<_>>().join("\t");
        text.push('\n');
    }
    Some(text)
}

#[cfg(all(test, feature = "xlsx"))]
mod tests {
    use super::*;
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
        let error = texts(&file, &ReadOptions::default()).unwrap_err();
        assert!(
            error.what.starts_with("as Excel workbook: ") && !error.what.contains('\n'),
            "{error}"
        );
    }
}
