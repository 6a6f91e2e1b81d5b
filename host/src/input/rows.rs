//! A text as rows of cells, each with its line.

use csv::StringRecord;

use super::unit::Unit;
use crate::error::{Error, shown};

/// How a table writes fractions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decimal {
    /// Not seen yet.
    Unknown,
    /// `0.5`
    Point,
    /// `0,5`
    Comma,
}

/// What stands between the cells of a table: a tab, a semicolon, a comma or a bar if the line has one, else spaces.
pub fn delimiter(line: &str) -> Option<u8> {
    [b'\t', b';', b',', b'|']
        .into_iter()
        .find(|&c| line.as_bytes().contains(&c))
}

/// The lines of a text with their numbers, from 1, and where they begin; any kind of line ends is fine.
pub fn lines(text: &str) -> impl Iterator<Item = (u64, usize, &str)> + Clone {
    let bytes = text.as_bytes();
    let mut start = 0;
    (1..).map_while(move |number| {
        let rest = bytes.get(start..).filter(|rest| !rest.is_empty())?;
        let end = start + memchr::memchr2(b'\n', b'\r', rest).unwrap_or(rest.len());
        let begin = start;
        let pair = bytes[end..].starts_with(b"\r\n");
        start = end + if pair { 2 } else { 1 };
        Some((number, begin, &text[begin..end]))
    })
}

/// The cells of one line, trimmed.
pub fn split(line: &str, delimiter: Option<u8>) -> Vec<&str> {
    let Some(delimiter) = delimiter else {
        return line.split_whitespace().collect();
    };
    let bare = |cell: &'_ str| -> (usize, usize) {
        let inner = cell.trim();
        let quoted = inner.len() > 1 && inner.starts_with('"') && inner.ends_with('"');
        let begin = inner.as_ptr().addr() - cell.as_ptr().addr();
        if quoted {
            (begin + 1, begin + inner.len() - 1)
        } else {
            (begin, begin + inner.len())
        }
    };
    let mut cells = Vec::new();
    let (mut begin, mut inside) = (0, false);
    for (at, byte) in line.bytes().enumerate() {
        inside ^= byte == b'"';
        if byte == delimiter && !inside {
            let (from, to) = bare(&line[begin..at]);
            cells.push(line[begin + from..begin + to].trim());
            begin = at + 1;
        }
    }
    let (from, to) = bare(&line[begin..]);
    cells.push(line[begin + from..begin + to].trim());
    cells
}

/// Calls `take` with the line and the cells of each row, without remarks and blank rows.
///
/// Lines that begin with `#` are remarks; any kind of line ends is fine.
///
/// # Errors
/// Those of `take`, and quotes that are not closed.
pub fn for_each(text: &str, take: impl FnMut(u64, &[&str]) -> Result<(), Error>) -> Result<(), Error> {
    let first = text.lines().find(|line| !is_remark(line)).unwrap_or("");
    each(text, delimiter(first), take)
}

/// The same with a known delimiter, spaces being none.
///
/// # Errors
/// As [`for_each`].
pub fn each(
    text: &str,
    delimiter: Option<u8>,
    mut take: impl FnMut(u64, &[&str]) -> Result<(), Error>,
) -> Result<(), Error> {
    if let Some(delimiter) = delimiter
        && memchr::memchr(b'"', text.as_bytes()).is_some()
    {
        return quoted(text, delimiter, take);
    }
    let mut cells: Vec<&str> = Vec::new();
    for (number, _, line) in lines(text).filter(|(_, _, line)| !is_remark(line)) {
        cells.clear();
        match delimiter {
            None => cells.extend(line.split_ascii_whitespace()),
            Some(delimiter) => {
                let mut begin = 0;
                for end in memchr::memchr_iter(delimiter, line.as_bytes()) {
                    cells.push(bare(&line[begin..end]));
                    begin = end + 1;
                }
                cells.push(bare(&line[begin..]));
            }
        }
        // Spreadsheets write blank rows as delimiters.
        if cells.iter().any(|cell| !cell.is_empty()) {
            take(number, &cells)?;
        }
    }
    Ok(())
}

