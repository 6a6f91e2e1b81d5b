//! `brdfit fit`: files in, reports out.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

use crate::cli::Streams;
use crate::engine::{self, FitError, FitOptions, Method};
use crate::error::Error;
use crate::input::{self, Invalid, Measurement, STDIN};
use crate::options::SearchArguments;
use crate::output::{deliver, replace_file};
use crate::plot;
use crate::report::{self, Report};

/// Fits the model to scans
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  brdfit fit paint.csv --terms diffuse,surface --fix n=1.5 --format json")]
pub struct Arguments {
    /// CSV files with the columns theta_i_deg,theta_s_deg,brdf_per_sr[,delta_phi_deg]; - is standard input
    #[arg(required = true, value_name = "SCAN")]
    scans: Vec<PathBuf>,
    #[command(flatten)]
    search: SearchArguments,
    /// Form of the result
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Prints the distinct minima too (JSON always has them)
    #[arg(long)]
    minima: bool,
    /// Leaves out rows without a valid BRDF or angle, and says how many
    #[arg(long)]
    drop_invalid: bool,
    /// Writes the result to a file
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Draws the scan with its distinct minima, as SVG; for one scan
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Format {
    Text,
    Json,
    Csv,
}

/// Runs the subcommand; nothing is written before every scan is read and fitted.
///
/// # Errors
/// The first thing that is wrong with options, files or the fit.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    let options = arguments.search.fit_options()?;
    if arguments.plot.is_some() && arguments.scans.len() > 1 {
        return Err(Error::new("--plot draws one scan").help("give one scan, or call brdfit once for each"));
    }
    let measurements = read(arguments, streams)?;
    let pool = arguments.search.pool()?;
    let bar = progress(streams.progress, &options, measurements.len());
    let results: Vec<Result<Report, Error>> = pool.install(|| {
        let each = measurements.par_iter();
        each.map(|measurement| {
            let report = fit(measurement, &options);
            bar.inc(1);
            report
        })
        .collect()
    });
    bar.finish_and_clear();
    let reports: Vec<Report> = results.into_iter().collect::<Result<_, _>>()?;
    let text = match arguments.format {
        Format::Text => report::text(&reports, arguments.minima),
        Format::Json => report::json(&reports),
        Format::Csv => report::csv(&reports, arguments.minima),
    };
    if let (Some(path), [measurement], [report]) = (&arguments.plot, &measurements[..], &reports[..]) {
        let curves: Vec<_> = report.outcome.minima.iter().map(|minimum| minimum.params).collect();
        replace_file(
            path,
            plot::scan_svg(&measurement.file, &measurement.samples, &curves).as_bytes(),
        )?;
    }
    deliver(text.as_bytes(), arguments.output.as_deref(), streams.output)?;
    for measurement in measurements.iter().filter(|measurement| measurement.dropped > 0) {
        let (file, dropped, kept) = (&measurement.file, measurement.dropped, measurement.samples.len());
        let rows = if dropped == 1 { "row" } else { "rows" };
        let _ = writeln!(
            streams.errors,
            "{file}: left out {dropped} {rows} that are not valid, kept {kept}"
        );
    }
    Ok(())
}

/// Reads every scan, before anything is computed.
fn read(arguments: &Arguments, streams: &mut Streams) -> Result<Vec<Measurement>, Error> {
    let invalid = if arguments.drop_invalid {
        Invalid::Drop
    } else {
        Invalid::Refuse
    };
    if arguments.scans.iter().filter(|path| path.as_os_str() == STDIN).count() > 1 {
        return Err(Error::new("standard input can be read only once").help("give - once"));
    }
    let one = |path: &PathBuf| {
        let bytes = if path.as_os_str() == STDIN {
            input::read_stdin(streams.input)?
        } else {
            input::read_file(path)?
        };
        input::parse(&path.display().to_string(), &bytes, invalid)
    };
    arguments.scans.iter().map(one).collect()
}

/// Fits one scan.
fn fit(measurement: &Measurement, options: &FitOptions) -> Result<Report, Error> {
    let begun = Instant::now();
    let outcome = engine::fit(&measurement.samples, options);
    let elapsed = begun.elapsed();
    match outcome {
        Ok(outcome) if !outcome.cost.is_finite() => Err(Error::new("no start gives a finite model")
            .in_file(&measurement.file)
            .help("take less extreme --bounds or --precision f64")),
        Ok(outcome) => Ok(Report::new(measurement, options, outcome, elapsed)),
        Err(error) => Err(explain(measurement, error)),
    }
}

/// Names the line instead of the sample, and what to do.
pub(crate) fn explain(measurement: &Measurement, error: FitError) -> Error {
    let plain = |what: String| Error::new(what).in_file(&measurement.file);
    match error {
        // A scan that was read is valid in f64; only rounding to f32 can move a sample out of range.
        FitError::Sample(index, error) => plain(error.to_string())
            .at_line(measurement.lines[index])
            .help("take --precision f64, or leave out the row"),
        FitError::TooFew(..) => plain(error.to_string()).help("measure more, or leave out terms with --terms"),
        FitError::Terms(_) => plain(error.to_string()),
    }
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
