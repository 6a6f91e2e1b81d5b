//! Stiff scenes: condition 10^4 to 10^17 at the optimum, where rho_s, rho_v, n and kappa trade along a valley.

use brdfit::engine::{self, FitOptions, blocks};
use brdfit_core::brdf::{ALL, NAMES};
use brdfit_core::lm::{self, Options, Stop};
use brdfit_core::residuals::Scan;
use brdfit_core::search::Scene;
use brdfit_suite::scan::{data, scan};
use brdfit_suite::tolerance::{self, check};

/// rho_d, rho_s, rho_v, m, n, kappa of test data 1 and 2.
const ACTUAL: [[f64; 6]; 2] = [[0.1, 10.0, 0.01, 0.1, 3.0, 1.0], [0.2, 1.5, 0.02, 0.15, 1.15, 0.9]];

#[test]
fn all_six_parameters_come_back_without_noise() {
    for (set, actual) in (1..).zip(ACTUAL) {
        let samples = scan(&data(&format!("testdata{set}_ideal.csv")));
        let found = engine::fit(&samples, &FitOptions::default()).expect("a valid scan");
        for (k, got) in found.params.to_array().into_iter().enumerate() {
            let error = (got / actual[k] - 1.0).abs();
            println!("set {set}: {} is off by {error:.1e}", NAMES[k]);
            assert!(
                error < tolerance::RECOVERED,
                "set {set}: {} is off by {error:e}",
                NAMES[k]
            );
        }
    }
}

#[test]
fn the_valley_of_test_data_3_is_followed_to_its_end() {
    let samples = scan(&data("testdata3_ideal.csv"));
    let found = engine::fit(&samples, &FitOptions::default()).expect("a valid scan");
    println!("cost {:e}, stop {:?}", found.cost, found.stop);
    assert!(found.stop.converged());
    assert!(found.cost < tolerance::VALLEY_COST, "{:e}", found.cost);
}

/// Passes of one fit from each of 20 candidates to convergence: median and most.
fn passes(file: &str) -> (u32, u32) {
    let blocks = blocks::<f64>(&scan(&data(file))).expect("a valid scan");
    let scene = Scan::<f64, ALL, 6>::new(&blocks);
    let bounds = FitOptions::default();
    let bounds = Scan::<f64, ALL, 6>::bounds(&bounds.lower, &bounds.upper);
    let options = Options {
        max_passes: 5000,
        ..Options::default()
    };
    let mut passes = Vec::new();
    for i in 0..20 {
        let fit = lm::fit(&scene, &bounds, scene.candidate(&bounds, 0, i, None).x, &options);
        assert!(
            fit.stop.is_some_and(Stop::converged),
            "{file}, candidate {i}: {:?}",
            fit.stop
        );
        passes.push(fit.passes);
    }
    passes.sort_unstable();
    println!(
        "{file}: median {}, most {} passes; all {passes:?}",
        passes[10], passes[19]
    );
    (passes[10], passes[19])
}

#[test]
fn single_fits_end_within_a_bounded_number_of_passes() {
    let mut worst_median = 0;
    for (kind, bound) in [
        ("sym_seed1", tolerance::PASSES_NOISY),
        ("ideal", tolerance::PASSES_IDEAL),
    ] {
        let mut worst = 0;
        for set in 1..=3 {
            let (median, most) = passes(&format!("testdata{set}_{kind}.csv"));
            worst = worst.max(most);
            worst_median = worst_median.max(median);
        }
        check(f64::from(worst), bound);
    }
    check(f64::from(worst_median), tolerance::PASSES_MEDIAN);
}
