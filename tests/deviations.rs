//! The standard deviations of a file: no bias from weights or logarithms, and errors that hold, over simulated copies.
#![allow(
    clippy::disallowed_methods,
    reason = "simulated scans may use std's functions; the code under test may not"
)]

use brdfit::analysis::bootstrap::Noise;
use brdfit::analysis::choose::Wanted;
use brdfit::analysis::deviations::{Verdict, settled};
use brdfit::analysis::fit::fit;
use brdfit::analysis::misfit::coverage_factor;
use brdfit::engine::{FitOptions, Material};
use brdfit::input::{ReadOptions, parse};
use brdfit_core::brdf::{DIFFUSE, SURFACE};
use brdfit_core::geometry::Sample;
use brdfit_suite::program;
use brdfit_suite::scan::data;
use serde_json::Value;

const TRUTH: [f64; 6] = [0.1, 1.0, 0.0, 0.2, 1.5, 0.0];

/// A file with the standard deviation of each value.
fn file(absolute: f64, relative: f64, head: &str, copy: u64) -> String {
    let truth = Material::paper(TRUTH);
    let mut noise = Noise::new(5, copy);
    let mut text = format!("theta_i_deg,theta_s_deg,brdf_per_sr,{head}\n");
    for theta_i in [20, 50] {
        for theta_s in -80..=80 {
            let sample = Sample::in_plane(f64::from(theta_i).to_radians(), f64::from(theta_s).to_radians(), 1.0);
            let f = truth.ln_f(&sample).unwrap().exp();
            let sigma = absolute.hypot(relative * f);
            let value = f + sigma * noise.normal();
            let told = if head == "sigma" { sigma } else { relative };
            if value > 0.0 {
                text += &format!("{theta_i},{theta_s},{value},{told}\n");
            }
        }
    }
    text
}

/// Mean pull of rho_d and m, the share of their 95 % intervals that hold the truth, and of scans whose deviations are believed.
fn pulls(absolute: f64, relative: f64, head: &str) -> ([f64; 2], f64, f64) {
    let copies = 60;
    let mut options = FitOptions {
        terms: DIFFUSE | SURFACE,
        ..FitOptions::default()
    };
    (options.lower[4], options.upper[4]) = (1.5, 1.5);
    let wanted = Wanted::One(options);
    let (mut sums, mut held, mut used) = ([0.0; 2], 0.0, 0.0);
    for copy in 0..copies {
        let text = file(absolute, relative, head, copy);
        let measurement = parse("scan.csv", text.as_bytes(), &ReadOptions::default())
            .unwrap()
            .remove(0);
        let measurement = settled(measurement, &wanted);
        let scan = fit(&measurement, &wanted).unwrap();
        let known = &scan.outcome.uncertainty;
        used += f64::from(u8::from(scan.deviations == Some(Verdict::Used)));
        for (sum, place) in sums.iter_mut().zip([0, 3]) {
            let pull = (scan.outcome.params[place] - TRUTH[place]) / known.stderr[place];
            *sum += pull / copies as f64;
            held += 0.5 * f64::from(u8::from(pull.abs() <= coverage_factor(known)));
        }
    }
    (sums, held / copies as f64, used / copies as f64)
}

/// The mean of 60 pulls is known to 0.13, and a share of 95 % to 2 %.
#[test]
fn errors_of_the_file_are_unbiased_and_hold() {
    let cases = [
        (0.004, 0.0, "sigma"),
        (0.0, 0.2, "sigma"),
        (0.002, 0.05, "sigma"),
        (0.0, 0.1, "rel_sigma"),
    ];
    for (absolute, relative, head) in cases {
        let (mean, held, used) = pulls(absolute, relative, head);
        println!("{absolute} {relative} {head}: pulls {mean:?}, held {held}, believed {used}");
        assert!(
            mean.iter().all(|mean| mean.abs() < 0.4),
            "{absolute} {relative}: {mean:?}"
        );
        assert!((0.88..=0.99).contains(&held), "{absolute} {relative}: {held}");
        assert!(used > 0.75, "{absolute} {relative}: {used}");
    }
}

/// Made with rho_d 0.1 and noise of 20 %, which here is 1.7 % high on average; deviations over the measured f gave 0.1078 +- 0.0017.
#[test]
fn weights_are_of_the_fitted_f() {
    let path = data("fit/sigma20.csv");
    let ran = program::brdfit(&["fit", path.to_str().unwrap(), "--format", "json"], b"");
    let fit: Value = serde_json::from_str(&ran.output).unwrap();
    let rho_d = fit["parameters"]["rho_d"].as_f64().unwrap();
    let stderr = fit["uncertainty"]["stderr"]["rho_d"].as_f64().unwrap();
    assert!(
        (rho_d - 0.1017).abs() < 1.5 * stderr && stderr < 0.003,
        "{rho_d} +- {stderr}"
    );
    assert_eq!(fit["deviations"], "used");
}
