//! Section 4 of the paper: its three synthetic sets, fitted by both methods.

use brdfit_core::brdf::NAMES;
use serde::Serialize;

use super::paper_sets::{self, Noise};
use crate::engine::clock::Stopwatch;
use crate::engine::{self, FitOptions, Method, Minimum, Outcome};

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
    /// Wall time, s: the only part of a study that is not the same in every run, so it is no part of JSON.
    #[serde(skip)]
    pub elapsed_s: f64,
}

/// Fits every draw of every set by both methods.
///
/// `seed` is that of the starts, of which the paper's method makes `starts`.
pub fn study(noise: Noise, seed: u64, starts: u32) -> Study {
    let paper = FitOptions {
        method: Method::Paper,
        seed,
        starts: Some(starts),
        ..FitOptions::default()
    };
    let mut sets = Vec::new();
    for source in &paper_sets::SETS {
        let seeds = source.files(noise).iter().zip(1..);
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
        noise,
        seed,
        starts,
        sets,
    }
}

fn draw(csv: &str, noise_seed: u32, paper: &FitOptions) -> Draw {
    let samples = paper_sets::samples(csv);
    let timed = |options: &FitOptions| {
        let begin = Stopwatch::start();
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
    let value = |minimum: &Minimum| minimum.params[index];
    let values = outcome.minima.iter().map(value);
    Range {
        min: values.clone().fold(f64::INFINITY, f64::min),
        max: values.fold(f64::NEG_INFINITY, f64::max),
        best: outcome.params[index],
        at_bound: outcome.at_bound.contains(&NAMES[index]),
    }
}