/// A cell without the blanks around it, which most cells do not have.
fn bare(cell: &str) -> &str {
    let is_bare = |byte: Option<&u8>| byte.is_some_and(u8::is_ascii_graphic);
    let bytes = cell.as_bytes();
    if is_bare(bytes.first()) && is_bare(bytes.last()) {
        cell
    } else {
        cell.trim()
    }
}

/// As [`each`] where cells may be in quotes, and so hold delimiters and line ends.
fn quoted(text: &str, delimiter: u8, mut take: impl FnMut(u64, &[&str]) -> Result<(), Error>) -> Result<(), Error> {
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
        // The reader skips only `#` in the first place of a line.
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
    number_in(cells, column, &mut Decimal::Point)
}

/// The same where fractions may be written with a comma; `decimal` learns what the table does.
///
/// # Errors
/// As [`number`], and if the table writes them both ways.
pub fn number_in(cells: &[&str], column: usize, decimal: &mut Decimal) -> Result<f64, Error> {
    let cell = cells.get(column).copied().unwrap_or("");
    if *decimal == Decimal::Unknown {
        *decimal = match (cell.contains(','), cell.contains('.')) {
            (true, false) => Decimal::Comma,
            (false, true) => Decimal::Point,
            _ => Decimal::Unknown,
        };
    }
    if let Some(number) = parse(cell, *decimal) {
        return Ok(number);
    }
    if is_missing(cell) && column < cells.len() {
        return Ok(f64::NAN);
    }
    Err({
        let mut between = cell.bytes().filter(|byte| b".,'".contains(byte));
        let help = match decimal {
            // `1,234.5` and the like.
            _ if between.any(|mark| cell.bytes().any(|other| b".,".contains(&other) && other != mark)) => {
                "write numbers without marks between their thousands"
            }
            _ if Unit::at_end(cell).1.is_some() => {
                "write the unit in the name of the column, as in 'brf (%)', and numbers alone in its cells"
            }
            Decimal::Comma if cell.contains('.') => "other numbers have a decimal comma; write all in one way",
            _ if cell.contains(',') => "write numbers with a decimal point",
            _ => "write a number, or leave the cell empty and use --drop-invalid if there is no value",
        };
        Error::new(format!("'{}' is not a number", shown(cell)))
            .at_column(column as u64 + 1)
            .help(help)
    })
}

/// True of what people and spreadsheets write where there is no number.
fn is_missing(cell: &str) -> bool {
    const WORDS: [&str; 16] = [
        "", "-", "--", "---", "*", "na", "n/a", "n.a.", "null", "none", "missing", "#n/a", "#value!", "#div/0!",
        "#num!", "#ref!",
    ];
    WORDS.iter().any(|word| cell.eq_ignore_ascii_case(word))
}

/// A number as people and programs write it.
pub fn parse(cell: &str, decimal: Decimal) -> Option<f64> {
    if decimal != Decimal::Comma
        && let Ok(number) = fast_float2::parse(cell)
    {
        return Some(number);
    }
    let point = match decimal {
        Decimal::Point => !cell.contains(','),
        // A point would then part the thousands.
        _ => !cell.contains('.') && cell.matches(',').count() < 2,
    };
    if !point {
        return None;
    }
    // A true minus sign or a dash, and the exponent of Fortran.
    let spelt = cell.replace(',', ".").replace(['\u{2212}', '\u{2013}'], "-");
    spelt.parse().or_else(|_| spelt.replace(['D', 'd'], "e").parse()).ok()
}

#[cfg(test)]
mod tests {
    use rand_xoshiro::Xoshiro256PlusPlus;
    use rand_xoshiro::rand_core::{Rng, SeedableRng};

    use super::*;

