//! Prints how often the 95 % intervals hold the truth, as a Markdown table: `cargo run --release --example coverage > benches/results/coverage.md`; behind `--` the number of copies, and a part of the names of the scenes that are wanted.

#[path = "coverage/copies.rs"]
mod copies;

use brdfit::analysis::derived::{self, Value};
use brdfit::analysis::fit::known;
use brdfit::analysis::misfit::{coverage_factor, inflation};
use brdfit::analysis::profile::{calibrate::threshold, hold::hold};
use brdfit::engine::uncertainty::Uncertainty;
use brdfit::engine::{Material, fit};
use brdfit::input::Measurement;
use brdfit_core::geometry::Sample;
use copies::{Noise, SCENES, Scene};
use rayon::prelude::*;

/// What is looked at, at the middle angle of incidence.
const NAMES: [&str; 6] = ["rho_d", "m", "rho_s F", "peak", "width", "reflectance"];

/// One in so many copies is profiled.
const PROFILED: u64 = 5;

fn main() {
    let copies: u64 = std::env::args()
        .nth(1)
        .map_or(200, |count| count.parse().expect("a number of copies"));
    println!("# Coverage of the 95 % intervals\n");
    println!(
        "Share in % of simulated copies of each scene whose interval holds the truth, the parameters or quantities that the scene was made with; a share of 95 % has a noise (95 %) of +-3.0 with 200 copies, and of +-6.8 with the 40 that have profiles."
    );
    println!(
        "Independent: value +- Student's t times the standard error of independent residuals, with bounds taken as known where a parameter is on one, as it was before. Stated: value +- the coverage factor times the standard error that `fit` prints. Profile: the F test of `brdfit profile` does not refute the true value, for every fifth copy."
    );
    println!("Correlated: copies whose residuals are taken for correlated; bound: copies with a parameter on a bound.");
    println!(
        "Of GGX scenes, which are fitted with Beckmann's model and are random, the truth is the real rho_d, peak and reflectance; m and rho_s F mean something else there."
    );
    println!("Regenerate: `cargo run --release --example coverage > benches/results/coverage.md`.\n");
    println!(
        "| scene | errors | intervals | {} | correlated | bound | copies |",
        NAMES.join(" | ")
    );
    println!("|---|---|---|{}", "--:|".repeat(NAMES.len() + 3));
    let only = std::env::args().nth(2).unwrap_or_default();
    for scene in SCENES.iter().filter(|scene| scene.name.contains(&only)) {
        for noise in scene.noises {
            row(scene, *noise, copies);
        }
    }
}

/// Of one copy: whether each interval of each kind holds the truth, if it is known, and whether residuals are correlated and a parameter is on a bound.
type Held = ([[Option<bool>; 6]; 3], bool, bool);

fn row(scene: &Scene, noise: Noise, copies: u64) {
    let all: Vec<Held> = (0..copies)
        .into_par_iter()
        .map(|copy| one(scene, noise, copy))
        .collect();
    let share = |of: &dyn Fn(&Held) -> Option<bool>| {
        let list: Vec<bool> = all.iter().filter_map(of).collect();
        match list.len() {
            0 => "–".to_string(),
            count => format!(
                "{:.1}",
                100.0 * list.iter().filter(|held| **held).count() as f64 / count as f64
            ),
        }
    };
    for (kind, name) in ["independent", "stated", "profile"].into_iter().enumerate() {
        let shares: Vec<String> = (0..6).map(|k| share(&|held| held.0[kind][k])).collect();
        let (correlated, bound) = (share(&|held| Some(held.1)), share(&|held| Some(held.2)));
        println!(
            "| {} | {} | {name} | {} | {correlated} | {bound} | {copies} |",
            scene.name,
            noise.name(),
            shares.join(" | ")
        );
    }
}

fn one(scene: &Scene, noise: Noise, copy: u64) -> Held {
    let (truth, samples) = scene.copy(noise, copy);
    let options = scene.options();
    let found = fit(&samples, &options).expect("simulated scans are valid");
    let independent = found.uncertainty.clone();
    let measurement = Measurement::of_samples(scene.name, samples.clone(), None);
    let (outcome, _) = known(&measurement, &samples, &options, found.clone());
    let theta_i = scene.angles[scene.angles.len() / 2].to_radians();
    let material = outcome.material();
    let actual = quantities(&truth, theta_i, &independent);
    let held = |known: &Uncertainty, factor: f64| -> [Option<bool>; 6] {
        let values = quantities(&material, theta_i, known);
        std::array::from_fn(|k| {
            let (value, actual) = (values[k]?, actual[k]?);
            let same = truth.model == material.model || !matches!(k, 1 | 2);
            same.then_some((value.value - actual.value).abs() <= factor * value.stderr)
        })
    };
    let degrees = independent.degrees_of_freedom as f64;
    let plain = held(&without_bounds(&independent), threshold(0.95, degrees).sqrt());
    let stated = held(&outcome.uncertainty, coverage_factor(&outcome.uncertainty));
    // Profiles take most of the time: every fifth copy has them.
    let profile = std::array::from_fn(|k| {
        let name = ["rho_d", "m"].get(k).filter(|_| copy.is_multiple_of(PROFILED))?;
        let place = material.model.place(name)?;
        if truth.model != material.model && k == 1 {
            return None;
        }
        let value = truth.values[place];
        let point = hold(&samples, &options, &found, place, value).ok()?;
        let rise = (point.cost - found.cost).max(0.0) / found.cost * degrees;
        let limit =
            inflation(&outcome.uncertainty, &independent, place) * threshold(0.95, outcome.uncertainty.effective);
        Some(rise <= limit)
    });
    let bound = !outcome.at_bound.is_empty();
    ([plain, stated, profile], outcome.uncertainty.misfit.is_some(), bound)
}

/// Errors with what is on a bound held there.
fn without_bounds(known: &Uncertainty) -> Uncertainty {
    let inside: Vec<usize> = known.inside().collect();
    let mut axes = known.axes.clone();
    for (place, axis) in axes.iter_mut().enumerate() {
        if !inside.contains(&place) {
            axis.iter_mut().for_each(|part| *part = 0.0);
        }
    }
    known.clone().with_axes(axes)
}

fn quantities(material: &Material, theta_i: f64, known: &Uncertainty) -> [Option<Value>; 6] {
    let at = derived::at(theta_i, material, known);
    let parameter = |name: &str| {
        let place = material.model.place(name)?;
        let (value, stderr) = (material.values[place], known.stderr[place]);
        Some(Value { value, stderr })
    };
    [
        parameter("rho_d"),
        parameter("m"),
        at.rho_s_f,
        at.peak.map(|peak| peak.f),
        at.peak.and_then(|peak| peak.width),
        Some(at.reflectance),
    ]
}

/// A sample of a material in plane.
fn sample(material: &Material, theta_i: f64, theta_s: f64, error: f64) -> Sample<f64> {
    let sample = Sample::in_plane(theta_i.to_radians(), theta_s.to_radians(), 1.0);
    let ln_f = material.ln_f(&sample).expect("above the horizon") + error;
    Sample {
        brdf: libm::exp(ln_f),
        ..sample
    }
}
