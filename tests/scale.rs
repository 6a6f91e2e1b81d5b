//! Scans and weights of any size have the same fit, in the unit of the scan.

use brdfit::engine::models::MODELS;
use brdfit::engine::{self, FitOptions, Material, Model, Outcome, Precision, joint};
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use brdfit_suite::program::{SCENE, brdfit, succeed, write};
use brdfit_suite::tolerance::{self, check};
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use serde_json::Value;

/// A metal with noise of 3 % at two angles of incidence.
fn scan() -> Vec<Sample<f64>> {
    let material = Material::paper([0.05, 0.8, 0.0, 0.25, 1.4, 3.0]);
    let mut runner = TestRunner::new_with_rng(
        ProptestConfig::default(),
        TestRng::deterministic_rng(RngAlgorithm::ChaCha),
    );
    let mut noise = || {
        let tree = (-0.05..0.05f64).new_tree(&mut runner).expect("a number");
        proptest::strategy::ValueTree::current(&tree)
    };
    let directions = [20.0f64, 60.0].into_iter().flat_map(|theta_i| {
        let all = (-80..=80).step_by(2);
        all.map(move |theta_s| (theta_i.to_radians(), f64::from(theta_s).to_radians()))
    });
    let one = |(theta_i, theta_s)| {
        let sample = Sample::in_plane(theta_i, theta_s, 1.0);
        let ln_f = material.ln_f(&sample).expect("above the horizon");
        Sample::in_plane(theta_i, theta_s, Real::portable_exp(ln_f + noise()))
    };
    directions.map(one).collect()
}

fn scaled(samples: &[Sample<f64>], brdf: f64, weight: f64) -> Vec<Sample<f64>> {
    let one = |sample: &Sample<f64>| Sample {
        brdf: sample.brdf * brdf,
        weight: sample.weight * weight,
        ..*sample
    };
    samples.iter().map(one).collect()
}

/// Without bounds on weights from above, as a scan in any unit needs.
fn open(precision: Precision) -> FitOptions {
    let mut options = FitOptions {
        precision,
        ..FitOptions::default()
    };
    for place in 0..3 {
        options.upper[place] = 1e305;
    }
    options.upper[2] = 0.0;
    if precision == Precision::F32 {
        // Single precision does not tell these two and rho_s from each other.
        (options.lower[4], options.upper[4]) = (1.4, 1.4);
        (options.lower[5], options.upper[5]) = (3.0, 3.0);
    }
    options
}

fn size(place: usize, brdf: f64) -> f64 {
    if Model::paper().parameters[place].is_weight() {
        brdf
    } else {
        1.0
    }
}

/// The largest relative difference of parameters, in the unit of the scan; of kappa that of its square, as it is fitted.
fn difference(found: &Outcome, expected: &Outcome, brdf: f64) -> f64 {
    let fitted = |outcome: &Outcome, k: usize| match Model::paper().parameters[k].is_squared() {
        true => outcome.params[k] * outcome.params[k],
        false => outcome.params[k],
    };
    largest(found, expected, brdf, fitted)
}

/// The same of standard errors.
fn difference_of_errors(found: &Outcome, expected: &Outcome, brdf: f64) -> f64 {
    largest(found, expected, brdf, |outcome, k| outcome.uncertainty.stderr[k])
}

fn largest(found: &Outcome, expected: &Outcome, brdf: f64, of: impl Fn(&Outcome, usize) -> f64) -> f64 {
    let each = (0..found.params.len()).map(|k| match (of(found, k), of(expected, k)) {
        (a, 0.0) => a.abs(),
        (a, b) => (a / size(k, brdf) / b - 1.0).abs(),
    });
    each.fold(0.0, f64::max)
}

/// Powers of ten of either sign.
fn powers(step: usize, most: i32) -> impl Iterator<Item = f64> {
    (-most..=most)
        .step_by(step)
        .map(|power| format!("1e{power}").parse().expect("a number"))
}

