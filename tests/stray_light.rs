//! Models of stray light: against 60-digit arithmetic, at their limits, and found again from their own scans.

use brdfit_core::brdf::ALL;
use brdfit_core::check::worst_gradient;
use brdfit_core::dual::Number;
use brdfit_core::formula::{Directions, Formula, Own, worst_slope};
use brdfit_core::geometry::{Block, LANES, Sample};
use brdfit_core::lm::Options;
use brdfit_core::lobes::{Ggx, Smith};
use brdfit_core::microfacet::Microfacet;
use brdfit_core::model::{Model, Parameter, Role};
use brdfit_core::models::{Abg, HarveyShack, KCorrelation, KCorrelation2};
use brdfit_core::real::Real;
use brdfit_core::residuals::{Residuals, ln_f, observe};
use brdfit_core::search::{CANDIDATES, search};
use brdfit_suite::corners::corners;
use brdfit_suite::tolerance::{self, check};
use dashu_float::{FBig, round::mode::HalfEven};

type Big = FBig<HalfEven, 2>;

fn big(x: f64) -> Big {
    Big::try_from(x).expect("a finite number").with_precision(200).value()
}

/// 1 / pi, from pi in two parts.
fn per_pi() -> Big {
    big(1.0) / (big(std::f64::consts::PI) + big(1.224_646_799_147_353_2e-16))
}

/// f and its derivatives, and the largest logarithm on the way, whose rounding is that of the result.
struct Exact {
    f: Big,
    slopes: Vec<Big>,
    logarithm: f64,
}

/// x^y, and ln x; 0 to a power is 0, and to the power 0 is 1.
fn power(x: &Big, y: f64) -> (Big, Big) {
    if *x == big(0.0) {
        return (big(if y == 0.0 { 1.0 } else { 0.0 }), big(0.0));
    }
    let ln = x.ln();
    ((ln.clone() * big(y)).exp(), ln)
}

fn abg(x: &[f64], shift: f64) -> Exact {
    let [rho_d, a, b, g] = x.try_into().expect("four parameters");
    let (p, ln) = power(&big(shift), g);
    let below = big(1.0) / (big(b) + p.clone());
    let squared = big(a) * below.clone() * below.clone();
    Exact {
        f: big(rho_d) * per_pi() + big(a) * below.clone(),
        logarithm: (ln.clone() * big(g)).to_f64().value(),
        slopes: vec![per_pi(), below, -squared.clone(), -squared * p * ln],
    }
}

/// `height factor / (1 + (shift / length)^2)^(fall / 2)`: its derivatives by height, length and fall.
fn shoulder([height, length, fall]: [Big; 3], shift: &Big, factor: &Big) -> (Big, [Big; 3], f64) {
    let half = big(0.5);
    let r2 = (shift.clone() / length.clone()) * (shift.clone() / length.clone());
    let u = big(1.0) + r2.clone();
    let ln = u.ln();
    let exponent = -(ln.clone() * fall.clone() * half.clone());
    let w = exponent.exp() * factor.clone();
    let f = height * w.clone();
    let by_length = f.clone() * fall * r2 / (length * u);
    let by_fall = -(f.clone() * ln * half);
    (f, [w, by_length, by_fall], exponent.to_f64().value())
}

fn harvey_shack(x: &[f64], shift: f64) -> Exact {
    let (f, slopes, logarithm) = shoulder([big(x[1]), big(x[2]), big(x[3])], &big(shift), &big(1.0));
    Exact {
        f: big(x[0]) * per_pi() + f,
        slopes: [vec![per_pi()], slopes.to_vec()].concat(),
        logarithm,
    }
}

