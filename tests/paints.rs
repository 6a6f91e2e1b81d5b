//! Models of paints, and facets by their tilt: against 60-digit arithmetic, and at their limits.

use brdfit::engine::{FitOptions, Model as Compiled, fit};
use brdfit_core::brdf::{ABSORBING, DIFFUSE, SURFACE};
use brdfit_core::formula::Own;
use brdfit_core::geometry::{Geometry, Sample};
use brdfit_core::lobes::{Beckmann, InAngle, VGroove};
use brdfit_core::microfacet::Microfacet;
use brdfit_core::model::Model;
use brdfit_core::models::BeardMaxwell;
use brdfit_core::real::Real;
use brdfit_core::residuals::ln_f;
use brdfit_suite::corners::corners;
use brdfit_suite::tolerance::{self, check};
use dashu_float::{FBig, round::mode::HalfEven};

type Big = FBig<HalfEven, 2>;

fn big(x: f64) -> Big {
    Big::try_from(x).expect("a finite number").with_precision(220).value()
}

fn f64(x: &Big) -> f64 {
    x.to_f64().value()
}

fn squared(x: &Big) -> Big {
    x.clone() * x.clone()
}

/// Halved five times, and then by its series.
fn atan(x: &Big) -> Big {
    let mut x = x.clone();
    for _ in 0..5 {
        x = x.clone() / (big(1.0) + (big(1.0) + squared(&x)).sqrt());
    }
    let (x2, mut power, mut sum) = (squared(&x), x, big(0.0));
    for k in 0..50 {
        let term = power.clone() / big(f64::from(2 * k + 1));
        sum = if k % 2 == 0 { sum + term } else { sum - term };
        power *= x2.clone();
    }
    sum * big(32.0)
}

fn pi() -> Big {
    atan(&big(1.0)) * big(4.0)
}

/// F of n - i kappa, given kappa^2, at the cosine of the angle of incidence.
fn fresnel(n: &Big, kappa2: &Big, c: &Big) -> Big {
    let s2 = big(1.0) - squared(c);
    let real = squared(n) - kappa2.clone() - s2.clone();
    let size = (squared(&real) + big(4.0) * squared(n) * kappa2.clone()).sqrt();
    let a = ((size.clone() + real) * big(0.5)).sqrt();
    let two_ac = big(2.0) * a.clone() * c.clone();
    let perpendicular = (size.clone() - two_ac.clone() + squared(c)) / (size.clone() + two_ac + squared(c));
    let (far, near) = (size * squared(c) + squared(&s2), big(2.0) * a * c.clone() * s2);
    let parallel = (far.clone() - near.clone()) / (far + near);
    perpendicular * (big(1.0) + parallel) * big(0.5)
}

/// f from the numbers that the model has of a pair of directions; of Torrance and Sparrow's the first column is tan^2 theta_h here, and the last the factor of Eq. 14's geometry.
fn torrance_sparrow(x: &[Big], at: &[Big]) -> Big {
    let [tan2, cos_d, factor] = [&at[0], &at[2], &at[4]];
    let theta2 = squared(&atan(&tan2.sqrt()));
    let m2 = squared(&x[2]);
    let cos_4 = squared(&(big(1.0) + tan2.clone()));
    let lobe = (-(theta2 / m2.clone())).exp() * factor.clone() / (m2 * cos_4);
    x[0].clone() / pi() + x[1].clone() * fresnel(&x[3], &x[4], cos_d) * lobe
}

