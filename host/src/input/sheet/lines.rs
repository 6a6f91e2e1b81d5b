//! What a line above the rows or a line of cells may be.

use crate::error::{Error, shown};
use crate::input::channel;
use crate::input::head::Head;
use crate::input::role::{self, Role};
use crate::input::rows::{self, Decimal};
use crate::input::unit::Unit;
use crate::input::wide;

/// A line above the rows.
#[derive(Clone, Copy)]
pub struct Line<'a> {
    pub number: u64,
    pub text: &'a str,
}

pub fn is_number(cell: &str) -> bool {
    rows::parse(cell, Decimal::Unknown).is_some()
}

/// True of lines that no table has.
pub fn is_remark(line: &str) -> bool {
    rows::is_remark(line) || line.trim_start().starts_with(['%', '!'])
}

/// True of names: no angle is a number, and at least two are known.
pub fn is_head(cells: &[&str]) -> bool {
    let known = |cell: &&&str| {
        let head = Head::new(cell);
        let role = role::role(&head);
        !matches!(role, Role::Unknown(_) | Role::Repeat | Role::Unit) || channel::is(&head) || wide::at(cell).is_some()
    };
    let names = cells.iter().filter(|cell| !is_number(cell));
    cells.len() > 1
        && names.clone().any(|cell| !cell.is_empty())
        && !cells.iter().take(2).all(|cell| is_number(cell))
        && {
            let roles = names.filter(known).count();
            roles > 1
                && cells
                    .iter()
                    .all(|cell| !is_number(cell) || channel::is(&Head::new(cell)))
        }
}

/// True of a remark such as `Wavelength: 632.8 nm` or, in cells, `Wavelength,632.8 nm`, and of what goes before names, such as `Columns: theta_i, theta_s, brdf`.
pub fn is_pair(cells: &[&str]) -> bool {
    // A unit may stand behind a colon, as in `theta_i:deg`.
    let has_key = |cell: &&str| {
        let (name, _) = cell.split_at(cell.find(['[', '(']).unwrap_or(cell.len()));
        name.split_once(':')
            .is_some_and(|(_, behind)| Unit::parse(behind).is_none())
    };
    let mut filled = cells.iter().filter(|cell| !cell.is_empty());
    let (key, value, more) = (filled.next(), filled.next(), filled.next());
    cells.first().is_some_and(has_key)
        || matches!((key, value, more), (Some(key), Some(value), None) if is_fact(key, value))
        || cells.len() > 2 && !cells.iter().any(|cell| is_table(&Head::new(cell)))
}

/// True of a name and a number behind it, as in `Detector angle,20 deg`: a column at an angle, or a fact.
pub fn is_value_of_one(cells: &[&str]) -> bool {
    let mut filled = cells.iter().filter(|cell| !cell.is_empty());
    let (_, value, more) = (filled.next(), filled.next(), filled.next());
    more.is_none() && value.is_some_and(|value| value.starts_with(|c: char| c.is_ascii_digit()))
}

/// True of the name of what is the same in all rows, with a number or a word behind it.
pub fn is_fact(key: &str, value: &str) -> bool {
    let [key, value] = [key, value].map(|text| role::role(&Head::new(text)));
    !matches!(key, Role::ThetaS | Role::Theta | Role::Value(_))
        && !matches!(value, Role::ThetaS | Role::Theta | Role::Value(_))
}

/// True of what every table has: scattering angles, or values.
pub fn is_table(head: &Head) -> bool {
    matches!(role::role(head), Role::ThetaS | Role::Theta | Role::Value(_))
}

/// What is said of rows without heads: which word or number in the line that might have them is no name.
pub fn no_heads(line: Line, above: Option<&Line>, delimiter: Option<u8>) -> Error {
    for line in [Some(&line), above].into_iter().flatten() {
        let cells = rows::split(line.text, delimiter);
        if let Some(cell) = no_name(&cells).filter(|_| !is_pair(&cells)) {
            return Error::new(format!(
                "this line begins with '{}', and '{}' in it is not the name of a column",
                shown(cells[0]),
                shown(cell)
            ))
            .at_line(line.number)
            .help("name every column, a wavelength with its unit, such as 550 nm; as the first row of a matrix it stands first, has angles of at most 360 degrees and nothing else, and the rows below begin with an angle");
        }
    }
    Error::new("there is no header line: the columns have no names")
        .at_line(line.number)
        .help("say what they are, such as --columns theta_i=1,theta_s=2,brdf=3, or name them in a first line")
}

/// The cell which, in a line that begins with a known name, is none: a word, or else a number.
fn no_name<'a>(cells: &[&'a str]) -> Option<&'a str> {
    let (first, others) = cells.split_first()?;
    let is_known = |cell: &str| !matches!(role::role(&Head::new(cell)), Role::Unknown(_));
    let word = |cell: &&&str| !cell.is_empty() && !is_number(cell) && !is_known(cell);
    let found = others.iter().find(word).or(others.iter().find(|cell| is_number(cell)));
    found.filter(|_| is_known(first)).copied()
}

/// True of a row of numbers; with `only`, of nothing else.
pub fn is_row(cells: &[&str], only: bool) -> bool {
    let numbers = cells.iter().filter(|cell| is_number(cell)).count();
    numbers > 1
        && if only {
            numbers == cells.len()
        } else {
            2 * numbers >= cells.len()
        }
}

/// The delimiter with which a line is a row of numbers, spaces being none.
pub fn delimiter_of_row(line: &str) -> Option<Option<u8>> {
    const ALL: [Option<u8>; 5] = [Some(b'\t'), Some(b';'), Some(b','), Some(b'|'), None];
    let present = |delimiter: &Option<u8>| delimiter.is_none_or(|mark| line.as_bytes().contains(&mark));
    let with = |only| {
        ALL.into_iter()
            .filter(present)
            .find(|&delimiter| is_row(&rows::split(line, delimiter), only))
    };
    with(true).or_else(|| {
        // A remark such as `Incident Angle: 20` with a number or two is no row.
        with(false).filter(|_| !line.contains([':', '=']))
    })
}

/// The parts of a remark at each mark that may stand between them.
pub fn parts(remark: &str, delimiter: Option<u8>) -> Vec<Vec<&str>> {
    let bare = remark.trim().trim_start_matches(['#', '%', '!', ' ', '\t']);
    let behind = bare.split_once(':').map(|(_, behind)| behind.trim());
    let texts = [behind, Some(bare)].into_iter().flatten();
    let marks = [delimiter, Some(b'\t'), Some(b';'), Some(b','), Some(b'|'), None];
    texts
        .flat_map(|text| marks.iter().map(move |&mark| rows::split(text, mark)))
        .collect()
}
