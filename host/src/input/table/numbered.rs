//! A row of the numbers of the columns, below their names.

use crate::error::Error;
use crate::input::rows::{self, Decimal};
use crate::input::sheet::Sheet;

/// Of so many rows below, each must have a number that is not whole, as measured values are not.
const ROWS: usize = 8;

/// Refuses a first row that is `1,2,3` among rows of measured numbers.
///
/// # Errors
/// It is one, at its line.
pub fn refuse(sheet: &Sheet) -> Result<(), Error> {
    let mut all = rows::lines(sheet.rows).filter(|(_, _, line)| !rows::is_remark(line));
    let Some((_, _, first)) = all.next() else { return Ok(()) };
    let count = |from: usize| {
        let cells = rows::split(first, sheet.delimiter);
        cells.len() > 1
            && cells
                .iter()
                .enumerate()
                .all(|(place, cell)| *cell == (place + from).to_string())
    };
    if !count(1) && !count(0) {
        return Ok(());
    }
    let is_measured = |line: &str| {
        let numbers = rows::split(line, sheet.delimiter);
        let mut numbers = numbers.iter().filter_map(|cell| rows::parse(cell, Decimal::Unknown));
        numbers.any(|number| number.fract() != 0.0)
    };
    let below: Vec<bool> = all.take(ROWS).map(|(_, _, line)| is_measured(line)).collect();
    if below.len() < 2 || !below.into_iter().all(|is| is) {
        return Ok(());
    }
    Err(Error::new("the first row counts the columns, and is no sample")
        .at_line(sheet.first_line)
        .help("remove that line, or begin it with #"))
}
