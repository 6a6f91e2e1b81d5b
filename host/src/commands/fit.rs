//! `brdfit fit`: files in, reports out.

use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Duration;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

use crate::analysis::fit::{FittedScan, fit};
use crate::engine::{FitOptions, Material, Method, Until};
use crate::error::Error;
use crate::input::{self, ReadOptions, left_out};
use crate::interrupt;
use crate::options::SearchArguments;
use crate::output::{OutputArguments, TableFormat, deliver};
use crate::plot::{self, picture};
use crate::result;
use crate::streams::{Ended, Streams};

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
    /// Adds the time of each search to JSON and CSV, which are then not the same in each run
    #[arg(long)]
    time: bool,
    /// Draws the scan with its distinct minima, as SVG, or as PNG if brdfit is built with it; for one scan
    #[arg(long, value_name = "FILE", value_parser = picture::name)]
    plot: Option<PathBuf>,
    #[command(flatten)]
    read: ReadOptions,
}

/// Runs the subcommand; nothing is written before every scan is read and fitted, or an interrupt leaves those that are.
///
/// # Errors
/// The first thing that is wrong with options, files or the fit.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<Ended, Error> {
    let options = arguments.search.fit_options()?;
    let (target, picture) = arguments.output.targets(arguments.plot.as_deref(), &arguments.scans)?;
    let measurements = input::read(&arguments.scans, &arguments.read, streams.input)?;
    if arguments.plot.is_some() && measurements.len() > 1 {
        return Err(Error::new("--plot draws one scan").help("give one scan, or call brdfit once for each"));
    }
    let pool = arguments.search.pool()?;
    let bar = progress(streams.progress, &options, measurements.len());
    // Of one scan nothing is finished before all is.
    let several = measurements.len() > 1;
    let interrupt = several.then(interrupt::keeping);
    let interrupted = || interrupt.is_some_and(|flag| flag.load(Ordering::Relaxed));
    let options = FitOptions {
        until: interrupt.map_or_else(Until::default, Until::set),
        ..options
    };
    let results: Vec<Option<Result<FittedScan, Error>>> = pool.install(|| {
        let each = measurements.par_iter();
        each.map(|measurement| {
            if interrupted() {
                return None;
            }
            let report = fit(measurement, &options);
            bar.inc(1);
            Some(report).filter(|report| report.is_ok() || !interrupted())
        })
        .collect()
    });
    bar.finish_and_clear();
    let mut reports: Vec<FittedScan> = results.into_iter().flatten().collect::<Result<_, _>>()?;
    if arguments.output.format != TableFormat::Text && !arguments.time {
        reports.iter_mut().for_each(|report| report.elapsed = None);
    }
    let missing = measurements.len() - reports.len();
    let ended = match missing {
        0 => Ended::default(),
        _ => Ended {
            code: interrupt::EXIT_CODE,
            why: format!(
                "interrupted: {} of {} scans are fitted and written\n",
                reports.len(),
                measurements.len()
            ),
        },
    };
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
    left_out::note(&measurements, streams.errors);
    Ok(ended)
}

/// A bar over the scans if there are several, a clock if one takes long.
fn progress(shown: bool, options: &FitOptions, scans: usize) -> ProgressBar {
    let long = options.method == Method::Paper;
    if !shown || (scans == 1 && !long) {
        return ProgressBar::hidden();
    }
    if scans == 1 {
        let clock = ProgressBar::new_spinner().with_message(format!("{} starts", options.starts()));
        clock.enable_steady_tick(Duration::from_millis(100));
        return clock;
    }
    let bar = ProgressBar::new(scans as u64);
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} scans, {eta} left") {
        bar.set_style(style);
    }
    bar
}
