//! `brdfit compare`: which model a scan needs.

use std::path::PathBuf;

use clap::Args;

use crate::analysis::choose::{Wanted, choose};
use crate::analysis::deviations;
use crate::engine::{FitOptions, Model};
use crate::error::Error;
use crate::input::{self, ReadOptions, measurement};
use crate::output::{Format, OutputArguments, deliver};
use crate::parameters::models;
use crate::plot::picture;
use crate::result::compare::{json, svg, text};
use crate::streams::Streams;
use crate::until::until;

/// Fits several models to a scan, and tells which it needs: the one that `brdfit fit --model auto` takes
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  brdfit compare paint.csv --models beckmann,ggx,beckmann-second --plot paint.svg")]
pub struct Arguments {
    /// A scan, as `brdfit fit` reads it; - is standard input
    #[arg(value_name = "SCAN")]
    scan: PathBuf,
    /// Models to compare, with commas between, or auto for all
    #[arg(long, value_name = "LIST", default_value = "auto")]
    models: String,
    /// Seed of the starts
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    output: OutputArguments,
    /// Draws every model's best fit over the data, as SVG, or as PNG if brdfit is built with it
    #[arg(long, value_name = "FILE", value_parser = picture::name)]
    plot: Option<PathBuf>,
    #[command(flatten)]
    read: ReadOptions,
}

/// Runs the subcommand.
///
/// # Errors
/// An unknown model, a scan that cannot be read or fitted, or an output that cannot be written.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    let models = models(&arguments.models)?;
    let inputs = std::slice::from_ref(&arguments.scan);
    let (target, plot) = arguments.output.targets(arguments.plot.as_deref(), inputs)?;
    let measurement = input::read_one(&arguments.scan, &arguments.read, streams.input)?;
    let options = |model: &'static Model| FitOptions {
        seed: arguments.seed,
        until: until(),
        ..FitOptions::of(model)
    };
    let candidates: Vec<FitOptions> = models.into_iter().map(options).collect();
    let measurement = deviations::settled(measurement, &Wanted::Best(candidates.clone()));
    let fitted = choose(&measurement.samples, &candidates);
    let choice = fitted.map_err(|error| input::explain(&measurement, error))?;
    let text = match arguments.output.format {
        Format::Text => text(&measurement, &choice),
        Format::Json => json(&measurement, &choice),
    };
    if let Some(plot) = &plot {
        picture::save(plot, &svg(&measurement, &choice))?;
    }
    deliver(text.as_bytes(), target.as_ref(), streams.output)?;
    measurement::note(&[measurement], streams.errors);
    Ok(())
}
