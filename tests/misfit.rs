//! Errors under correlated residuals: coverage of the truth of simulated scans, and what the output says of it.
#![allow(
    clippy::disallowed_methods,
    reason = "oracles may use std's functions; the code under test may not"
)]

use std::sync::atomic::{AtomicBool, Ordering};

use brdfit::analysis::bootstrap::{Noise, bootstrap};
use brdfit::analysis::derived::{self, Derived, Value};
use brdfit::analysis::misfit::{coverage_factor, lines, uncertainty};
use brdfit::engine::{self, FitOptions, Material, Model, Until};
use brdfit::input::{ReadOptions, parse};
use brdfit::until::give_up;
use brdfit_core::brdf::{DIFFUSE, SURFACE};
use brdfit_core::geometry::Sample;
use brdfit_suite::scan::{left_out, scan, shared};

#[test]
fn lines_are_what_one_angle_of_incidence_has_in_one_plane() {
    let at = |theta_i: f64, theta_s: f64, delta_phi: f64| Sample {
        theta_i,
        theta_s,
        delta_phi,
        brdf: 1.0,
        weight: 1.0,
    };
    let pi = std::f64::consts::PI;
    let samples = [
        at(0.5, 0.2, pi),
        at(0.7, 0.1, pi),
        at(0.5, 0.4, 0.0),
        at(0.5, 0.1, pi),
        Sample {
            weight: 0.0,
            ..at(0.5, 0.3, pi)
        },
        at(0.5, 0.3, -pi),
        at(0.7, 0.2, pi),
    ];
    let places: Vec<Vec<usize>> = lines::of(&samples)
        .iter()
        .map(|line| line.iter().map(|&(place, _)| place).collect())
        .collect();
    assert_eq!(places, [vec![2, 3, 0, 5], vec![1, 6]]);
    // Around a cone every plane has one sample, and the cone is the line.
    let cone: Vec<_> = (0..20).map(|k| at(0.5, 0.6, 0.1 + 0.1 * f64::from(k))).collect();
    assert_eq!(lines::of(&cone).len(), 1);
}

const TRUTH: [f64; 6] = [0.05, 1.0, 0.0, 0.2, 1.5, 0.0];

/// rho_d, rho_s and m of a scan of three angles of incidence, whose ln f has errors of 5 % that are correlated over so many degrees.
fn measured(length: f64, copy: u64) -> (Vec<Sample<f64>>, FitOptions) {
    let truth = Material::paper(TRUTH);
    let mut noise = Noise::new(3, copy);
    let mut samples = Vec::new();
    for theta_i in [20.0f64, 45.0, 60.0] {
        let mut error = noise.normal();
        for theta_s in (-84..=84).step_by(2) {
            let kept = if length > 0.0 { (-2.0 / length).exp() } else { 0.0 };
            error = kept * error + (1.0 - kept * kept).sqrt() * noise.normal();
            let sample = Sample::in_plane(theta_i.to_radians(), f64::from(theta_s).to_radians(), 1.0);
            let ln_f = truth.ln_f(&sample).unwrap() + 0.05 * error;
            samples.push(Sample {
                brdf: ln_f.exp(),
                ..sample
            });
        }
    }
    let mut options = FitOptions {
        terms: DIFFUSE | SURFACE,
        ..FitOptions::default()
    };
    (options.lower[4], options.upper[4]) = (1.5, 1.5);
    (samples, options)
}

/// How many of the copies have 95 % intervals that hold the actual rho_d and m, and how many are taken for correlated.
fn covered(length: f64, copies: u64) -> (u64, u64, [u64; 2]) {
    let (mut correlated, mut held, mut plain) = (0, 0, [0; 2]);
    for copy in 0..copies {
        let (samples, options) = measured(length, copy);
        let outcome = engine::fit(&samples, &options).unwrap();
        let known = uncertainty(&samples, &options, &outcome);
        correlated += u64::from(known.misfit.is_some());
        if known.misfit.is_none() {
            assert_eq!(known, outcome.uncertainty);
        }
        for (k, place) in [0, 3].into_iter().enumerate() {
            let error = (outcome.params[place] - TRUTH[place]).abs();
            held += u64::from(error <= coverage_factor(&known) * known.stderr[place]);
            let independent = &outcome.uncertainty;
            plain[k] += u64::from(error <= coverage_factor(independent) * independent.stderr[place]);
        }
    }
    (correlated, held, plain)
}

