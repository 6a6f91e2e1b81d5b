//! `brdfit merge`: the parts of a batch become one result, if nothing is missing and nothing doubled.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use clap::Args;

use super::batch::results::Form;
use crate::error::Error;
use crate::output;
use crate::records::own;
use crate::records::record::{self, Head, Record};
use crate::records::shard::Shard;
use crate::streams::{Ended, Streams};

/// Makes one result of the parts of a batch
#[derive(Args, Debug)]
#[command(
    after_help = "Nothing is written if a part or a file is missing or doubled, or if parts are of different batches.\nThe result has the bits of a batch that was not cut in parts.\n\nExample:\n  brdfit merge --out results.csv"
)]
pub struct Arguments {
    /// The parts [default: those beside --out, such as results.csv.2-of-4]
    #[arg(value_name = "PART")]
    parts: Vec<PathBuf>,
    /// Results: .csv, .json or .parquet; - is standard output
    #[arg(short, long, visible_alias = "output", value_name = "FILE")]
    out: PathBuf,
    /// Form of the results [default: by the ending of --out, csv for -]
    #[arg(long, value_enum)]
    format: Option<Form>,
}

/// Runs the subcommand; the result says how the batch went.
///
/// # Errors
/// The parts are not those of one whole batch, or the result cannot be written.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<Ended, Error> {
    let out = arguments.out.as_path();
    let form = Form::of(out, arguments.format)?;
    let paths = if arguments.parts.is_empty() {
        beside(out)?
    } else {
        arguments.parts.clone()
    };
    let target = output::target(Some(out), &paths)?;
    let mut parts = paths
        .into_iter()
        .map(Part::open)
        .collect::<Result<Vec<Part>, Error>>()?;
    parts.sort_by_key(|part| part.head.shard.number);
    let head = whole(&parts, out)?;
    if form.rows() != head.rows {
        return Err(parts[0]
            .error("this is for results of another form")
            .help("let --out end as that of the parts"));
    }
    let mut records = (0..=head.files).filter_map(|index| {
        if index < head.files {
            let count = parts.len();
            return Some(parts[index % count].record(index));
        }
        parts.iter_mut().find_map(|part| part.end().err()).map(Err)
    });
    super::batch::deliver(form, &head.columns, &mut records, target.as_ref(), streams)
}

/// The parts that lie beside the result.
fn beside(out: &Path) -> Result<Vec<PathBuf>, Error> {
    let folder = out
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    let none = || {
        Error::new(format!("there are no parts of {}", out.display()))
            .help("name them, or the --out that the batch had")
    };
    let base = out.file_name().ok_or_else(none)?.to_string_lossy().into_owned();
    let is_part = |path: &PathBuf| {
        let name = path
            .file_name()
            .map(|name| name.to_string_lossy().into_owned())
            .unwrap_or_default();
        name.strip_prefix(&base).is_some_and(own::is_part)
    };
    let unlisted = |error: std::io::Error| {
        Error::file(format!("cannot be listed: {error}"))
            .in_file(folder.display().to_string())
            .help("name the parts, or the --out that the batch had")
    };
    let entries = folder.read_dir().map_err(unlisted)?;
    let paths = entries.map(|entry| Ok(entry.map_err(unlisted)?.path()));
    let mut parts = paths.collect::<Result<Vec<PathBuf>, Error>>()?;
    parts.retain(is_part);
    parts.sort();
    if parts.is_empty() { Err(none()) } else { Ok(parts) }
}

/// Checks that sorted parts are all those of one batch; the result is their common head.
fn whole(parts: &[Part], out: &Path) -> Result<Head, Error> {
    let first = &parts[0];
    let count = first.head.shard.count;
    for part in parts {
        record::agree(
            &part.head,
            &first.head,
            &part.path,
            &format!("{} is of another batch; merge the parts of one", first.path.display()),
        )?;
    }
    for pair in parts.windows(2) {
        if pair[0].head.shard == pair[1].head.shard {
            return Err(pair[1]
                .error(&format!(
                    "this is part {}, and so is {}",
                    pair[1].head.shard,
                    pair[0].path.display()
                ))
                .help("merge each part once"));
        }
    }
    if let Some(number) = (1..=count).find(|&number| parts.iter().all(|part| part.head.shard.number != number)) {
        let shard = Shard { number, count };
        let partial = record::partial_path(out, shard);
        let help = if partial.exists() {
            format!("it is unfinished: run --shard {shard} again with --resume")
        } else {
            format!("run --shard {shard}, or name its file")
        };
        return Err(Error::new(format!("part {shard} is missing")).help(help));
    }
    Ok(first.head.clone())
}

/// An open part.
struct Part {
    path: PathBuf,
    head: Head,
    lines: BufReader<File>,
}

impl Part {
    fn open(path: PathBuf) -> Result<Part, Error> {
        let fail = |what: String| {
            Error::new(what)
                .in_file(path.display().to_string())
                .help("give the parts that brdfit batch --shard wrote")
        };
        let read = |error: std::io::Error| fail(format!("cannot be read: {error}"));
        let mut lines = BufReader::new(File::open(&path).map_err(read)?);
        let head = record::head(&mut lines).map_err(read)?;
        let (head, _) = head.ok_or_else(|| fail("this is not a part of a batch".into()))?;
        Ok(Part { path, head, lines })
    }

    /// The next record, which must be that of file `index`.
    fn record(&mut self, index: usize) -> Result<Record, Error> {
        let mut line = Vec::new();
        let read = self.lines.read_until(b'\n', &mut line);
        read.map_err(|error| self.error(&format!("cannot be read: {error}")))?;
        let again = |error: Error| error.help(format!("run --shard {} again", self.head.shard));
        let cut = || {
            again(self.error(&format!(
                "file {} of the batch is missing: the part is cut off",
                index + 1
            )))
        };
        if !line.ends_with(b"\n") {
            return Err(cut());
        }
        let record: Record = record::of_line(&line).ok_or_else(|| {
            self.error(&format!("the record of file {} is broken", index + 1))
                .help(format!(
                    "run --shard {} again with --resume, which fits only what is broken",
                    self.head.shard
                ))
        })?;
        if record.index == index {
            return Ok(record);
        }
        let (place, state) = if record.index < index {
            (record.index, "doubled")
        } else {
            (index, "missing")
        };
        Err(again(
            self.error(&format!("file {} of the batch is {state}", place + 1)),
        ))
    }

    /// Checks that there are no more records.
    fn end(&mut self) -> Result<(), Error> {
        match self.lines.fill_buf() {
            Ok([]) => Ok(()),
            _ => Err(self
                .error("there are more files than the batch has")
                .help(format!("run --shard {} again", self.head.shard))),
        }
    }

    fn error(&self, what: &str) -> Error {
        Error::new(what).in_file(self.path.display().to_string())
    }
}
