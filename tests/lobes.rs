//! Models put together from other lobes: against 60-digit values, against Eq. 14 as `Scan` fits it, and fitted to their own data.

use brdfit_core::brdf::ALL;
use brdfit_core::composed::{Composed, OWN_SLOPE, SECOND, parameters, slot};
use brdfit_core::geometry::{Block, LANES, Observation, Sample};
use brdfit_core::lm::{Bounds, Options, Problem};
use brdfit_core::lobes::{Beckmann, Distribution, Facets, Ggx, Masking, NoMasking, Smith, VGroove};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::search::{CANDIDATES, search};
use brdfit_suite::reference::{self, LobesRow};
use brdfit_suite::tolerance::{self, check};

const BOTH: u8 = OWN_SLOPE | SECOND;

/// ln f and its derivatives by the parameters; with kappa where the solver has kappa^2.
fn model<R: Real, D: Distribution, M: Masking<D>>(row: &LobesRow) -> [f64; 10] {
    let [theta_i, theta_s, delta_phi] = row.angles.map(R::of);
    let sample = Sample {
        theta_i,
        theta_s,
        delta_phi,
        brdf: R::ONE,
        weight: R::ONE,
    };
    let facets = [Facets::new(&[sample]).expect("a valid sample")];
    let mut x = row.params.map(R::of);
    x[5] *= x[5];
    let mut values = [0.0; 10];
    Composed::<R, D, M, BOTH, 9>::new(&facets).each(&x, |ln_f, gradient| {
        values[0] = ln_f.f64();
        for (value, derivative) in values[1..].iter_mut().zip(gradient) {
            *value = derivative.f64();
        }
    });
    values[6] *= 2.0 * row.params[5];
    values
}

fn by_name<R: Real>(row: &LobesRow) -> [f64; 10] {
    match (row.distribution.as_str(), row.masking.as_str()) {
        ("beckmann", "v-groove") => model::<R, Beckmann, VGroove>(row),
        ("beckmann", "smith") => model::<R, Beckmann, Smith>(row),
        ("beckmann", "none") => model::<R, Beckmann, NoMasking>(row),
        ("ggx", "v-groove") => model::<R, Ggx, VGroove>(row),
        ("ggx", "smith") => model::<R, Ggx, Smith>(row),
        ("ggx", "none") => model::<R, Ggx, NoMasking>(row),
        other => panic!("no such model: {other:?}"),
    }
}

fn worst<R: Real>() -> f64 {
    let mut worst = 0.0f64;
    for row in reference::lobes() {
        let values = by_name::<R>(&row);
        for (value, exact) in values.into_iter().zip(row.values) {
            worst = worst.max((value - exact).abs() / exact.abs().max(1.0) / R::EPSILON.f64());
        }
    }
    worst
}

#[test]
fn values_of_sixty_digits() {
    check(worst::<f64>(), tolerance::LOBES_F64);
    check(worst::<f32>(), tolerance::LOBES_F32);
}

fn samples(theta_i: f64, f: impl Fn(&Sample<f64>) -> f64) -> Vec<Sample<f64>> {
    (-80..=80)
        .step_by(2)
        .map(|degrees| {
            let sample = Sample::in_plane(theta_i.to_radians(), f64::from(degrees).to_radians(), 1.0);
            Sample {
                brdf: f(&sample),
                ..sample
            }
        })
        .collect()
}

fn facets(samples: &[Sample<f64>]) -> Vec<Facets<f64>> {
    samples
        .chunks(8)
        .map(|chunk| Facets::new(chunk).expect("valid samples"))
        .collect()
}

fn f<D: Distribution, M: Masking<D>, const EXTRAS: u8, const P: usize>(x: &[f64; P], sample: &Sample<f64>) -> f64 {
    let mut value = 0.0;
    let facets = [Facets::new(std::slice::from_ref(sample)).expect("a valid sample")];
    Composed::<f64, D, M, EXTRAS, P>::new(&facets).each(x, |ln_f, _| value = Real::exp(ln_f));
    value
}