fn beard_maxwell(x: &[Big], at: &[Big]) -> Big {
    let [cos_i, cos_s, tan2, cos_d] = [&at[0], &at[1], &at[5], &at[6]];
    let theta_h = atan(&tan2.sqrt());
    let theta_d = atan(&((big(1.0) - squared(cos_d)).sqrt() / cos_d.clone()));
    let tilt = theta_h.clone() / x[6].clone();
    let hidden = (big(-2.0) * theta_d / x[5].clone()).exp();
    let shadowing = (big(1.0) + tilt.clone() * hidden) / (big(1.0) + tilt);
    let none = big(0.0);
    let over = fresnel(&x[4], &none, cos_d) / fresnel(&x[4], &none, &big(1.0));
    let density = (-squared(&(theta_h / x[3].clone()))).exp();
    let surface = density * over * shadowing / ((big(1.0) + tan2.clone()) * cos_i.clone() * cos_s.clone());
    let volume = big(2.0) / (cos_i.clone() + cos_s.clone());
    x[0].clone() / pi() + x[1].clone() * surface + x[2].clone() * volume
}

/// Directions, radians: specular ones, near them, far from them, grazing, and out of plane.
fn directions() -> Vec<[f64; 3]> {
    let pi = std::f64::consts::PI;
    let mut all = Vec::new();
    for theta_i in [0.0, 0.3, 0.8, 1.5] {
        for off in [0.0, 1e-3, 0.05, 0.6] {
            all.push([theta_i, theta_i - off, pi]);
            all.push([theta_i, theta_i, pi - off]);
        }
        all.push([theta_i, -1.4, pi]);
        all.push([theta_i, 1.0, 0.5]);
    }
    all
}

/// Largest errors of ln f and of its derivatives, in epsilons: against 66 digits, and their central differences.
fn worst<R: Real, M: Model<R, P, C>, const P: usize, const C: usize>(
    cases: &[[f64; P]],
    given: impl Fn([R; 3], [R; C]) -> [R; C],
    exact: impl Fn(&[Big], &[Big]) -> Big,
) -> [f64; 2] {
    let mut worst = [0.0f64; 2];
    for case in cases {
        let x = case.map(R::of);
        for angles in directions() {
            let in_plane = angles[2] == std::f64::consts::PI;
            let mut angles = angles.map(R::of);
            if in_plane {
                angles[2] = R::PI;
            }
            let at = M::geometry(angles[0], angles[1], angles[2]).expect("above the horizon");
            let numbers = given(angles, at).map(|number| big(number.f64()));
            let own: Vec<Big> = x.iter().map(|value| big(value.f64())).collect();
            let f = exact(&own, &numbers);
            if f64(&f) < 1e3 * R::TINY.f64() {
                continue;
            }
            let ln = f64(&f.ln());
            let (value, gradient) = ln_f::<R, M, P, C>(&x, at);
            worst[0] = worst[0].max((value.f64() - ln).abs() / (R::EPSILON.f64() * (1.0 + ln.abs())));
            for k in 0..P {
                let step = own[k].clone() * big(1e-20) + big(1e-30);
                let beside = |step: Big| {
                    let mut x = own.clone();
                    x[k] = x[k].clone() + step;
                    exact(&x, &numbers)
                };
                let slope = (beside(step.clone()) - beside(-step.clone())) / (big(2.0) * step * f.clone());
                let slope = f64(&slope);
                // A parameter that moves ln f by less than its rounding has no derivative worth a digit.
                let unit = slope.abs() + 1.0 / own_size(&own[k]);
                worst[1] = worst[1].max((gradient[k].f64() - slope).abs() / (R::EPSILON.f64() * unit));
            }
        }
    }
    worst
}

fn own_size(x: &Big) -> f64 {
    f64(x).abs().max(0.01)
}

type TorranceSparrow = Microfacet<{ DIFFUSE | SURFACE | ABSORBING }, Beckmann, InAngle<VGroove>>;

const TORRANCE_SPARROW: [[f64; 5]; 3] = [
    [0.03, 2.0, 0.3, 2.0, 0.25],
    [0.0, 50.0, 0.8, 1.2, 9.0],
    [0.5, 1.0, 0.01, 1.5, 0.0],
];
const BEARD_MAXWELL: [[f64; 7]; 4] = [
    [0.03, 2.0, 0.3, 0.3, 2.0, 0.3, 0.1],
    [0.0, 5.0, 0.0, 1.5, 1.2, 10.0, 0.01],
    [0.1, 30.0, 0.01, 0.02, 1.65, 0.01, 10.0],
    [0.0, 1.0, 0.2, 0.5, 30.0, 1.0, 1.0],
];