/// With one term or two; b is one over the length.
fn k_correlation(x: &[f64], shift: f64, cosines: f64) -> Exact {
    let mut exact = Exact {
        f: big(x[0]) * per_pi(),
        slopes: vec![per_pi()],
        logarithm: 0.0,
    };
    for term in x[1..].chunks(3) {
        let length = big(1.0) / big(term[1]);
        let place = [big(term[0]), length.clone(), big(term[2])];
        let (f, [by_a, by_length, by_c], logarithm) = shoulder(place, &big(shift), &big(cosines));
        exact.f += f;
        exact.slopes.extend([by_a, -by_length * length.clone() * length, by_c]);
        exact.logarithm = exact.logarithm.min(logarithm);
    }
    exact
}

/// Directions, radians: specular ones, near them by steps down to the rounding of `f32`, far from them, out of plane.
fn directions() -> Vec<[f64; 3]> {
    let pi = std::f64::consts::PI;
    let mut all = Vec::new();
    for theta_i in [0.0, 0.3, 0.8, 1.2, 1.5] {
        for off in [0.0, 1e-6, 1e-4, 1e-3, 0.01, 0.05, 0.2, 0.6] {
            all.push([theta_i, theta_i - off, pi]);
            all.push([theta_i, theta_i, pi - off]);
        }
        all.push([theta_i, -1.4, pi]);
        all.push([theta_i, 1.0, 0.5]);
    }
    all
}

/// Largest errors of ln f and of its derivatives, in epsilons of their natural scale.
fn worst<R: Real, F: Formula<P>, const P: usize>(
    cases: &[[f64; P]],
    exact: impl Fn(&[f64], f64, f64) -> Exact,
) -> [f64; 2] {
    let mut worst = [0.0f64; 2];
    let mut compared = 0;
    for case in cases {
        let x = case.map(R::of);
        let own = x.map(R::f64);
        for angles in directions() {
            let [theta_i, theta_s, delta_phi] = angles.map(R::of);
            let delta_phi = if angles[2] == std::f64::consts::PI {
                R::PI
            } else {
                delta_phi
            };
            let at = <Own<F> as Model<R, P, 8>>::geometry(theta_i, theta_s, delta_phi).expect("above the horizon");
            let exact = exact(&own, at[7].f64(), (at[0] * at[1]).f64());
            let f = exact.f.to_f64().value();
            // What is less counts as R::TINY, which no instrument sees.
            if f < 1e3 * R::TINY.f64() {
                continue;
            }
            compared += 1;
            let (value, gradient) = ln_f::<R, Own<F>, P, 8>(&x, at);
            let ln = exact.f.ln().to_f64().value();
            let steps = 1.0 + exact.logarithm.abs();
            let unit = R::EPSILON.f64() * steps;
            worst[0] = worst[0].max((value.f64() - ln).abs() / (unit + R::EPSILON.f64() * ln.abs()));
            for k in 0..P {
                let slope = (exact.slopes[k].clone() / exact.f.clone()).to_f64().value();
                // By an exponent, ln (1 + x) is right to the rounding of 1, not of x.
                let whole = match F::PARAMETERS[k].role {
                    Role::Shape => 1.0,
                    // A parameter that moves ln f by less than its rounding has no derivative worth a digit.
                    _ if own[k] > 0.0 => R::EPSILON.f64() / own[k],
                    _ => 0.0,
                };
                let error = (gradient[k].f64() - slope).abs() / (unit * (slope.abs() + whole));
                worst[1] = worst[1].max(error);
            }
        }
    }
    assert!(compared > 50 * cases.len(), "{compared} of {} cases", cases.len());
    worst
}

