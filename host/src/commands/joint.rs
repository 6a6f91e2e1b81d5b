//! `brdfit joint`: several scans of one material, of which chosen parameters are the same.

use std::path::PathBuf;

use brdfit_core::brdf::NAMES;
use brdfit_core::geometry::Sample;
use brdfit_engine::joint::{Fitted, SCANS, fit};
use clap::Args;
use serde_json::{Map, Value, json};

use crate::error::{Error, shown};
use crate::input::{self, Measurement, ReadOptions, left_out};
use crate::output::{Format, OutputArguments, shortest};
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
    /// Seed of the starts
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    read: ReadOptions,
}

/// Runs the subcommand.
///
/// # Errors
/// An unknown parameter, too few or too many scans, a scan that can not be read or fitted, or an output that can not be written.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    let shared = shared(&arguments.share)?;
    let measurements = input::read(&arguments.scans, &arguments.read, streams.input)?;
    if !(2..=SCANS).contains(&measurements.len()) {
        return Err(
            Error::new(format!("{} scans can not be fitted together", measurements.len()))
                .help(format!("give 2 to {SCANS} scans")),
        );
    }
    let samples: Vec<&[Sample<f64>]> = measurements.iter().map(|one| &one.samples[..]).collect();
    let fitted =
        fit(&samples, shared, arguments.seed).map_err(|(place, error)| input::explain(&measurements[place], error))?;
    let text = match arguments.output.format {
        Format::Text => text(&measurements, &fitted),
        Format::Json => json(&measurements, &fitted),
    };
    arguments.output.deliver(&text, streams.output)?;
    left_out::note(&measurements, streams.errors);
    Ok(())
}

fn shared(list: &str) -> Result<[bool; 6], Error> {
    let mut shared = [false; 6];
    for name in list.split(',').map(str::trim) {
        let known = NAMES.iter().position(|known| *known == name);
        let index = known.ok_or_else(|| {
            Error::new(format!("there is no parameter '{}'", shown(name)))
                .help(format!("--share takes some of {}", NAMES.join(",")))
        })?;
        shared[index] = true;
    }
    Ok(shared)
}

fn text(measurements: &[Measurement], fitted: &Fitted) -> String {
    let names: Vec<&str> = (0..6).filter(|&k| fitted.shared[k]).map(|k| NAMES[k]).collect();
    let value = |(value, error): (f64, Option<f64>)| match error {
        Some(error) => format!("{} ± {}", digits(value, 4), digits(error, 2)),
        None => digits(value, 4),
    };
    let mut lines = vec![format!(
        "{} scans, {} samples, {} parameters; shared: {}",
        measurements.len(),
        fitted.samples,
        fitted.parameters,
        names.join(", ")
    )];
    for k in (0..6).filter(|&k| fitted.shared[k]) {
        lines.push(format!("  {:<6} {}", NAMES[k], value(fitted.scans[0][k])));
    }
    for (measurement, parameters) in measurements.iter().zip(&fitted.scans) {
        let own = (0..6).filter(|&k| !fitted.shared[k]);
        let own: Vec<_> = own.map(|k| format!("{} {}", NAMES[k], value(parameters[k]))).collect();
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

fn digits(value: f64, digits: usize) -> String {
    let rounded = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    shortest(rounded)
}

fn json(measurements: &[Measurement], fitted: &Fitted) -> String {
    let shared: Vec<&str> = (0..6).filter(|&k| fitted.shared[k]).map(|k| NAMES[k]).collect();
    let scans: Vec<Value> = measurements
        .iter()
        .zip(&fitted.scans)
        .map(|(measurement, parameters)| {
            let of = |part: fn(&(f64, Option<f64>)) -> Value| -> Map<String, Value> {
                NAMES
                    .iter()
                    .map(|name| name.to_string())
                    .zip(parameters.iter().map(part))
                    .collect()
            };
            json!({
                "scan": measurement.label(),
                "parameters": of(|p| p.0.into()),
                "stderr": of(|p| p.1.into()),
            })
        })
        .collect();
    let value = json!({
        "shared": shared,
        "samples": fitted.samples,
        "cost": fitted.cost,
        "cost_separate": fitted.separate,
        "scans": scans,
    });
    format!("{value:#}\n")
}