#[test]
fn intervals_hold_the_truth_under_correlated_errors() {
    let copies = 60;
    let (correlated, held, plain) = covered(8.0, copies);
    assert_eq!(correlated, copies);
    // Of 120 intervals 114 are expected, and independent errors would hold half of it.
    assert!((108..=119).contains(&held), "{held}");
    assert!(plain.iter().all(|&held| held < 45), "{plain:?}");
}

#[test]
fn errors_that_nobody_waits_for_are_not_computed() {
    static OVER: AtomicBool = AtomicBool::new(false);
    let (samples, options) = measured(8.0, 1);
    let outcome = engine::fit(&samples, &options).unwrap();
    give_up(Until::set(&OVER));
    let known = uncertainty(&samples, &options, &outcome);
    assert!(known.misfit.is_some());
    OVER.store(true, Ordering::Relaxed);
    assert!(uncertainty(&samples, &options, &outcome).misfit.is_none());
    OVER.store(false, Ordering::Relaxed);
    assert_eq!(uncertainty(&samples, &options, &outcome), known);
}

#[test]
fn independent_errors_hardly_grow() {
    let copies = 60;
    let (correlated, held, plain) = covered(0.0, copies);
    assert!(correlated <= 24, "{correlated}");
    assert!((108..=119).contains(&held), "{held}");
    assert!(held >= plain.iter().sum());
    let grown = (0..copies).map(|copy| {
        let (samples, options) = measured(0.0, copy);
        let outcome = engine::fit(&samples, &options).unwrap();
        let expanded = |known: &engine::uncertainty::Uncertainty| coverage_factor(known) * known.stderr[0];
        expanded(&uncertainty(&samples, &options, &outcome)) / expanded(&outcome.uncertainty)
    });
    let mean = grown.sum::<f64>() / copies as f64;
    println!("{correlated} of {copies} are taken for correlated; intervals are {mean:.3} times as wide in the mean");
    assert!(mean < 1.05, "{mean}");
}

/// A wander of 15 degrees that is a third of the variance beside white noise: hard to see, and errors are three times as large for it.
#[test]
fn a_wander_under_white_noise_is_counted() {
    let copies = 60;
    let (mut held, mut plain) = (0, 0);
    for copy in 0..copies {
        let (mut samples, options) = measured(15.0, copy);
        let mut noise = Noise::new(31, copy);
        let white = 0.05 * f64::sqrt(0.7 / 0.3);
        for sample in &mut samples {
            sample.brdf *= (white * noise.normal()).exp();
        }
        let outcome = engine::fit(&samples, &options).unwrap();
        let known = uncertainty(&samples, &options, &outcome);
        let error = (outcome.params[0] - TRUTH[0]).abs();
        held += u64::from(error <= coverage_factor(&known) * known.stderr[0]);
        let independent = &outcome.uncertainty;
        plain += u64::from(error <= coverage_factor(independent) * independent.stderr[0]);
    }
    println!("rho_d: {held} of {copies} held, {plain} by independent errors");
    assert!(held >= 54 && plain <= 48, "{held}, {plain}");
}

