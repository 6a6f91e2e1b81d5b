//! `brdfit certify`: a proof that a fit is the best there is.

use std::path::PathBuf;
use std::sync::atomic::Ordering;

use clap::Args;

use super::claim;
use super::prove::{ProofArguments, ended, part, proving, so_far};
use super::subject::{self, Subject};
use crate::analysis::choose::Wanted;
use crate::analysis::fit::{FittedScan, fit, prove};
use crate::analysis::proof::provable;
use crate::engine::certify::Certificate;
use crate::engine::{self, FitOptions, Until, robust};
use crate::error::Error;
use crate::input::{self, ReadOptions, measurement};
use crate::interrupt;
use crate::options::SearchArguments;
use crate::output::{OutputArguments, TableFormat, deliver};
use crate::result;
use crate::streams::{Ended, Streams};

/// Proves that no parameters within the bounds fit a scan better, or finds those that do
#[derive(Args, Debug)]
#[command(
    after_help = "An interrupt keeps what is proved so far, and the exit code is 130.\nOf results the scans are read and fitted again, with the options given here, and the proof starts from the better of both fits.\n\nExample:\n  brdfit certify paint.csv --within 5%\n  brdfit certify results.json --within 1% --proof-seconds 600 --format json"
)]
pub struct Arguments {
    /// Scans, as `brdfit fit` reads them, or results of `brdfit fit` or `batch` (JSON, CSV); - is standard input
    #[arg(required = true, value_name = "SCAN|RESULTS")]
    scans: Vec<PathBuf>,
    /// The part that no MSE^2 is to be lower by than that of the fit
    #[arg(long, value_name = "PART", default_value = "5%", value_parser = part)]
    within: f64,
    #[command(flatten)]
    proof: ProofArguments,
    /// Adds times to JSON and CSV, which are then not the same in each run
    #[arg(long)]
    time: bool,
    #[command(flatten)]
    search: SearchArguments,
    #[command(flatten)]
    output: OutputArguments<TableFormat>,
    #[command(flatten)]
    read: ReadOptions,
}

/// Runs the subcommand; scans are proved one after the other, each on all threads.
///
/// # Errors
/// The first thing that is wrong with options, files or a fit.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<Ended, Error> {
    let wanted = arguments.search.wanted()?;
    provable(wanted.candidates())?;
    // Results name further files, which are inputs too.
    arguments.output.target(&arguments.scans)?;
    let subjects = subject::read(&arguments.scans, &arguments.read, "certify", streams)?;
    let target = arguments.output.target(&subject::inputs(&arguments.scans, &subjects))?;
    let subjects = subject::settled(subjects, &wanted);
    let pool = arguments.search.pool()?;
    let clock = proving(streams.progress);
    let flag = interrupt::keeping();
    let wanted = wanted.until(Until::set(flag));
    let interrupted = || flag.load(Ordering::Relaxed);
    let mut reports: Vec<FittedScan> = Vec::new();
    for subject in &subjects {
        let label = subject.measurement.label();
        let told = |certificate: &Certificate| clock.set_message(format!("{label}: {}", so_far(certificate)));
        let goal = arguments.proof.goal(arguments.within, &interrupted, &told);
        let one = || prove(&subject.measurement, known(subject, &wanted)?, &goal);
        match pool.install(one) {
            Ok(report) => reports.push(report),
            Err(_) if interrupted() => break,
            Err(error) => return Err(error),
        }
    }
    clock.finish_and_clear();
    let ended = ended(&reports, subjects.len());
    if reports.is_empty() {
        return Ok(ended);
    }
    if arguments.output.format != TableFormat::Text && !arguments.time {
        reports.iter_mut().for_each(FittedScan::forget_times);
    }
    let text = match arguments.output.format {
        TableFormat::Text => result::text(&reports, false),
        TableFormat::Json => result::json(&reports),
        TableFormat::Csv => result::csv(&reports, false),
    };
    deliver(text.as_bytes(), target.as_ref(), streams.output)?;
    for subject in &subjects {
        measurement::note(std::slice::from_ref(&subject.measurement), streams.errors);
    }
    Ok(ended)
}

/// The fit of a scan, or that from the parameters of its results, if they lead lower.
fn known(subject: &Subject, wanted: &Wanted) -> Result<FittedScan, Error> {
    let Subject { measurement, stored } = subject;
    let fitted = fit(measurement, wanted)?;
    let Some(stored) = stored else {
        return Ok(fitted);
    };
    let label = measurement.label();
    let Ok(material) = &stored.material else {
        return Ok(fitted);
    };
    claim::same(stored, measurement, &fitted).map_err(|error| error.in_file(&label))?;
    let explain = |error| input::explain(measurement, error);
    let kept = robust::kept(&measurement.samples, &fitted.outcome);
    let options = FitOptions {
        robust: false,
        ..fitted.options
    };
    let end = engine::descend(&kept, &options, &[material.values]).map_err(explain)?;
    match end {
        Some((cost, values)) if cost < fitted.outcome.cost * (1.0 - 1e-9) => {
            fitted.improved(measurement, &kept, values).map_err(explain)
        }
        _ => Ok(fitted),
    }
}
