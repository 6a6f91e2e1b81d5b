//! Profile likelihood and bootstrap: intervals against brute force, against the quadratic ones where those are right, and at bounds; the command's contract.
#![allow(
    clippy::disallowed_methods,
    reason = "oracles may use std's functions; the code under test may not"
)]

use brdfit::analysis::bootstrap::{Noise, bootstrap, copy, quantile};
use brdfit::analysis::misfit;
use brdfit::analysis::profile::calibrate::{LEVELS, thresholds};
use brdfit::analysis::profile::{Profile, calibrate::threshold, hold::hold, profile};
use brdfit::engine::{self, FitOptions, Material, Outcome, Values};
use brdfit_core::geometry::Sample;
use brdfit_suite::program;
use brdfit_suite::scan::{data, scan};
use brdfit_suite::tolerance::{self, check};
use serde_json::Value;

fn fitted(name: &str) -> (Vec<Sample<f64>>, FitOptions, Outcome) {
    let samples = scan(&data(name));
    let options = FitOptions::default();
    let outcome = engine::fit(&samples, &options).unwrap();
    (samples, options, outcome)
}

/// The cost of a search with one parameter held, and nothing else known.
fn searched(samples: &[Sample<f64>], options: &FitOptions, index: usize, value: f64) -> f64 {
    let with = |params: &Values| {
        let mut all = *params;
        all[index] = value;
        all
    };
    let options = FitOptions {
        lower: with(&options.lower),
        upper: with(&options.upper),
        seed: 99,
        ..*options
    };
    engine::fit(samples, &options).unwrap().cost
}

#[test]
fn quantiles_of_student() {
    // Any table of Student's t.
    for (degrees, quantile) in [(10, 2.228_138_85), (120, 1.979_930_41)] {
        assert!(tolerance::STUDENT.admits((threshold(0.95, degrees as f64).sqrt() - quantile).abs()));
    }
}

#[test]
fn intervals_end_where_the_cost_has_risen() {
    let (mut ends, mut points, mut quadratic) = (0.0f64, 0.0f64, 0.0f64);
    for name in ["testdata1_sym_seed1.csv", "testdata2_sym_seed1.csv"] {
        let (samples, options, outcome) = fitted(name);
        let degrees = outcome.uncertainty.degrees_of_freedom;
        for index in [0, 1, 3] {
            let profile = profile(&samples, &options, &outcome, index, 0, None).unwrap();
            for interval in profile.intervals {
                for end in [interval.low, interval.high] {
                    assert!(!end.at_bound);
                    let cost = searched(&samples, &options, index, end.value);
                    let rise = (cost / profile.best.cost - 1.0) * degrees as f64;
                    let place = LEVELS.iter().position(|&level| level == interval.level).unwrap();
                    let part = rise / profile.limits[place] - 1.0;
                    // The search may miss what the profile came by, but must not find less.
                    assert!(tolerance::INTERVAL_BELOW.admits(-part), "{part}");
                    ends = ends.max(part);
                }
            }
            for point in profile.points.iter().step_by(7) {
                let cost = searched(&samples, &options, index, point.value);
                points = points.max(point.cost / cost - 1.0);
            }
            // rho_d is as good as linear.
            if index == 0 {
                let half = 0.5 * (profile.intervals[1].high.value - profile.intervals[1].low.value);
                let known = misfit::uncertainty(&samples, &options, &outcome);
                let expected = misfit::coverage_factor(&known) * known.stderr[0];
                quadratic = quadratic.max((half / expected - 1.0).abs());
            }
        }
    }
    check(ends, tolerance::INTERVAL_END);
    assert!(
        tolerance::PROFILE_POINT.admits(points),
        "a search beats the profile by {points:e}"
    );
    check(quadratic, tolerance::INTERVAL_QUADRATIC);
}

