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

    /// The CRC-32 of a ZIP archive's file.
    fn crc32(bytes: &[u8]) -> u32 {
        let step = |crc: u32| (crc >> 1) ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 };
        let all = bytes
            .iter()
            .fold(!0, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), |crc, _| step(crc)));
        !all
    }

    /// A ZIP archive of files that are stored as they are.
    fn zip(files: &[(String, String)]) -> Vec<u8> {
        let (mut archive, mut directory) = (Vec::new(), Vec::new());
        for (name, content) in files {
            let (at, size) = (archive.len() as u32, content.len() as u32);
            // Version 2.0, no flags, stored, without a date.
            let mut facts = [20u16, 0, 0, 0, 0].map(u16::to_le_bytes).concat();
            facts.extend([crc32(content.as_bytes()), size, size].map(u32::to_le_bytes).concat());
            facts.extend([name.len() as u16, 0].map(u16::to_le_bytes).concat());
            archive.extend([b"PK\x03\x04", &facts[..], name.as_bytes(), content.as_bytes()].concat());
            directory.extend(
                [
                    b"PK\x01\x02\x14\0",
                    &facts[..],
                    &[0; 10],
                    &at.to_le_bytes(),
                    name.as_bytes(),
                ]
                .concat(),
            );
        }
        let count = (files.len() as u16).to_le_bytes();
        let [at, size] = [archive.len(), directory.len()].map(|length| (length as u32).to_le_bytes());
        let end = [&b"PK\x05\x06\0\0\0\0"[..], &count, &count, &size, &at, &[0, 0]].concat();
        [archive, directory, end].concat()
    }

    /// A workbook of sheets: each its name, its cells with spaces between and `.` for none, and its merged cells.
    fn workbook(sheets: &[(&str, &str, &[&str])]) -> Vec<u8> {
        let cell = |(column, text): (usize, &str), row: usize| {
            let place = format!("{}{row}", char::from(b'A' + column as u8));
            match text {
                "." => String::new(),
                text if text.parse::<f64>().is_ok() => format!("<c r=\"{place}\"><v>{text}</v></c>"),
                text => format!("<c r=\"{place}\" t=\"inlineStr\"><is><t>{text}</t></is></c>"),
            }
        };
        let row = |(above, line): (usize, &str)| {
            let cells = line.split(' ').enumerate().map(|one| cell(one, above + 1));
            format!("<row r=\"{}\">{}</row>", above + 1, cells.collect::<String>())
        };
        let schema = "http://schemas.openxmlformats.org";
        let main = format!(
            "xmlns=\"{schema}/spreadsheetml/2006/main\" xmlns:r=\"{schema}/officeDocument/2006/relationships\""
        );
        let (mut names, mut links, mut files) = (String::new(), String::new(), Vec::new());
        for (place, (name, cells, merged)) in (1..).zip(sheets) {
            names += &format!("<sheet name=\"{name}\" sheetId=\"{place}\" r:id=\"r{place}\"/>");
            links += &format!(
                "<Relationship Id=\"r{place}\" Type=\"{schema}/officeDocument/2006/relationships/worksheet\" Target=\"worksheets/sheet{place}.xml\"/>"
            );
            let rows: String = cells.lines().enumerate().map(row).collect();
            let merged: String = merged.iter().map(|one| format!("<mergeCell ref=\"{one}\"/>")).collect();
            files.push((
                format!("xl/worksheets/sheet{place}.xml"),
                format!("<worksheet {main}><sheetData>{rows}</sheetData><mergeCells>{merged}</mergeCells></worksheet>"),
            ));
        }
        let related = |links: &str| {
            format!("<Relationships xmlns=\"{schema}/package/2006/relationships\">{links}</Relationships>")
        };
        let start = format!(
            "<Relationship Id=\"r\" Type=\"{schema}/officeDocument/2006/relationships/officeDocument\" Target=\"xl/workbook.xml\"/>"
        );
        files.push(("_rels/.rels".to_string(), related(&start)));
        files.push(("xl/_rels/workbook.xml.rels".to_string(), related(&links)));
        files.push((
            "xl/workbook.xml".to_string(),
            format!("<workbook {main}><sheets>{names}</sheets></workbook>"),
        ));
        zip(&files)
    }

    /// The name, and the rows as theta_i, theta_s and value, of each scan.
    fn read(file: &[u8], sheets: &[&str]) -> Result<Vec<(String, Vec<[f64; 3]>)>, Error> {
        let options = ReadOptions {
            sheet: sheets.iter().map(|name| name.to_string()).collect(),
            ..ReadOptions::default()
        };
        let each = scans(file, &options)?.1.into_iter();
        let rows = |scan: &RawScan| {
            scan.rows
                .iter()
                .map(|row| [row.theta_i, row.theta_s, row.value])
                .collect()
        };
        Ok(each.map(|scan| (scan.names.join(" "), rows(&scan))).collect())
    }

    #[test]
    fn sheets_are_chosen_by_name_or_number() {
        let table = |value: &str| format!("theta_i theta_s brdf\n30 10 {value}\n30 20 0.5");
        let (red, blue) = (table("0.25"), table("0.125"));
        let file = workbook(&[
            ("Notes", "measured on. a. Monday", &[]),
            ("Red", &red, &[]),
            ("Blue paint", &blue, &[]),
        ]);
        let scan = |name: &str, value: f64| (name.to_string(), vec![[30.0, 10.0, value], [30.0, 20.0, 0.5]]);
        // All that have numbers, told apart by their names.
        assert_eq!(
            read(&file, &[]).unwrap(),
            [scan("Red", 0.25), scan("Blue paint", 0.125)]
        );
        for (asked, name, value) in [
            ("Red", "", 0.25),
            ("blue PAINT", "", 0.125),
            ("2", "", 0.25),
            ("3", "", 0.125),
        ] {
            assert_eq!(read(&file, &[asked]).unwrap(), [scan(name, value)], "{asked}");
        }
        let both = [scan("Blue paint", 0.125), scan("Red", 0.25)];
        assert_eq!(read(&file, &["3", "red"]).unwrap(), both);
        for missing in ["Green", "0", "4"] {
            let error = read(&file, &[missing]).unwrap_err().to_string();
            assert!(
                error.contains(&format!("no sheet '{missing}'")) && error.contains("Blue paint"),
                "{error}"
            );
        }
        let error = read(&file, &["Notes"]).unwrap_err();
        assert!(error.what.contains("no sheet with numbers"), "{error}");
    }

    #[test]
    fn a_faulty_sheet_is_named_among_others() {
        let file = workbook(&[
            ("Good", "theta_i theta_s brdf\n30 10 0.25", &[]),
            ("Bad", "theta_i theta_s brdf\n30 10 dark\n30 20 1", &[]),
        ]);
        let error = read(&file, &[]).unwrap_err().to_string();
        assert!(
            error.contains("sheet Bad: 'dark' is not a number") && error.contains("--sheet chooses among Good, Bad"),
            "{error}"
        );
        assert_eq!(read(&file, &["Good"]).unwrap().len(), 1);
        let csv = b"theta_i,theta_s,brdf\n30,10,0.25\n";
        let options = ReadOptions {
            sheet: vec!["1".to_string()],
            ..ReadOptions::default()
        };
        let error = crate::input::parse("scan.csv", csv, &options).unwrap_err().to_string();
        assert!(error.contains("--sheet is for Excel workbooks"), "{error}");
    }

    #[test]
    fn merged_cells_all_have_the_content_of_the_first() {
        // A title over the whole width, angles of incidence merged downwards, and angles merged over two columns each.
        let down = "Paint\ntheta_i theta_s brdf\n30 10 0.25\n. 20 0.5\n. 30 1\n60 10 0.125\n. 20 2";
        let rows = [
            [30.0, 10.0, 0.25],
            [30.0, 20.0, 0.5],
            [30.0, 30.0, 1.0],
            [60.0, 10.0, 0.125],
            [60.0, 20.0, 2.0],
        ];
        let merged = workbook(&[("A", down, &["A1:C1", "A3:A5", "A6:A7"])]);
        assert_eq!(read(&merged, &[]).unwrap(), [(String::new(), rows.to_vec())]);
        // Without the merging the angles are missing, which is refused where rows are judged.
        let error =
            crate::input::parse("a.xlsx", &workbook(&[("A", down, &["A1:C1"])]), &ReadOptions::default()).unwrap_err();
        assert!(
            error.to_string().contains("of merged cells only the first has it"),
            "{error}"
        );
        let across = ". 30 . 60 .\ntheta_s R G R G\n10 1 2 3 4\n20 5 6 7 8";
        let found = read(&workbook(&[("A", across, &["B1:C1", "D1:E1"])]), &[]).unwrap();
        let of = |theta_i: f64, [first, second]: [f64; 2]| vec![[theta_i, 10.0, first], [theta_i, 20.0, second]];
        let all: Vec<[f64; 3]> = found.iter().flat_map(|(_, rows)| rows.clone()).collect();
        for [row, other] in [
            of(30.0, [1.0, 5.0]),
            of(30.0, [2.0, 6.0]),
            of(60.0, [3.0, 7.0]),
            of(60.0, [4.0, 8.0]),
        ]
        .map(|rows| [rows[0], rows[1]])
        {
            assert!(all.contains(&row) && all.contains(&other), "{found:?}");
        }
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