#[test]
fn the_size_of_f_changes_weights_alone() {
    let samples = scan();
    for (precision, most, step, tolerance, of_errors) in [
        (
            Precision::F64,
            300,
            25,
            tolerance::SCALED_F64,
            tolerance::SCALED_ERRORS_F64,
        ),
        (Precision::F32, 30, 5, tolerance::SCALED_F32, tolerance::SCALED_F32),
    ] {
        let options = open(precision);
        let expected = engine::fit(&samples, &options).expect("a scan");
        let (mut worst, mut worst_error) = (0.0f64, 0.0f64);
        for size in powers(step, most) {
            let found = engine::fit(&scaled(&samples, size, 1.0), &options).expect("a scan");
            worst = worst.max(difference(&found, &expected, size));
            worst_error = worst_error.max(difference_of_errors(&found, &expected, size));
            assert_eq!(found.at_bound, expected.at_bound, "{size}");
        }
        check(worst, tolerance);
        check(worst_error, of_errors);
    }
}

#[test]
fn bounds_that_nobody_gave_are_in_the_unit_of_the_scan() {
    let samples = scan();
    let mut options = FitOptions::default();
    let expected = engine::fit(&samples, &options).expect("a scan");
    for size in [1e-300, 1e-30, 1e30, 1e300] {
        let found = engine::fit(&scaled(&samples, size, 1.0), &options).expect("a scan");
        assert!(
            tolerance::SCALED_F64.admits(difference(&found, &expected, size)),
            "{size}"
        );
    }
    // Bounds that somebody gave are of the numbers in the file.
    options.upper[0] = 0.02;
    let bounded = engine::fit(&samples, &options).expect("a scan");
    assert_eq!(bounded.params[0], 0.02);
    options.upper[0] = 0.02e-40;
    let found = engine::fit(&scaled(&samples, 1e-40, 1.0), &options).expect("a scan");
    assert!(found.at_bound.contains(&"rho_d"));
    assert!((found.params[0] / 0.02e-40 - 1.0).abs() < 1e-15);
}

#[test]
fn the_size_of_weights_changes_the_cost_alone() {
    let samples = scan();
    for (precision, most) in [(Precision::F64, 150), (Precision::F32, 30)] {
        let options = open(precision);
        let expected = engine::fit(&samples, &options).expect("a scan");
        for exponent in [-most, -most / 2, most / 2, most] {
            // Powers of two keep every bit.
            let weight = libm::ldexp(1.0, 3 * exponent);
            let found = engine::fit(&scaled(&samples, 1.0, weight), &options).expect("a scan");
            assert_eq!(found.params, expected.params);
            assert_eq!(found.uncertainty.stderr, expected.uncertainty.stderr);
            assert_eq!(found.cost, expected.cost * weight * weight);
            assert_eq!(found.uncertainty.scale, expected.uncertainty.scale * weight);
        }
    }
}

#[test]
fn ordinary_scans_are_left_alone() {
    use engine::scale::Scale;
    let samples = scan();
    let of = |brdf: f64, weight: f64| Scale::of(&[&scaled(&samples, brdf, weight)], &FitOptions::default());
    for size in [1e-8, 1e-3, 1.0, 1e3, 1e8] {
        assert_eq!(of(size, 1.0 / size), None, "{size}");
    }
    assert!(of(1e-12, 1.0).is_some_and(|scale| scale.weight == 0));
    assert!(of(1.0, 1e10).is_some_and(|scale| scale.brdf == 0));
    // One sample that is dark beyond measure leaves the scan what it is.
    let mut one = samples.clone();
    one[7].brdf = 1e-200;
    assert_eq!(Scale::of(&[&one], &FitOptions::default()), None);
}

#[test]
fn a_joint_fit_and_a_fit_that_leaves_out_outliers_have_no_size_either() {
    let mut samples = scan();
    samples[30].brdf *= 20.0;
    let options = FitOptions {
        robust: true,
        ..open(Precision::F64)
    };
    let expected = engine::fit(&samples, &options).expect("a scan");
    let found = engine::fit(&scaled(&samples, 1e-250, 1.0), &options).expect("a scan");
    assert_eq!(
        found.robust.as_ref().map(|robust| &robust.outliers),
        expected.robust.as_ref().map(|robust| &robust.outliers)
    );
    assert!(tolerance::SCALED_F64.admits(difference(&found, &expected, 1e-250)));

    let both = [scan(), scaled(&scan(), 0.5, 1.0)];
    let shared = [false, false, false, true, true, true];
    let fit = |size: f64| {
        let scans: Vec<_> = both.iter().map(|samples| scaled(samples, size, 1.0)).collect();
        let scans: Vec<_> = scans.iter().map(|samples| &samples[..]).collect();
        joint::fit(&scans, &shared, &open(Precision::F64)).expect("two scans")
    };
    let (one, other) = (fit(1.0), fit(1e280));
    for scan in 0..2 {
        for place in (0..6).filter(|&place| one.scans[scan][place] != 0.0) {
            let ratio = other.scans[scan][place] / one.scans[scan][place] / size(place, 1e280);
            assert!(tolerance::SCALED_F64.admits((ratio - 1.0).abs()), "{place}: {ratio}");
            let errors = [one.errors[scan][place], other.errors[scan][place]].map(|error| error.expect("an error"));
            assert!((errors[1] / errors[0] / size(place, 1e280) - 1.0).abs() < 1e-6);
        }
    }
}

