//! Reads scans: tables with named columns, angles in degrees, BRDF in sr^-1. Degrees exist here and in `simulate` only.

use std::fs;
use std::io::Read;
use std::path::Path;

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use csv::StringRecord;

use crate::columns::{self, Columns};
use crate::error::{Error, shown};

/// A scan as it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// Where it came from, as the user named it.
    pub file: String,
    /// The valid rows in order of the file; at least one.
    pub samples: Vec<Sample<f64>>,
    /// The line of each sample; the first line of a file is 1.
    pub lines: Vec<u64>,
    /// Where the columns were.
    pub columns: Columns,
    /// How many rows were left out.
    pub dropped: usize,
}

/// What to do about rows without a valid sample: a BRDF that is missing or not positive, or an angle beyond the horizon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Invalid {
    /// They are an error.
    Refuse,
    /// They are left out and counted.
    Drop,
}

/// The name that stands for standard input.
pub const STDIN: &str = "-";

/// Reads the bytes of a file.
///
/// # Errors
/// It is missing, a directory, or not readable.
pub fn read_file(path: &Path) -> Result<Vec<u8>, Error> {
    let fail = |what: String| Error::new(what).in_file(path.display().to_string());
    // On some systems a directory opens like a file, and only reading it fails.
    if path.is_dir() {
        return Err(fail("this is a directory".into()).help("name the files in it"));
    }
    fs::read(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => fail("no such file".into()).help("check the name and the folder"),
        _ => fail(format!("can not be read: {error}")).help("check its permissions"),
    })
}

/// Reads all of standard input.
///
/// # Errors
/// The stream breaks.
pub fn read_stdin(stream: &mut dyn Read) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    match stream.read_to_end(&mut bytes) {
        Ok(_) => Ok(bytes),
        Err(error) => Err(Error::new(format!("can not be read: {error}")).in_file(STDIN)),
    }
}

/// Reads a scan from the bytes of `file`, which is only named here.
///
/// Commas, semicolons or tabs separate the columns; lines that begin with `#`, blank lines, a byte order mark and any kind of line ends are fine.
///
/// # Errors
/// Anything that leaves a doubt about what was measured, with its line and column.
pub fn parse(file: &str, bytes: &[u8], invalid: Invalid) -> Result<Measurement, Error> {
    table(file, text(bytes).map_err(|error| error.in_file(file))?, invalid).map_err(|error| error.in_file(file))
}

/// The text, without its byte order mark.
fn text(bytes: &[u8]) -> Result<&str, Error> {
    if bytes.is_empty() {
        return Err(Error::new("the file is empty").help("give a file with a header line and one row a sample"));
    }
    let line_at = |end: usize| 1 + bytes[..end].iter().filter(|&&byte| byte == b'\n').count() as u64;
    let binary = |end: usize| {
        Error::new("this is not UTF-8 text")
            .at_line(line_at(end))
            .help("give a CSV file, or save it again as UTF-8 text")
    };
    let text = std::str::from_utf8(bytes).map_err(|error| binary(error.valid_up_to()))?;
    match text.find('\0') {
        Some(end) => Err(binary(end)),
        None => Ok(text.strip_prefix('\u{feff}').unwrap_or(text)),
    }
}

/// The table in a text.
fn table(file: &str, text: &str, invalid: Invalid) -> Result<Measurement, Error> {
    let header = text.lines().find(|line| !is_remark(line)).unwrap_or("");
    let delimiter = [b'\t', b';'].into_iter().find(|&c| header.as_bytes().contains(&c));
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(delimiter.unwrap_or(b','))
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let mut record = StringRecord::new();
    let mut columns = None;
    let mut rows = 0;
    let mut faults = Faults::default();
    let (mut samples, mut lines) = (Vec::new(), Vec::new());
    while reader
        .read_record(&mut record)
        .map_err(|error| Error::new(error.to_string()))?
    {
        // The reader skips only `#` in the first place of a line, and spreadsheets write blank rows as delimiters.
        let blank = record.iter().all(|cell| cell.trim().is_empty());
        if blank || record[0].trim_start().starts_with('#') {
            continue;
        }
        let line = line_of(text, &record);
        let Some(columns) = columns else {
            columns = Some(columns::find(record.iter()).map_err(|error| error.at_line(line))?);
            continue;
        };
        rows += 1;
        match sample(&record, &columns).map_err(|error| error.at_line(line))? {
            Row::Valid(sample) => {
                samples.push(sample);
                lines.push(line);
            }
            Row::Invalid { what, column } => faults.add(line, column, what),
        }
    }
    let Some(columns) = columns else {
        return Err(Error::new("there is no header line, only remarks").help("name the columns in the first line"));
    };
    if rows == 0 {
        return Err(Error::new("there are no rows below the header").help("give one row a sample"));
    }
    if faults.count > 0 && invalid == Invalid::Refuse {
        return Err(faults.error());
    }
    if samples.is_empty() {
        return Err(
            Error::new(format!("none of the {rows} rows is a valid sample")).help("check the columns and units")
        );
    }
    Ok(Measurement {
        file: file.to_string(),
        samples,
        lines,
        columns,
        dropped: faults.count,
    })
}

