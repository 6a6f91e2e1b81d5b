//! What is kept of a fitted file: one line of JSON with its checksum, in a file that begins with a line that says of which batch it is.

use std::fmt;
use std::io::{self, BufRead, Read};
use std::path::{Path, PathBuf};

use serde::de::{DeserializeOwned, Deserializer, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};

use super::shard::Shard;
use crate::error::Error;
use crate::result::cell::{Cell, Kind};

/// The form of the rows that are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Rows {
    /// Cells, for CSV and Parquet.
    Cells,
    /// JSON objects.
    Objects,
}

/// The first line: what must agree for records to be of one batch.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Head {
    /// Version of the program.
    pub brdfit: String,
    /// Everything asked for that changes a result.
    pub options: String,
    /// Number of files of the whole batch.
    pub files: usize,
    /// [`fingerprint`] of their names in order.
    pub names: u64,
    /// The form of the rows.
    pub rows: Rows,
    /// The columns of the cells: name, and what it holds.
    pub columns: Vec<(String, Kind)>,
    /// Which part this is.
    pub shard: Shard,
}

/// One file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Its place in the batch, from 0.
    pub index: usize,
    /// [`fingerprint`] of its contents.
    pub contents: u64,
    /// Its scans in order; one that says why, if the file cannot be read.
    pub scans: Vec<ScanRecord>,
}

impl Record {
    /// Is there a scan that was not fitted?
    pub fn failed(&self) -> bool {
        self.scans.iter().any(|scan| scan.line.is_err())
    }
}

/// One scan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScanRecord {
    /// Its row of the results.
    pub row: Written,
    /// Its line of Table 3, or why it has none.
    pub line: Result<Line, String>,
}

/// A row of the results in one of the forms of [`Rows`].
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Written {
    /// One cell a column.
    Cells(Vec<Cell>),
    /// A JSON object.
    Object(String),
}

/// As [`Cell`] is read.
impl<'de> Deserialize<'de> for Written {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(OfJson)
    }
}

struct OfJson;

impl<'de> Visitor<'de> for OfJson {
    type Value = Written;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("cells, or a JSON object as text")
    }
    fn visit_str<E>(self, object: &str) -> Result<Written, E> {
        Ok(Written::Object(object.into()))
    }
    fn visit_string<E>(self, object: String) -> Result<Written, E> {
        Ok(Written::Object(object))
    }
    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Written, A::Error> {
        let mut cells = Vec::new();
        while let Some(cell) = list.next_element()? {
            cells.push(cell);
        }
        Ok(Written::Cells(cells))
    }
}

/// Rows as they come.
pub type RowsIn<'a> = &'a mut dyn Iterator<Item = io::Result<Written>>;

/// The cells of a row of a table.
///
/// # Errors
/// It is an object.
pub fn cells(row: Written) -> io::Result<Vec<Cell>> {
    match row {
        Written::Cells(cells) => Ok(cells),
        Written::Object(_) => Err(io::Error::other("a JSON object is not a row of a table")),
    }
}

/// A line of Table 3 of the paper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// The scan's name.
    pub scan: String,
    /// Its model, if there was a choice.
    pub model: Option<String>,
    /// Its angles of incidence in degrees.
    pub theta_i: Vec<f64>,
    /// Number of distinct minima.
    pub minima: usize,
    /// Largest MSE^2 of these.
    pub high: f64,
    /// Least MSE^2.
    pub low: f64,
    /// (high - low) / high, dimensionless.
    pub improvement_potential: f64,
}

/// FNV-1a of bytes: finds a file that was changed; it does not protect against forgery.
pub fn fingerprint(bytes: &[u8]) -> u64 {
    let step = |hash: u64, &byte: &u8| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, step)
}

/// The fingerprint of a list of names.
pub fn names(files: &[PathBuf]) -> u64 {
    let mut hash: u64 = 0;
    for file in files {
        let named = [&hash.to_le_bytes(), file.as_os_str().as_encoded_bytes()].concat();
        hash = fingerprint(&named);
    }
    hash
}

