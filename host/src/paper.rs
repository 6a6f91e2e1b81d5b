//! `brdfit paper`: section 4 of the paper, from the synthetic sets that the program carries.

pub(crate) mod embedded;
mod text;

use std::time::Instant;

use brdfit_core::brdf::NAMES;
use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::engine::{self, FitOptions, Method, Minimum, Outcome};
use crate::error::Error;
use crate::output::{Format, deliver};
use crate::streams::Streams;

/// What noise the synthetic sets have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Noise {
    /// Uniform within +-10 %: the reading that agrees with the paper's fitted rho_d.
    Sym,
    /// Uniform within 0 to 10 %.
    Pos,
}

/// Fits the paper's three synthetic sets, which are built in, as its section 4 does
#[derive(Args, Clone, Copy, Debug, PartialEq)]
#[command(after_help = "Example:\n  brdfit paper --noise pos --format json")]
pub struct Arguments {
    /// Noise of the sets
    #[arg(long, value_enum, default_value = "sym")]
    pub noise: Noise,
    /// Form of the result
    #[arg(long, value_enum, default_value = "text")]
    pub format: Format,
    /// Seed of the starts of both methods (not of the noise)
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Number of starts of the paper's method
    #[arg(long, value_name = "N", default_value_t = 250, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub starts: u32,
}

/// Section 4 of the paper, done again.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Study {
    /// The noise of the sets.
    pub noise: Noise,
    /// Seed of the starts.
    pub seed: u64,
    /// Number of starts of the paper's method.
    pub starts: u32,
    /// Test data 1, 2 and 3.
    pub sets: Vec<Set>,
}

/// One of the paper's synthetic sets, with several draws of the noise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Set {
    /// As the paper calls it.
    pub name: &'static str,
    /// Incident angle, degrees.
    pub theta_i_deg: f64,
    /// Number of distinct minima that the paper found.
    pub paper_minima: u32,
    /// The six parameters, in the order of [`NAMES`]; dimensionless.
    pub parameters: [Reference; 6],
    /// One for each draw of the noise.
    pub draws: Vec<Draw>,
}

/// What is known of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Reference {
    /// Its name.
    pub name: &'static str,
    /// The value that the data were made with.
    pub actual: f64,
    /// The paper's own best fit.
    pub paper_best: f64,
}

/// The results for one draw of the noise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Draw {
    /// Seed of the noise.
    pub noise_seed: u32,
    /// Number of samples.
    pub samples: usize,
    /// The paper's Table 2, in the order of [`NAMES`].
    pub parameters: [Range; 6],
    /// Number of distinct minima.
    pub minima: usize,
    /// Least MSE^2 (Eq. 17).
    pub mse2_low: f64,
    /// MSE^2 of the worst minimum.
    pub mse2_high: f64,
    /// (high - low) / high, 0 to 1 (Table 3).
    pub improvement_potential: f64,
    /// What the paper's method cost.
    pub paper_method: Effort,
    /// MSE^2 of the default method over that of the paper's method, less 1; negative where it is better.
    pub default_mse2_change: f64,
    /// What the default method cost.
    pub default_method: Effort,
}

/// One parameter over the distinct minima.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Range {
    /// Least.
    pub min: f64,
    /// Largest.
    pub max: f64,
    /// In the best minimum.
    pub best: f64,
    /// The best sits on a bound of the search.
    pub at_bound: bool,
}

/// What a fit cost.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Effort {
    /// Passes over the scan, with or without derivatives.
    pub evaluations: u64,
    /// Wall time, s; the only part of a study that is not the same in every run.
    pub elapsed_s: f64,
}

/// Runs the subcommand.
///
/// # Errors
/// The stream breaks.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    deliver(&write(arguments), None, streams.output)
}

/// The study as text or JSON.
fn write(arguments: &Arguments) -> Vec<u8> {
    let study = study(arguments);
    let mut out = Vec::new();
    match arguments.format {
        Format::Text => text::write(&mut out, &study).expect("a Vec takes all"),
        Format::Json => {
            out = serde_json::to_vec_pretty(&study).expect("numbers and names have a JSON form");
            out.push(b'\n');
        }
    }
    out
}

