//! `brdfit joint`: several scans of one material, of which chosen parameters are the same.

use std::path::PathBuf;

use brdfit_core::brdf::{ALL, NAMES};
use brdfit_core::geometry::Block;
use brdfit_core::joint::Joint;
use brdfit_core::lm::{self, Options};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::search::{CANDIDATES, search};
use brdfit_core::uncertainty::Uncertainty;
use clap::{Args, ValueEnum};
use rayon::prelude::*;
use serde_json::{Map, Value, json};

use crate::cli::Streams;
use crate::engine::{FitOptions, blocks};
use crate::error::{Error, shown};
use crate::input::{self, Measurement, ReadOptions, left_out};
use crate::output::{deliver, shortest};
use crate::simd::{FastScan, Simd};

/// Scans at most.
pub const SCANS: usize = 8;
/// Coordinates at most: with every parameter each scan's own.
const COORDINATES: usize = 6 * SCANS;

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
    /// Form of the result
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Writes the result to a file, or with - to standard output
    #[arg(short, long, visible_alias = "out", value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    read: ReadOptions,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Format {
    Text,
    Json,
}

/// A fit of several scans.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// Which of [`NAMES`] are shared.
    pub shared: [bool; 6],
    /// Parameters of each scan, with their standard errors (none on a bound, or if undetermined).
    pub scans: Vec<[(f64, Option<f64>); 6]>,
    /// Sum of squared residuals of ln f over all scans.
    pub cost: f64,
    /// The same of fits of each scan on its own.
    pub separate: f64,
    /// Samples of all scans.
    pub samples: usize,
    /// Parameters that are free.
    pub parameters: usize,
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
    let fitted = fit(&measurements, shared, arguments.seed)?;
    let text = match arguments.format {
        Format::Text => text(&measurements, &fitted),
        Format::Json => json(&measurements, &fitted),
    };
    deliver(text.as_bytes(), arguments.output.as_deref(), streams.output)?;
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

/// Fits each scan on its own, then all together: from the mean of the shared parameters, and from those of each scan; the best counts.
///
/// # Errors
/// A scan that can not be fitted.
pub fn fit(measurements: &[Measurement], shared: [bool; 6], seed: u64) -> Result<Fitted, Error> {
    let mut all: Vec<Vec<Block<f64>>> = Vec::new();
    for measurement in measurements {
        all.push(blocks(&measurement.samples).map_err(|error| input::explain(measurement, error))?);
    }
    let simd = Simd::best();
    let each = all.iter().map(|blocks| FastScan {
        scan: Scan::<f64, ALL, 6>::new(blocks),
        simd,
    });
    let scans: Vec<_> = each.collect();
    let defaults = FitOptions::default();
    let one = Scan::<f64, ALL, 6>::bounds(&defaults.lower, &defaults.upper);
    let options = Options::default();
    let separate: Vec<([f64; 6], f64)> = scans
        .par_iter()
        .map(|scan| {
            let found = search(scan, &one, seed, CANDIDATES, &options);
            let best = found.minima.best().expect("a search makes at least one fit");
            (best.x, best.cost)
        })
        .collect();
    let problem = Joint::new(&scans, shared);
    let bounds = problem.bounds::<f64, COORDINATES>(&one);
    let mean: [f64; COORDINATES] = problem.join(separate.iter().map(|fit| fit.0));
    let of_each = separate.iter().map(|(x, _)| {
        let mut start = mean;
        for index in (0..6).filter(|&index| shared[index]) {
            start[problem.place(0, index)] = x[index];
        }
        start
    });
    let starts: Vec<_> = std::iter::once(mean).chain(of_each).collect();
    let fits = starts
        .into_par_iter()
        .map(|start| lm::fit(&problem, &bounds, start, &options));
    let fits: Vec<_> = fits.collect();
    let best = fits
        .into_iter()
        .min_by(|a, b| a.at.cost.total_cmp(&b.at.cost))
        .expect("there are starts");
    let samples = measurements.iter().flat_map(|one| &one.samples);
    let samples = samples.filter(|sample| sample.weight != 0.0).count();
    let uncertainty = Uncertainty::new(&best.at, &best.x, &bounds, samples);
    let parameter = |s: usize, index: usize| {
        let place = problem.place(s, index);
        let value = best.x[place];
        let free = bounds.lower[place] < value && value < bounds.upper[place];
        let error = free
            .then(|| uncertainty.held.standard_error(place))
            .filter(|error| error.is_finite());
        match NAMES[index] {
            // The solver has kappa^2.
            "kappa" => {
                let kappa = Real::sqrt(value);
                (kappa, error.map(|error| error / (2.0 * kappa)))
            }
            _ => (value, error),
        }
    };
    Ok(Fitted {
        shared,
        scans: (0..scans.len())
            .map(|s| std::array::from_fn(|index| parameter(s, index)))
            .collect(),
        cost: best.at.cost,
        separate: separate.iter().map(|fit| fit.1).sum(),
        samples,
        parameters: problem.coordinates(),
    })
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
