//! The calibration of f, and the energy that it allows.

use super::{PLACE_M, PLACE_N, all_terms, dielectric, fit, grid, noisy, options};
use brdfit::analysis::bootstrap::Noise;
use brdfit::analysis::derived;
use brdfit::analysis::profile::hold::hold;
use brdfit::analysis::reflectance::reflectance;
use brdfit::engine::{self, FitError, FitOptions, Material, Outcome, Values};
use brdfit::instrument::ENERGY;

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
    let mut cheaper = 0;
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
        let inside = values[0] <= 1.0 && values.iter().all(|value| *value >= 0.0);
        if inside && cost(&other) < held.cost * (1.0 - 1e-4) {
            cheaper += 1;
            assert!(most(&other) > 1.0, "{values:?}");
        }
    }
    assert!(cheaper > 100, "{cheaper}");
    // Where it is conserved anyway, no bit changes; where no weights can, it is refused.
    let dark = noisy(&dielectric(), &grid(&[20.0, 60.0], 4, 80), 0.03, 4);
    assert_eq!(fit(&dark, &bounded(false)).params, fit(&dark, &bounded(true)).params);
    let impossible = FitOptions {
        lower: Values::from([1.0, 1.0, 0.0, 0.01, 1.5, 0.0]),
        ..bounded(true)
    };
    assert_eq!(engine::fit(&samples, &impossible), Err(FitError::Limit));
    // Of a profile, the values that nothing allowed goes with are refuted.
    let least = held.params[1];
    let bound = FitOptions {
        lower: Values::from([0.0, 0.5 * least, 0.0, 0.01, 1.5, 0.0]),
        ..bounded(true)
    };
    let refuted = hold(&samples, &bound, &held, 0, 1.0).unwrap();
    assert_eq!(refuted.cost, f64::INFINITY);
}

/// A scan that is far too bright is held by weights that are lower, and not by an index at its bound.
#[test]
fn energy_of_a_scan_that_is_far_too_bright_is_conserved_at_the_least_cost() {
    let bright = Material::paper([0.9, 2.5, 0.0, 0.15, 1.6, 0.5]);
    let samples = noisy(&bright, &grid(&[20.0, 50.0], 4, 80), 0.03, 5);
    let costs = [0, 3].map(|seed| {
        let options = all_terms(|options| {
            options.instrument.limit = Some(ENERGY);
            options.seed = seed;
        });
        let outcome = fit(&samples, &options);
        assert!(outcome.stop.converged());
        outcome.cost
    });
    assert!((costs[0] / costs[1] - 1.0).abs() < 1e-3, "{costs:?}");
}