/// Table 1, for every model.
fn bounds<const P: usize>(extras: u8) -> Bounds<f64, P> {
    let lower = [0.0, 0.0, 0.0, 1e-5, 1.0, 0.0, 1e-5, 0.0, 1e-5];
    let upper = [1.0, 100.0, 100.0, 10.0, 100.0, 1e4, 10.0, 100.0, 10.0];
    let mut bounds = Bounds {
        lower: [0.0; P],
        upper: [0.0; P],
    };
    for index in 0..9 {
        if let Some(k) = slot(extras, index) {
            bounds.lower[k] = lower[index];
            bounds.upper[k] = upper[index];
        }
    }
    bounds
}

#[test]
fn the_pieces_of_equation_14_give_its_fast_form() {
    let x = [0.1, 10.0, 0.5, 0.2, 3.0, 1.0];
    let samples = samples(30.0, |sample| 0.05 + sample.theta_s.abs());
    let composed = facets(&samples);
    let observations: Vec<_> = samples
        .iter()
        .map(|s| Observation::new(s).expect("a valid sample"))
        .collect();
    let blocks: Vec<_> = observations.chunks(LANES).map(Block::new).collect();
    let slow = Composed::<f64, Beckmann, VGroove, 0, 6>::new(&composed).linearize(&x);
    let fast = Scan::<f64, ALL, 6>::new(&blocks).linearize(&x);
    let mut worst = ((slow.cost - fast.cost) / fast.cost).abs();
    for i in 0..6 {
        worst = worst.max((slow.gradient[i] - fast.gradient[i]).abs() / fast.gradient[i].abs());
        for j in 0..6 {
            worst = worst.max((slow.hessian[i][j] - fast.hessian[i][j]).abs() / fast.hessian[i][j].abs());
        }
    }
    check(worst, tolerance::COMPOSED);
}

/// Cost of the best fit to data of the model itself.
fn recovered<D: Distribution, M: Masking<D>, const EXTRAS: u8, const P: usize>(x: [f64; P]) -> f64 {
    const { assert!(P == parameters(EXTRAS)) };
    let mut all = samples(20.0, |sample| f::<D, M, EXTRAS, P>(&x, sample));
    all.extend(samples(60.0, |sample| f::<D, M, EXTRAS, P>(&x, sample)));
    let facets = facets(&all);
    let scene = Composed::<f64, D, M, EXTRAS, P>::new(&facets);
    let found = search(&scene, &bounds::<P>(EXTRAS), 0, CANDIDATES, &Options::default());
    found.minima.best().expect("a minimum").cost
}

#[test]
fn every_model_finds_its_own_parameters() {
    let six = [0.05, 2.0, 0.3, 0.3, 2.0, 0.5];
    let costs = [
        recovered::<Beckmann, VGroove, 0, 6>(six),
        recovered::<Ggx, VGroove, 0, 6>(six),
        recovered::<Ggx, Smith, 0, 6>(six),
        recovered::<Beckmann, Smith, 0, 6>(six),
        recovered::<Ggx, NoMasking, 0, 6>(six),
        recovered::<Beckmann, VGroove, OWN_SLOPE, 7>([0.05, 2.0, 0.3, 0.3, 2.0, 0.5, 0.8]),
        recovered::<Beckmann, VGroove, SECOND, 8>([0.05, 2.0, 0.3, 0.1, 2.0, 0.5, 1.0, 0.4]),
        recovered::<Ggx, VGroove, SECOND, 8>([0.05, 2.0, 0.3, 0.1, 2.0, 0.5, 1.0, 0.4]),
    ];
    let worst = costs.into_iter().fold(0.0, f64::max);
    println!("largest cost {worst:e}");
    check(worst, tolerance::LOBES_FIT);
}