fn all<R: Real>() -> [f64; 2] {
    let tan2 = |angles: [R; 3], _: [R; 6]| {
        let [theta_i, theta_s, delta_phi] = angles;
        let columns: [R; 6] = Geometry::new(theta_i, theta_s, delta_phi)
            .expect("above the horizon")
            .into();
        columns
    };
    let same = |_: [R; 3], at: [R; 8]| at;
    let each = [
        worst::<R, TorranceSparrow, 5, 6>(&TORRANCE_SPARROW, tan2, torrance_sparrow),
        worst::<R, Own<BeardMaxwell>, 7, 8>(&BEARD_MAXWELL, same, beard_maxwell),
    ];
    println!("{each:?}");
    [0, 1].map(|k| each.iter().map(|one| one[k]).fold(0.0, f64::max))
}

#[test]
fn values_and_derivatives_of_sixty_digits() {
    let double = all::<f64>();
    let single = all::<f32>();
    check(double[0], tolerance::PAINTS_F64);
    check(double[1], tolerance::PAINTS_GRADIENT_F64);
    check(single[0], tolerance::PAINTS_F32);
    check(single[1], tolerance::PAINTS_GRADIENT_F32);
}

#[test]
fn no_corner_of_the_domain_overflows() {
    corners::<f64, BeardMaxwell, 7>(&directions());
    corners::<f32, BeardMaxwell, 7>(&directions());
}

/// With tilts so small that they are slopes, Torrance and Sparrow's is Cook and Torrance's.
#[test]
fn small_tilts_are_slopes() {
    type CookTorrance = Microfacet<{ DIFFUSE | SURFACE | ABSORBING }>;
    let x = [0.01, 2.0, 1e-3, 2.0, 0.25];
    for off in [0.0, 5e-4, 1e-3, 2e-3] {
        let of = |geometry: Result<[f64; 6], _>| geometry.expect("above the horizon");
        let one = of(<TorranceSparrow as Model<f64, 5, 6>>::geometry(0.5, 0.5 - off, f64::PI));
        let other = of(<CookTorrance as Model<f64, 5, 6>>::geometry(0.5, 0.5 - off, f64::PI));
        let one = ln_f::<f64, TorranceSparrow, 5, 6>(&x, one).0;
        let other = ln_f::<f64, CookTorrance, 5, 6>(&x, other).0;
        assert!((one - other).abs() < 1e-5, "{off}: {one} {other}");
    }
}

#[test]
fn searches_find_the_parameters_again() {
    for (name, cases) in [
        ("torrance-sparrow", TORRANCE_SPARROW.map(|x| x.to_vec()).to_vec()),
        ("beard-maxwell", BEARD_MAXWELL.map(|x| x.to_vec()).to_vec()),
    ] {
        let model = Compiled::find(name).expect("a model");
        for mut truth in cases {
            if let Some(kappa) = model.place("kappa") {
                truth[kappa] = libm::sqrt(truth[kappa]);
            }
            let mut samples = Vec::new();
            for theta_i in [0.2, 0.9] {
                for degrees in (-80..=80).step_by(2) {
                    let sample = Sample::in_plane(theta_i, f64::from(degrees).to_radians(), 1.0);
                    let ln_f = model.ln_f(&truth, &sample).expect("above the horizon");
                    samples.push(Sample {
                        brdf: Real::portable_exp(ln_f),
                        ..sample
                    });
                }
            }
            let found = fit(&samples, &FitOptions::of(model)).expect("a fit");
            assert!(
                found.cost < 1e-14,
                "{name} {truth:?}: {} at {:?}",
                found.cost,
                found.params
            );
        }
    }
}
