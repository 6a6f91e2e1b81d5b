//! What is known of the instrument takes part in a fit, and gives the actual values back where without it they are missed.
#![allow(
    clippy::disallowed_methods,
    reason = "simulated scans may use std's functions; the code under test may not"
)]

use brdfit::analysis::bootstrap::{Noise, copy};
use brdfit::analysis::derived;
use brdfit::analysis::reflectance::reflectance;
use brdfit::engine::{self, FitError, FitOptions, Material, Outcome, Prior, Values, joint};
use brdfit::instrument::ENERGY;
use brdfit_core::brdf::{DIFFUSE, SURFACE};
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use brdfit_suite::program::{brdfit, fail, succeed, write};
use brdfit_suite::scan::{left_out, scan, shared};
use brdfit_suite::tolerance::{self, check};
use serde_json::Value;
use tempfile::TempDir;

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

fn fit(samples: &[Sample<f64>], options: &FitOptions) -> Outcome {
    engine::fit(samples, options).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_prior_tells_what_the_scan_does_not() {
    let (mut pulls, mut free) = (0.0, 0.0);
    const SEEDS: u64 = 20;
    for seed in 0..SEEDS {
        let samples = noisy(&dielectric(), &grid(&[20.0, 40.0], 4, 80), 0.05, seed);
        // The ellipsometer errs too.
        let mean = 1.5 + 0.02 * Noise::new(3, seed).normal();
        let prior = Some(Prior { mean, sigma: 0.02 });
        let with = options(|options| options.instrument.priors[PLACE_N] = prior);
        let (with, without) = (fit(&samples, &with), fit(&samples, &options(|_| ())));
        for (place, actual) in [(1, 0.8), (PLACE_N, 1.5)] {
            let error = with.uncertainty.stderr[place];
            pulls += ((with.params[place] - actual) / error).powi(2) / (2.0 * SEEDS as f64);
        }
        free += (without.params[PLACE_N] - 1.5).abs() / SEEDS as f64;
        assert!(with.uncertainty.stderr[PLACE_N] < 0.0201);
        // What the samples themselves are left with is hardly more.
        assert!(with.rms_ln >= without.rms_ln * (1.0 - 1e-9) && with.rms_ln < 1.05 * without.rms_ln);
        let sigma = with.sigma.expect("what the prior was weighed by");
        assert!((sigma / 0.05 - 1.0).abs() < 0.3, "{sigma}");
    }
    println!("mean squared pull {pulls:.2}; without the prior n is off by {free:.2}");
    assert!((0.5..1.6).contains(&pulls) && free > 0.05);
}

#[test]
fn priors_go_from_nothing_to_a_fixed_value() {
    let samples = noisy(&dielectric(), &grid(&[20.0, 60.0], 4, 80), 0.05, 1);
    let with = |sigma: f64| {
        let prior = Some(Prior { mean: 1.45, sigma });
        fit(&samples, &options(|options| options.instrument.priors[PLACE_N] = prior))
    };
    let fixed = options(|options| (options.lower[PLACE_N], options.upper[PLACE_N]) = (1.45, 1.45));
    let (weak, strong, none, fixed) = (
        with(1e4),
        with(1e-6),
        fit(&samples, &options(|_| ())),
        fit(&samples, &fixed),
    );
    let apart = |a: &Outcome, b: &Outcome| {
        let pairs = a.params.iter().zip(b.params.iter());
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    assert!(apart(&weak, &none) < 1e-4 && apart(&strong, &fixed) < 1e-4);
    // Fewer samples than parameters suffice if priors make up for them.
    let few = &samples[30..33];
    assert_eq!(engine::fit(few, &options(|_| ())), Err(FitError::TooFew(3, 4)));
    let known = options(|options| {
        options.instrument.priors[PLACE_N] = Some(Prior { mean: 1.5, sigma: 0.02 });
        options.instrument.priors[PLACE_M] = Some(Prior {
            mean: 0.15,
            sigma: 0.01,
        });
    });
    assert!((fit(few, &known).params[PLACE_N] - 1.5).abs() < 0.1);
}

#[test]
fn a_prior_of_kappa_is_one_of_kappa() {
    let metal = Material::paper([0.1, 0.5, 0.0, 0.2, 1.2, 3.0]);
    let samples = noisy(&metal, &grid(&[20.0, 50.0], 4, 80), 0.05, 2);
    let with = |mean: f64| {
        let mut options = FitOptions::default();
        options.instrument.priors[5] = Some(Prior { mean, sigma: 0.001 });
        fit(&samples, &options)
    };
    for mean in [3.0, 1.0, 0.0] {
        let found = with(mean);
        assert!((found.params[5] - mean).abs() < 0.02, "{mean}: {:?}", found.params);
    }
}

#[test]
fn an_offset_is_found_with_its_error() {
    let material = Material::paper([0.25, 2.0, 0.0, 0.06, 1.5, 0.0]);
    let (mut pulls, mut worst) = (0.0, 0.0f64);
    const SEEDS: u64 = 10;
    for seed in 0..SEEDS {
        let degrees = [3.0, -2.4, 0.0, 0.7, -6.0][(seed % 5) as usize];
        let clean = noisy(&material, &grid(&[30.0, 50.0], 2, 80), 0.02, seed);
        let read = clean.iter().map(|sample| Sample {
            theta_s: sample.theta_s + f64::to_radians(degrees),
            ..*sample
        });
        let read: Vec<Sample<f64>> = read.filter(|sample| sample.theta_s.abs() < 1.45).collect();
        let found = fit(
            &read,
            &options(|options| options.instrument.offsets = Some((-0.17, 0.17))),
        );
        let offset = found.offset.expect("an offset");
        let away = (offset.value.to_degrees() - degrees).abs();
        worst = worst.max(away);
        pulls += (away / offset.stderr.to_degrees()).powi(2) / SEEDS as f64;
        assert!((found.params[PLACE_M] / 0.06 - 1.0).abs() < 0.03 && !offset.at_bound);
    }
    println!("offsets off by {worst:.4} deg at most, mean squared pull {pulls:.2}");
    assert!(worst < 0.05 && (0.3..2.5).contains(&pulls));
}

#[test]
fn an_offset_knows_where_samples_end() {
    let out_of_plane = Sample {
        delta_phi: 2.0,
        ..Sample::in_plane(0.5, 0.6, 1.0)
    };
    let mut samples = noisy(&dielectric(), &grid(&[30.0], 2, 88), 0.02, 1);
    let wanted = options(|options| options.instrument.offsets = Some((-0.17, 0.17)));
    // Up to 88 degrees there is room for 1.9.
    for sample in &mut samples {
        sample.brdf = 0.1 + Real::exp(-((sample.theta_s.to_degrees() - 36.0) / 5.0).powi(2));
    }
    let offset = fit(&samples, &wanted).offset.expect("an offset");
    assert!(
        offset.at_bound && (offset.value.to_degrees() - 1.9).abs() < 0.01,
        "{offset:?}"
    );
    samples.push(out_of_plane);
    assert_eq!(
        engine::fit(&samples, &wanted),
        Err(FitError::OutOfPlane(samples.len() - 1))
    );
}

/// ln of the mean of f over a fine grid of the disk that a detector sees, as it measures it.
fn averaged(material: &Material, sample: &Sample<f64>, half_angle: f64) -> f64 {
    const ACROSS: i32 = 60;
    let (sin_s, cos_s) = sample.theta_s.sin_cos();
    let (mut power, mut solid_angle) = (0.0, 0.0);
    for i in -ACROSS..=ACROSS {
        for j in -ACROSS..=ACROSS {
            // Squares of equal solid angle in Lambert's azimuthal projection.
            let (u, v) = (f64::from(i) / f64::from(ACROSS), f64::from(j) / f64::from(ACROSS));
            let radius = u.hypot(v);
            if radius > 1.0 {
                continue;
            }
            let away = 2.0 * (radius * (half_angle / 2.0).sin()).asin();
            let (sin_a, cos_a) = if radius > 0.0 {
                (v / radius, u / radius)
            } else {
                (0.0, 1.0)
            };
            let x = sin_s * away.cos() + cos_s * away.sin() * cos_a;
            let y = away.sin() * sin_a;
            let z = cos_s * away.cos() - sin_s * away.sin() * cos_a;
            solid_angle += away.cos();
            if z > 0.0 {
                let at = Sample {
                    theta_s: x.hypot(y).atan2(z),
                    delta_phi: std::f64::consts::PI + y.atan2(x),
                    ..*sample
                };
                power += material.ln_f(&at).map_or(0.0, f64::exp) * z;
            }
        }
    }
    (power / (solid_angle * cos_s)).ln()
}

#[test]
fn a_narrow_lobe_comes_back_through_an_aperture() {
    let material = Material::paper([0.05, 3.0, 0.0, 0.02, 1.5, 0.0]);
    let half_angle = 2.15f64.to_radians();
    let mut samples = grid(&[20.0, 45.0], 1, 80);
    for (place, sample) in samples.iter_mut().enumerate() {
        let noise = 0.01 * Noise::new(5, place as u64).normal();
        sample.brdf = (averaged(&material, sample, half_angle) + noise).exp();
    }
    let through = options(|options| options.instrument.aperture = half_angle);
    let (found, plain) = (fit(&samples, &through), fit(&samples, &options(|_| ())));
    println!(
        "m {:.5} +- {:.5}, without the aperture {:.5}; rms {:.4} and {:.4}",
        found.params[PLACE_M], found.uncertainty.stderr[PLACE_M], plain.params[PLACE_M], found.rms_ln, plain.rms_ln
    );
    assert!((found.params[PLACE_M] / 0.02 - 1.0).abs() < 0.01 && found.rms_ln < 0.0115);
    assert!(plain.params[PLACE_M] > 0.023);
    let pull = (found.params[PLACE_M] - 0.02) / found.uncertainty.stderr[PLACE_M];
    assert!(pull.abs() < 3.5, "{pull}");
}

#[test]
fn directions_of_an_aperture_stand_for_all_of_it() {
    // In and out of plane, up to where the aperture meets the horizon.
    let material = Material::paper([0.05, 3.0, 0.1, 0.1, 1.5, 0.0]);
    let half_angle = 2f64.to_radians();
    let mut worst = 0.0f64;
    for theta_s in [-70.0f64, -40.0, 0.0, 20.0, 45.0, 60.0, 80.0, 87.0] {
        let sample = Sample::in_plane(45f64.to_radians(), theta_s.to_radians(), 1.0);
        let view = engine::View {
            aperture: half_angle,
            ..engine::View::from(&material)
        };
        let seen = view.ln_f(&sample).unwrap();
        worst = worst.max((seen - averaged(&material, &sample, half_angle)).abs());
        // Derivatives are those of what is seen.
        let (same, slopes) = view.gradient(&sample).unwrap();
        assert_eq!(same, seen);
        let step = 1e-6;
        let moved = |m: f64| {
            let mut view = view;
            view.material = material.with("m", m);
            view.ln_f(&sample).unwrap()
        };
        let numeric = (moved(0.1 + step) - moved(0.1 - step)) / (2.0 * step);
        assert!((slopes[PLACE_M] - numeric).abs() < 1e-5 * (1.0 + numeric.abs()));
    }
    check(worst, tolerance::APERTURE);
}

#[test]
fn a_calibration_adds_to_weights_and_what_follows_from_them() {
    let samples = noisy(&dielectric(), &grid(&[20.0, 40.0], 4, 80), 0.05, 3);
    let part = 0.03;
    let held = |options: &mut FitOptions| (options.lower[PLACE_N], options.upper[PLACE_N]) = (1.5, 1.5);
    let plain = options(held);
    let scaled = options(|options| {
        held(options);
        options.instrument.scale_uncertainty = part;
    });
    let (plain, scaled) = (fit(&samples, &plain), fit(&samples, &scaled));
    assert_eq!((plain.params, plain.cost), (scaled.params, scaled.cost));
    let grown = |place: usize| {
        let more = scaled.uncertainty.stderr[place].powi(2) - plain.uncertainty.stderr[place].powi(2);
        more.max(0.0).sqrt() / scaled.params[place]
    };
    for (place, wanted) in [(0, part), (1, part), (PLACE_M, 0.0), (PLACE_N, 0.0)] {
        assert!((grown(place) - wanted).abs() < 1e-9, "{place}");
    }
    let at = |outcome: &Outcome| derived::at(0.5, &outcome.material(), &outcome.uncertainty);
    let (a, b) = (at(&plain), at(&scaled));
    let grown = |a: derived::Value, b: derived::Value| (b.stderr.powi(2) - a.stderr.powi(2)).max(0.0).sqrt() / a.value;
    let (p, q) = (a.peak.unwrap(), b.peak.unwrap());
    assert!((grown(a.reflectance, b.reflectance) / part - 1.0).abs() < 1e-6);
    assert!((grown(a.rho_s_f.unwrap(), b.rho_s_f.unwrap()) / part - 1.0).abs() < 1e-6);
    assert!((grown(p.f, q.f) / part - 1.0).abs() < 1e-6);
    assert!(grown(p.width.unwrap(), q.width.unwrap()) < 1e-6);
}

#[test]
fn energy_is_conserved_at_the_least_cost() {
    // Calibrated 20 % too high, more light seems to leave than arrives.
    let bright = Material::paper([0.95, 1.5, 0.0, 0.3, 1.5, 0.0]);
    let samples = noisy(&bright, &grid(&[20.0, 60.0], 4, 80), 0.03, 4);
    let angles = [20f64.to_radians(), 60f64.to_radians()];
    let most = |material: &Material| {
        angles
            .map(|theta_i| reflectance(material, theta_i).0)
            .into_iter()
            .fold(0.0, f64::max)
    };
    let bounded = |limited: bool| {
        options(|options| {
            (options.lower[PLACE_N], options.upper[PLACE_N]) = (1.5, 1.5);
            options.instrument.limit = limited.then_some(ENERGY);
        })
    };
    let (free, held) = (fit(&samples, &bounded(false)), fit(&samples, &bounded(true)));
    println!(
        "reflectance {:.4} free and {:.8} held",
        most(&free.material()),
        most(&held.material())
    );
    assert!(most(&free.material()) > 1.02);
    assert!((1.0 - 1e-5..=1.0).contains(&most(&held.material())) && held.cost > free.cost);
    // Nothing near that is allowed costs less.
    let cost = |material: &Material| -> f64 {
        samples
            .iter()
            .map(|sample| material.residual(sample).unwrap().powi(2))
            .sum()
    };
    assert!((cost(&held.material()) / held.cost - 1.0).abs() < 1e-9);
    let mut noise = Noise::new(1, 1);
    let mut tried = 0;
    for k in 0..4000 {
        let size = 10f64.powi(-1 - k % 4);
        let mut values = held.params;
        for place in [0, 1, PLACE_M] {
            values[place] *= 1.0 + size * noise.normal();
        }
        let other = Material {
            values,
            ..held.material()
        };
        if values[0] <= 1.0 && values.iter().all(|value| *value >= 0.0) && most(&other) <= 1.0 {
            tried += 1;
            assert!(cost(&other) >= held.cost * (1.0 - 1e-4), "{values:?}");
        }
    }
    assert!(tried > 500);
    // Where it is conserved anyway, no bit changes; where no weights can, it is refused.
    let dark = noisy(&dielectric(), &grid(&[20.0, 60.0], 4, 80), 0.03, 4);
    assert_eq!(fit(&dark, &bounded(false)).params, fit(&dark, &bounded(true)).params);
    let impossible = FitOptions {
        lower: Values::from([1.0, 1.0, 0.0, 0.01, 1.5, 0.0]),
        ..bounded(true)
    };
    assert_eq!(engine::fit(&samples, &impossible), Err(FitError::Limit));
}

#[test]
fn joint_fits_take_part() {
    let material = Material::paper([0.05, 3.0, 0.0, 0.02, 1.5, 0.0]);
    let half_angle = 2.15f64.to_radians();
    let seen = |seed: u64| {
        let mut samples = grid(&[30.0], 2, 80);
        for (place, sample) in samples.iter_mut().enumerate() {
            let noise = 0.01 * Noise::new(seed, place as u64).normal();
            sample.brdf = (averaged(&material, sample, half_angle) + noise).exp();
        }
        samples
    };
    let (a, b) = (seen(1), seen(2));
    let wanted = options(|options| {
        options.instrument.aperture = half_angle;
        options.instrument.scale_uncertainty = 0.03;
        options.instrument.priors[PLACE_N] = Some(Prior { mean: 1.5, sigma: 0.01 });
        options.instrument.limit = Some(ENERGY);
    });
    let shared: Vec<bool> = (0..6).map(|place| place >= PLACE_M).collect();
    let fitted = joint::fit(&[&a, &b], &shared, &wanted).unwrap();
    assert!(
        (fitted.scans[0][PLACE_M] / 0.02 - 1.0).abs() < 0.01,
        "{:?}",
        fitted.scans
    );
    // A prior of a shared parameter counts once.
    let error = fitted.errors[0][PLACE_N].expect("n is known");
    assert!((error / 0.01 - 1.0).abs() < 0.02, "{error}");
    let rho_d = fitted.errors[0][0].expect("rho_d is known") / fitted.scans[0][0];
    assert!((0.03..0.04).contains(&rho_d), "{rho_d}");
}

fn json(arguments: &[&str]) -> Value {
    let arguments = [arguments, &["--format", "json"]].concat();
    let ran = brdfit(&arguments, b"");
    assert_eq!(ran.code, 0, "{}", ran.errors);
    serde_json::from_str(&ran.output).expect("JSON")
}

#[test]
fn every_command_honours_or_refuses() {
    let folder = TempDir::new().unwrap();
    let samples = noisy(&dielectric(), &grid(&[20.0, 40.0], 4, 80), 0.02, 5);
    let row = |sample: &Sample<f64>| {
        let (theta_i, theta_s) = (sample.theta_i.to_degrees(), sample.theta_s.to_degrees() + 0.5);
        format!("{theta_i},{theta_s},{}\n", sample.brdf)
    };
    let table: String = samples.iter().map(row).collect();
    let file = write(
        &folder,
        "scan.csv",
        format!("theta_i_deg,theta_s_deg,brdf_per_sr\n{table}"),
    );
    let all = [
        "--terms",
        "diffuse,surface",
        "--prior",
        "n=1.50+-0.02",
        "--aperture-half-angle",
        "0.5",
        "--scale-uncertainty",
        "3%",
        "--conserve-energy",
    ];
    let fit = json(&[&["fit", &file, "--fit-offset"], &all[..]].concat());
    let beside = &fit["provenance"]["instrument"];
    assert_eq!(beside["priors"]["n"], serde_json::json!([1.5, 0.02]));
    assert_eq!(
        (&beside["fit_offset"], &beside["conserve_energy"]),
        (&true.into(), &true.into())
    );
    assert_eq!(
        (&beside["aperture_half_angle_deg"], &beside["scale_uncertainty"]),
        (&0.5.into(), &0.03.into())
    );
    assert!((fit["offset_deg"].as_f64().unwrap() - 0.5).abs() < 0.3);
    assert!((fit["parameters"]["n"].as_f64().unwrap() - 1.5).abs() < 0.05);
    let text = succeed(&[&["fit", &file, "--fit-offset"], &all[..]].concat());
    for word in ["offset", "priors", "aperture", "scale", "energy"] {
        assert!(text.contains(&format!("\n  {word} ")), "{word}\n{text}");
    }
    // Without any of it nothing is said of it.
    assert!(json(&["fit", &file])["provenance"]["instrument"].is_null());
    let page = brdfit(&[&["report", &file, "--fit-offset"], &all[..]].concat(), b"");
    assert!(
        page.code == 0
            && page.output.contains("averaged over a half-angle of 0.5 deg")
            && page.output.contains("offset_deg")
    );
    let profile = json(&[&["profile", &file, "--parameter", "n"], &all[..]].concat());
    let interval = &profile["parameters"][0]["intervals"][1];
    let (low, high) = (interval["low"].as_f64().unwrap(), interval["high"].as_f64().unwrap());
    assert!(1.35 < low && low < high && high < 1.55, "{interval}");
    let parts = [
        "--terms",
        "diffuse,surface",
        "--prior",
        "n=1.50+-0.02",
        "--fit-offset",
        "--bootstrap",
        "20",
    ];
    let shifted = json(&[&["profile", &file, "--parameter", "m"], &parts[..]].concat());
    let interval = &shifted["parameters"][0]["intervals"][1];
    assert!(
        interval["low"].as_f64() < Some(0.15) && interval["high"].as_f64() > Some(0.15),
        "{interval}"
    );
    let joint = json(&[&["joint", &file, &file, "--share", "m,n"], &all[..]].concat());
    assert!((joint["scans"][0]["parameters"]["n"].as_f64().unwrap() - 1.5).abs() < 0.05);
    assert!(fail(&["joint", &file, &file, "--fit-offset"]).contains("--fit-offset"));
    let out = folder.path().join("results.csv");
    let ran = brdfit(
        &[
            &["batch", &file, "--fit-offset", "--out", out.to_str().unwrap()],
            &all[..],
        ]
        .concat(),
        b"",
    );
    assert_eq!(ran.code, 0, "{}", ran.errors);
    let results = std::fs::read_to_string(&out).unwrap();
    let cell = |name: &str| {
        let mut lines = results.lines();
        let place = lines.next()?.split(',').position(|head| head == name)?;
        lines.next()?.split(',').nth(place)?.parse::<f64>().ok()
    };
    assert_eq!(cell("offset_deg"), fit["offset_deg"].as_f64());
    for (bad, word) in [
        (&["fit", &file, "--fit-offset", "--robust"][..], "--robust"),
        (
            &["fit", &file, "--aperture-half-angle", "1", "--precision", "f32"],
            "f32",
        ),
        (&["fit", &file, "--prior", "n=1.5+-0.1", "--fix", "n=1.5"], "fixed"),
        (&["fit", &file, "--prior", "x=1.5+-0.1"], "x"),
        (&["profile", &file, "--fit-offset", "--calibrate", "20"], "--fit-offset"),
    ] {
        let message = fail(bad);
        assert!(message.contains(word), "{message}");
    }
}

#[test]
fn the_offset_of_a_case_is_found() {
    let path = shared("cases/fit/f09_angle_offset_3deg.csv");
    if !path.exists() {
        return left_out("a scan whose zero is off by 3 deg", &path);
    }
    let found = fit(
        &scan(&path),
        &options(|options| options.instrument.offsets = Some((-0.17, 0.17))),
    );
    let offset = found.offset.expect("an offset").value.to_degrees();
    println!(
        "offset {offset:.4} deg, m {:.5}, rms {:.4}",
        found.params[PLACE_M], found.rms_ln
    );
    assert!((offset + 3.0).abs() < 0.02 && (found.params[PLACE_M] - 0.0601).abs() < 2e-4 && found.rms_ln < 0.0125);
}