const ABG: [[f64; 4]; 7] = [
    [0.02, 0.01, 1e-3, 1.7],
    [0.0, 1e-3, 1e-12, 2.0],
    [1.0, 1e6, 10.0, 6.0],
    [0.1, 0.0, 1e-3, 2.0],
    [1e-3, 1e-4, 1e-15, 3.0],
    [0.05, 1.0, 1e-6, 0.0],
    [0.0, 1e-6, 1e-9, 0.5],
];
const HARVEY_SHACK: [[f64; 4]; 5] = [
    [0.02, 30.0, 0.02, 1.7],
    [0.0, 1e6, 1e-5, 2.0],
    [1e-3, 1e3, 1e-7, 6.0],
    [0.1, 1.0, 2.0, 0.0],
    [0.0, 10.0, 1e-3, 1.0],
];
const K_CORRELATION: [[f64; 4]; 4] = [
    [0.02, 50.0, 60.0, 2.2],
    [0.0, 1e6, 1e7, 1.0],
    [0.1, 1.0, 0.1, 6.0],
    [1e-3, 10.0, 1e3, 0.0],
];
const K_CORRELATION_2: [[f64; 7]; 3] = [
    [0.02, 50.0, 60.0, 2.2, 1.0, 4.0, 3.0],
    [0.0, 1e4, 1e5, 1.5, 0.1, 1.0, 6.0],
    [1e-3, 0.0, 1e3, 2.0, 5.0, 10.0, 0.5],
];

fn all<R: Real>() -> [f64; 2] {
    let each = [
        worst::<R, Abg, 4>(&ABG, |x, shift, _| abg(x, shift)),
        worst::<R, HarveyShack, 4>(&HARVEY_SHACK, |x, shift, _| harvey_shack(x, shift)),
        worst::<R, KCorrelation, 4>(&K_CORRELATION, k_correlation),
        worst::<R, KCorrelation2, 7>(&K_CORRELATION_2, k_correlation),
    ];
    println!("{each:?}");
    [0, 1].map(|k| each.iter().map(|one| one[k]).fold(0.0, f64::max))
}

#[test]
fn values_and_derivatives_of_sixty_digits() {
    let double = all::<f64>();
    let single = all::<f32>();
    check(double[0], tolerance::STRAY_LIGHT_F64);
    check(double[1], tolerance::STRAY_LIGHT_GRADIENT_F64);
    check(single[0], tolerance::STRAY_LIGHT_F32);
    check(single[1], tolerance::STRAY_LIGHT_GRADIENT_F32);
}

/// |beta - beta_0| from the angles, against the length of the difference of the two direction cosines in wider arithmetic.
#[test]
fn shift_keeps_its_digits_near_the_peak() {
    let mut worst = 0.0f64;
    for theta_i in [0.0f32, 0.3, 0.8, 1.2, 1.5] {
        for off in [1e-6f32, 1e-4, 1e-3, 0.01, 0.2, 0.6] {
            let theta_s = theta_i - off;
            let shift = Directions::new(theta_i, theta_s, f32::PI)
                .expect("above the horizon")
                .shift;
            let (mean, half) = (
                0.5 * (f64::from(theta_i) + f64::from(theta_s)),
                0.5 * (f64::from(theta_i) - f64::from(theta_s)),
            );
            let exact = (2.0 * libm::cos(mean) * libm::sin(half)).abs();
            worst = worst.max((f64::from(shift) / exact - 1.0).abs() / f64::from(f32::EPSILON));
        }
    }
    check(worst, tolerance::SHIFT_F32);
}

/// At the specular direction itself, with no shoulder, and with no slope.
#[test]
fn limits() {
    let at = |shift: f64| Directions {
        shift,
        ..Directions::new(0.5, 0.5, f64::PI).expect("above the horizon")
    };
    let floor = 0.1 / f64::PI;
    let peak = at(0.0);
    let (f, slopes) = Abg::gradient(&[0.1, 2.0, 1e-3, 0.2], &peak);
    assert!(
        (f / (floor + 2.0e3) - 1.0).abs() < 1e-15 && slopes[3] == 0.0,
        "{f} {slopes:?}"
    );
    // 0 to the power 0 is 1: without a slope the peak is as high as all else.
    let flat = [0.1, 2.0, 1e-3, 0.0];
    assert_eq!(Abg::gradient(&flat, &peak).0, Abg::gradient(&flat, &at(0.3)).0);
    let f = HarveyShack::gradient(&[0.1, 2.0, 1e-3, 1.5], &peak).0;
    assert!((f / (floor + 2.0) - 1.0).abs() < 1e-15);
    let cosines = peak.cos_i * peak.cos_s;
    let f = KCorrelation::gradient(&[0.1, 2.0, 1e3, 1.5], &peak).0;
    assert!((f / (floor + 2.0 * cosines) - 1.0).abs() < 1e-15);
    // With B near 0, A over the power.
    let f = Abg::gradient(&[0.0, 2.0, 1e-15, 1.5], &at(0.25)).0;
    assert!((f / 16.0 - 1.0).abs() < 1e-13);
    // The second term of weight 0 is nothing.
    let two = KCorrelation2::gradient(&[0.1, 2.0, 1e3, 1.5, 0.0, 5.0, 2.0], &at(0.25)).0;
    assert_eq!(two, KCorrelation::gradient(&[0.1, 2.0, 1e3, 1.5], &at(0.25)).0);
}

