//! `brdfit compare`: which model a scan needs.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use crate::analysis::choose::{Criteria, criteria};
use crate::engine::models::MODELS;
use crate::engine::{self, FitOptions, Model, Outcome};
use crate::error::Error;
use crate::input::{self, Measurement, ReadOptions, left_out};
use crate::number::four;
use crate::output::{self, Format, OutputArguments, deliver};
use crate::parameters;
use crate::plot::{self, picture};
use crate::result::json::ByName;
use crate::result::json::provenance::provenance;
use crate::streams::Streams;

/// Fits models of other lobes beside that of the paper, and tells which the scan needs
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  brdfit compare paint.csv --models beckmann,ggx,beckmann-second --plot paint.svg")]
pub struct Arguments {
    /// A scan, as `brdfit fit` reads it; - is standard input
    #[arg(value_name = "SCAN")]
    scan: PathBuf,
    /// Models to compare, with commas between [default: all]
    #[arg(long, value_name = "LIST")]
    models: Option<String>,
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
    let models = models(arguments.models.as_deref())?;
    let inputs = std::slice::from_ref(&arguments.scan);
    let (target, plot) = arguments.output.targets(arguments.plot.as_deref(), inputs)?;
    let measurement = input::read_one(&arguments.scan, &arguments.read, streams.input)?;
    let fits = compare(&models, &measurement, arguments.seed)?;
    let text = match arguments.output.format {
        Format::Text => text(&measurement, &fits),
        Format::Json => json(&measurement, &fits),
    };
    if let Some(plot) = &plot {
        picture::save(plot, &picture(&measurement, &fits))?;
    }
    deliver(text.as_bytes(), target.as_ref(), streams.output)?;
    left_out::note(&[measurement], streams.errors);
    Ok(())
}

/// The models of a list, or all.
pub fn models(list: Option<&str>) -> Result<Vec<&'static Model>, Error> {
    match list {
        None => Ok(MODELS.iter().collect()),
        Some(list) => list.split(',').map(parameters::model).collect(),
    }
}

/// A model's fit.
struct Judged {
    outcome: Outcome,
    criteria: Criteria,
}

/// Fits each model, on all threads.
fn compare(models: &[&'static Model], measurement: &Measurement, seed: u64) -> Result<Vec<Judged>, Error> {
    use rayon::prelude::*;
    let samples = &measurement.samples;
    let fits: Vec<_> = models
        .par_iter()
        .map(|model| {
            let options = FitOptions {
                seed,
                ..FitOptions::of(model)
            };
            let outcome = engine::fit(samples, &options)?;
            let criteria = criteria(samples, &options, outcome.cost);
            Ok(Judged { outcome, criteria })
        })
        .collect();
    let each = fits.into_iter();
    each.map(|fit| fit.map_err(|error| input::explain(measurement, error)))
        .collect()
}

fn least_aicc(fits: &[Judged]) -> f64 {
    fits.iter().map(|fit| fit.criteria.aicc).fold(f64::INFINITY, f64::min)
}

fn text(measurement: &Measurement, fits: &[Judged]) -> String {
    let least = least_aicc(fits);
    let mut lines = vec![
        format!("{}: {} samples", measurement.label(), measurement.samples.len()),
        "  model                   P        MSE^2  rms ln    AICc  minima  parameters".to_string(),
    ];
    for Judged { outcome, criteria } in fits {
        let values = outcome.model.named(&outcome.params);
        let values: Vec<_> = values.map(|(name, value)| format!("{name} {}", four(value))).collect();
        let mark = if criteria.aicc == least { '*' } else { ' ' };
        lines.push(format!(
            "{mark} {:<22} {:>2} {:>12.4e} {:>7.4} {:>7.1} {:>7}  {}",
            outcome.model.name,
            criteria.parameters,
            outcome.mse2,
            outcome.rms_ln,
            criteria.aicc - least,
            outcome.minima.len(),
            values.join(", "),
        ));
    }
    lines.push("  AICc is above the least, which * has; a difference of 10 leaves no doubt.".to_string());
    lines.join("\n") + "\n"
}

fn json(measurement: &Measurement, fits: &[Judged]) -> String {
    let models: Vec<_> = fits
        .iter()
        .map(|Judged { outcome, criteria }| {
            json!({
                "model": outcome.model.name,
                "mse2": outcome.mse2,
                "rms_ln": outcome.rms_ln,
                "aicc": criteria.aicc,
                "bic": criteria.bic,
                "minima": outcome.minima.len(),
                "parameters": ByName::new(outcome.model, |place| outcome.params[place]),
            })
        })
        .collect();
    let value = json!({ "scan": measurement.label(), "samples": measurement.samples.len(), "models": models, "provenance": provenance(&measurement.about, None) });
    output::json(&value)
}

fn picture(measurement: &Measurement, fits: &[Judged]) -> String {
    let mut best_first: Vec<&Outcome> = fits.iter().map(|fit| &fit.outcome).collect();
    best_first.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let lines: Vec<_> = best_first
        .into_iter()
        .map(|outcome| plot::Overlay {
            label: format!("{}, rms {:.3}", outcome.model.name, outcome.rms_ln),
            ln_f: plot::of(&outcome.material()),
        })
        .collect();
    plot::overlay_svg(&measurement.label(), &plot::Drawn::of_scan(measurement).data(), &lines)
}
