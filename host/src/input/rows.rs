//! A text as rows of cells, each with its line.

use csv::StringRecord;

use crate::error::{Error, shown};

/// What stands between the cells of a table: a tab, a semicolon or a comma if its first line has one, else spaces.
fn delimiter(first: &str) -> Option<u8> {
    [b'\t', b';', b','].into_iter().find(|&c| first.as_bytes().contains(&c))
}

/// Calls `take` with the line and the cells of each row, without remarks and blank rows.
///
/// Lines that begin with `#` are remarks; any kind of line ends is fine.
///
/// # Errors
/// Those of `take`, and quotes that are not closed.
pub fn for_each(text: &str, mut take: impl FnMut(u64, &[&str]) -> Result<(), Error>) -> Result<(), Error> {
    let first = text.lines().find(|line| !is_remark(line)).unwrap_or("");
    let Some(delimiter) = delimiter(first) else {
        let lines = text.lines().zip(1..).filter(|(line, _)| !is_remark(line));
        for (line, number) in lines {
            let cells: Vec<&str> = line.split_whitespace().collect();
            take(number, &cells)?;
        }
        return Ok(());
    };
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(delimiter)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let mut record = StringRecord::new();
    while reader
        .read_record(&mut record)
        .map_err(|error| Error::new(error.to_string()))?
    {
        // The reader skips only `#` in the first place of a line, and spreadsheets write blank rows as delimiters.
        let blank = record.iter().all(|cell| cell.trim().is_empty());
        if blank || record[0].trim_start().starts_with('#') {
            continue;
        }
        let cells: Vec<&str> = record.iter().map(str::trim).collect();
        take(line_of(text, &record), &cells)?;
    }
    Ok(())
}

/// True of a line without numbers.
pub fn is_remark(line: &str) -> bool {
    let line = line.trim_start();
    line.is_empty() || line.starts_with('#')
}

/// The line on which a record begins.
///
/// The position that the reader gives is that of the end of the record before, so remarks and blank lines between must be counted here, and the line feed of a pair CR LF.
fn line_of(text: &str, record: &StringRecord) -> u64 {
    let Some(position) = record.position() else { return 1 };
    let mut line = position.line();
    let mut rest = &text[position.byte() as usize..];
    while let Some((first, after)) = rest.split_once('\n') {
        if !(first.trim_end_matches('\r').is_empty() || first.starts_with('#')) {
            break;
        }
        line += 1;
        rest = after;
    }
    line
}

/// The number in a cell, counted from 0; NaN and infinities are numbers here.
///
/// # Errors
/// It is none, or there is no such cell.
pub fn number(cells: &[&str], column: usize) -> Result<f64, Error> {
    let cell = cells.get(column).copied().unwrap_or("");
    cell.parse().map_err(|_| {
        let help = if cell.contains(',') {
            "write numbers with a decimal point"
        } else {
            "write a number, or NaN and use --drop-invalid if there is no value"
        };
        Error::new(format!("'{}' is not a number", shown(cell)))
            .at_column(column as u64 + 1)
            .help(help)
    })
}
