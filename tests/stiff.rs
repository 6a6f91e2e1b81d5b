//! Stiff scenes: condition 10^4 to 10^17 at the optimum, where rho_s, rho_v, n and kappa trade along a valley.

use brdfit::engine::{self, FitOptions};
use brdfit_core::brdf::NAMES;
use brdfit_suite::scan::{data, scan, six};
use brdfit_suite::tolerance::{self, check};
use brdfit_suite::valley::{KINDS, passes_to_the_end};

/// rho_d, rho_s, rho_v, m, n, kappa of test data 1 and 2.
const ACTUAL: [[f64; 6]; 2] = [[0.1, 10.0, 0.01, 0.1, 3.0, 1.0], [0.2, 1.5, 0.02, 0.15, 1.15, 0.9]];

#[test]
fn all_six_parameters_come_back_without_noise() {
    let mut worst = 0.0f64;
    for (set, actual) in (1..).zip(ACTUAL) {
        let samples = scan(&data(&format!("testdata{set}_ideal.csv")));
        let found = engine::fit(&samples, &FitOptions::default()).expect("a valid scan");
        for (k, got) in six(&found.params).into_iter().enumerate() {
            let error = (got / actual[k] - 1.0).abs();
            println!("set {set}: {} is off by {error:.1e}", NAMES[k]);
            worst = worst.max(error);
        }
    }
    check(worst, tolerance::RECOVERED);
}

#[test]
fn the_valley_of_test_data_3_is_followed_to_its_end() {
    let samples = scan(&data("testdata3_ideal.csv"));
    let found = engine::fit(&samples, &FitOptions::default()).expect("a valid scan");
    println!("cost {:e}, stop {:?}", found.cost, found.stop);
    assert!(found.stop.converged());
    check(found.cost, tolerance::VALLEY_COST);
}

#[test]
fn single_fits_end_within_a_bounded_number_of_passes() {
    let (mut noisy, mut valley, mut ideal, mut median) = (0, 0, 0, 0);
    for set in 1..=3 {
        for kind in KINDS {
            let passes = passes_to_the_end(set, kind, true);
            println!("test data {set}, {kind}: {passes:?}");
            let most = if kind == "ideal" { &mut ideal } else { &mut noisy };
            *most = passes.most.max(*most);
            median = passes.median.max(median);
            if set > 1 && kind != "ideal" {
                valley = passes.most.max(valley);
            }
        }
    }
    check(f64::from(noisy), tolerance::PASSES_NOISY);
    check(f64::from(valley), tolerance::PASSES_VALLEY);
    check(f64::from(ideal), tolerance::PASSES_IDEAL);
    check(f64::from(median), tolerance::PASSES_MEDIAN);
}
