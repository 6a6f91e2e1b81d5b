//! `brdfit joint`: several scans of one material, of which chosen parameters are the same.

use std::path::PathBuf;

use brdfit_core::geometry::Sample;
use brdfit_engine::joint::{Fitted, SCANS, fit};
use clap::Args;
use serde_json::{Value, json};

use crate::engine::{FitOptions, Model};
use crate::error::Error;
use crate::input::{self, Measurement, ReadOptions, left_out};
use crate::number::{four, two};
use crate::options::SearchArguments;
use crate::output::{self, Format, OutputArguments, deliver};
use crate::parameters::parameter;
use crate::result::json::ByName;
use crate::result::json::provenance::provenance;
use crate::streams::Streams;

/// Fits several scans of one material together: wavelengths that share m, or repeats that share all but the weights
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  brdfit joint red.csv green.csv blue.csv --share m")]
pub struct Arguments {
    /// Two to eight scans, as `brdfit fit` reads them; a file may hold several
    #[arg(value_name = "SCAN", required = true)]
    scans: Vec<PathBuf>,
    /// The parameters that are the same in all scans, with commas between
    #[arg(long, value_name = "LIST", default_value = "m")]
    share: String,
    #[command(flatten)]
    search: SearchArguments,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    read: ReadOptions,
}

/// Runs the subcommand.
///
/// # Errors
/// An unknown parameter, too few or too many scans, a scan that cannot be read or fitted, or an output that cannot be written.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    let options = arguments.search.fit_options()?;
    let shared = shared(options.model, &arguments.share)?;
    let target = arguments.output.target(&arguments.scans)?;
    let measurements = input::read(&arguments.scans, &arguments.read, streams.input)?;
    if !(2..=SCANS).contains(&measurements.len()) {
        return Err(
            Error::new(format!("{} scans cannot be fitted together", measurements.len()))
                .help(format!("give 2 to {SCANS} scans")),
        );
    }
    let samples: Vec<&[Sample<f64>]> = measurements.iter().map(|one| &one.samples[..]).collect();
    let pool = arguments.search.pool()?;
    let fitted = pool
        .install(|| fit(&samples, &shared, &options))
        .map_err(|(place, error)| input::explain(&measurements[place], error))?;
    let text = match arguments.output.format {
        Format::Text => text(&options, &measurements, &fitted),
        Format::Json => json(&options, &measurements, &fitted),
    };
    deliver(text.as_bytes(), target.as_ref(), streams.output)?;
    left_out::note(&measurements, streams.errors);
    Ok(())
}

fn shared(model: &Model, list: &str) -> Result<Vec<bool>, Error> {
    let mut shared = vec![false; model.parameters.len()];
    for name in list.split(',') {
        shared[parameter(model, name)?] = true;
    }
    Ok(shared)
}

fn text(options: &FitOptions, measurements: &[Measurement], fitted: &Fitted) -> String {
    let name = |k: usize| options.model.parameters[k].name;
    let present = |shared: bool| options.present().filter(move |&k| fitted.shared[k] == shared);
    let names: Vec<&str> = present(true).map(name).collect();
    let value = |scan: usize, k: usize| match fitted.errors[scan][k] {
        Some(error) => format!("{} ± {}", four(fitted.scans[scan][k]), two(error)),
        None => four(fitted.scans[scan][k]),
    };
    let mut lines = vec![format!(
        "{} scans, {} samples, {} parameters; shared: {}",
        measurements.len(),
        fitted.samples,
        fitted.parameters,
        names.join(", ")
    )];
    for k in present(true) {
        lines.push(format!("  {:<6} {}", name(k), value(0, k)));
    }
    for (scan, measurement) in measurements.iter().enumerate() {
        let own: Vec<_> = present(false)
            .map(|k| format!("{} {}", name(k), value(scan, k)))
            .collect();
        lines.push(format!("  {}: {}", measurement.label(), own.join(", ")));
    }
    let rms = |cost: f64| (cost / fitted.samples as f64).sqrt();
    lines.push(format!(
        "  rms ln residual {:.4} together, {:.4} with each scan on its own",
        rms(fitted.cost),
        rms(fitted.separate)
    ));
    lines.push("  ± is one standard error; none where a parameter is on a bound or undetermined.".to_string());
    lines.join("\n") + "\n"
}

fn json(options: &FitOptions, measurements: &[Measurement], fitted: &Fitted) -> String {
    let model = options.model;
    let shared: Vec<&str> = (0..fitted.shared.len())
        .filter(|&k| fitted.shared[k])
        .map(|k| model.parameters[k].name)
        .collect();
    let scans: Vec<Value> = measurements
        .iter()
        .enumerate()
        .map(|(scan, measurement)| {
            json!({
                "scan": measurement.label(),
                "parameters": ByName::new(model, |k| fitted.scans[scan][k]),
                "stderr": ByName::new(model, |k| fitted.errors[scan][k]),
                "provenance": provenance(&measurement.about, Some(options)),
            })
        })
        .collect();
    let value = json!({
        "model": model.name,
        "shared": shared,
        "samples": fitted.samples,
        "cost": fitted.cost,
        "cost_separate": fitted.separate,
        "scans": scans,
    });
    output::json(&value)
}
