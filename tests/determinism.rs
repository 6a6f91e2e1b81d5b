//! The same bits with any number of threads, any vector instructions, and every time.

use brdfit::engine::simd::Simd;
use brdfit::engine::{FitOptions, Method, Outcome, Precision, fit};
use brdfit_core::brdf::{ABSORBING, ALL, Brdf, DIFFUSE, Params, SURFACE};
use brdfit_core::geometry::{Geometry, Sample};
use brdfit_core::real::Real;
use brdfit_suite::scan::six;

/// Test data 1 of the paper with a made-up ripple of 5 % in place of noise; 37 samples, so the last block is not full.
fn scan() -> Vec<Sample<f64>> {
    let truth = Params {
        rho_d: 0.1,
        rho_s: 10.0,
        rho_v: 0.01,
        m: 0.1,
        n: 3.0,
        kappa: 1.0,
    };
    let sample = |index: i32| {
        let theta_s = (f64::from(index) * 4.5 - 80.0).to_radians();
        let geometry = Geometry::new(45f64.to_radians(), theta_s, f64::PI).unwrap();
        let ripple = f64::from((index * 37) % 101 - 50) * 1e-3;
        Sample::in_plane(
            45f64.to_radians(),
            theta_s,
            Real::portable_exp(Brdf::<f64, ALL>::new(&truth).ln_f(&geometry) + ripple),
        )
    };
    (0..37).map(sample).collect()
}

/// All numbers of an outcome as bits.
fn bits(outcome: &Outcome) -> Vec<u64> {
    let mut bits = vec![
        outcome.cost,
        outcome.mse2,
        outcome.rms_ln,
        outcome.improvement_potential,
    ];
    bits.extend(six(&outcome.params));
    let mut counts = vec![
        outcome.samples as u64,
        u64::from(outcome.evaluations.cost),
        u64::from(outcome.evaluations.linearize),
    ];
    for minimum in &outcome.minima {
        bits.push(minimum.mse2);
        bits.extend(six(&minimum.params));
        counts.extend([u64::from(minimum.hits), minimum.first_start]);
    }
    bits.into_iter().map(f64::to_bits).chain(counts).collect()
}

fn cases() -> Vec<FitOptions> {
    let mut cases = Vec::new();
    for precision in [Precision::F64, Precision::F32] {
        for (method, starts) in [(Method::Default, 32), (Method::Paper, 12)] {
            for terms in [ALL, DIFFUSE | SURFACE | ABSORBING] {
                cases.push(FitOptions {
                    method,
                    precision,
                    terms,
                    starts: Some(starts),
                    seed: 7,
                    ..FitOptions::default()
                });
            }
        }
    }
    cases
}

fn on_threads(threads: usize, options: &FitOptions) -> Outcome {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| fit(&scan(), options)).unwrap()
}

#[test]
fn threads_and_repetition_change_no_bit() {
    for options in cases() {
        let once = on_threads(1, &options);
        assert!(once.cost.is_finite() && once.cost > 0.0);
        for threads in [1, 2, 3] {
            let again = on_threads(threads, &options);
            assert_eq!(bits(&once), bits(&again), "{threads} threads, {options:?}");
            assert_eq!((once.stop, &once.at_bound), (again.stop, &again.at_bound));
        }
    }
}

#[test]
fn vector_instructions_change_no_bit() {
    for options in cases() {
        let outcomes = Simd::available()
            .into_iter()
            .map(|simd| (simd, FitOptions { simd, ..options }));
        let portable = on_threads(
            1,
            &FitOptions {
                simd: Simd::Portable,
                ..options
            },
        );
        for (simd, options) in outcomes {
            let other = on_threads(1, &options);
            assert_eq!(bits(&portable), bits(&other), "{}, {options:?}", simd.name());
            assert_eq!((portable.stop, &portable.at_bound), (other.stop, &other.at_bound));
        }
    }
}

#[test]
fn seeds_change_the_search() {
    let options = cases()[2];
    let other = FitOptions { seed: 8, ..options };
    assert_ne!(bits(&on_threads(1, &options)), bits(&on_threads(1, &other)));
}
