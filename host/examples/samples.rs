//! Fits samples that the program has itself, and asks which values of a parameter they allow.
//!
//! `cargo run --release -p brdfit --example samples`

use std::error::Error;

use brdfit::analysis::choose::Wanted;
use brdfit::analysis::fit::fit;
use brdfit::analysis::profile::profiles;
use brdfit::engine::{FitOptions, Material, Model};
use brdfit::input::Measurement;
use brdfit_core::brdf::{DIFFUSE, SURFACE};
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

fn main() -> Result<(), Box<dyn Error>> {
    // Angles in radians, BRDF in sr^-1; here from a known material, 5 % off in turn.
    let truth = Material::paper([0.1, 5.0, 0.0, 0.15, 1.5, 0.0]);
    let angles = (-80..=80).step_by(4).map(|degrees| f64::from(degrees).to_radians());
    let samples: Vec<Sample<f64>> = angles
        .enumerate()
        .filter_map(|(place, theta_s)| {
            let sample = Sample::in_plane(0.5, theta_s, 1.0);
            let error = if place % 2 == 0 { 1.05 } else { 0.95 };
            let brdf = Real::portable_exp(truth.ln_f(&sample)?) * error;
            Some(Sample { brdf, ..sample })
        })
        .collect();
    let scan = Measurement::of_samples("my instrument", samples, None);

    let mut options = FitOptions {
        terms: DIFFUSE | SURFACE,
        ..FitOptions::default()
    };
    // What is known need not be searched.
    let n = Model::paper().place("n").ok_or("there is no n")?;
    (options.lower[n], options.upper[n]) = (1.5, 1.5);
    let fitted = fit(&scan, &Wanted::One(options))?;
    for place in options.free() {
        let parameter = &Model::paper().parameters[place];
        let (value, stderr) = (fitted.outcome.params[place], fitted.outcome.uncertainty.stderr[place]);
        println!("{:6} {value:.5} +- {stderr:.5}  {}", parameter.name, parameter.what);
    }
    let m = Model::paper().place("m").ok_or("there is no m")?;
    let found = profiles(&scan.samples, &options, fitted.outcome, &[m], 0, None)?;
    let [_, interval] = found.list[0].intervals;
    println!(
        "m is within {:.5} and {:.5} at 95 %",
        interval.low.value, interval.high.value
    );
    assert!(interval.low.value < 0.15 && 0.15 < interval.high.value);
    Ok(())
}
