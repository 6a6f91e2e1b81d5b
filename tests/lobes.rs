//! Models put together from other lobes: against 60-digit values, and fitted to their own data.

use brdfit_core::brdf::{ALL, MIRRORS, OWN_SLOPE, SECOND, TAIL};
use brdfit_core::geometry::{Block, Geometry, LANES, Sample};
use brdfit_core::lm::Options;
use brdfit_core::lobes::{Beckmann, Distribution, Exponential, Ggx, HyperCauchy, NoMasking, Smith, VGroove};
use brdfit_core::microfacet::Microfacet;
use brdfit_core::model::Model;
use brdfit_core::real::Real;
use brdfit_core::residuals::{Residuals, ln_f, observe};
use brdfit_core::search::{CANDIDATES, search};
use brdfit_suite::reference::{self, LobesRow};
use brdfit_suite::tolerance::{self, check};

const BOTH: u8 = ALL | OWN_SLOPE | SECOND;

/// ln f and its derivatives by the parameters; with kappa where the solver has kappa^2.
fn model<R: Real, M: Model<R, 9, C>, const C: usize>(row: &LobesRow) -> [f64; 10] {
    let [theta_i, theta_s, delta_phi] = row.angles.map(R::of);
    let geometry = M::geometry(theta_i, theta_s, delta_phi).expect("valid angles");
    let mut x = row.params.map(R::of);
    x[5] *= x[5];
    let (ln_f, gradient) = ln_f::<R, M, 9, C>(&x, geometry);
    let mut values = [ln_f.f64(); 10];
    for (value, derivative) in values[1..].iter_mut().zip(gradient) {
        *value = derivative.f64();
    }
    values[6] *= 2.0 * row.params[5];
    values
}

