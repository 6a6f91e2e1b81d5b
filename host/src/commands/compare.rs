//! `brdfit compare`: which model a scan needs.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use crate::analysis::choose::{Candidate, Choice, choose};
use crate::document;
use crate::engine::{FitOptions, Model, Outcome};
use crate::error::Error;
use crate::input::{self, Measurement, ReadOptions, left_out};
use crate::number::four;
use crate::output::{Format, OutputArguments, deliver};
use crate::parameters::models;
use crate::plot::{self, picture};
use crate::result::json::ByName;
use crate::result::json::provenance::provenance;
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
    let fitted = choose(&measurement.samples, &candidates);
    let choice = fitted.map_err(|error| input::explain(&measurement, error))?;
    let text = match arguments.output.format {
        Format::Text => text(&measurement, &choice),
        Format::Json => json(&measurement, &choice),
    };
    if let Some(plot) = &plot {
        picture::save(plot, &picture(&measurement, &choice))?;
    }
    deliver(text.as_bytes(), target.as_ref(), streams.output)?;
    left_out::note(&[measurement], streams.errors);
    Ok(())
}

fn text(measurement: &Measurement, choice: &Choice) -> String {
    let (least_aicc, least_bic) = (
        choice.least(|one| one.criteria.aicc),
        choice.least(|one| one.criteria.bic),
    );
    let mut lines = vec![
        format!("{}: {} samples", measurement.label(), measurement.samples.len()),
        "  model                   P        MSE^2  rms ln    AICc     BIC  minima  parameters".to_string(),
    ];
    for (place, Candidate { outcome, criteria, .. }) in choice.candidates.iter().enumerate() {
        let values = outcome.model.named(&outcome.params);
        let values: Vec<_> = values.map(|(name, value)| format!("{name} {}", four(value))).collect();
        let mark = if place == choice.place { '*' } else { ' ' };
        lines.push(format!(
            "{mark} {:<22} {:>2} {:>12.4e} {:>7.4} {:>7.1} {:>7.1} {:>7}  {}",
            outcome.model.name,
            criteria.parameters,
            outcome.mse2,
            outcome.rms_ln,
            criteria.aicc - least_aicc,
            criteria.bic - least_bic,
            outcome.minima.len(),
            values.join(", "),
        ));
    }
    lines.push(
        "  AICc and BIC are above their least; * has the least BIC; a difference of 10 leaves no doubt.".to_string(),
    );
    lines.join("\n") + "\n"
}

fn json(measurement: &Measurement, choice: &Choice) -> String {
    let candidates = choice.candidates.iter();
    let models: Vec<_> = candidates
        .map(|one| {
            let (outcome, criteria) = (&one.outcome, &one.criteria);
            let bounds = |place: usize| [one.options.lower[place], one.options.upper[place]];
            json!({
                "model": outcome.model.name,
                "mse2": outcome.mse2,
                "rms_ln": outcome.rms_ln,
                "aicc": criteria.aicc,
                "bic": criteria.bic,
                "minima": outcome.minima.len(),
                "parameters": ByName::new(outcome.model, |place| outcome.params[place]),
                "bounds": ByName::new(outcome.model, bounds),
            })
        })
        .collect();
    let value = json!({
        "scan": measurement.label(),
        "samples": measurement.samples.len(),
        "model": choice.chosen().outcome.model.name,
        "criterion": "bic",
        "seed": choice.chosen().options.seed,
        "starts": choice.chosen().options.starts(),
        "models": models,
        "provenance": provenance(&measurement.about, None),
    });
    document::json(&value)
}

fn picture(measurement: &Measurement, choice: &Choice) -> String {
    let mut best_first: Vec<&Outcome> = choice.candidates.iter().map(|one| &one.outcome).collect();
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
