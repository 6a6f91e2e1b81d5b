//! A fit with default options reaches the best optimum known, and with it what the noise lets it know of the truth.

use std::path::Path;

use brdfit::engine::{self, FitOptions, Outcome};
use brdfit_core::real::Real;
use brdfit_suite::scan::{data, left_out, number, rows, scan, shared};
use brdfit_suite::tolerance::{self, check};

/// rho_d and m that each synthetic set was made with.
const ACTUAL: [(f64, f64); 3] = [(0.1, 0.1), (0.2, 0.15), (0.15, 0.005)];

fn fit(path: &Path) -> Outcome {
    engine::fit(&scan(path), &FitOptions::default()).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Fits the files of a table of known optima and checks the one that ends furthest above its own.
fn reaches(table: &Path, wanted: impl Fn(&str) -> bool, folder: &Path) {
    let known = rows(table).into_iter().filter(|row| wanted(&row[0]));
    let mut excesses = Vec::new();
    for row in known {
        let (file, least) = (&row[0], number(&row[2]));
        let excess = fit(&folder.join(file)).mse2 / least - 1.0;
        eprintln!("{file}: MSE^2 = best known x (1 {excess:+.1e})");
        excesses.push(excess);
    }
    let worst = excesses.into_iter().max_by(f64::total_cmp);
    check(worst.expect("the table has such files"), tolerance::OPTIMUM_MSE2);
}

#[test]
fn noisy_synthetic_sets_reach_the_best_known() {
    reaches(&data("optimum.csv"), |file| file.contains("_seed"), &data(""));
}

#[test]
fn measured_scans_reach_the_best_known() {
    let (table, folder) = (shared("reference/optimum.csv"), shared("real"));
    if !table.exists() || !folder.exists() {
        return left_out("the fit of measured scans", &folder);
    }
    reaches(&table, |file| !file.starts_with("testdata"), &folder);
}

#[test]
fn sets_without_noise_are_fitted_exactly() {
    let mut worst = 0.0f64;
    for set in 1..=3 {
        let mse2 = fit(&data(&format!("testdata{set}_ideal.csv"))).mse2;
        eprintln!("set {set}: MSE^2 = {mse2:.1e}");
        worst = worst.max(mse2);
    }
    check(worst, tolerance::IDEAL_MSE2);
}

#[test]
fn rho_d_m_and_the_curve_come_back() {
    let mut worst = [0.0f64; 3];
    for (set, (rho_d, m)) in (1..).zip(ACTUAL) {
        let ideal = scan(&data(&format!("testdata{set}_ideal.csv")));
        for seed in 1..=3 {
            let material = fit(&data(&format!("testdata{set}_sym_seed{seed}.csv"))).material();
            let squares = ideal.iter().map(|sample| {
                let residual = material.ln_f(sample).expect("valid angles") - Real::portable_ln(sample.brdf);
                residual * residual
            });
            let rms = (squares.sum::<f64>() / ideal.len() as f64).sqrt();
            let (off_rho_d, off_m) = (material.values[0] / rho_d - 1.0, material.values[3] / m - 1.0);
            eprintln!("set {set}, seed {seed}: rho_d {off_rho_d:+.4}, m {off_m:+.4}, ln f {rms:.4}");
            for (worst, error) in worst.iter_mut().zip([off_rho_d.abs(), off_m.abs(), rms]) {
                *worst = worst.max(error);
            }
        }
    }
    check(worst[0], tolerance::ACTUAL_RHO_D);
    check(worst[1], tolerance::ACTUAL_M);
    check(worst[2], tolerance::IDEAL_RMS_LN);
}