    #[test]
    fn numbers_of_many_hands() {
        for (cell, decimal, number) in [
            ("0.5", Decimal::Point, Some(0.5)),
            ("0,5", Decimal::Comma, Some(0.5)),
            ("0,5", Decimal::Point, None),
            ("1.234,5", Decimal::Comma, None),
            ("0.5", Decimal::Comma, None),
            ("-1,5e-3", Decimal::Comma, Some(-1.5e-3)),
            ("\u{2212}80", Decimal::Point, Some(-80.0)),
            ("1.5D-3", Decimal::Point, Some(1.5e-3)),
            ("20", Decimal::Comma, Some(20.0)),
            ("dead", Decimal::Point, None),
            ("", Decimal::Unknown, None),
        ] {
            assert_eq!(parse(cell, decimal), number, "{cell}");
        }
        let mut decimal = Decimal::Unknown;
        assert_eq!(number_in(&["20", "0,25"], 0, &mut decimal).unwrap(), 20.0);
        assert_eq!(number_in(&["20", "0,25"], 1, &mut decimal).unwrap(), 0.25);
        assert!(
            number_in(&["0.5"], 0, &mut decimal)
                .unwrap_err()
                .to_string()
                .contains("decimal comma")
        );
    }

    #[test]
    fn numbers_have_the_bits_of_the_standard_library() {
        let words = [
            "",
            "+",
            "-",
            ".",
            "1.",
            ".5",
            "-.5e1",
            "+7",
            "1e",
            "e1",
            "1e+",
            "1_0",
            " 1",
            "1 ",
            "0x1p3",
            "inf",
            "-INF",
            "Infinity",
            "nan",
            "NaN",
            "+nan",
            "infin",
            "1e400",
            "-1e-400",
            "5e-324",
            "2.4703282292062328e-324",
            "1.7976931348623158e308",
            "9007199254740993",
            "9007199254740992.999999999999999999",
            "0.1e-30",
            "123456789012345678901234567890e-20",
            "00012.50",
        ];
        // Digits, points and exponents in any order, mostly as numbers have them.
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        let made = (0..20_000).map(|_| {
            let mut below = |n: u64| random.next_u64() % n;
            let digits: String = (0..1 + below(19)).map(|_| char::from(b'0' + below(10) as u8)).collect();
            let point = below(digits.len() as u64 + 1) as usize;
            let exponent =
                ["".to_string(), format!("e{}", below(40)), format!("E-{}", below(340))][below(3) as usize].clone();
            format!(
                "{}{}.{}{exponent}",
                ["", "-", "+"][below(3) as usize],
                &digits[..point],
                &digits[point..]
            )
        });
        for word in words.map(String::from).into_iter().chain(made) {
            let expected = word.parse::<f64>().ok().map(f64::to_bits);
            let found = fast_float2::parse::<f64, _>(&word).ok().map(f64::to_bits);
            assert_eq!(found, expected, "{word:?}");
        }
    }

    #[test]
    fn rows_with_and_without_quotes_are_the_same() {
        let text = "# a\n theta , b\n\n1,2\r\n # x\n,,\n3 ,\u{a0}4\n5,";
        let rows = |text: &str| {
            let mut rows: Vec<(u64, Vec<String>)> = Vec::new();
            each(text, Some(b','), |line, cells| {
                rows.push((line, cells.iter().map(|cell| cell.to_string()).collect()));
                Ok(())
            })
            .unwrap();
            rows
        };
        let plain = rows(text);
        assert_eq!(plain[1], (4, vec!["1".to_string(), "2".to_string()]));
        assert_eq!(plain.iter().map(|row| row.0).collect::<Vec<_>>(), [2, 4, 7, 8]);
        assert_eq!(rows(&text.replace("1,2", "\"1\",2")), plain);
    }

    #[test]
    fn lines_of_all_ends() {
        for end in ["\n", "\r\n", "\r"] {
            let text = ["a", "", "b"].join(end);
            let seen: Vec<_> = lines(&text).map(|(number, _, line)| (number, line)).collect();
            assert_eq!(seen, [(1, "a"), (2, ""), (3, "b")], "{end:?}");
        }
        assert_eq!(split("1, \"a,b\" ,2", Some(b',')), ["1", "a,b", "2"]);
        assert_eq!(split(" 1  2 ", None), ["1", "2"]);
    }
}
