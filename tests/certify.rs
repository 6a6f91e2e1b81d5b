//! The proof of the global optimum: what it claims is true, it finds better minima than it was given, and it does the same on any number of threads.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use brdfit::engine::certify::{Certificate, Claim, Region, Visit, certify, scene};
use brdfit::engine::{FitOptions, fit};
use brdfit_core::brdf::{ABSORBING, DIFFUSE, Params, SURFACE, VOLUME};
use brdfit_core::geometry::Sample;
use brdfit_suite::claims::{check, prove};
use brdfit_suite::interval_oracle::{Verdict, verdict};
use brdfit_suite::scan::{data, scan};

fn noisy(set: u32, seed: u32) -> Vec<Sample<f64>> {
    scan(&data(&format!("testdata{set}_sym_seed{seed}.csv")))
}

/// Each `step`-th sample.
fn thinned(samples: &[Sample<f64>], step: usize) -> Vec<Sample<f64>> {
    samples.iter().step_by(step).copied().collect()
}

fn best(samples: &[Sample<f64>], options: &FitOptions) -> Params<f64> {
    Params::from_array(
        fit(samples, options).expect("the scan is valid").params[..]
            .try_into()
            .expect("Eq. 14"),
    )
}

fn hold(options: &mut FitOptions, name: &str, lower: f64, upper: f64) {
    let place = options.model.place(name).expect("a parameter");
    (options.lower[place], options.upper[place]) = (lower, upper);
}

fn assert_true(samples: &[Sample<f64>], options: &FitOptions, eps: f64, per_box: u32) -> Certificate {
    let checked = check(samples, options, &best(samples, options), eps, per_box);
    assert!(checked.false_claims.is_empty(), "{:#?}", checked.false_claims);
    assert!(checked.points > u64::from(per_box), "no points");
    // Points next to the optimum were among them, with the claim of 1 - eps.
    let least = 1.0 / (1.0 - eps) - 1.0;
    assert!(checked.closest < least * 1.1, "{} of {least}", checked.closest);
    assert!(checked.certificate.complete);
    checked.certificate
}

#[test]
fn no_cost_is_below_what_is_claimed() {
    assert_true(&thinned(&noisy(3, 1), 3), &FitOptions::default(), 0.05, 4);
    let (samples, options) = (thinned(&noisy(1, 1), 6), FitOptions::default());
    let boxes = prove(&samples, &options, &best(&samples, &options), 0.05).boxes;
    // Of which some are outside the bounds.
    let per_box = (3_000_000 / boxes) as u32;
    let checked = check(&samples, &options, &best(&samples, &options), 0.05, per_box);
    assert!(checked.points >= 1_000_000, "{} points", checked.points);
    assert!(checked.false_claims.is_empty(), "{:#?}", checked.false_claims);
}

#[test]
fn every_set_of_terms_is_proved() {
    let samples = thinned(&noisy(2, 1), 6);
    for terms in [
        DIFFUSE,
        SURFACE,
        DIFFUSE | SURFACE,
        DIFFUSE | SURFACE | ABSORBING,
        DIFFUSE | SURFACE | VOLUME,
        SURFACE | ABSORBING,
    ] {
        let mut options = FitOptions {
            terms,
            ..FitOptions::default()
        };
        if terms & DIFFUSE == 0 {
            // Without Lambert's part a narrow range keeps the test short.
            hold(&mut options, "m", 0.1, 2.0);
        }
        let checked = check(&samples, &options, &best(&samples, &options), 0.1, 4);
        assert!(checked.certificate.complete, "{terms:#b}");
        assert!(
            checked.false_claims.is_empty(),
            "{terms:#b}: {:#?}",
            checked.false_claims
        );
    }
}

#[test]
fn bounds_fixed_parameters_and_weights_are_honoured() {
    let mut samples = thinned(&noisy(1, 2), 4);
    for (k, sample) in samples.iter_mut().enumerate() {
        sample.weight = [1e3, 0.0, 2e3, -5e2][k % 4];
    }
    let mut options = FitOptions::default();
    hold(&mut options, "n", 1.5, 1.5);
    hold(&mut options, "rho_d", 0.11, 0.2);
    let certificate = assert_true(&samples, &options, 0.05, 20);
    assert_eq!(certificate.params.n, 1.5);
    assert!(certificate.params.rho_d >= 0.11);
    // The optimum without these bounds is lower, and was not adopted.
    let free = prove(&samples, &FitOptions::default(), &certificate.params, 0.05);
    assert!(free.better > 0 && free.cost < certificate.cost * 0.99);
}

#[test]
fn a_missed_minimum_is_found() {
    for (name, missed, least) in [
        ("onedeg_min", [1e-5, 1.0, 0.0, 1.4e-5, 1.5, 0.5], 0.141_84),
        ("mirror_min", [1e-4, 1.0, 0.0, 2e-5, 1.5, 0.5], 0.073_2),
    ] {
        let samples = scan(&data(&format!("fit/{name}.csv")));
        let certificate = prove(&samples, &FitOptions::default(), &Params::from_array(missed), 0.05);
        assert!(certificate.complete && certificate.better > 0);
        assert!(certificate.cost < least, "{name}: {}", certificate.cost);
    }
}

