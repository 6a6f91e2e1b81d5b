//! `brdfit converge`: how fast each method comes how near to the best known fit of a scan.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use indicatif::ProgressBar;

use crate::analysis::converge::{METHODS, study};
use crate::analysis::paper_sets::{Subject, paper_scans};
use crate::engine::FitOptions;
use crate::error::Error;
use crate::input::{self, ReadOptions, measurement};
use crate::options::all_parameters;
use crate::output::{OutputArguments, TableFormat, deliver};
use crate::parameters::model;
use crate::plot::picture;
use crate::result::converge as write;
use crate::result::json::provenance::provenance;
use crate::streams::Streams;
use crate::terms::terms_of;

/// Shows error against run time and passes of both methods, in f64 and f32, over many seeds
#[derive(Args, Debug)]
#[command(
    after_help = "A pass with derivatives counts as one, a pass without them as half.\nEach search runs three times on one thread, and the fastest counts.\n\nExample:\n  brdfit converge paint.csv --seeds 50 --plot paint.svg"
)]
pub struct Arguments {
    /// A scan, as `brdfit fit` reads it; - is standard input
    #[arg(value_name = "SCAN", required_unless_present = "paper", conflicts_with = "paper")]
    scan: Option<PathBuf>,
    /// Takes the paper's three synthetic sets, which are built in
    #[arg(long)]
    paper: bool,
    /// All parameters that the scan was made with: adds the errors of rho_d, m and the curve
    #[arg(long, value_name = "NAME=X,...", conflicts_with = "paper")]
    truth: Option<String>,
    /// Number of searches by each method, with seeds from 0
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    seeds: u32,
    /// The model, one of those that brdfit compare shows
    #[arg(long, value_name = "NAME", default_value = "beckmann", conflicts_with = "paper")]
    model: String,
    /// Terms of the model, of diffuse,surface,volume,absorbing
    #[arg(long, value_name = "LIST", default_value = "all")]
    terms: String,
    #[command(flatten)]
    output: OutputArguments<TableFormat>,
    /// Draws the excess cost over the run time, as SVG, or as PNG if brdfit is built with it
    #[arg(long, value_name = "FILE", value_parser = picture::name)]
    plot: Option<PathBuf>,
    #[command(flatten)]
    read: ReadOptions,
}

/// Runs the subcommand, on one thread.
///
/// # Errors
/// The first thing that is wrong with options, file or scan.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    let model = model(&arguments.model)?;
    let options = FitOptions {
        terms: terms_of(&[model], &arguments.terms)?,
        ..FitOptions::of(model)
    };
    let truth = arguments.truth.as_deref();
    let truth = truth.map(|list| all_parameters(model, list, "--truth")).transpose()?;
    let (target, picture) = arguments
        .output
        .targets(arguments.plot.as_deref(), arguments.scan.as_slice())?;
    let measurement = match &arguments.scan {
        Some(path) => Some(input::read_one(path, &arguments.read, streams.input)?),
        None => None,
    };
    let scans: Vec<Subject> = match &measurement {
        Some(measurement) => vec![Subject {
            name: measurement.label(),
            samples: measurement.samples.clone(),
            truth,
        }],
        None => paper_scans(),
    };
    let bar = progress(streams.progress, scans.len(), arguments.seeds);
    let mut studies = Vec::new();
    for Subject { name, samples, truth } in &scans {
        let study = study(name, samples, truth.as_ref(), &options, arguments.seeds, || bar.inc(1));
        let study = study.map_err(|error| match &measurement {
            Some(measurement) => input::explain(measurement, error),
            None => Error::new(error.to_string()).in_file(name),
        })?;
        if !study.best_mse2.is_finite() {
            return Err(Error::new("no start gives a finite model").in_file(name));
        }
        studies.push(study);
    }
    bar.finish_and_clear();
    let text = match arguments.output.format {
        TableFormat::Text => write::text(&studies, arguments.seeds),
        TableFormat::Json => {
            let read = measurement.as_ref().map(|read| provenance(&read.about, Some(&options)));
            write::json(&studies, arguments.seeds, read)
        }
        TableFormat::Csv => write::csv(&studies),
    };
    if let Some(picture) = &picture {
        picture::save(picture, &write::svg(&studies, arguments.seeds))?;
    }
    deliver(text.as_bytes(), target.as_ref(), streams.output)?;
    measurement::note(measurement.as_slice(), streams.errors);
    Ok(())
}

fn progress(shown: bool, scans: usize, seeds: u32) -> ProgressBar {
    if !shown {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(scans as u64 * u64::from(seeds) * METHODS.len() as u64);
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