/// Copies of a scan whose residuals are correlated have such errors too, and spread as far as its errors say.
#[test]
fn copies_of_a_correlated_scan_are_correlated() {
    let spread = |copies: &[engine::Values], place: usize| {
        let mean = copies.iter().map(|values| values[place]).sum::<f64>() / copies.len() as f64;
        let squares = copies.iter().map(|values| (values[place] - mean).powi(2));
        (squares.sum::<f64>() / (copies.len() - 1) as f64).sqrt()
    };
    let (mut of_correlated, mut of_independent) = (0.0, 0.0);
    for copy in 0..6 {
        let (samples, options) = measured(8.0, copy);
        let independent = engine::fit(&samples, &options).unwrap();
        let mut outcome = independent.clone();
        outcome.uncertainty = uncertainty(&samples, &options, &outcome);
        let stderr = outcome.uncertainty.stderr[0];
        of_correlated += spread(&bootstrap(&samples, &options, &outcome, 60).unwrap(), 0) / stderr / 6.0;
        of_independent += spread(&bootstrap(&samples, &options, &independent, 60).unwrap(), 0) / stderr / 6.0;
    }
    println!("spread of copies over the standard error: {of_correlated:.3}, of independent ones {of_independent:.3}");
    assert!((0.75..1.25).contains(&of_correlated), "{of_correlated}");
    assert!(of_independent < 0.6, "{of_independent}");
}

/// A surface with GGX's facets whose lobe is fitted with Beckmann's: the width of that is another, and its error says so.
#[test]
fn the_width_of_another_lobe_is_within_its_error() {
    let model = Model::find("ggx").unwrap();
    let (mut held, mut alone, mut count) = (0, 0, 0);
    for copy in 0..40 {
        let mut noise = Noise::new(12, copy);
        let mut truth = Material {
            model,
            values: model.lower(),
        };
        for (name, value) in [("rho_d", 0.05), ("rho_s", 1.0), ("n", 1.5)] {
            truth = truth.with(name, value);
        }
        truth = truth.with("m", 0.06 + 0.12 * noise.unit());
        let at = |degrees: i32| Sample::in_plane(30f64.to_radians(), f64::from(degrees).to_radians(), 1.0);
        let samples: Vec<Sample<f64>> = (-84..=84)
            .map(|degrees| Sample {
                brdf: (truth.ln_f(&at(degrees)).unwrap() + 0.01 * noise.normal()).exp(),
                ..at(degrees)
            })
            .collect();
        let options = measured(0.0, 0).1;
        let mut outcome = engine::fit(&samples, &options).unwrap();
        let plain = derived::at_each_angle(&samples, outcome.view(), &outcome.uncertainty)[0];
        assert!(plain.peak.unwrap().from_data.is_none());
        outcome.uncertainty = uncertainty(&samples, &options, &outcome);
        let known = &outcome.uncertainty;
        let width = |at: &Derived| at.peak.and_then(|peak| peak.width);
        let actual = derived::at(at(0).theta_i, &truth, known);
        let found = derived::at_each_angle(&samples, outcome.view(), known)[0];
        let by_parameters = derived::at(at(0).theta_i, &outcome.material(), known);
        // A lobe that never falls to half has no width.
        let (Some(actual), Some(got), Some(without)) = (width(&actual), width(&found), width(&by_parameters)) else {
            continue;
        };
        count += 1;
        assert_eq!(got.value, without.value);
        let read = found.peak.unwrap().from_data.unwrap().width.unwrap();
        assert!((read.value / actual.value - 1.0).abs() < 0.1, "{read:?} {actual:?}");
        let within = |width: Value| {
            let away = (width.value - actual.value).abs();
            u32::from(away <= coverage_factor(known) * width.stderr)
        };
        (held, alone) = (held + within(got), alone + within(without));
    }
    println!("widths: {held} of {count} held, {alone} by the errors of parameters");
    assert!(count >= 30 && 10 * held >= 9 * count && 2 * alone <= count);
}

