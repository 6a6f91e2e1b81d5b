//! Standard errors against slow literal algebra, reflectance and the lobe's shape against slow literal integrals and scans.
#![allow(
    clippy::disallowed_methods,
    reason = "oracles may use std's functions; the code under test may not"
)]

use std::f64::consts::PI;

use brdfit::analysis::derived::{self, Peak};
use brdfit::analysis::reflectance::reflectance;
use brdfit::analysis::undetermined::undetermined;
use brdfit::engine::{self, FitOptions, Material};
use brdfit::result::words::sentence;
use brdfit_core::brdf::{DIFFUSE, SURFACE, VOLUME};
use brdfit_core::geometry::Sample;
use brdfit_core::lm::{Bounds, Linearization};
use brdfit_core::uncertainty::{Place, Uncertainty};
use brdfit_suite::literal;
use brdfit_suite::scan::{data, scan, six};
use brdfit_suite::tolerance::{self, check};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

const P: usize = 5;

fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(seed);
    move || (generator.next_u64() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// The inverse by Gauss and Jordan's elimination, of the rows and columns in `keep`; 0 elsewhere.
fn inverse(a: &[[f64; P]; P], keep: &[usize]) -> [[f64; P]; P] {
    let count = keep.len();
    let row = |i: usize| -> Vec<f64> {
        let unit = (0..count).map(|j| f64::from(u8::from(i == j)));
        keep.iter().map(|&j| a[keep[i]][j]).chain(unit).collect()
    };
    let mut rows: Vec<Vec<f64>> = (0..count).map(row).collect();
    for k in 0..count {
        let pivot: Vec<f64> = rows[k].iter().map(|x| x / rows[k][k]).collect();
        for row in &mut rows {
            let factor = row[k];
            row.iter_mut().zip(&pivot).for_each(|(x, y)| *x -= factor * y);
        }
        rows[k] = pivot;
    }
    let mut inverse = [[0.0; P]; P];
    for i in 0..count {
        for j in 0..count {
            inverse[keep[i]][keep[j]] = rows[i][count + j];
        }
    }
    inverse
}

/// A linear problem of 40 rows whose columns differ in size by 1e6, at the point that is 0.
fn linear(seed: u64) -> (Linearization<f64, P>, f64) {
    let mut random = random(seed);
    let rows: Vec<[f64; P]> = (0..40)
        .map(|_| std::array::from_fn(|k| random() * [1.0, 1e3, 1e-3, 1.0, 30.0][k]))
        .collect();
    let residuals: Vec<f64> = rows.iter().map(|_| 0.1 * random()).collect();
    let sum = |f: &dyn Fn(usize) -> f64| (0..rows.len()).map(f).sum::<f64>();
    let at = Linearization {
        cost: sum(&|r| residuals[r] * residuals[r]),
        gradient: std::array::from_fn(|i| sum(&|r| rows[r][i] * residuals[r])),
        hessian: std::array::from_fn(|i| std::array::from_fn(|j| sum(&|r| rows[r][i] * rows[r][j]))),
    };
    (at, 40.0)
}

#[test]
fn covariance_is_the_inverse() {
    let mut worst = 0.0f64;
    for seed in 0..50 {
        let (at, count) = linear(seed);
        // The second parameter is held by its bound, the fourth by equal bounds.
        let bounds = Bounds {
            lower: [-1.0, 0.0, -1.0, 0.0, -1.0],
            upper: [1.0, 1.0, 1.0, 0.0, 1.0],
        };
        let known = Uncertainty::new(&at, &[0.0; P], &bounds, 40);
        assert_eq!(known.places[1..4], [Place::Lower, Place::Inside, Place::Fixed]);
        assert_eq!(known.degrees_of_freedom, 37);
        let variance = at.cost / (count - 3.0);
        let compare = |got: f64, exact: f64, scale: f64| ((got - exact) / scale).abs();
        for (axes, keep) in [(&known.held, &[0, 2, 4][..]), (&known.lifted, &[0, 1, 2, 4])] {
            let exact = inverse(&at.hessian, keep);
            for i in 0..P {
                for j in 0..P {
                    let scale = (exact[i][i] * exact[j][j]).sqrt() * variance;
                    if scale == 0.0 {
                        assert_eq!(axes.covariance(i, j), 0.0);
                        assert_eq!(axes.correlation(i, j), 0.0);
                        continue;
                    }
                    worst = worst.max(compare(axes.covariance(i, j), exact[i][j] * variance, scale));
                    worst = worst.max(compare(axes.correlation(i, j), exact[i][j] * variance / scale, 1.0));
                }
            }
            let mut gradient = [0.0; P];
            keep.iter().for_each(|&k| gradient[k] = 1.0 / exact[k][k].sqrt());
            let of = |i: usize| (0..P).map(move |j| (i, j));
            let squared: f64 = (0..P)
                .flat_map(of)
                .map(|(i, j)| gradient[i] * exact[i][j] * gradient[j])
                .sum();
            let exact = (squared * variance).sqrt();
            worst = worst.max(compare(axes.standard_error_of(&gradient), exact, exact));
        }
    }
    check(worst, tolerance::COVARIANCE);
}

/// The push is how far the minimum over a parameter lies beyond its bound, where the others inside are at theirs.
#[test]
fn push_leads_to_the_minimum_beyond() {
    let mut worst = 0.0f64;
    for seed in 0..50 {
        let (mut at, _) = linear(seed);
        let bounds = Bounds {
            lower: [-1.0, 0.0, -1.0, -1.0, -1.0],
            upper: [1.0; P],
        };
        let free = [0, 2, 3, 4];
        free.iter().for_each(|&k| at.gradient[k] = 0.0);
        let known = Uncertainty::new(&at, &[0.0; P], &bounds, 40);
        let exact = inverse(&at.hessian, &[0, 1, 2, 3, 4]);
        let step = -exact[1][1] * at.gradient[1];
        let error = known.scale * exact[1][1].sqrt();
        worst = worst.max((known.push[1] * error / step - 1.0).abs());
        assert_eq!(free.map(|k| known.push[k]), [0.0; 4]);
    }
    check(worst, tolerance::PUSH);
}

#[test]
fn what_nothing_tells() {
    let mut worst = 0.0f64;
    for seed in 0..20 {
        let (mut at, _) = linear(seed);
        for k in 0..P {
            (at.hessian[4][k], at.hessian[k][4]) = (0.0, 0.0);
            // Columns 0 and 3 are the same.
            at.hessian[3][k] = at.hessian[0][k];
        }
        for k in 0..P {
            at.hessian[k][3] = at.hessian[k][0];
        }
        let bounds = Bounds {
            lower: [-1.0; P],
            upper: [1.0; P],
        };
        let known = Uncertainty::new(&at, &[0.0; P], &bounds, 40);
        assert_eq!(known.places[4], Place::Unseen);
        assert_eq!(known.held.standard_error(4), f64::INFINITY);
        assert_eq!(known.held.correlation(4, 0), 0.0);
        assert!(known.held.condition >= 0.1 / f64::EPSILON);
        assert!(known.held.correlation(0, 3) < -0.999_999);
        // What has nothing to do with those two is known as if they were one.
        let exact = inverse(&at.hessian, &[0, 1, 2]);
        for k in [1, 2] {
            let ratio = known.held.standard_error(k) / (known.scale * exact[k][k].sqrt());
            worst = worst.max((ratio - 1.0).abs());
        }
        // No degrees of freedom: nothing is known, and nothing is NaN.
        let none = Uncertainty::new(&at, &[0.0; P], &bounds, 4);
        assert_eq!((none.degrees_of_freedom, none.scale), (0, f64::INFINITY));
        assert!((0..P).all(|k| none.held.standard_error(k) == f64::INFINITY && none.held.correlation(0, k) == 0.0));
    }
    check(worst, tolerance::BESIDE_SINGULAR);
}

/// The midpoint rule over theta_s and the azimuth, of Eq. 14 as printed.
fn literal_reflectance(params: [f64; 6], theta_i: f64, count: usize) -> f64 {
    let (step, turn) = (0.5 * PI / count as f64, PI / count as f64);
    let mut sum = 0.0;
    for i in 0..count {
        let theta_s = (i as f64 + 0.5) * step;
        for j in 0..count {
            let f = literal::f([theta_i, theta_s, (j as f64 + 0.5) * turn], params);
            sum += 2.0 * f * theta_s.cos() * theta_s.sin() * step * turn;
        }
    }
    sum
}

#[test]
fn reflectance_is_the_integral() {
    let mut worst = 0.0f64;
    for (rho, m, n, kappa) in [
        ([0.0, 1.0, 0.0], 0.01, 1.5, 0.0),
        ([0.0, 0.0, 1.0], 0.01, 1.5, 0.3),
        ([0.1, 3.0, 0.2], 0.1, 3.0, 1.0),
        ([0.0, 1.0, 0.0], 0.3, 1.3, 0.0),
        ([0.0, 0.0, 1.0], 0.3, 1.3, 0.0),
        ([0.2, 1.0, 0.1], 1.0, 1.1, 0.9),
        ([0.0, 1.0, 0.0], 10.0, 1.5, 0.1),
        ([0.0, 0.0, 1.0], 10.0, 1.5, 0.1),
    ] {
        for theta_i in [5.0f64, 45.0, 80.0] {
            let params = [rho[0], rho[1], rho[2], m, n, kappa];
            let count = if m < 0.1 { 1000 } else { 500 };
            let slow = literal_reflectance(params, theta_i.to_radians(), count);
            let fast = reflectance(&Material::paper(params), theta_i.to_radians()).0;
            worst = worst.max((fast / slow - 1.0).abs());
        }
    }
    check(worst, tolerance::REFLECTANCE);
}

/// That by m is compared with the literal integral: a difference of the fast one would see its nodes move over the kinks of G.
#[test]
fn derivatives_of_the_reflectance() {
    let (mut worst, mut worst_m) = (0.0f64, 0.0f64);
    for theta_i in [5.0f64, 45.0, 80.0] {
        let params = [0.1, 3.0, 0.2, 0.2, 1.8, 0.7];
        let theta_i = theta_i.to_radians();
        let (_, gradient) = reflectance(&Material::paper(params), theta_i);
        for k in 0..6 {
            let at = |factor: f64| {
                let mut params = params;
                params[k] *= factor;
                if k == 3 {
                    literal_reflectance(params, theta_i, 400)
                } else {
                    reflectance(&Material::paper(params), theta_i).0
                }
            };
            let slope = (at(1.001) - at(0.999)) / (0.002 * params[k]);
            let error = (gradient[k] - slope).abs() / slope.abs().max(0.01);
            if k == 3 {
                worst_m = worst_m.max(error);
            } else {
                worst = worst.max(error);
            }
        }
    }
    check(worst, tolerance::REFLECTANCE_GRADIENT);
    check(worst_m, tolerance::REFLECTANCE_BY_M);
}

/// The lobe's peak and width from a fine table of Eq. 14 as printed, and their errors by moving each parameter.
#[test]
fn peak_and_width() {
    let samples = scan(&data("testdata1_sym_seed1.csv"));
    let options = FitOptions {
        terms: DIFFUSE | SURFACE | VOLUME,
        ..FitOptions::default()
    };
    let outcome = engine::fit(&samples, &options).unwrap();
    let known = &outcome.uncertainty;
    let table = |params: &[f64; 6]| {
        let lobe = [0.0, params[1], 0.0, params[3], params[4], params[5]];
        let f = |degrees: f64| literal::f([samples[0].theta_i, degrees.to_radians(), PI], lobe);
        let angles = (0..80_000).map(|k| 0.001 * f64::from(k));
        let (top, most) = angles
            .clone()
            .map(|at| (at, f(at)))
            .fold((0.0, 0.0), |a, b| if b.1 > a.1 { b } else { a });
        let above: Vec<f64> = angles.filter(|&at| f(at) > 0.5 * most).collect();
        [top, most, above[above.len() - 1] - above[0] + 0.001]
    };
    let params = six(&outcome.params);
    let [top, most, width] = table(&params);
    let peak = derived::at(samples[0].theta_i, &outcome.material(), known)
        .peak
        .unwrap();
    let got = peak.width.unwrap();
    let angles = [peak.theta_s.to_degrees() - top, got.value.to_degrees() - width];
    check(angles[0].abs().max(angles[1].abs()), tolerance::LOBE_ANGLES);
    check((peak.f.value / most - 1.0).abs(), tolerance::LOBE_PEAK);
    let mut gradient = [[0.0; 6]; 2];
    for k in [1, 3, 4] {
        let step = 0.02 * params[k];
        let at = |sign: f64| {
            let mut moved = params;
            moved[k] += sign * step;
            table(&moved)
        };
        let (right, left) = (at(1.0), at(-1.0));
        gradient[0][k] = (right[1] - left[1]) / (2.0 * step);
        gradient[1][k] = (right[2] - left[2]) / (2.0 * step);
    }
    let errors = [
        peak.f.stderr / known.stderr_of(&gradient[0]),
        got.stderr.to_degrees() / known.stderr_of(&gradient[1]),
    ];
    let largest = errors.into_iter().map(|ratio| (ratio - 1.0).abs()).fold(0.0, f64::max);
    check(largest, tolerance::LOBE_STDERR);
}

/// At 50 degrees a lobe of m = 0.1988 has two maxima that are equally bright, and beside it one of them is the peak: errors there are at least those of moving the parameters by two of their errors, to the side that changes more.
#[test]
fn peak_of_two_equal_maxima() {
    let theta_i = 50f64.to_radians();
    let mut random = random(5);
    let mut paint = |m: f64, size: f64| -> (Material, Vec<Sample<f64>>) {
        let material = Material::paper([0.1, 1.0, 0.0, m, 1.5, 0.0]);
        let one = |degree: i32| {
            let sample = Sample::in_plane(theta_i, f64::from(degree).to_radians(), 1.0);
            let ln_f = material.ln_f(&sample).unwrap() + size * random();
            Sample {
                brdf: ln_f.exp(),
                ..sample
            }
        };
        (material, (-80..=80).map(one).collect())
    };
    let mut options = FitOptions {
        terms: DIFFUSE | SURFACE,
        ..FitOptions::default()
    };
    (options.lower[4], options.upper[4]) = (1.5, 1.5);
    let known = engine::fit(&paint(0.1988, 0.05).1, &options).unwrap().uncertainty;
    let (mut tops, mut least) = (Vec::new(), f64::INFINITY);
    for m in [0.1965, 0.197, 0.1975, 0.198, 0.1985, 0.1988, 0.199, 0.1995, 0.2] {
        let (material, _) = paint(m, 0.0);
        let peak = |material: &Material| derived::at(theta_i, material, &known).peak.unwrap();
        let here = peak(&material);
        tops.push(here.theta_s.to_degrees());
        let mut squares = [0.0; 2];
        for axis in &known.axes {
            let moved = |sign: f64| {
                let mut moved = material;
                for (value, part) in moved.values.iter_mut().zip(axis.iter()) {
                    *value += 2.0 * sign * part;
                }
                peak(&moved)
            };
            let both = [moved(1.0), moved(-1.0)];
            let change = |of: &dyn Fn(&Peak) -> f64| {
                both.iter()
                    .map(|at| (of(at) - of(&here)).abs() / 2.0)
                    .fold(0.0, f64::max)
            };
            squares[0] += change(&|at| at.f.value).powi(2);
            squares[1] += change(&|at| at.width.unwrap().value).powi(2);
        }
        let errors = [here.f.stderr, here.width.unwrap().stderr];
        for (error, square) in errors.into_iter().zip(squares) {
            println!("m = {m}: {} of it", error / square.sqrt());
            least = least.min(error / square.sqrt());
        }
    }
    // The first is where the lobe is brightest of itself, the last where its attenuation bends.
    assert!(tops[0] < 70.0 && tops[8] > 76.0, "{tops:?}");
    check(1.0 - least, tolerance::TWO_MAXIMA);
}

#[test]
fn says_what_is_only_known_through_a_product() {
    let samples = scan(&data("testdata3_sym_seed1.csv"));
    let outcome = engine::fit(&samples, &FitOptions::default()).unwrap();
    let derived = derived::at_each_angle(&samples, &outcome.material(), &outcome.uncertainty);
    let open = undetermined(&outcome.material(), &outcome.uncertainty, &derived);
    assert_eq!(open.len(), 1);
    assert_eq!(open[0].parameters, ["rho_s", "rho_v", "n", "kappa"]);
    assert!(sentence(&open[0]).starts_with(
        "rho_s, rho_v, n and kappa only through rho_s F(theta_d) and rho_v F(theta_de); these products are known to "
    ));
    // The actual products, and rho_d and m, are within three standard errors.
    let f = literal::fresnel(30f64.to_radians(), 1.1, 0.86);
    let at = derived[0];
    for (value, actual) in [(at.rho_s_f.unwrap(), f), (at.rho_v_f.unwrap(), 1e-3 * f)] {
        assert!((value.value - actual).abs() < 3.0 * value.stderr && value.stderr < 0.1 * actual);
    }
    for (index, actual) in [(0, 0.15), (3, 0.005)] {
        let error = six(&outcome.params)[index] - actual;
        assert!(error.abs() < 3.0 * outcome.uncertainty.stderr[index]);
    }
    // A grey surface: nothing is known of a lobe, and everything of the reflectance.
    let grey: Vec<_> = samples.iter().map(|sample| Sample { brdf: 0.1, ..*sample }).collect();
    let outcome = engine::fit(&grey, &FitOptions::default()).unwrap();
    let derived = derived::at_each_angle(&grey, &outcome.material(), &outcome.uncertainty);
    let reflectance = derived[0].reflectance;
    assert!(tolerance::GREY.admits((reflectance.value - 0.1 * PI).abs()) && tolerance::GREY.admits(reflectance.stderr));
    assert_eq!(outcome.uncertainty.scale, 0.0);
}