/// The whole of what the program says of a scan of another size.
fn fitted(size: &str, options: &[&str]) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let simulate = [&SCENE[..], &["--noise", "0.02", "--seed", "1"]].concat();
    let table = succeed(&simulate);
    let lines = table.lines().map(|line| match line.rsplit_once(',') {
        Some((angles, value)) if value.parse::<f64>().is_ok() => {
            let value: f64 = value.parse().expect("a number");
            format!("{angles},{:e}\n", value * size.parse::<f64>().expect("a number"))
        }
        _ => format!("{line}\n"),
    });
    let file = write(&folder, "scan.csv", lines.collect::<String>());
    let ran = brdfit(&[&["fit", &file, "--format", "json"], options].concat(), b"");
    assert_eq!(ran.code, 0, "{}", ran.errors);
    serde_json::from_str(&ran.output).expect("JSON")
}

#[test]
fn errors_and_derived_quantities_have_the_unit_of_the_scan() {
    let expected = fitted("1", &[]);
    let mut worst: f64 = 0.0;
    for size in ["1e-300", "1e-100", "1e100", "1e300"] {
        let found = fitted(size, &["--value-unit", "plain"]);
        let size: f64 = size.parse().expect("a number");
        let at = |fit: &Value, path: &str| fit.pointer(path).and_then(Value::as_f64);
        for (path, size) in [
            ("/parameters/rho_d", size),
            ("/parameters/m", 1.0),
            ("/uncertainty/stderr/rho_d", size),
            ("/uncertainty/stderr/m", 1.0),
            ("/derived/0/reflectance/value", size),
            ("/derived/0/reflectance/stderr", size),
            ("/derived/0/peak_brdf_per_sr/value", size),
            ("/derived/0/peak_brdf_per_sr/stderr", size),
            ("/derived/1/width_deg/value", 1.0),
        ] {
            let pair = [&found, &expected].map(|fit| at(fit, path).unwrap_or_else(|| panic!("no {path}: {fit:#}")));
            worst = worst.max((pair[0] / size / pair[1] - 1.0).abs());
        }
        let hints = found["hints"].as_array().expect("hints");
        assert!(hints.iter().any(|hint| hint["about"] == "unit"), "{hints:?}");
        assert_eq!(
            found["uncertainty"]["undetermined"],
            expected["uncertainty"]["undetermined"]
        );
    }
    check(worst, tolerance::SCALED_OUTPUT);
}

/// Every model with a weight, whose f is linear in all weights together, in any unit: Sandford and Robertson's alone has none, as what it emits is an absolute part of 1.
#[test]
fn every_model_has_a_fit_of_any_size() {
    let samples = scan();
    let (mut worst, mut of) = (0.0f64, "");
    for model in &MODELS {
        let mut options = FitOptions::of(model);
        for (place, parameter) in model.parameters.iter().enumerate() {
            if parameter.is_weight() {
                options.upper[place] = 1e305;
            }
        }
        let without = !model.parameters.iter().any(|parameter| parameter.is_weight());
        assert_eq!(without, model.name == "sandford-robertson", "{}", model.name);
        if without {
            continue;
        }
        let expected = engine::fit(&samples, &options).expect("a scan");
        for size in ["1e-300", "1e-30", "1e300"] {
            let size: f64 = size.parse().expect("a number");
            let found = engine::fit(&scaled(&samples, size, 1.0), &options).expect("a scan");
            let apart = (found.cost / expected.cost - 1.0).abs();
            println!("{} {size:e}: cost {apart:.1e}", model.name);
            if apart > worst {
                (worst, of) = (apart, model.name);
            }
        }
    }
    println!("{of}: {worst}");
    check(worst, tolerance::SCALED_COST);
}