#[test]
fn no_corner_of_the_domain_overflows() {
    corners::<f64, Abg, 4>(&directions());
    corners::<f32, Abg, 4>(&directions());
    corners::<f64, HarveyShack, 4>(&directions());
    corners::<f32, HarveyShack, 4>(&directions());
    corners::<f64, KCorrelation, 4>(&directions());
    corners::<f32, KCorrelation, 4>(&directions());
    corners::<f64, KCorrelation2, 7>(&directions());
    corners::<f32, KCorrelation2, 7>(&directions());
}

/// Parameters of scene `k`, evenly in the logarithm over what surfaces have.
fn scene<const P: usize>(parameters: &[Parameter; P], k: u64) -> [f64; P] {
    let unit = |place: usize| {
        let word = (k * 64 + place as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let word = (word ^ word >> 31).wrapping_mul(0x94d0_49bb_1331_11eb);
        (word >> 11) as f64 / (1u64 << 53) as f64
    };
    let between = |least: f64, most: f64, place: usize| {
        libm::exp(libm::log(least) + (libm::log(most) - libm::log(least)) * unit(place))
    };
    std::array::from_fn(|place| match parameters[place].name {
        "rho_d" => between(1e-3, 0.5, place),
        "A" => between(1e-3, 0.1, place),
        "B" => between(1e-5, 1e-2, place),
        "b_0" | "a" => between(5.0, 500.0, place),
        "l" => between(5e-3, 0.1, place),
        "b" => between(20.0, 200.0, place),
        "a_2" => between(0.3, 2.0, place),
        "b_2" => between(2.0, 6.0, place),
        _ => between(1.5, 3.5, place),
    })
}

/// The scenes whose parameters a search does not find again.
fn lost<F: Formula<P>, const P: usize>(scenes: u64) -> Vec<u64> {
    let is_lost = |k: &u64| {
        let truth = scene(&F::PARAMETERS, *k);
        let angles = [0.2f64, 0.9].into_iter();
        let samples =
            angles.flat_map(|theta_i| (-80..=80).step_by(2).map(move |theta_s| (theta_i, f64::from(theta_s))));
        let observations: Vec<_> = samples
            .map(|(theta_i, degrees)| {
                let at = Directions::new(theta_i, degrees.to_radians(), f64::PI).expect("above the horizon");
                let sample = Sample::in_plane(theta_i, degrees.to_radians(), F::gradient(&truth, &at).0);
                observe::<f64, Own<F>, P, 8>(&sample).expect("a valid sample")
            })
            .collect();
        let blocks: Vec<_> = observations.chunks(LANES).map(Block::new).collect();
        let scan = Residuals::<f64, Own<F>, P, 8>::new(&blocks);
        let bounds = Residuals::<f64, Own<F>, P, 8>::usual_bounds();
        let found = search(&scan, &bounds, 0, CANDIDATES, &Options::default());
        found.best.at.cost > 1e-16
    };
    (0..scenes).filter(is_lost).collect()
}

#[test]
fn searches_find_the_parameters_again() {
    let lost = [
        lost::<Abg, 4>(40),
        lost::<HarveyShack, 4>(40),
        lost::<KCorrelation, 4>(40),
        lost::<KCorrelation2, 7>(40),
    ];
    assert!(lost.iter().all(Vec::is_empty), "{lost:?}");
}

/// A Lambertian floor and a lobe, whose own derivative by the width has the wrong factor.
#[derive(Clone, Copy)]
struct Wrong;

impl Formula<3> for Wrong {
    const PARAMETERS: [Parameter; 3] = [
        Parameter::new("rho_d", "ρ_d", Role::Weight, 1.0),
        Parameter::new("rho_s", "ρ_s", Role::Weight, 10.0),
        Parameter::new("m", "m", Role::Slope, 3.0),
    ];

    fn brdf<R: Real, N: Number<R>>([rho_d, rho_s, m]: &[N; 3], at: &Directions<R>) -> N {
        *rho_d / R::PI + *rho_s * (N::of(-at.tan2_theta_h) / m.squared()).exp()
    }

    fn gradient<R: Real>(x: &[R; 3], at: &Directions<R>) -> (R, [R; 3]) {
        let [rho_d, rho_s, m] = *x;
        let lobe = Real::portable_exp(-at.tan2_theta_h / (m * m));
        let by_m = rho_s * lobe * at.tan2_theta_h / (m * m * m);
        (rho_d / R::PI + rho_s * lobe, [R::ONE / R::PI, lobe, by_m])
    }
}

#[test]
fn the_derivative_check_names_the_wrong_parameter() {
    let at = Directions::new(0.4, 0.7, f64::PI).expect("above the horizon");
    let (place, off) = worst_slope::<f64, Wrong, 3>(&[0.1, 2.0, 0.3], &at);
    assert_eq!(Wrong::PARAMETERS[place].name, "m");
    assert!((off - 0.5).abs() < 1e-12, "{off}");
    let (_, off) = worst_slope::<f64, Abg, 4>(&ABG[0], &at);
    assert_eq!(off, 0.0);
}

/// The check of J'r by differences, of a scan that no model fits, at these values of the parameters.
fn differences<R: Real, M: Model<R, P, C>, const P: usize, const C: usize>(values: [f64; P]) -> (usize, f64) {
    let mut blocks = [Block::EMPTY; 2];
    for row in 0..2 * LANES {
        let theta_s = R::of(0.08 * (row as f64 - 12.0));
        let sample = Sample::in_plane(R::of(0.6), theta_s, R::of(0.3));
        let observation = observe::<R, M, P, C>(&sample).expect("above the horizon");
        blocks[row / LANES].set(row % LANES, &observation);
    }
    let x = Residuals::<R, M, P, C>::from_values(&values.map(R::of));
    let (place, off) = worst_gradient(&Residuals::<R, M, P, C>::new(&blocks), &x);
    (place, off.f64())
}

fn worst_difference<R: Real>() -> f64 {
    let eq_14 = [0.01, 0.3, 0.2, 0.2, 1.5, 0.3];
    [
        differences::<R, Microfacet<ALL>, 6, 6>(eq_14),
        differences::<R, Microfacet<ALL, Ggx, Smith>, 6, 8>(eq_14),
        differences::<R, Own<Abg>, 4, 8>(ABG[0]),
        differences::<R, Own<HarveyShack>, 4, 8>([0.01, 2.0, 0.05, 2.2]),
        differences::<R, Own<KCorrelation>, 4, 8>([0.01, 2.0, 20.0, 2.2]),
    ]
    .map(|(_, off)| off)
    .into_iter()
    .fold(0.0, f64::max)
}

#[test]
fn differences_of_the_cost_agree_with_right_derivatives_and_name_a_wrong_one() {
    check(worst_difference::<f64>(), tolerance::DIFFERENCES_F64);
    check(worst_difference::<f32>(), tolerance::DIFFERENCES_F32);
    let (place, off) = differences::<f64, Own<Wrong>, 3, 8>([0.1, 2.0, 0.3]);
    assert_eq!(Wrong::PARAMETERS[place].name, "m");
    assert!((off - 0.5).abs() < 1e-6, "{off}");
}
