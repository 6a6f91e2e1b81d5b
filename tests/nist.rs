//! The solver on NIST's certified nonlinear regression problems.

use brdfit_core::lm::Options;
use brdfit_suite::nist_models::{options, run_all};
use brdfit_suite::tolerance::{self, check_digits};

#[test]
fn certified_parameters_from_both_starts() {
    let runs = run_all(&options());
    assert_eq!(runs.len(), 54);
    for run in &runs {
        assert!(run.stop.converged(), "{run:?}");
        assert!(run.lre >= tolerance::NIST_LEAST_LRE, "{run:?}");
    }
    let mut lre: Vec<f64> = runs.iter().map(|run| run.lre).collect();
    lre.sort_by(f64::total_cmp);
    check_digits(lre[0], tolerance::NIST_LEAST_LRE);
    check_digits(0.5 * (lre[26] + lre[27]), tolerance::NIST_MEDIAN_LRE);
}

/// Lanczos1 is a curve without noise: its certified deviations are those of the last digits of its data.
#[test]
fn certified_standard_errors() {
    let mut lre: Vec<f64> = Vec::new();
    for run in run_all(&options()) {
        if run.name != "Lanczos1" {
            lre.push(run.lre_deviations);
        }
    }
    lre.sort_by(f64::total_cmp);
    check_digits(lre[0], tolerance::NIST_LEAST_LRE_DEVIATION);
    check_digits(lre[25], tolerance::NIST_MEDIAN_LRE_DEVIATION);
}

/// The options of ordinary fits, from starts that are not absurd: more damping or more passes are not what makes the others right.
#[test]
fn default_options_from_the_nearer_start() {
    for run in run_all(&Options::default()).iter().filter(|run| run.start == 2) {
        assert!(run.stop.converged(), "{run:?}");
        assert!(run.lre >= tolerance::NIST_DEFAULT_LRE, "{run:?}");
    }
}
