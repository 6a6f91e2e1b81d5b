//! Checks what a proof claims of its boxes, at random points and with the slow oracle of [`crate::interval_oracle`].

use std::sync::Mutex;

use brdfit::engine::FitOptions;
use brdfit::engine::certify::{self, Certificate, Claim, Region, Visit, certify};
use brdfit_core::brdf::Params;
use brdfit_core::geometry::Sample;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// What a proof said, and what was checked of it.
#[derive(Debug)]
pub struct Checked {
    pub certificate: Certificate,
    /// Points at which a claim was compared with the cost.
    pub points: u64,
    /// Claims that are not true, described.
    pub false_claims: Vec<String>,
    /// The least cost over a claim, less 1.
    pub closest: f64,
}

/// A proof without limits.
pub fn prove(samples: &[Sample<f64>], options: &FitOptions, best: &Params<f64>, eps: f64) -> Certificate {
    let claim = Claim {
        eps,
        boxes: u64::MAX,
        alone: false,
        stop: &|| false,
        progress: &|_| {},
        watch: None,
    };
    certify(samples, options, best, &claim).expect("the scan is valid")
}

/// A proof with `per_box` points in each of its boxes: half of them anywhere, half as near to the `best` as the box allows.
pub fn check(samples: &[Sample<f64>], options: &FitOptions, best: &Params<f64>, eps: f64, per_box: u32) -> Checked {
    let scene = certify::scene(samples, options).expect("the scan is valid");
    let known = scene.point(best);
    let sums = Mutex::new((0, Vec::new(), f64::INFINITY));
    let watch = |visit: &Visit| {
        let bits = visit.before.lo.iter().chain(&visit.before.hi).map(|x| x.to_bits());
        let seed = bits.fold(0, |seed: u64, bits| {
            seed.rotate_left(7) ^ bits.wrapping_mul(0x9e37_79b9_7f4a_7c15)
        });
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        for k in 0..per_box {
            let x = point(&visit.before, (k % 2 == 0).then_some(&known), &mut random);
            let params = scene.params(&x);
            if !allowed(&params, options) {
                continue;
            }
            let (claim, cost) = (claimed(visit, &x), scene.cost(&params));
            let mut sums = sums.lock().expect("no thread panics");
            sums.0 += 1;
            sums.2 = sums.2.min(cost / claim - 1.0);
            // The cost itself is rounded.
            if cost < claim * (1.0 - 1e-12) {
                sums.1
                    .push(format!("{cost} at {params:?} is below {claim} of {visit:?}"));
            }
        }
    };
    let claim = Claim {
        eps,
        boxes: u64::MAX,
        alone: false,
        stop: &|| false,
        progress: &|_| {},
        watch: Some(&watch),
    };
    let certificate = certify(samples, options, best, &claim).expect("the scan is valid");
    let (points, false_claims, closest) = sums.into_inner().expect("no thread panics");
    Checked {
        certificate,
        points,
        false_claims,
        closest,
    }
}

/// What is claimed of the cost at a point of a visited box.
fn claimed(visit: &Visit, x: &[f64; 6]) -> f64 {
    let within = |region: &Region| (0..6).all(|i| region.lo[i] <= x[i] && x[i] <= region.hi[i]);
    match visit.after {
        Some(after) if within(&after) => after.bound,
        _ => visit.target,
    }
}

/// A point of a box; coordinates of `near` are moved into it, and now and then one is anywhere.
fn point(region: &Region, near: Option<&[f64; 6]>, random: &mut Xoshiro256PlusPlus) -> [f64; 6] {
    let mut unit = || (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    std::array::from_fn(|i| {
        let (lo, hi) = (region.lo[i], region.hi[i]);
        let near = near.filter(|_| unit() < 0.8).map(|x| x[i]);
        if hi == f64::NEG_INFINITY {
            hi
        } else if lo == f64::NEG_INFINITY {
            near.filter(|&x| x <= hi).unwrap_or(hi + 3.0 * unit().max(1e-9).ln())
        } else if let Some(x) = near {
            x.clamp(lo, hi)
        } else if lo > 0.0 && hi > 2.0 * lo {
            (lo * (hi / lo).powf(unit())).clamp(lo, hi)
        } else {
            (lo + (hi - lo) * unit()).clamp(lo, hi)
        }
    })
}

/// Within the bounds but for rounding; a claim says nothing of other parameters.
fn allowed(params: &Params<f64>, options: &FitOptions) -> bool {
    let (lower, upper) = (&options.lower, &options.upper);
    let within = |(k, x): (usize, f64)| x >= lower[k] * (1.0 - 1e-12) && x <= upper[k] * (1.0 + 1e-12);
    params.to_array().into_iter().enumerate().all(within)
}