/// Fits every draw of every set by both methods.
pub fn study(arguments: &Arguments) -> Study {
    let paper = FitOptions {
        method: Method::Paper,
        seed: arguments.seed,
        starts: Some(arguments.starts),
        ..FitOptions::default()
    };
    let mut sets = Vec::new();
    for source in &embedded::SETS {
        let seeds = source.files(arguments.noise).iter().zip(1..);
        let draws = seeds.map(|(csv, seed)| draw(csv, seed, &paper));
        sets.push(Set {
            name: source.name,
            theta_i_deg: source.theta_i_deg,
            paper_minima: source.paper_minima,
            parameters: std::array::from_fn(|k| Reference {
                name: NAMES[k],
                actual: source.actual[k],
                paper_best: source.paper_best[k],
            }),
            draws: draws.collect(),
        });
    }
    Study {
        noise: arguments.noise,
        seed: arguments.seed,
        starts: arguments.starts,
        sets,
    }
}

fn draw(csv: &str, noise_seed: u32, paper: &FitOptions) -> Draw {
    let samples = embedded::samples(csv);
    let timed = |options: &FitOptions| {
        let begin = Instant::now();
        let outcome = engine::fit(&samples, options).expect("the built-in sets are valid");
        let evaluations = u64::from(outcome.evaluations.cost) + u64::from(outcome.evaluations.linearize);
        let elapsed_s = begin.elapsed().as_secs_f64();
        let effort = Effort { evaluations, elapsed_s };
        (outcome, effort)
    };
    let (outcome, paper_method) = timed(paper);
    let default = FitOptions {
        method: Method::Default,
        starts: None,
        ..*paper
    };
    let (quick, default_method) = timed(&default);
    Draw {
        noise_seed,
        samples: outcome.samples,
        parameters: std::array::from_fn(|index| range(&outcome, index)),
        minima: outcome.minima.len(),
        mse2_low: outcome.mse2,
        mse2_high: outcome
            .minima
            .iter()
            .map(|minimum| minimum.mse2)
            .fold(outcome.mse2, f64::max),
        improvement_potential: outcome.improvement_potential,
        paper_method,
        default_mse2_change: quick.mse2 / outcome.mse2 - 1.0,
        default_method,
    }
}

/// Parameter `index` of [`NAMES`] over the distinct minima.
fn range(outcome: &Outcome, index: usize) -> Range {
    let value = |minimum: &Minimum| minimum.params.to_array()[index];
    let values = outcome.minima.iter().map(value);
    Range {
        min: values.clone().fold(f64::INFINITY, f64::min),
        max: values.fold(f64::NEG_INFINITY, f64::max),
        best: outcome.params.to_array()[index],
        at_bound: outcome.at_bound.contains(&NAMES[index]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(format: Format, noise: Noise) -> String {
        let arguments = Arguments {
            noise,
            format,
            seed: 0,
            starts: 12,
        };
        String::from_utf8(write(&arguments)).expect("the text is UTF-8")
    }

    #[test]
    fn text_fits_100_columns() {
        for noise in [Noise::Sym, Noise::Pos] {
            let text = written(Format::Text, noise);
            let widest = text.lines().map(|line| line.chars().count()).max();
            assert!(widest <= Some(100), "{widest:?}");
            for name in NAMES {
                assert_eq!(
                    text.lines()
                        .filter(|line| line.starts_with(&format!("{name} ")))
                        .count(),
                    3
                );
            }
            assert!(!text.contains("NaN") && !text.contains("inf"));
        }
    }

    #[test]
    fn json_has_every_draw() {
        let json: serde_json::Value = serde_json::from_str(&written(Format::Json, Noise::Sym)).expect("JSON");
        assert_eq!(json["starts"], 12);
        assert_eq!(json["sets"][2]["parameters"][3]["actual"], 0.005);
        for set in 0..3 {
            for draw in 0..3 {
                let draw = &json["sets"][set]["draws"][draw];
                assert_eq!(draw["samples"], 171);
                let minima = draw["minima"].as_u64().expect("a count");
                assert!((1..=12).contains(&minima));
                let (low, high) = (draw["mse2_low"].as_f64(), draw["mse2_high"].as_f64());
                assert!(low <= high && low > Some(0.0));
            }
        }
    }
}