fn by_name<R: Real>(row: &LobesRow) -> [f64; 10] {
    match (row.distribution.as_str(), row.masking.as_str()) {
        ("beckmann", "v-groove") => model::<R, Microfacet<BOTH, Beckmann, VGroove>, 6>(row),
        ("beckmann", "smith") => model::<R, Microfacet<BOTH, Beckmann, Smith>, 8>(row),
        ("beckmann", "none") => model::<R, Microfacet<BOTH, Beckmann, NoMasking>, 6>(row),
        ("ggx", "v-groove") => model::<R, Microfacet<BOTH, Ggx, VGroove>, 6>(row),
        ("ggx", "smith") => model::<R, Microfacet<BOTH, Ggx, Smith>, 8>(row),
        ("ggx", "none") => model::<R, Microfacet<BOTH, Ggx, NoMasking>, 6>(row),
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

/// f of a model, sr^-1.
fn f<M: Model<f64, P, C>, const P: usize, const C: usize>(x: &[f64; P], sample: &Sample<f64>) -> f64 {
    let geometry = M::geometry(sample.theta_i, sample.theta_s, sample.delta_phi).expect("valid angles");
    Real::portable_exp(ln_f::<f64, M, P, C>(x, geometry).0)
}

/// Cost of the best fit to data of the model itself.
fn recovered<M: Model<f64, P, C>, const P: usize, const C: usize>(x: [f64; P]) -> f64 {
    let mut all = samples(20.0, |sample| f::<M, P, C>(&x, sample));
    all.extend(samples(60.0, |sample| f::<M, P, C>(&x, sample)));
    let observations: Vec<_> = all
        .iter()
        .map(|sample| observe::<f64, M, P, C>(sample).expect("a valid sample"))
        .collect();
    let blocks: Vec<_> = observations.chunks(LANES).map(Block::new).collect();
    let scene = Residuals::<f64, M, P, C>::new(&blocks);
    let bounds = Residuals::<f64, M, P, C>::usual_bounds();
    let found = search(&scene, &bounds, 0, CANDIDATES, &Options::default());
    found.minima.best().expect("a minimum").cost
}

#[test]
fn every_model_finds_its_own_parameters() {
    const OWN: u8 = ALL | OWN_SLOPE;
    const TWO: u8 = ALL | SECOND;
    let six = [0.05, 2.0, 0.3, 0.3, 2.0, 0.5];
    let costs = [
        recovered::<Microfacet<ALL>, 6, 6>(six),
        recovered::<Microfacet<ALL, Ggx>, 6, 6>(six),
        recovered::<Microfacet<ALL, Ggx, Smith>, 6, 8>(six),
        recovered::<Microfacet<ALL, Beckmann, Smith>, 6, 8>(six),
        recovered::<Microfacet<ALL, Ggx, NoMasking>, 6, 6>(six),
        recovered::<Microfacet<OWN>, 7, 6>([0.05, 2.0, 0.3, 0.3, 2.0, 0.5, 0.8]),
        recovered::<Microfacet<TWO>, 8, 6>([0.05, 2.0, 0.3, 0.1, 2.0, 0.5, 1.0, 0.4]),
        recovered::<Microfacet<TWO, Ggx>, 8, 6>([0.05, 2.0, 0.3, 0.1, 2.0, 0.5, 1.0, 0.4]),
        recovered::<Microfacet<{ ALL | TAIL }, HyperCauchy>, 7, 6>([0.05, 2.0, 0.3, 0.3, 2.0, 0.5, 3.0]),
        recovered::<Microfacet<TWO, Ggx, Smith>, 8, 8>([0.05, 2.0, 0.3, 0.1, 2.0, 0.5, 1.0, 0.4]),
        recovered::<Microfacet<{ ALL | MIRRORS }, Ggx>, 7, 6>([0.05, 2.0, 0.3, 0.3, 2.0, 0.5, 0.2]),
        recovered::<Microfacet<ALL, Exponential>, 6, 6>(six),
    ];
    println!("costs {costs:?}");
    check(costs.into_iter().fold(0.0, f64::max), tolerance::LOBES_FIT);
}

/// With a tail of exponent 2 the hyper-Cauchy distribution is GGX, and its derivative by the tail is that of differences.
#[test]
fn a_free_tail_contains_ggx() {
    type Tail = Microfacet<{ ALL | TAIL }, HyperCauchy>;
    let x = [0.05, 2.0, 0.3, 0.3, 2.0, 0.25, 2.0];
    let [six @ .., _] = x;
    let mut worst = [0.0f64; 2];
    for sample in samples(30.0, |_| 1.0) {
        let geometry = Geometry::new(sample.theta_i, sample.theta_s, sample.delta_phi).expect("valid angles");
        let (tail, by) = ln_f::<f64, Tail, 7, 6>(&x, geometry.into());
        let (ggx, by_six) = ln_f::<f64, Microfacet<ALL, Ggx>, 6, 6>(&six, geometry.into());
        worst[0] = worst[0].max((tail - ggx).abs());
        for k in 0..6 {
            worst[0] = worst[0].max((by[k] - by_six[k]).abs());
        }
        let at = |q: f64| {
            let mut moved = x;
            moved[6] = q;
            ln_f::<f64, Tail, 7, 6>(&moved, geometry.into()).0
        };
        worst[1] = worst[1].max((by[6] - (at(2.0 + 1e-5) - at(2.0 - 1e-5)) / 2e-5).abs());
    }
    check(worst[0], tolerance::TAIL_GGX);
    check(worst[1], tolerance::TAIL_SLOPE);
}

/// ln f of a surface lobe alone differs between any two tails by `ln (q - 1) - q ln (1 + t)`, t = tan^2 theta_h / m^2; its derivative by q follows.
fn tail<R: Real>() -> [f64; 2] {
    type Big = dashu_float::FBig<dashu_float::round::mode::HalfEven, 2>;
    let big = |x: f64| Big::try_from(x).expect("a finite number").with_precision(200).value();
    let mut worst = [0.0f64; 2];
    for q in [1.001, 1.01, 1.3, 2.0, 3.7, 10.0, 50.0] {
        for m in [0.02, 0.3, 3.0] {
            for sample in samples(30.0, |_| 1.0) {
                let angles = [sample.theta_i, sample.theta_s].map(R::of);
                let geometry = Geometry::new(angles[0], angles[1], R::PI).expect("valid angles");
                let at = |q: R| {
                    let x = [0.0, 2.0, 0.0, m, 2.0, 0.0].map(R::of);
                    let x = [x[0], x[1], x[2], x[3], x[4], x[5], q];
                    ln_f::<R, Microfacet<{ ALL | TAIL }, HyperCauchy>, 7, 6>(&x, geometry.into())
                };
                let (q, two) = (R::of(q), R::of(2.0));
                let (tail, ggx) = (at(q), at(two));
                let tan2 = big(geometry.surface().tan2_theta_h.f64());
                let m = big(R::of(m).f64());
                let ln = (big(1.0) + tan2 / (m.clone() * m)).ln();
                let less = big(q.f64()) - big(1.0);
                let change = (less.ln() - (big(q.f64()) - big(2.0)) * ln.clone()).to_f64().value();
                let slope = (big(1.0) / less - ln.clone()).to_f64().value();
                let exponent = q.f64() * ln.to_f64().value();
                // Below this the lobe counts as R::TINY.
                if tail.0.f64() < Real::portable_ln(R::TINY.f64()) + 7.0 {
                    continue;
                }
                let unit = R::EPSILON.f64() * (1.0 + exponent + ggx.0.f64().abs());
                worst[0] = worst[0].max((tail.0.f64() - ggx.0.f64() - change).abs() / unit);
                let unit = R::EPSILON.f64() * (1.0 + slope.abs());
                worst[1] = worst[1].max((tail.1[6].f64() - slope).abs() / unit);
            }
        }
    }
    println!("{worst:?}");
    worst
}

#[test]
fn any_tail_has_its_digits() {
    let (double, single) = (tail::<f64>(), tail::<f32>());
    check(double[0].max(single[0]), tolerance::TAIL_VALUE);
    check(double[1].max(single[1]), tolerance::TAIL_DERIVATIVE);
}

/// Mirrors add to rho_s F of the surface lobe what does not depend on the angle: with n so large that F is 1, rho_s and rho_m are one weight, by lanes and one by one.
#[test]
fn mirrors_are_facets_that_reflect_everything() {
    type Mirrors = Microfacet<{ ALL | MIRRORS }, Ggx>;
    let mut worst = [0.0f64; 2];
    for sample in samples(30.0, |_| 1.0) {
        let geometry = Geometry::new(sample.theta_i, sample.theta_s, sample.delta_phi).expect("valid angles");
        let plain = |rho_s: f64| {
            let x = [0.05, rho_s, 0.0, 0.3, 1e15, 0.0];
            ln_f::<f64, Microfacet<ALL, Ggx>, 6, 6>(&x, geometry.into())
        };
        let at = |rho_m: f64| {
            let x = [0.05, 0.5, 0.0, 0.3, 1e15, 0.0, rho_m];
            ln_f::<f64, Mirrors, 7, 6>(&x, geometry.into())
        };
        let ((one, by_one), (two, by_two)) = (plain(2.0), at(1.5));
        worst[0] = worst[0].max((one - two).abs()).max((by_one[1] - by_two[6]).abs());
        // With an index of its own the derivative is that of differences.
        let moved = |rho_m: f64| {
            let x = [0.05, 2.0, 0.3, 0.3, 2.0, 0.25, rho_m];
            ln_f::<f64, Mirrors, 7, 6>(&x, geometry.into())
        };
        let slope = (moved(0.2 + 1e-5).0 - moved(0.2 - 1e-5).0) / 2e-5;
        worst[1] = worst[1].max((moved(0.2).1[6] - slope).abs());
    }
    println!("mirrors {worst:?}");
    check(worst[0], tolerance::MIRRORS);
    check(worst[1], tolerance::MIRRORS_SLOPE);
}

/// Exponential slopes are a distribution: g is 1 in the sum over t, falls as it says, and its logarithm is a straight line over the slope.
#[test]
fn exponential_slopes_are_a_distribution() {
    use brdfit_core::pack::Pack;
    let g = |t: f64| Exponential::shape::<f64, 1>(Pack([t]), Pack([0.0]), 1.0).0[0];
    // Over u = sqrt(t), by Simpson's rule.
    let steps = 20_000;
    let (step, mut sum) = (60.0 / f64::from(steps), 0.0);
    for k in 0..=steps {
        let u = step * f64::from(k);
        let factor = if k == 0 || k == steps {
            1.0
        } else if k % 2 == 1 {
            4.0
        } else {
            2.0
        };
        sum += factor * 2.0 * u * g(u * u) * step / 3.0;
    }
    let mut worst = 0.0f64;
    for t in [1e-8, 1e-3, 0.5, 3.0, 400.0] {
        let exact = libm::exp(-libm::sqrt(t)) / 2.0;
        worst = worst.max((g(t) / exact - 1.0).abs());
        let fall = Exponential::fall::<f64, 1>(Pack([t]), 1.0).0[0];
        let slope = -(libm::log(g(t * 1.0001)) - libm::log(g(t / 1.0001))) / (2.0 * libm::log(1.0001));
        worst = worst.max((fall - slope).abs() / (1.0 + fall) * 1e-8);
    }
    println!("exponential {:e} {worst:e}", sum - 1.0);
    check((sum - 1.0).abs(), tolerance::EXPONENTIAL_SUM);
    check(worst, tolerance::EXPONENTIAL_VALUE);
    assert_eq!(g(1e12), 0.0);
}
