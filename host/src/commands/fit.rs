//! `brdfit fit`: files in, reports out.

use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Duration;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};

use super::prove::{ProofArguments, ended, part, proving, so_far};
use crate::analysis::choose::{Wanted, left_out_by_auto};
use crate::analysis::deviations;
use crate::analysis::fit::{FittedScan, fit, prove};
use crate::analysis::proof::provable;
use crate::engine::certify::Certificate;
use crate::engine::threads;
use crate::engine::{FitOptions, Material, Method, Until, robust};
use crate::error::Error;
use crate::input::{self, Measurement, ReadOptions, measurement};
use crate::interrupt;
use crate::options::SearchArguments;
use crate::output::{OutputArguments, TableFormat, deliver};
use crate::plot::{self, picture};
use crate::result;
use crate::streams::{Ended, Streams};
use crate::until::until;

/// Fits the model to scans
#[derive(Args, Debug)]
#[command(
    after_help = "Example:\n  brdfit fit paint.csv --terms diffuse,surface --fix n=1.5 --format json\n  brdfit fit paint.astm --column R --robust --drop-invalid --mask-retro 6 --max-angle 85"
)]
pub struct Arguments {
    /// Files with scans, such as CSV with the columns theta_i_deg,theta_s_deg,brdf_per_sr; - is standard input
    #[arg(required = true, value_name = "SCAN")]
    scans: Vec<PathBuf>,
    #[command(flatten)]
    search: SearchArguments,
    #[command(flatten)]
    output: OutputArguments<TableFormat>,
    /// Prints the distinct minima too (JSON always has them)
    #[arg(long)]
    minima: bool,
    /// Adds the times of searches and proofs to JSON, and of searches to CSV, which are then not the same in each run
    #[arg(long)]
    time: bool,
    /// Draws the scan with its distinct minima, as SVG, or as PNG if brdfit is built with it; for one scan
    #[arg(long, value_name = "FILE", value_parser = picture::name)]
    plot: Option<PathBuf>,
    /// Proves that no parameters within the bounds have an MSE^2 lower by more than this part, such as 5%, or finds them; an interrupt keeps what is proved so far
    #[arg(long, value_name = "PART", value_parser = part)]
    certify: Option<f64>,
    #[command(flatten)]
    proof: ProofArguments,
    #[command(flatten)]
    read: ReadOptions,
}

/// Runs the subcommand; nothing is written before every scan is read and fitted, or an interrupt leaves those that are.
///
/// # Errors
/// The first thing that is wrong with options, files or the fit.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<Ended, Error> {
    let wanted = arguments.search.wanted()?;
    arguments.proof.refuse_without(arguments.certify)?;
    let (target, picture) = arguments.output.targets(arguments.plot.as_deref(), &arguments.scans)?;
    let measurements = input::read(&arguments.scans, &arguments.read, streams.input)?;
    if arguments.plot.is_some() && measurements.len() > 1 {
        return Err(Error::new("--plot draws one scan").help("give one scan, or call brdfit once for each"));
    }
    if arguments.certify.is_some() {
        provable(wanted.candidates())?;
    }
    let pool = arguments.search.pool()?;
    let bar = progress(streams.progress, &wanted, measurements.len());
    // Of one scan nothing is finished before all is, but for its proof.
    let settled = |measurement| deviations::settled(measurement, &wanted);
    let measurements = pool.install(|| threads::into(measurements, &settled));
    let keeps = measurements.len() > 1 || arguments.certify.is_some();
    let interrupt = keeps.then(interrupt::keeping);
    let interrupted = || interrupt.is_some_and(|flag| flag.load(Ordering::Relaxed));
    let wanted = wanted.until(interrupt.map_or_else(until, Until::set));
    let one = |measurement: &Measurement| {
        if interrupted() {
            return None;
        }
        let report = fit(measurement, &wanted);
        bar.inc(1);
        Some(report).filter(|report| report.is_ok() || !interrupted())
    };
    let results = pool.install(|| threads::map(&measurements, &one));
    bar.finish_and_clear();
    let each = measurements.iter().zip(results);
    let fitted = each.filter_map(|(measurement, result)| Some((measurement, result?)));
    let clock = proving(streams.progress && arguments.certify.is_some());
    // One proof after the other, each on all threads: so a limit of time is one of each.
    let finish = |(measurement, result): (&Measurement, Result<FittedScan, Error>)| {
        let Some(eps) = arguments.certify else {
            return result;
        };
        let label = measurement.label();
        let told = |certificate: &Certificate| clock.set_message(format!("{label}: {}", so_far(certificate)));
        let goal = arguments.proof.goal(eps, &interrupted, &told);
        pool.install(|| prove(measurement, result?, &goal))
    };
    let mut reports: Vec<FittedScan> = fitted.map(finish).collect::<Result<_, _>>()?;
    clock.finish_and_clear();
    if arguments.output.format != TableFormat::Text && !arguments.time {
        reports.iter_mut().for_each(FittedScan::forget_times);
    }
    if arguments.output.format == TableFormat::Text {
        let by_auto = |place: usize| {
            let report = &reports[place];
            let plain = report.choice.is_none() && report.options.method == Method::Default;
            let kept = || robust::kept(&measurements[place].samples, &report.outcome);
            plain.then(|| left_out_by_auto(&kept(), &report.options))
        };
        if reports.len() == measurements.len() {
            let left_out = pool.install(|| threads::each(reports.len(), &by_auto));
            for (report, terms) in reports.iter_mut().zip(left_out) {
                report.left_out_by_auto = terms.unwrap_or_default();
            }
        }
    }
    let ended = ended(&reports, measurements.len());
    if reports.is_empty() {
        return Ok(ended);
    }
    let text = match arguments.output.format {
        TableFormat::Text => result::text(&reports, arguments.minima),
        TableFormat::Json => result::json(&reports),
        TableFormat::Csv => result::csv(&reports, arguments.minima),
    };
    if let (Some(picture), [measurement], [report]) = (&picture, &measurements[..], &reports[..]) {
        let material = |values| Material {
            values,
            ..report.outcome.material()
        };
        let minima = report.outcome.minima.iter();
        let curves: Vec<_> = minima.map(|minimum| material(minimum.params)).collect();
        picture::save(
            picture,
            &plot::scan_svg(
                &measurement.label(),
                &plot::Drawn::of_fit(measurement, &report.outcome).data(),
                &curves,
            ),
        )?;
    }
    deliver(text.as_bytes(), target.as_ref(), streams.output)?;
    measurement::note(&measurements, streams.errors);
    Ok(ended)
}

/// A bar over the scans if there are several, a clock if one takes long.
fn progress(shown: bool, wanted: &Wanted, scans: usize) -> ProgressBar {
    let candidates = wanted.candidates();
    let long = candidates.iter().any(|options| options.method == Method::Paper);
    if !shown || (scans == 1 && !long) {
        return ProgressBar::hidden();
    }
    if scans == 1 {
        let starts: u32 = candidates.iter().map(FitOptions::starts).sum();
        let clock = ProgressBar::new_spinner().with_message(format!("{starts} starts"));
        clock.enable_steady_tick(Duration::from_millis(100));
        return clock;
    }
    let bar = ProgressBar::new(scans as u64);
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} scans, {eta} left") {
        bar.set_style(style);
    }
    bar
}
