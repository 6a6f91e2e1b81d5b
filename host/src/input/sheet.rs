//! A text as a table: what stands above it, the heads of its columns, and where its rows begin.

mod lines;
mod two_lines;

use lines::{Line, delimiter_of_row, is_head, is_number, is_pair, is_remark, is_row, is_value_of_one, no_heads, parts};
use two_lines::{goes_on, joined, names_in_two, over_names};

use super::facts::Facts;
use super::head::Head;
use super::options::ReadOptions;
use super::rows;
use super::unit::Unit;
use crate::error::Error;

/// A table in a text.
#[derive(Debug)]
pub struct Sheet<'a> {
    /// The heads of the columns; their texts are empty if there are none.
    pub heads: Vec<Head>,
    /// The line of the heads, or of the first row.
    pub line: u64,
    /// What the lines above say.
    pub facts: Facts,
    /// The rows, as text.
    pub rows: &'a str,
    /// The line of the first of them.
    pub first_line: u64,
    /// What stands between cells; spaces if none.
    pub delimiter: Option<u8>,
}

impl<'a> Sheet<'a> {
    /// Finds the table: heads in a line of their own, in a remark above the rows, or none.
    ///
    /// # Errors
    /// There are only remarks, or rows without heads and without `--columns`.
    pub fn find(text: &'a str, options: &ReadOptions) -> Result<Sheet<'a>, Error> {
        let mut above: Vec<Line> = Vec::new();
        let mut given = None;
        let mut first = None;
        for (number, start, text_of_line) in rows::lines(text) {
            let line = Line {
                number,
                text: text_of_line,
            };
            if line.text.trim().is_empty() {
                continue;
            }
            if is_remark(line.text) {
                above.push(line);
                continue;
            }
            if let Some(delimiter) = separator(line.text) {
                given = Some(delimiter);
                continue;
            }
            first.get_or_insert((line, start));
            let delimiter = given.or_else(|| rows::delimiter(line.text));
            let cells = rows::split(line.text, delimiter);
            let below = |width| Sheet::has_names_below(text, start, delimiter, width);
            if is_head(&cells) && !is_pair(&cells) && !(is_value_of_one(&cells) && below(None)) {
                return Ok(Sheet::with_heads(text, start, line, &cells, delimiter, &above));
            }
            let found = match given {
                Some(delimiter) => Some(Some(delimiter)).filter(|_| is_row(&cells, true) || is_row(&cells, false)),
                None => delimiter_of_row(line.text),
            };
            // Angles may stand over the names, as in `,20,20,40,40` over `theta_s,R,G,R,G`.
            let is_over_names = || cells.first() == Some(&"") && below(Some(cells.len()));
            if let Some(delimiter) = found
                && !is_over_names()
            {
                return Sheet::without_heads(text, start, line, delimiter, &above, options);
            }
            above.push(line);
        }
        let Some((line, start)) = first else {
            return Err(Error::new("there is no header line, only remarks").help("name the columns in the first line"));
        };
        // No rows: what the first line lacks is the better message.
        let delimiter = given.or_else(|| rows::delimiter(line.text));
        let cells = rows::split(line.text, delimiter);
        Ok(Sheet::with_heads(text, start, line, &cells, delimiter, &[]))
    }

    /// Is the line below the one that begins at `start` one of names, of so many if that is given?
    fn has_names_below(text: &str, start: usize, delimiter: Option<u8>, width: Option<usize>) -> bool {
        let below = rows::lines(&text[start..]).nth(1);
        below.is_some_and(|(_, _, below)| {
            let cells = rows::split(below, delimiter);
            width.is_none_or(|width| cells.len() == width) && is_head(&cells) && !is_pair(&cells)
        })
    }

    /// A table below a line of names, and perhaps one of units, or one that the names go on in.
    fn with_heads(
        text: &'a str,
        start: usize,
        line: Line,
        cells: &[&str],
        delimiter: Option<u8>,
        above: &[Line],
    ) -> Sheet<'a> {
        let mut heads: Vec<Head> = cells.iter().map(|cell| Head::new(cell)).collect();
        let mut delimiter = delimiter;
        // Lines below, with their places in the whole text.
        let mut below = rows::lines(&text[start..])
            .skip(1)
            .map(|(number, begin, below)| (line.number + number - 1, start + begin, below))
            .filter(|(_, _, below)| !rows::is_remark(below));
        let mut next = below.next();
        if let Some(names) = over_names(above.last(), line.number, cells, delimiter) {
            heads = names.iter().map(|name| Head::new(name)).collect();
        }
        if let Some((_, _, units)) = next {
            let beyond = below.clone().next().map(|(_, _, row)| row);
            let cells = rows::split(units, delimiter);
            let known = cells.iter().all(|cell| cell.is_empty() || Unit::parse(cell).is_some());
            let words = cells.iter().any(|cell| !cell.is_empty() && !is_number(cell));
            if cells.len() == heads.len() && words && known {
                heads = heads
                    .into_iter()
                    .zip(&cells)
                    .map(|(head, unit)| head.with_unit(unit))
                    .collect();
                next = below.next();
            } else if beyond.is_some_and(|row| goes_on(&heads, &cells, &rows::split(row, delimiter))) {
                let upper: Vec<&str> = heads.iter().map(|head| head.text.as_str()).collect();
                heads = joined(&upper, &cells).iter().map(|name| Head::new(name)).collect();
                next = below.next();
            }
        }
        // Names may stand between commas, and numbers between spaces.
        if let Some((_, _, row)) = next
            && rows::split(row, delimiter).len() != heads.len()
        {
            let fits = delimiter_of_row(row).filter(|&other| rows::split(row, other).len() == heads.len());
            delimiter = fits.unwrap_or(delimiter);
        }
        let (first_line, begin, _) = next.unwrap_or((line.number + 1, text.len(), ""));
        Sheet {
            heads,
            line: line.number,
            facts: Facts::of(above.iter().map(|line| (line.number, line.text))),
            rows: &text[begin..],
            first_line,
            delimiter,
        }
    }

