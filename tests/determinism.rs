//! The same bits with any number of threads, any vector instructions, and every time.

use std::sync::atomic::AtomicBool;

use brdfit::engine::simd::{FastEq14, Simd};
use brdfit::engine::{FitError, FitOptions, Method, Outcome, Precision, Until, blocks, descend, fit, joint};
use brdfit_core::brdf::{ABSORBING, ALL, Brdf, DIFFUSE, Params, SURFACE};
use brdfit_core::geometry::{Geometry, Sample};
use brdfit_core::lm::Problem;
use brdfit_core::real::Real;
use brdfit_core::residuals::{PART, Scan};
use brdfit_core::search::{Region, Scene};
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

#[test]
fn passes_over_a_large_scan_have_the_same_bits_on_any_number_of_threads() {
    let once = scan();
    // Two whole parts and a bit more.
    let count = 2 * PART * 16 + 37;
    let samples: Vec<Sample<f64>> = once.iter().cycle().take(count).copied().collect();
    let blocks = blocks::<f64>(&samples).unwrap();
    let whole = Scan::<f64, ALL, 6>::new(&blocks);
    let bounds = Scan::<f64, ALL, 6>::usual_bounds();
    let start = whole.candidate(&bounds, 1, 3, Region::Band(1));
    let passes = |scene: &dyn Scene<f64, 6>| {
        let (level, cost) = scene.level(&bounds, &start.x);
        (
            scene.cost(&start.x).to_bits(),
            scene.linearize(&start.x),
            level.map(f64::to_bits),
            cost.to_bits(),
            scene.candidate(&bounds, 1, 7, Region::Band(1)).x.map(f64::to_bits),
        )
    };
    let alone = passes(&whole);
    for simd in Simd::available() {
        let fast = FastEq14::<f64, ALL, 6>::new(whole, simd);
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            assert_eq!(pool.install(|| passes(&fast)), alone, "{simd:?}, {threads} threads");
        }
    }
    // Fewer samples than a part are summed in one go, as ever.
    let few = Scan::<f64, ALL, 6>::new(&blocks[..PART]);
    assert_eq!(few.cost(&start.x).to_bits(), few.inlined_cost(&start.x).to_bits());
    assert_ne!(whole.cost(&start.x).to_bits(), whole.inlined_cost(&start.x).to_bits());
}

#[test]
fn a_search_that_is_not_wanted_ends() {
    static OVER: AtomicBool = AtomicBool::new(true);
    static GOES_ON: AtomicBool = AtomicBool::new(false);
    let samples: Vec<Sample<f64>> = (0..40)
        .map(|k| Sample::in_plane(0.7, 0.03 * f64::from(k), 0.1 + f64::from(k % 7)))
        .collect();
    for method in [Method::Default, Method::Paper] {
        for robust in [false, true] {
            let options = FitOptions {
                method,
                robust,
                starts: Some(40),
                ..FitOptions::default()
            };
            let until = |flag| FitOptions {
                until: Until::set(flag),
                ..options
            };
            assert_eq!(fit(&samples, &until(&OVER)), Err(FitError::Interrupted));
            assert_eq!(fit(&samples, &until(&GOES_ON)), fit(&samples, &options));
            let descend = |options: &FitOptions| descend(&samples, options, &[options.lower]);
            assert_eq!(descend(&until(&OVER)), Err(FitError::Interrupted));
            assert_eq!(descend(&until(&GOES_ON)), descend(&options));
        }
    }
    let shared = [false, false, false, true, false, false];
    let joint = |flag| {
        let until = Until::set(flag);
        let options = FitOptions {
            until,
            ..FitOptions::default()
        };
        joint::fit(&[&samples, &samples], &shared, &options)
    };
    assert_eq!(joint(&OVER), Err((2, FitError::Interrupted)));
    assert!(joint(&GOES_ON).is_ok());
}

#[test]
fn the_first_error_in_order_ends_the_work() {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use brdfit::engine::threads::try_each;

    assert_eq!(try_each(100, &|k| Ok::<_, usize>(k)), Ok((0..100).collect()));
    let made = AtomicUsize::new(0);
    let fails = |k: usize| {
        made.fetch_add(1, Ordering::Relaxed);
        if k % 1000 == 700 { Err(k) } else { Ok(k) }
    };
    assert_eq!(try_each(1_000_000, &fails), Err(700));
    assert!(made.into_inner() < 900_000);
}
