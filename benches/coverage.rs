//! Prints how often the 95 % intervals hold the truth, as a Markdown table: `cargo run --release --example coverage > benches/results/coverage.md`.

use brdfit::analysis::bootstrap::{Noise, copy};
use brdfit::analysis::profile::calibrate::thresholds;
use brdfit::analysis::profile::{calibrate::threshold, hold::hold};
use brdfit::engine::{FitOptions, Material, fit};
use brdfit_core::brdf::NAMES;
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use brdfit_suite::scan::{data, scan, six};
use rayon::prelude::*;

const COPIES: u64 = 1000;
/// Copies of a copy that tell how far its cost rises.
const CALIBRATION: u32 = 99;
/// The set and the parameter whose calibrated intervals are looked at: m of test data 2.
const CALIBRATED: (usize, usize) = (1, 3);
/// Standard deviation of a number that is uniform within +-0.1.
const SCALE: f64 = 0.057_735_026_918_962_58;

/// How a set is measured again.
type Measure = fn(&[Sample<f64>], &Material, &mut Noise) -> Vec<Sample<f64>>;

/// The actual parameters of the paper's sets.
const ACTUAL: [[f64; 6]; 3] = [
    [0.1, 10.0, 0.01, 0.1, 3.0, 1.0],
    [0.2, 1.5, 0.02, 0.15, 1.15, 0.9],
    [0.15, 1.0, 0.001, 0.005, 1.1, 0.86],
];

fn main() {
    println!("# Coverage of the 95 % intervals\n");
    println!(
        "Share in % of {COPIES} noisy copies of each of the paper's sets whose interval holds the actual value; binomial noise of these shares is +-0.7 at 95 %."
    );
    println!(
        "Quadratic: best value +- Student's t times the standard error that a fit prints; a value on a bound has none, and counts as its own interval."
    );
    println!(
        "Profile: the best fit with the parameter held at its actual value is not refuted by the F test, which is what the intervals of `brdfit profile` are made of."
    );
    println!(
        "Calibrated: it is not refuted by {CALIBRATION} copies of that fit with noise of their own (`brdfit profile --calibrate {CALIBRATION}`); only for m of set 2, where the F test says too little, as it takes 200 fits for one answer."
    );
    println!("Regenerate: `cargo run --release --example coverage > benches/results/coverage.md`.");
    let normal: Measure = |samples, params, noise| copy(samples, params, SCALE, noise);
    let uniform: Measure = |samples, params, noise| {
        let clean = copy(samples, params, 0.0, noise);
        let noisy = |sample: &Sample<f64>, noise: &mut Noise| Sample {
            brdf: sample.brdf * (0.9 + 0.2 * noise.unit()),
            ..*sample
        };
        clean.iter().map(|sample| noisy(sample, noise)).collect()
    };
    table(
        "Errors of ln f normal, standard deviation 0.0577: what the intervals assume",
        normal,
        true,
    );
    table(
        "Errors of f uniform within +-10 %, as the paper's: of the same standard deviation, but ln f is low by 0.0017 on average, so rho_d and the products of rho and F are low by 0.17 %",
        uniform,
        false,
    );
}

fn table(title: &str, measure: Measure, calibrated: bool) {
    println!("\n{title}.\n");
    println!("| set | intervals | {} |", NAMES.join(" | "));
    println!("|--:|---|{}", "--:|".repeat(NAMES.len()));
    for (set, actual) in ACTUAL.iter().enumerate() {
        let samples = scan(&data(&format!("testdata{}_ideal.csv", set + 1)));
        let held = (0..COPIES).into_par_iter().map(|seed| {
            let noise = &mut Noise::new(set as u64, seed);
            let calibrated = (calibrated && set == CALIBRATED.0).then_some(seed);
            intervals(&measure(&samples, &Material::paper(*actual), noise), actual, calibrated)
        });
        let none = || [[0u32; 6]; 3];
        let sum = held
            .map(|held| held.map(|row| row.map(u32::from)))
            .reduce(none, |a, b| {
                std::array::from_fn(|kind| std::array::from_fn(|k| a[kind][k] + b[kind][k]))
            });
        let kinds = ["quadratic", "profile", "calibrated"].iter().zip(sum);
        for (kind, counts) in kinds.take(if calibrated && set == CALIBRATED.0 { 3 } else { 2 }) {
            let mut shares = counts.map(|count| format!("{:.1}", 100.0 * f64::from(count) / COPIES as f64));
            for k in (0..6).filter(|&k| *kind == "calibrated" && k != CALIBRATED.1) {
                shares[k] = "–".to_string();
            }
            println!("| {} | {kind} | {} |", set + 1, shares.join(" | "));
        }
    }
}

/// Do the quadratic, the profile and the calibrated interval of each parameter hold its actual value? The last only with a seed for its copies.
fn intervals(samples: &[Sample<f64>], actual: &[f64; 6], calibrated: Option<u64>) -> [[bool; 6]; 3] {
    let options = FitOptions::default();
    let outcome = fit(samples, &options).expect("simulated scans are valid");
    let known = &outcome.uncertainty;
    let limit = threshold(0.95, known.degrees_of_freedom as f64);
    let best = six(&outcome.params);
    let quadratic = std::array::from_fn(|k| (best[k] - actual[k]).abs() <= Real::sqrt(limit) * known.stderr[k]);
    let held = std::array::from_fn(|k| {
        let point = hold(samples, &options, &outcome, k, actual[k]).expect("simulated scans are valid");
        let best = outcome.cost.min(point.cost);
        let rise = (point.cost - best) / best * known.degrees_of_freedom as f64;
        let calibrated = calibrated.filter(|_| k == CALIBRATED.1).map(|seed| {
            let options = FitOptions { seed, ..options };
            let copies = thresholds(samples, &options, k, &point.params, known.scale, CALIBRATION);
            rise <= copies.expect("simulated scans are valid")[1]
        });
        (rise <= limit, calibrated == Some(true))
    });
    [
        quadratic,
        held.map(|(profile, _)| profile),
        held.map(|(_, calibrated)| calibrated),
    ]
}