    /// A table whose first row is `line`: its names are in the last remark that has as many, or in the line right above, or nowhere.
    fn without_heads(
        text: &'a str,
        start: usize,
        line: Line,
        delimiter: Option<u8>,
        above: &[Line],
        options: &ReadOptions,
    ) -> Result<Sheet<'a>, Error> {
        let width = rows::split(line.text, delimiter).len();
        let facts = Facts::of(above.iter().map(|line| (line.number, line.text)));
        let known = above.iter().enumerate().rev();
        let known = known.filter_map(|(place, remark)| Some((place, names_in(remark.text, width, delimiter)?)));
        let last = above.len().checked_sub(1);
        let foreign = last.and_then(|place| Some((place, foreign_names(above[place].text, width, delimiter)?)));
        let both = last.and_then(|place| Some((place, names_in_two(above, width, delimiter)?)));
        let owned =
            |(place, names): (usize, Vec<&str>)| (place, names.into_iter().map(String::from).collect::<Vec<_>>());
        let named = both
            .into_iter()
            .chain(known.map(owned))
            .chain(foreign.map(owned))
            .next();
        let (at, heads) = match named {
            Some((place, names)) => {
                let mut heads: Vec<Head> = names.iter().map(|name| Head::new(name)).collect();
                if let Some(units) = above
                    .get(place + 1)
                    .and_then(|below| units_in(below.text, width, delimiter))
                {
                    heads = heads
                        .into_iter()
                        .zip(units)
                        .map(|(head, unit)| head.with_unit(unit))
                        .collect();
                }
                (above[place].number, heads)
            }
            None if options.columns.is_empty() => return Err(no_heads(line, above.last(), delimiter)),
            None => (line.number, vec![Head::new(""); width]),
        };
        Ok(Sheet {
            heads,
            line: at,
            facts,
            rows: &text[start..],
            first_line: line.number,
            delimiter,
        })
    }

    /// The names in a remark, if it has one for each column.
    pub fn names_in<'b>(&self, remark: &'b str) -> Option<Vec<&'b str>> {
        names_in(remark, self.heads.len(), self.delimiter)
    }

    /// Calls `take` with the line and the cells of each row.
    ///
    /// # Errors
    /// Those of `take`, and rows of another length than the heads.
    pub fn for_each(&self, mut take: impl FnMut(u64, &[&str]) -> Result<(), Error>) -> Result<(), Error> {
        rows::each(self.rows, self.delimiter, |line, cells| {
            let line = self.first_line + line - 1;
            // Delimiters at the end of a row, which the heads do not have, part nothing.
            let cells = match cells.split_at_checked(self.heads.len()) {
                Some((cells, more)) if more.iter().all(|cell| cell.is_empty()) => cells,
                _ => cells,
            };
            if cells.len() != self.heads.len() {
                let (have, width) = (cells.len(), self.heads.len());
                return Err(Error::new(format!("the row has {have} cells, the header {width}"))
                    .at_line(line)
                    .help("give every row the cells that the header names"));
            }
            take(line, cells).map_err(|error| {
                if error.line.is_some() {
                    error
                } else {
                    error.at_line(line)
                }
            })
        })
    }
}

/// The delimiter in a line such as `sep=;`, which spreadsheets write and read.
fn separator(line: &str) -> Option<u8> {
    let (key, mark) = line.trim_matches(['"', '\r', '\u{feff}']).split_once('=')?;
    let mark = mark.trim_matches(['"', ' ']);
    match mark.as_bytes() {
        [mark] if key.trim().eq_ignore_ascii_case("sep") => Some(*mark),
        _ if mark == "\\t" && key.trim().eq_ignore_ascii_case("sep") => Some(b'\t'),
        _ => None,
    }
}

/// The names in a remark, if there are as many as columns and they are known.
fn names_in(remark: &str, width: usize, delimiter: Option<u8>) -> Option<Vec<&str>> {
    let known = |names: &Vec<&str>| names.len() == width && is_head(names);
    parts(remark, delimiter).into_iter().find(known)
}