/// A claim on a cost that is not the least is never proved: a better minimum takes its place.
#[test]
fn false_claims_are_refused() {
    let samples = noisy(3, 1);
    let options = FitOptions::default();
    let right = best(&samples, &options);
    let cost = prove(&samples, &options, &right, 0.05).cost;
    for wrong in [
        Params { m: 1e-5, ..right },
        Params { m: 1.0, ..right },
        Params {
            rho_s: 0.0,
            rho_v: 0.0,
            ..right
        },
        Params { rho_d: 1.0, ..right },
        Params {
            n: 1.0,
            kappa: 0.0,
            ..right
        },
    ] {
        let certificate = prove(&samples, &options, &wrong, 0.05);
        assert!(certificate.complete && certificate.better > 0);
        assert!(
            certificate.cost < cost * (1.0 + 1e-9),
            "{} from {wrong:?}",
            certificate.cost
        );
    }
}

#[test]
fn the_slow_oracle_agrees_box_by_box() {
    let samples = thinned(&noisy(3, 2), 12);
    // With the index held, the oracle has four coordinates to halve.
    let mut options = FitOptions {
        terms: DIFFUSE | SURFACE,
        ..FitOptions::default()
    };
    hold(&mut options, "n", 1.5, 1.5);
    let scene = scene(&samples, &options).expect("the scan is valid");
    let visits = Mutex::new(Vec::new());
    let watch = |visit: &Visit| visits.lock().expect("no thread panics").push(*visit);
    let claim = Claim {
        eps: 0.05,
        boxes: u64::MAX,
        alone: false,
        stop: &|| false,
        progress: &|_| {},
        watch: Some(&watch),
    };
    certify(&samples, &options, &best(&samples, &options), &claim).expect("the scan is valid");
    let visits = visits.into_inner().expect("no thread panics");
    let closed = |region: &Region| (0..6).all(|i| region.lo[i].is_finite() || region.hi[i] == f64::NEG_INFINITY);
    let bright = |visit: &&Visit| visit.after.is_none() && closed(&visit.before);
    let mut excluded: Vec<Visit> = visits.iter().filter(bright).copied().collect();
    // The oracle is slow: of large boxes it would say nothing.
    let size = |visit: &Visit| {
        (0..3)
            .map(|i| visit.before.hi[i] - visit.before.lo[i])
            .filter(|x| x.is_finite())
            .sum::<f64>()
    };
    excluded.sort_by(|a, b| size(a).total_cmp(&size(b)));
    let mut counts = [0; 3];
    for visit in excluded.iter().take(40) {
        let verdict = verdict(&scene, &samples, &visit.before, visit.target, 3000);
        assert_ne!(verdict, Verdict::Below, "{visit:?}");
        counts[verdict as usize] += 1;
    }
    let [above, _, open] = counts;
    assert!(above >= 3, "the oracle confirmed {above} boxes and left {open} open");
}

#[test]
fn the_oracle_refutes_what_is_false() {
    let samples = thinned(&noisy(3, 2), 12);
    let options = FitOptions::default();
    let scene = scene(&samples, &options).expect("the scan is valid");
    let right = best(&samples, &options);
    let mut region = Region {
        lo: scene.point(&Params {
            rho_v: right.rho_v.max(1e-6),
            ..right
        }),
        hi: [0.0; 6],
        bound: 0.0,
    };
    region.hi = region.lo.map(|x| x + 1e-9);
    let cost = scene.cost(&right);
    assert_eq!(verdict(&scene, &samples, &region, cost * 1.01, 100), Verdict::Below);
    assert_eq!(verdict(&scene, &samples, &region, cost * 0.99, 100), Verdict::Above);
}

#[test]
fn threads_change_nothing() {
    let samples = thinned(&noisy(1, 1), 3);
    let options = FitOptions::default();
    let start = Params {
        m: 0.5,
        ..best(&samples, &options)
    };
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        pool.install(|| prove(&samples, &options, &start, 0.2))
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn what_is_interrupted_says_how_far_it_came() {
    let samples = noisy(1, 1);
    let options = FitOptions::default();
    let rounds = AtomicU64::new(0);
    let seen = Mutex::new(Vec::new());
    let claim = Claim {
        eps: 0.01,
        boxes: u64::MAX,
        alone: false,
        stop: &|| rounds.fetch_add(1, Ordering::Relaxed) == 40,
        progress: &|certificate| seen.lock().expect("no thread panics").push(certificate.eps),
        watch: None,
    };
    let certificate = certify(&samples, &options, &best(&samples, &options), &claim).expect("the scan is valid");
    assert!(!certificate.complete && certificate.open > 0);
    assert!(certificate.eps > 0.01 && certificate.eps < 1.0, "{}", certificate.eps);
    let seen = seen.lock().expect("no thread panics").clone();
    assert!(
        seen.is_sorted_by(|a, b| a >= b),
        "what is proved stays proved: {seen:?}"
    );
    // A limit of boxes ends a proof too.
    let limited = Claim {
        boxes: 100,
        stop: &|| false,
        ..claim
    };
    let limited = certify(&samples, &options, &certificate.params, &limited).expect("the scan is valid");
    assert!(!limited.complete && limited.boxes >= 100);
}

/// No cost is below 0, and what rounding makes of 0 counts as 0.
#[test]
fn an_exact_fit_needs_no_box() {
    let samples: Vec<_> = noisy(1, 1)
        .iter()
        .map(|sample| Sample { brdf: 0.1, ..*sample })
        .collect();
    let options = FitOptions::default();
    let certificate = prove(&samples, &options, &best(&samples, &options), 0.05);
    assert!(certificate.complete);
    assert_eq!(certificate.boxes, 0);
}