fn is_remark(line: &str) -> bool {
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

/// What a row holds.
enum Row {
    Valid(Sample<f64>),
    /// Numbers that are no sample; the column counts from 1.
    Invalid {
        what: String,
        column: u64,
    },
}

/// The sample in a row.
fn sample(record: &StringRecord, columns: &Columns) -> Result<Row, Error> {
    if record.len() != columns.count {
        return Err(Error::new(format!(
            "the row has {} cells, the header {}",
            record.len(),
            columns.count
        ))
        .help("give every row the cells that the header names"));
    }
    let angle_i = number(record, columns.theta_i)?;
    let angle_s = number(record, columns.theta_s)?;
    let brdf = number(record, columns.brdf)?;
    let phi_s = columns.phi_s.map(|column| number(record, column)).transpose()?;
    let phi_i = columns.phi_i.map(|column| number(record, column)).transpose()?;
    let invalid = |column: usize, what: String| {
        Ok(Row::Invalid {
            what,
            column: column as u64 + 1,
        })
    };
    let angles = [
        (Some(columns.theta_i), "theta_i", Some(angle_i)),
        (Some(columns.theta_s), "theta_s", Some(angle_s)),
        (columns.phi_s, "the azimuth", phi_s),
        (columns.phi_i, "the azimuth of incidence", phi_i),
    ];
    for (column, name, angle) in angles {
        if let (Some(column), Some(angle)) = (column, angle)
            && !angle.is_finite()
        {
            return invalid(column, format!("{name} is {angle}, which is no angle"));
        }
    }
    if angle_i < 0.0 {
        return Err(Error::new(format!("theta_i is {angle_i}, and must not be negative"))
            .at_column(columns.theta_i as u64 + 1)
            .help("turn the plane round: change the signs of both theta_i and theta_s in such rows"));
    }
    for (column, name, angle) in [
        (columns.theta_i, "theta_i", angle_i),
        (columns.theta_s, "theta_s", angle_s),
    ] {
        if angle.abs() >= 90.0 {
            return invalid(column, format!("{name} is {angle} degrees, at or beyond the horizon"));
        }
    }
    if !brdf.is_finite() {
        return invalid(columns.brdf, format!("the BRDF is {brdf}, which is no value"));
    }
    let brdf_linear = if columns.is_ln { Real::exp(brdf) } else { brdf };
    let in_range = !columns.is_ln || (-708.0..=709.0).contains(&brdf);
    if !(brdf_linear >= f64::MIN_POSITIVE && in_range) {
        let why = match (columns.is_ln, brdf > 0.0) {
            (true, _) => "the logarithm of no number of the machine",
            (false, true) => "too small to compute with",
            (false, false) => "which has no logarithm",
        };
        return invalid(columns.brdf, format!("the BRDF is {brdf}, {why}"));
    }
    Ok(Row::Valid(Sample {
        theta_i: angle_i.to_radians(),
        theta_s: angle_s.to_radians(),
        delta_phi: phi_s.map_or(f64::PI, |phi_s| azimuth(phi_s - phi_i.unwrap_or(0.0))),
        brdf: brdf_linear,
        weight: 1.0,
    }))
}

/// The number in a cell; NaN and infinities are numbers here.
fn number(record: &StringRecord, column: usize) -> Result<f64, Error> {
    let cell = record[column].trim();
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

/// Degrees to radians, within -pi to pi; 180 degrees are exactly pi, which the model takes as in plane.
pub fn azimuth(degrees: f64) -> f64 {
    let turned = degrees % 360.0;
    let within = if turned > 180.0 {
        turned - 360.0
    } else if turned < -180.0 {
        turned + 360.0
    } else {
        turned
    };
    if within.abs() == 180.0 {
        f64::PI
    } else {
        within.to_radians()
    }
}

/// The rows that are no sample, summed up.
#[derive(Default)]
struct Faults {
    count: usize,
    first: Option<(u64, u64, String)>,
    lines: Vec<String>,
}

impl Faults {
    fn add(&mut self, line: u64, column: u64, what: String) {
        const LISTED: usize = 8;
        self.first.get_or_insert((line, column, what));
        if self.lines.len() < LISTED {
            self.lines.push(line.to_string());
        }
        self.count += 1;
    }

    /// One line for all of them, at the place of the first.
    fn error(self) -> Error {
        let Some((line, column, mut what)) = self.first else {
            return Error::new("no row is at fault");
        };
        if self.count > 1 {
            let more = if self.count > self.lines.len() { ", ..." } else { "" };
            let lines = self.lines.join(", ");
            what += &format!(" ({} rows are not valid, on lines {lines}{more})", self.count);
        }
        Error::new(what)
            .at_line(line)
            .at_column(column)
            .help("use --drop-invalid to leave such rows out")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Measurement, Error> {
        parse("scan.csv", text.as_bytes(), Invalid::Refuse)
    }

    #[test]
    fn counts_lines_over_remarks_blanks_and_line_ends() {
        for end in ["\n", "\r\n"] {
            for mark in ["", "\u{feff}"] {
                let lines = [
                    "# remark",
                    "",
                    "theta_i,theta_s,brdf",
                    "",
                    "1,2,3",
                    "# x",
                    "  # y",
                    "",
                    "4,5,6",
                    ",,",
                    "7,8,9",
                ];
                let scan = read(&format!("{mark}{}{end}", lines.join(end))).unwrap();
                assert_eq!(scan.lines, [5, 9, 11], "{end:?}");
                assert_eq!(scan.samples[2].brdf, 9.0);
                assert_eq!(scan.samples[0].theta_i, 1f64.to_radians());
            }
        }
    }

    #[test]
    fn takes_any_delimiter_and_quotes() {
        for text in [
            "theta_i;theta_s;brdf\n45;-85;0.5\n",
            "theta_i\ttheta_s\tbrdf\n45\t-85\t0.5",
            "\"theta_i\",\"theta_s\",\"brdf\"\n\"45\", -85 ,\"5e-1\"\n",
        ] {
            let sample = Sample::in_plane(45f64.to_radians(), (-85f64).to_radians(), 0.5);
            assert_eq!(read(text).unwrap().samples, [sample], "{text}");
        }
    }

    #[test]
    fn takes_azimuths() {
        let scan = read("theta_i,theta_s,delta_phi,brdf\n45,40,180,1\n45,40,-180,1\n45,40,0,1\n45,40,270,1\n").unwrap();
        let azimuths: Vec<f64> = scan.samples.iter().map(|sample| sample.delta_phi).collect();
        assert_eq!(azimuths, [f64::PI, f64::PI, 0.0, (-90f64).to_radians()]);
        let scan = read("theta_i,phi_i,theta_s,phi_s,brdf\n45,90,40,270,1\n").unwrap();
        assert_eq!(scan.samples[0].delta_phi, f64::PI);
    }

    #[test]
    fn drops_only_what_is_asked_for() {
        let text = "theta_i,theta_s,brdf\n45,1,-0.1\n45,2,1\n45,90,1\n45,4,nan\n45,5,0\n";
        let error = read(text).unwrap_err();
        assert_eq!((error.line, error.column), (Some(2), Some(3)));
        assert!(
            error.what.contains("4 rows are not valid, on lines 2, 4, 5, 6"),
            "{error}"
        );
        let scan = parse("scan.csv", text.as_bytes(), Invalid::Drop).unwrap();
        assert_eq!((scan.lines.as_slice(), scan.dropped), ([3].as_slice(), 4));
    }
}