/// A line of a file of records: the fingerprint of its JSON in 16 digits, a space, and the JSON.
pub fn line(value: &impl Serialize) -> String {
    // Only maps with other keys than strings, and failing writers, can make this fail.
    let json = serde_json::to_string(value).unwrap_or_default();
    format!("{:016x} {json}\n", fingerprint(json.as_bytes()))
}

/// What [`line()`] wrote; `None` if any byte of the line, or its end, is not as it was written.
pub fn of_line<T: DeserializeOwned>(line: &[u8]) -> Option<T> {
    let (sum, json) = line.strip_suffix(b"\n")?.split_at_checked(16)?;
    let json = json.strip_prefix(b" ")?;
    let written = format!("{:016x}", fingerprint(json));
    (sum == written.as_bytes()).then(|| serde_json::from_slice(json).ok())?
}

/// The first line of a file of records; `None` if it is another file.
///
/// # Errors
/// The file cannot be read.
pub fn head(file: &mut impl BufRead) -> io::Result<Option<(Head, u64)>> {
    /// No head is nearly as long.
    const LONGEST: u64 = 1 << 20;
    let mut line = Vec::new();
    file.take(LONGEST).read_until(b'\n', &mut line)?;
    Ok(of_line(&line).map(|head| (head, line.len() as u64)))
}

/// Where the finished files of an unfinished run are kept: `results.csv.partial`, or `results.csv.2-of-4.partial`.
pub fn partial_path(out: &Path, shard: Shard) -> PathBuf {
    let base = if shard == Shard::WHOLE {
        out.to_path_buf()
    } else {
        shard_path(out, shard)
    };
    with_suffix(&base, ".partial")
}

/// The result of a part: `results.csv.2-of-4`.
pub fn shard_path(out: &Path, shard: Shard) -> PathBuf {
    with_suffix(out, &format!(".{}-of-{}", shard.number, shard.count))
}

fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(suffix);
    PathBuf::from(name)
}

/// Refuses records of another batch; `file` holds `found`.
///
/// # Errors
/// What differs, but for the number of the part.
pub fn agree(found: &Head, wanted: &Head, file: &Path, help: &str) -> Result<(), Error> {
    let what = if found.brdfit != wanted.brdfit {
        format!("this is by brdfit {}, not {}", found.brdfit, wanted.brdfit)
    } else if (found.files, found.names) != (wanted.files, wanted.names) {
        "this is of other files".to_string()
    } else if (found.rows, &found.columns) != (wanted.rows, &wanted.columns) {
        "this is for results of another form".to_string()
    } else if found.options != wanted.options {
        "this was made with other options".to_string()
    } else if found.shard.count != wanted.shard.count {
        format!(
            "this is one of {} parts, not of {}",
            found.shard.count, wanted.shard.count
        )
    } else {
        return Ok(());
    };
    Err(Error::new(what).in_file(file.display().to_string()).help(help))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Of a batch of one file.
    pub fn head() -> Head {
        Head {
            brdfit: "0".into(),
            options: String::new(),
            files: 1,
            names: 0,
            rows: Rows::Cells,
            columns: Vec::new(),
            shard: Shard::WHOLE,
        }
    }

    #[test]
    fn any_flipped_bit_is_found() {
        let record = Record {
            index: 3,
            contents: 17,
            scans: vec![ScanRecord {
                row: Written::Cells(vec![Cell::Text("a.csv".into()), Cell::Number(0.25)]),
                line: Err("no".into()),
            }],
        };
        let line = line(&record).into_bytes();
        assert_eq!(of_line(&line), Some(record));
        for place in 0..line.len() {
            for bit in 0..8 {
                let mut flipped = line.clone();
                flipped[place] ^= 1 << bit;
                assert_eq!(of_line::<Record>(&flipped), None, "{place} {bit}");
            }
            assert_eq!(of_line::<Record>(&line[..place]), None);
        }
    }
}