/// The words in the line right above the rows, if there are as many as columns: names that somebody else gave.
fn foreign_names(remark: &str, width: usize, delimiter: Option<u8>) -> Option<Vec<&str>> {
    let is_name = |name: &&str| !name.is_empty() && !is_number(name);
    let names = |names: &Vec<&str>| names.len() == width && width > 1 && names.iter().all(is_name);
    let is_pair = remark.contains([':', '=']);
    parts(remark, delimiter).into_iter().find(names).filter(|_| !is_pair)
}

/// The units in a remark, if there are as many as columns.
fn units_in(remark: &str, width: usize, delimiter: Option<u8>) -> Option<Vec<&str>> {
    let units = |cells: &Vec<&str>| cells.len() == width && cells.iter().all(|cell| Unit::parse(cell).is_some());
    parts(remark, delimiter).into_iter().find(units)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(text: &str) -> Sheet<'_> {
        Sheet::find(text, &ReadOptions::default()).unwrap()
    }

    fn rows_of(sheet: &Sheet) -> Vec<(u64, Vec<String>)> {
        let mut all = Vec::new();
        let take = |line, cells: &[&str]| {
            all.push((line, cells.iter().map(|cell| cell.to_string()).collect()));
            Ok(())
        };
        sheet.for_each(take).unwrap();
        all
    }

    #[test]
    fn heads_where_people_put_them() {
        for (text, line, first) in [
            ("theta_i,theta_s,brdf\n20,-80,0.5\n", 1, 2),
            ("sep=;\ntheta_i;theta_s;brdf\n20;-80;0.5\n", 2, 3),
            ("sep=,\r\ntheta_i,theta_s,brdf\r\n20,-80,0.5\r\n", 2, 3),
            ("# theta_i theta_s brdf\n20 -80 0.5\n", 1, 2),
            ("# made up\n# columns: theta_i, theta_s, brdf\n#\n20\t-80\t0.5\n", 2, 4),
            ("% theta_i,theta_s,brdf\n20,-80,0.5\n", 1, 2),
            ("Name: made up\n\ntheta_i theta_s brdf\n20 -80 0.5\n", 3, 4),
            ("theta_i,theta_s,brdf\ndeg,deg,1/sr\n20,-80,0.5\n", 1, 3),
            ("theta_i;theta_s;brdf\n[°];[°];[sr^-1]\n\n# x\n20;-80;0.5\n", 1, 5),
            ("theta_i, theta_s, brdf\n20 -80 0.5\n", 1, 2),
        ] {
            let sheet = find(text);
            assert_eq!(sheet.line, line, "{text}");
            let plain: Vec<_> = sheet.heads.iter().map(|head| head.plain.as_str()).collect();
            assert_eq!(plain, ["thetai", "thetas", "brdf"], "{text}");
            let row = ["20", "-80", "0.5"].map(String::from).to_vec();
            assert_eq!(rows_of(&sheet), [(first, row)], "{text}");
        }
        let units = find("theta_i;theta_s;brdf\nrad;rad;%\n1;1;1\n");
        assert_eq!(
            (units.heads[0].unit, units.heads[2].unit),
            (Some(Unit::Rad), Some(Unit::Percent))
        );
        let units = find("# theta_i theta_s brdf\n# rad rad 1/sr\n1 1 1\n");
        assert_eq!(units.heads[1].unit, Some(Unit::Rad));
    }

    #[test]
    fn foreign_names_and_none() {
        let sheet = find("Angle A,Angle B,Signal\n20,-80,0.5\n");
        assert_eq!((sheet.line, sheet.heads[2].text.as_str()), (1, "Signal"));
        let columns = vec![super::super::part::parse("theta_s=1").unwrap()];
        let options = ReadOptions {
            columns,
            ..ReadOptions::default()
        };
        let text = "Name: made up\nIncident Angle: 20\nWavelength: 550\n-80\t0.128911\t0.00258\n";
        let sheet = Sheet::find(text, &options).unwrap();
        assert_eq!(
            (sheet.heads.len(), sheet.first_line, sheet.delimiter),
            (3, 4, Some(b'\t'))
        );
        assert_eq!(
            (sheet.facts.one_theta_i().unwrap(), sheet.facts.wavelength),
            (Some(20.0), Some(550.0))
        );
        for (text, cell) in [
            ("theta_s,550,650\n-80,1,2\n", "'550'"),
            ("theta_s,20,45,mean\n-80,1,2,3\n", "'mean'"),
            ("theta_s,-80,80\nBRDF,1,2\n", "'-80'"),
        ] {
            let error = Sheet::find(text, &ReadOptions::default()).unwrap_err();
            assert!(error.line == Some(1) && error.what.contains(cell), "{error}");
        }
        let error = Sheet::find(text, &ReadOptions::default()).unwrap_err();
        assert!(
            error.line == Some(4) && error.to_string().contains("--columns"),
            "{error}"
        );
        assert!(
            Sheet::find("# a\n\n# b\n", &options)
                .unwrap_err()
                .what
                .contains("no header line")
        );
    }
}