#[test]
fn flat_valleys_end_at_the_bounds() {
    let (samples, options, outcome) = fitted("testdata1_sym_seed1.csv");
    let n = profile(&samples, &options, &outcome, 4, 0, None).unwrap();
    let both = |profile: &Profile| profile.intervals.map(|at| (at.low.at_bound, at.high.at_bound));
    assert_eq!(both(&n), [(true, true); 2]);
    assert_eq!((n.intervals[1].low.value, n.intervals[1].high.value), (1.0, 100.0));
    // The actual value, 7 standard errors of nothing away, is as good as any.
    let actual = hold(&samples, &options, &outcome, 4, 3.0).unwrap();
    assert!(n.rise(&actual) < 1.0);
    // An optimum on a bound: that is an end.
    let (samples, options, outcome) = fitted("testdata3_sym_seed1.csv");
    assert_eq!(outcome.params[5], 0.0);
    let kappa = profile(&samples, &options, &outcome, 5, 0, None).unwrap();
    assert!(kappa.intervals[0].low.at_bound && kappa.intervals[0].low.value == 0.0);
    // A narrow range is respected.
    let mut narrow = options;
    (narrow.lower[3], narrow.upper[3]) = (0.00495, 0.0050);
    let outcome = engine::fit(&samples, &narrow).unwrap();
    let m = profile(&samples, &narrow, &outcome, 3, 0, None).unwrap();
    assert_eq!(both(&m), [(true, true); 2]);
    assert!(m.points.iter().all(|point| (0.00495..=0.0050).contains(&point.value)));
}

#[test]
fn copies_are_seeded_and_spread_as_the_standard_errors() {
    let (samples, options, outcome) = fitted("testdata1_sym_seed1.csv");
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| bootstrap(&samples, &options, &outcome, 400).unwrap())
    };
    let copies = on(2);
    assert_eq!(copies, on(1));
    assert_ne!(
        copies[0],
        bootstrap(&samples, &FitOptions { seed: 1, ..options }, &outcome, 1).unwrap()[0]
    );
    // m spreads less than its standard error says, for n and kappa have bounds.
    let values: Vec<f64> = copies.iter().map(|params| params[0]).collect();
    let mean = values.iter().sum::<f64>() / 400.0;
    let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / 399.0;
    check(
        (variance.sqrt() / outcome.uncertainty.stderr[0] - 1.0).abs(),
        tolerance::BOOTSTRAP,
    );
    assert_eq!(quantile(&[3.0, 1.0, 2.0], 0.5), 2.0);
    assert_eq!(quantile(&[3.0, 1.0, 2.0], 0.25), 1.5);
    assert!(quantile(&[], 0.5).is_nan());
    // Noise is of the size that is asked for, and less where a sample weighs more.
    let flat: Vec<Sample<f64>> = (0..4000)
        .map(|k| Sample {
            weight: if k < 2000 { 1.0 } else { 2.0 },
            ..Sample::in_plane(0.5, 0.2, 1.0)
        })
        .collect();
    let grey = Material::paper([std::f64::consts::PI, 0.0, 0.0, 0.1, 1.5, 0.0]);
    let noisy = copy(&flat, &grey, 0.1, &mut Noise::new(1, 2));
    let mut largest = 0.0f64;
    for (part, expected) in noisy.chunks(2000).zip([0.1, 0.05]) {
        let squares: f64 = part.iter().map(|sample| sample.brdf.ln() * sample.brdf.ln()).sum();
        largest = largest.max(((squares / 2000.0).sqrt() / expected - 1.0).abs());
    }
    check(largest, tolerance::NOISE_SIZE);
}

#[test]
fn measured_thresholds_are_those_of_f_where_the_model_is_linear() {
    let of = |name: &str, index: usize| {
        let (samples, options, outcome) = fitted(name);
        let scale = outcome.uncertainty.scale;
        let found = thresholds(&samples, &options, index, &outcome.params, scale, 100).unwrap();
        found[1] / threshold(0.95, outcome.uncertainty.degrees_of_freedom as f64)
    };
    check((of("testdata1_sym_seed1.csv", 0) - 1.0).abs(), tolerance::CALIBRATED);
    // m cannot go where n and kappa would have to leave their bounds.
    let m = of("testdata2_sym_seed1.csv", 3);
    println!("m of test data 2: {m:.3} of F's threshold");
    assert!(m < 0.9);
}

