//! `brdfit batch`: many scans, of which each is fitted once, whatever happens.

mod list;
#[cfg(feature = "parquet")]
mod parquet;
pub(super) mod results;
mod run;
mod summary;

use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::{Mutex, PoisonError};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};

use super::prove::{self, ProofArguments};
use crate::analysis::choose::Wanted;
use crate::analysis::proof::{Goal, provable};
use crate::engine::simd::Simd;
use crate::engine::{FitOptions, Until};
use crate::error::Error;
use crate::input::{ReadOptions, STDIN};
use crate::interrupt;
use crate::options::SearchArguments;
use crate::output;
use crate::records::journal::{self, Journal};
use crate::records::record::{self, Head, Record};
use crate::records::shard::Shard;
use crate::result::cell::Kind;
use crate::streams::{Ended, Streams};
use crate::target::{self, Target};
use results::Form;
use summary::Summary;

/// Fits many scans; keeps what is done when interrupted
#[derive(Args, Debug)]
#[command(
    after_help = "A scan that cannot be fitted has a row that says why, and the exit code is 1.\nAfter Ctrl-C what is finished is kept, and the exit code is 130; --resume goes on.\nWith --shard 2/4, OUT.2-of-4 is written, and `brdfit merge --out OUT` makes one result of all parts.\n\nExample:\n  brdfit batch scans/ --out results.csv\n  brdfit batch 'scans/**/*.csv' @more.txt --method paper --out results.json --resume"
)]
pub struct Arguments {
    /// Scans, folders of scans, patterns in quotes, or @LIST, a file of names (@- is standard input)
    #[arg(required = true, value_name = "DIR|GLOB|@LIST|SCAN")]
    scans: Vec<PathBuf>,
    /// Results: .csv, .json or .parquet; - is standard output
    #[arg(short, long, visible_alias = "output", value_name = "FILE")]
    out: PathBuf,
    /// Form of the results [default: by the ending of --out, csv for -]
    #[arg(long, value_enum)]
    format: Option<Form>,
    /// Goes on from what an interrupted run has kept; does no harm if there is none
    #[arg(long)]
    resume: bool,
    /// Fits only part i of n, to be merged with the others
    #[arg(long, value_name = "i/n")]
    shard: Option<Shard>,
    /// Proves of each scan that no parameters within the bounds have an MSE^2 lower by more than this part, such as 5%, or finds them
    #[arg(long, value_name = "PART", value_parser = prove::part)]
    certify: Option<f64>,
    #[command(flatten)]
    proof: ProofArguments,
    #[command(flatten)]
    search: SearchArguments,
    #[command(flatten)]
    read: ReadOptions,
}

