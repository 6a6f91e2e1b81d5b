//! Values that are known from elsewhere.

use super::{PLACE_M, PLACE_N, dielectric, fit, grid, noisy, options};
use brdfit::analysis;
use brdfit::analysis::bootstrap::Noise;
use brdfit::analysis::choose::Wanted;
use brdfit::analysis::profile::profiles;
use brdfit::engine::{self, FitError, FitOptions, Material, Outcome, Prior};
use brdfit::input::Measurement;
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

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

/// A scan whose ln f has errors of 5 % that are correlated over 10 degrees.
fn correlated(seed: u64) -> Vec<Sample<f64>> {
    let mut samples = noisy(&dielectric(), &grid(&[20.0, 40.0], 2, 80), 0.0, seed);
    let mut noise = Noise::new(13, seed);
    let kept = Real::portable_exp(-0.2);
    let mut error = noise.normal();
    for sample in &mut samples {
        error = kept * error + (1.0 - kept * kept).sqrt() * noise.normal();
        sample.brdf *= Real::portable_exp(0.05 * error);
    }
    samples
}

/// However many samples a scan has that say the same: what is known from elsewhere is known no worse with it, and better where it says something.
#[test]
fn a_prior_counts_beside_correlated_samples() {
    const SEEDS: u64 = 40;
    // As much as such a scan tells of m, and a fifth of it.
    for sigma in [0.004, 0.0008] {
        let (mut pulls, mut off, mut joint, mut alone) = (0.0, 0.0, 0.0, 0.0);
        for seed in 0..SEEDS {
            let samples = correlated(seed);
            let mean = 0.15 + sigma * Noise::new(14, seed).normal();
            let prior = Some(Prior { mean, sigma });
            let asked = options(|options| options.instrument.priors[PLACE_M] = prior);
            let without = fit(&samples, &options(|_| ()));
            alone += (without.params[PLACE_M] - 0.15).powi(2) / SEEDS as f64;
            let scan = Measurement::of_samples("scan", samples.clone(), None);
            let found = analysis::fit::fit(&scan, &Wanted::One(asked)).unwrap().outcome;
            let error = found.uncertainty.stderr[PLACE_M];
            assert!(error < 1.05 * sigma, "{error}");
            off += (found.params[PLACE_M] - 0.15).powi(2) / SEEDS as f64;
            pulls += ((found.params[PLACE_M] - 0.15) / error).powi(2) / SEEDS as f64;
            let other = correlated(seed + SEEDS);
            let shared = [false, false, false, true, true, false];
            let fits = analysis::joint::fit(&[&samples, &other], &[(asked, shared.to_vec())], None).unwrap();
            let best = fits.best();
            let error = best.known.errors[0][PLACE_M].expect("m is determined");
            assert!(error < 1.05 * sigma, "{error}");
            joint += ((best.fitted.scans[0][PLACE_M] - 0.15) / error).powi(2) / SEEDS as f64;
        }
        let [off, alone] = [off, alone].map(f64::sqrt);
        println!(
            "m is off by {off:.5} with a prior of {sigma}, {alone:.5} without: mean squared pull {pulls:.2}, of pairs {joint:.2}"
        );
        assert!((0.5..1.6).contains(&pulls) && (0.5..1.6).contains(&joint));
        assert!(off < sigma && off < alone);
    }
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
fn a_prior_that_the_scan_contradicts_is_told() {
    let samples = noisy(&dielectric(), &grid(&[20.0, 40.0], 4, 80), 0.02, 1);
    let hints = |mean: f64| {
        let prior = Some(Prior { mean, sigma: 0.001 });
        let asked = options(|options| options.instrument.priors[PLACE_M] = prior);
        let scan = Measurement::of_samples("scan", samples.clone(), None);
        analysis::fit::fit(&scan, &Wanted::One(asked)).unwrap().hints
    };
    assert!(hints(0.15).iter().all(|hint| hint.about != "prior"));
    // Whether it gives way to the scan or the scan to it.
    for mean in [0.18, 0.3] {
        assert!(
            hints(mean)
                .iter()
                .any(|hint| hint.about == "prior" && hint.text.contains("without it m is 0.1"))
        );
    }
}

#[test]
fn the_profile_of_a_parameter_with_a_prior_is_that_of_the_fit() {
    let samples = noisy(&dielectric(), &grid(&[20.0, 40.0], 4, 80), 0.02, 1);
    let prior = Some(Prior { mean: 1.5, sigma: 0.02 });
    let asked = options(|options| options.instrument.priors[PLACE_N] = prior);
    let outcome = fit(&samples, &asked);
    let (best, error) = (outcome.params[PLACE_N], outcome.uncertainty.stderr[PLACE_N]);
    let found = profiles(&samples, &asked.settled(&outcome), outcome, &[PLACE_N], 0, None).unwrap();
    assert_eq!(found.improved_from, None);
    let profile = &found.list[0];
    assert!((profile.best.value / best - 1.0).abs() < 1e-6, "{}", profile.best.value);
    // Over so little of n the sum of squares is a parabola, whose ends follow from the error.
    for end in [profile.intervals[0].low, profile.intervals[0].high] {
        let away = (end.value - best).abs() / (error * profile.limits[0].sqrt());
        assert!((away - 1.0).abs() < 0.1, "{end:?}: {away}");
    }
}
