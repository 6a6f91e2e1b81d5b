//! What is known of the instrument takes part in a fit, and gives the actual values back where without it they are missed.
#![allow(
    clippy::disallowed_methods,
    reason = "simulated scans may use std's functions; the code under test may not"
)]

mod angles;
mod commands;
mod priors;
mod scale;

use brdfit::analysis::bootstrap::{Noise, copy};
use brdfit::engine::{self, FitOptions, Material, Outcome};
use brdfit_core::brdf::{DIFFUSE, SURFACE};
use brdfit_core::geometry::Sample;
use brdfit_suite::program::brdfit;
use serde_json::Value;

const PLACE_M: usize = 3;
const PLACE_N: usize = 4;

/// A dielectric: rho_s and n trade against each other unless one is known.
fn dielectric() -> Material {
    Material::paper([0.2, 0.8, 0.0, 0.15, 1.5, 0.0])
}

fn grid(theta_i: &[f64], step: usize, reach: i32) -> Vec<Sample<f64>> {
    let at = |theta_i: f64| {
        let theta_s = (-reach..=reach).step_by(step);
        theta_s.map(move |theta_s| Sample::in_plane(theta_i.to_radians(), f64::from(theta_s).to_radians(), 1.0))
    };
    theta_i.iter().flat_map(|&theta_i| at(theta_i)).collect()
}

fn noisy(material: &Material, samples: &[Sample<f64>], noise: f64, seed: u64) -> Vec<Sample<f64>> {
    copy(samples, material, noise, &mut Noise::new(11, seed))
}

/// Diffuse and surface terms, with what an instrument adds.
fn options(change: impl Fn(&mut FitOptions)) -> FitOptions {
    let mut options = FitOptions {
        terms: DIFFUSE | SURFACE,
        ..FitOptions::default()
    };
    change(&mut options);
    options
}

/// All terms, with what an instrument adds.
fn all_terms(change: impl Fn(&mut FitOptions)) -> FitOptions {
    let mut options = FitOptions::default();
    change(&mut options);
    options
}

fn fit(samples: &[Sample<f64>], options: &FitOptions) -> Outcome {
    engine::fit(samples, options).unwrap_or_else(|error| panic!("{error}"))
}

fn json(arguments: &[&str]) -> Value {
    let arguments = [arguments, &["--format", "json"]].concat();
    let ran = brdfit(&arguments, b"");
    assert_eq!(ran.code, 0, "{}", ran.errors);
    serde_json::from_str(&ran.output).expect("JSON")
}