/// Runs the subcommand; the result says how it went.
///
/// # Errors
/// The first thing that is wrong with options or the output, but not with a scan.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<Ended, Error> {
    let out = arguments.out.as_path();
    let to_stdout = out.as_os_str() == STDIN;
    let shard = arguments.shard.unwrap_or(Shard::WHOLE);
    if to_stdout && arguments.shard.is_some() {
        return Err(Error::new("a part of a batch needs a file").help("give --out a name"));
    }
    let form = Form::of(out, arguments.format)?;
    let wanted = arguments.search.wanted()?;
    arguments.proof.refuse_without(arguments.certify)?;
    if arguments.certify.is_some() {
        provable(wanted.candidates())?;
    }
    arguments.read.refuse_together("batch")?;
    let files = list::files(&arguments.scans, out, streams.input)?;
    // Lists of names are inputs too.
    let lists = arguments.scans.iter().map(|scan| list::name(scan).unwrap_or(scan));
    let inputs: Vec<&Path> = files.iter().map(PathBuf::as_path).chain(lists).collect();
    let target = match arguments.shard {
        Some(shard) => Some(Target::new(&record::shard_path(out, shard), &inputs)?),
        None => output::target(Some(out), &inputs)?,
    };
    let models = wanted.models();
    let head = Head {
        brdfit: env!("CARGO_PKG_VERSION").to_string(),
        options: asked_for(&wanted, arguments),
        files: files.len(),
        names: record::names(&files),
        rows: form.rows(),
        columns: run::columns(&models),
        shard,
    };
    let scratch = to_stdout.then(tempfile::tempdir).transpose().map_err(|error| {
        Error::new(format!("there is no room for finished fits: {error}")).help("give --out the name of a file")
    })?;
    let kept_in = match &scratch {
        Some(folder) => folder.path().join("partial"),
        None => record::partial_path(out, shard),
    };
    if target::is_one_of(&kept_in, &inputs) {
        return Err(Error::new("this is a scan, and here finished fits are to be kept")
            .in_file(kept_in.display().to_string())
            .help("give --out another name"));
    }
    if let (Some(target), true, Some(_)) = (&target, arguments.resume, arguments.shard) {
        journal::take_over(target.path(), &kept_in, &head)?;
    }
    let journal = Journal::open(kept_in, &head, arguments.resume)?;
    for line in &journal.damaged {
        // If standard error is closed, the results are right all the same.
        let _ = writeln!(
            streams.errors,
            "{}:{line}: this record is not whole; its fit is made again",
            journal.path.display()
        );
    }
    let journal = Mutex::new(journal);
    let interrupt = interrupt::keeping();
    let interrupted = || interrupt.load(Ordering::Relaxed);
    let goal = arguments.certify.map(|eps| Goal {
        // Scans are side by side already.
        alone: true,
        ..arguments.proof.goal(eps, &interrupted, &|_| ())
    });
    let job = run::Job {
        files: &files,
        wanted: &wanted.until(Until::set(interrupt)),
        columns: run::timeless(&models),
        read: &arguments.read,
        rows: head.rows,
        goal,
        interrupt,
    };
    let places: Vec<usize> = (0..files.len()).filter(|&index| shard.has(index)).collect();
    let bar = progress(streams.progress, places.len());
    let pool = arguments.search.pool()?;
    let done = pool.install(|| run::run(&job, &places, &journal, &|| bar.inc(1)));
    bar.finish_and_clear();
    let (done, mut journal) = (done?, journal.into_inner().unwrap_or_else(PoisonError::into_inner));
    let kept = match scratch {
        Some(_) => "with --out FILE they would have been kept".to_string(),
        None => format!("they are kept in {}, and --resume goes on", journal.path.display()),
    };
    let interrupted = || Ended {
        code: interrupt::EXIT_CODE,
        why: format!("interrupted: {done} of {} files are done; {kept}\n", places.len()),
    };
    if done < places.len() {
        return Ok(interrupted());
    }
    // Hundreds of thousands of rows take longer to write than an interrupt may wait.
    let mut records = places.iter().map(|&index| match interrupt.load(Ordering::Relaxed) {
        true => Err(Error::new("interrupted")),
        false => journal.record(index),
    });
    let ended = match (arguments.shard, &target) {
        (Some(_), Some(target)) => {
            let mut summary = Summary::default();
            let written = target.write_with(|file| part(&head, &mut summary.of(&mut records), file));
            written.map(|()| summary.tell(true, streams))
        }
        _ => deliver(form, &head.columns, &mut records, target.as_ref(), streams),
    };
    let ended = match ended {
        Err(_) if interrupt.load(Ordering::Relaxed) => return Ok(interrupted()),
        ended => ended?,
    };
    journal.remove();
    Ok(ended)
}

/// Writes the results of a whole batch, and tells how it went; the result says how it went.
///
/// # Errors
/// A record is broken, or the output cannot be written.
pub(super) fn deliver(
    form: Form,
    columns: &[(String, Kind)],
    records: &mut dyn Iterator<Item = Result<Record, Error>>,
    target: Option<&Target>,
    streams: &mut Streams,
) -> Result<Ended, Error> {
    let mut summary = Summary::default();
    if let Some(target) = target {
        target.write_with(|file| results::write(form, columns, &mut summary.of(records), file))?;
    } else {
        output::to_stream(streams.output, |stream| {
            let mut scratch = tempfile::tempfile()?;
            results::write(form, columns, &mut summary.of(records), &mut scratch)?;
            scratch.rewind()?;
            io::copy(&mut scratch, stream).map(drop)
        })?;
    }
    Ok(summary.tell(target.is_some(), streams))
}

/// Writes the records of a part, in order.
fn part(head: &Head, records: &mut dyn Iterator<Item = Result<Record, Error>>, file: &mut dyn Write) -> io::Result<()> {
    file.write_all(record::line(head).as_bytes())?;
    for record in records {
        file.write_all(record::line(&record.map_err(io::Error::other)?).as_bytes())?;
    }
    Ok(())
}

/// Everything that changes a result, as text.
fn asked_for(wanted: &Wanted, arguments: &Arguments) -> String {
    // The machines of a cluster differ in their instructions, and give the same bits.
    let portable = |options: &FitOptions| FitOptions {
        simd: Simd::Portable,
        ..*options
    };
    let candidates: Vec<FitOptions> = wanted.candidates().iter().map(portable).collect();
    let proof = arguments.certify.map(|eps| (eps, &arguments.proof));
    format!("{candidates:?}, {:?}, {proof:?}", arguments.read)
}

fn progress(shown: bool, files: usize) -> ProgressBar {
    if !shown {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(files as u64);
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} files, {per_sec}, {eta} left") {
        bar.set_style(style);
    }
    bar
}