/// Two runs of one paint on one instrument: apart by many of the errors of independent residuals, and no more than by their own.
#[test]
fn runs_of_one_paint_agree_within_their_errors() {
    let run = |number: u32| shared(&format!("real/rt300s_aeroglaze_z307_run{number}.csv"));
    if !run(1).exists() || !run(2).exists() {
        return left_out("runs of one paint", &run(1));
    }
    let known = [1, 2].map(|number| {
        let samples = scan(&run(number));
        let options = FitOptions::default();
        let outcome = engine::fit(&samples, &options).unwrap();
        let known = uncertainty(&samples, &options, &outcome);
        (outcome.params, outcome.uncertainty, known)
    });
    let [(a, a_plain, a_known), (b, b_plain, b_known)] = &known;
    for place in [0, 3] {
        let apart = (a[place] - b[place]).abs();
        let expanded = |known: &engine::uncertainty::Uncertainty| coverage_factor(known) * known.stderr[place];
        assert!(apart < expanded(a_known).hypot(expanded(b_known)), "{place}: {apart}");
        assert!(apart > expanded(a_plain).hypot(expanded(b_plain)), "{place}: {apart}");
    }
}

/// A misfit over tens of degrees says little of a narrow lobe, even where n ends on its bound: made with m = 0.02.
#[test]
fn a_wandering_misfit_leaves_a_narrow_lobe_known() {
    let path = shared("cases/fit/f08_robust_drops_lobe.csv");
    if !path.exists() {
        return left_out("a scan whose misfit wanders", &path);
    }
    let bytes = std::fs::read(&path).unwrap();
    let samples = parse("f08", &bytes, &ReadOptions::default()).unwrap().remove(0).samples;
    let options = FitOptions {
        robust: true,
        ..FitOptions::default()
    };
    let outcome = engine::fit(&samples, &options).unwrap();
    let kept = engine::robust::kept(&samples, &outcome);
    let known = uncertainty(&kept, &options, &outcome);
    let [rho_d, m] = [0, 3].map(|place| (outcome.params[place], known.stderr[place]));
    println!("rho_d {rho_d:?}, m {m:?}, {:?}", known.misfit);
    assert!(
        (m.0 - 0.02).abs() < coverage_factor(&known) * m.1 && m.1 < 0.001,
        "{m:?}"
    );
    // What is Lambert's is as uncertain as the misfit makes it.
    assert!(rho_d.1 > 20.0 * outcome.uncertainty.stderr[0], "{rho_d:?}");
}

/// Scans of a narrow lobe whose ln f has a wave of 5 %: m is known to a few percent, and its intervals hold.
#[test]
fn a_lobe_under_a_wave_is_held_by_its_intervals() {
    let truth = Material::paper([0.2, 0.5, 0.0, 0.05, 1.3, 0.0]);
    let (mut held, mut errors) = (0, Vec::new());
    for copy in 0..30 {
        let mut noise = Noise::new(8, copy);
        let (phase, size) = (6.3 * noise.unit(), 0.07 * noise.normal());
        let samples: Vec<Sample<f64>> = (-80..=80)
            .map(|degrees| {
                let sample = Sample::in_plane(30f64.to_radians(), f64::from(degrees).to_radians(), 1.0);
                let wave = size * (4.0 * sample.theta_s + phase).sin() + 0.01 * noise.normal();
                Sample {
                    brdf: (truth.ln_f(&sample).unwrap() + wave).exp(),
                    ..sample
                }
            })
            .collect();
        let options = FitOptions {
            terms: DIFFUSE | SURFACE,
            ..FitOptions::default()
        };
        let outcome = engine::fit(&samples, &options).unwrap();
        let known = uncertainty(&samples, &options, &outcome);
        let error = (outcome.params[3] - 0.05).abs();
        held += u64::from(error <= coverage_factor(&known) * known.stderr[3]);
        errors.push(known.stderr[3] / 0.05);
    }
    errors.sort_by(f64::total_cmp);
    println!(
        "{held} of 30 held, errors of m from {:.4} to {:.4}, median {:.4}",
        errors[0], errors[29], errors[15]
    );
    assert!(held >= 26, "{held}");
    assert!(errors[15] < 0.1, "{errors:?}");
}
