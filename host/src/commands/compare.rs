//! `brdfit compare`: which model a scan needs.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use crate::engine::models::{Fitted, MODELS, Model};
use crate::error::{Error, shown};
use crate::input::{self, Measurement, ReadOptions, left_out};
use crate::output::{Format, OutputArguments, shortest};
use crate::plot::{self, picture};
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
    /// Draws every model's best fit over the data, as SVG or PNG
    #[arg(long, value_name = "FILE", value_parser = picture::name)]
    plot: Option<PathBuf>,
    #[command(flatten)]
    read: ReadOptions,
}

/// Runs the subcommand.
///
/// # Errors
/// An unknown model, a scan that can not be read or fitted, or an output that can not be written.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    let models = choose(arguments.models.as_deref())?;
    let measurement = input::read_one(&arguments.scan, &arguments.read, streams.input)?;
    let fits = compare(&models, &measurement, arguments.seed)?;
    let text = match arguments.output.format {
        Format::Text => text(&measurement, &fits),
        Format::Json => json(&measurement, &fits),
    };
    if let Some(path) = &arguments.plot {
        picture::save(path, &picture(&measurement, &models, &fits))?;
    }
    arguments.output.deliver(&text, streams.output)?;
    left_out::note(&[measurement], streams.errors);
    Ok(())
}

fn choose(list: Option<&str>) -> Result<Vec<Model>, Error> {
    let Some(list) = list else {
        return Ok(MODELS.to_vec());
    };
    let each = list.split(',').map(str::trim).map(|name| {
        MODELS.into_iter().find(|model| model.name == name).ok_or_else(|| {
            let names = MODELS.map(|model| model.name).join(", ");
            Error::new(format!("there is no model '{}'", shown(name))).help(format!("the models are {names}"))
        })
    });
    each.collect()
}

/// Fits each model, on all threads.
fn compare(models: &[Model], measurement: &Measurement, seed: u64) -> Result<Vec<Fitted>, Error> {
    use rayon::prelude::*;
    let fits: Vec<_> = models
        .par_iter()
        .map(|model| model.fit(&measurement.samples, seed))
        .collect();
    let each = fits.into_iter();
    each.map(|fit| fit.map_err(|error| input::explain(measurement, error)))
        .collect()
}

fn least_aicc(fits: &[Fitted]) -> f64 {
    fits.iter().map(Fitted::aicc).fold(f64::INFINITY, f64::min)
}

fn text(measurement: &Measurement, fits: &[Fitted]) -> String {
    let least = least_aicc(fits);
    let mut lines = vec![
        format!("{}: {} samples", measurement.label(), measurement.samples.len()),
        "  model                P        MSE^2  rms ln    AICc  minima  parameters".to_string(),
    ];
    for fit in fits {
        let values = fit.parameters.iter();
        let values: Vec<_> = values
            .map(|(name, value)| format!("{name} {}", short(*value)))
            .collect();
        let mark = if fit.aicc() == least { '*' } else { ' ' };
        lines.push(format!(
            "{mark} {:<19} {:>2} {:>12.4e} {:>7.4} {:>7.1} {:>7}  {}",
            fit.model,
            fit.parameters.len(),
            fit.mse2(),
            fit.rms_ln(),
            fit.aicc() - least,
            fit.minima,
            values.join(", "),
        ));
    }
    lines.push("  AICc is above the least, which * has; a difference of 10 leaves no doubt.".to_string());
    lines.join("\n") + "\n"
}

/// Four digits.
fn short(value: f64) -> String {
    let rounded = format!("{value:.3e}").parse().unwrap_or(value);
    shortest(rounded)
}

fn json(measurement: &Measurement, fits: &[Fitted]) -> String {
    let models: Vec<_> = fits
        .iter()
        .map(|fit| {
            json!({
                "model": fit.model,
                "mse2": fit.mse2(),
                "rms_ln": fit.rms_ln(),
                "aicc": fit.aicc(),
                "minima": fit.minima,
                "parameters": fit.parameters.iter().map(|&(name, value)| (name.to_string(), value.into())).collect::<serde_json::Map<String, serde_json::Value>>(),
            })
        })
        .collect();
    let value = json!({ "scan": measurement.label(), "samples": measurement.samples.len(), "models": models });
    format!("{value:#}\n")
}

fn picture(measurement: &Measurement, models: &[Model], fits: &[Fitted]) -> String {
    let values: Vec<Vec<f64>> = fits
        .iter()
        .map(|fit| fit.parameters.iter().map(|p| p.1).collect())
        .collect();
    let mut best_first: Vec<usize> = (0..fits.len()).collect();
    best_first.sort_by(|&a, &b| fits[a].cost.total_cmp(&fits[b].cost));
    let lines: Vec<_> = best_first
        .into_iter()
        .map(|k| {
            let (model, values) = (models[k], &values[k]);
            let label = format!("{}, rms {:.3}", model.name, fits[k].rms_ln());
            plot::Overlay {
                label,
                ln_f: Box::new(move |sample| model.ln_f(values, sample)),
            }
        })
        .collect();
    plot::overlay_svg(&measurement.label(), &measurement.samples, &lines)
}