#[test]
fn command() {
    let file = data("testdata2_sym_seed1.csv");
    let file = file.to_str().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let svg = folder.path().join("profile.svg");
    let svg = svg.to_str().unwrap();
    let arguments = ["profile", file, "--parameter", "rho_d,kappa", "--bootstrap", "20"];
    let ran = program::brdfit(&[&arguments[..], &["--plot", svg]].concat(), b"");
    assert_eq!((ran.code, ran.errors.as_str()), (0, ""));
    assert!(ran.output.contains("  kappa ") && ran.output.contains("(bound)") && ran.output.contains("20 copies"));
    assert!(!ran.output.contains("  rho_s "));
    let drawn = std::fs::read_to_string(svg).unwrap();
    assert!(drawn.ends_with("</svg>\n") && drawn.matches("translate(").count() == 2 && !drawn.contains("NaN"));
    let calibrated = [&arguments[..4], &["--calibrate", "20", "--format", "json"]].concat();
    let calibrated: Value = serde_json::from_str(&program::brdfit(&calibrated, b"").output).unwrap();
    let ran = program::brdfit(&[&arguments[..], &["--format", "json"]].concat(), b"");
    let json: Value = serde_json::from_str(&ran.output).unwrap();
    let rho_d = &json["parameters"][0];
    assert_eq!(rho_d["name"], "rho_d");
    let ends = &rho_d["intervals"][1];
    assert_eq!((&ends["level"], &ends["low_at_bound"]), (&0.95.into(), &false.into()));
    assert!(ends["low"].as_f64() < rho_d["best"].as_f64() && rho_d["best"].as_f64() < ends["high"].as_f64());
    assert!(rho_d["points"].as_array().unwrap().len() > 10);
    assert_eq!(
        (&json["calibrated"], &calibrated["calibrated"]),
        (&Value::Null, &20.into())
    );
    let (low, again) = (&ends["low"], &calibrated["parameters"][0]["intervals"][1]["low"]);
    assert!(low != again && again.as_f64() < rho_d["best"].as_f64());
    assert_eq!(
        (&json["bootstrap"]["copies"], &json["bootstrap"]["seed"]),
        (&20.into(), &0.into())
    );
    for (arguments, message) in [
        (
            vec!["profile", file, "--parameter", "x"],
            "'x' is not a free parameter of the terms diffuse,surface,volume,absorbing; the free parameters are rho_d, rho_s",
        ),
        (
            vec!["profile", file, "--parameter", "n", "--fix", "n=1.5"],
            "'n' is not a free parameter",
        ),
        (
            vec!["profile", file, "--parameter", "kappa", "--terms", "diffuse,surface"],
            "the free parameters are rho_d, rho_s, m, n",
        ),
    ] {
        let ran = program::brdfit(&arguments, b"");
        assert_eq!((ran.code, ran.output.as_str()), (2, ""));
        assert!(
            ran.errors.contains(message) && ran.errors.matches('\n').count() == 1,
            "{}",
            ran.errors
        );
    }
    let few = b"theta_i_deg,theta_s_deg,brdf_per_sr\n45,10,0.1\n";
    let ran = program::brdfit(&["profile", "-", "--terms", "diffuse"], few);
    assert_eq!(ran.code, 2);
    assert!(ran.errors.contains("as many parameters as samples"), "{}", ran.errors);
}

/// Without residuals nothing tells an interval.
#[test]
fn an_exact_scan_has_no_intervals() {
    let (_folder, file) = program::scene();
    let arguments = ["profile", &file, "--parameter", "rho_d,m,kappa"];
    let page = program::succeed(&arguments);
    assert!(
        page.contains("The fit is exact") && !page.contains("inf") && !page.contains("e30"),
        "{page}"
    );
    let json = program::succeed(&[&arguments[..], &["--format", "json"]].concat());
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["exact"], true);
    for parameter in json["parameters"].as_array().unwrap() {
        assert_eq!(
            (&parameter["stderr"], &parameter["intervals"][0]["low"]),
            (&Value::Null, &Value::Null)
        );
    }
}
