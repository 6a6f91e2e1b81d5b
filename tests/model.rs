//! ln f, F and their derivatives against 60-digit values, and against the paper's equations as printed.

#![allow(
    clippy::disallowed_methods,
    reason = "oracles may use std's functions; the code under test may not"
)]

use std::f64::consts::PI;

use brdfit_core::brdf::{ALL, Brdf, Params, fresnel};
use brdfit_core::geometry::Geometry;
use brdfit_core::real::Real;
use brdfit_core::start;
use brdfit_suite::literal;
use brdfit_suite::reference::{self, Row};
use brdfit_suite::tolerance::{self, check};

/// ln f and its gradient, at angles in radians.
fn model<R: Real>(angles: [f64; 3], params: [f64; 6]) -> [f64; 7] {
    let [theta_i, theta_s, delta_phi] = angles.map(R::of);
    let geometry = Geometry::new(theta_i, theta_s, delta_phi).expect("a valid pair of directions");
    let (ln_f, gradient) = Brdf::<R, ALL>::new(&Params::from_array(params.map(R::of))).gradient(&geometry);
    let mut values = [ln_f.f64(); 7];
    for (value, derivative) in values[1..].iter_mut().zip(gradient) {
        *value = derivative.f64();
    }
    values
}

/// What one epsilon of error is worth in ln f and its derivatives.
///
/// The file's angles, and decimal numbers such as n = 1.0001, are no numbers of a binary type: rounding them alone moves the result by |dq / d input| |input| epsilon, which at 89.999 degrees or n = 1.0001 is 10^3 to 10^5 |q| epsilon.
/// So the scale of q is |q|, and that for each of the nine inputs, by differences of the model over a thousandth of the way to where it is not smooth (an independent derivative is not needed: a factor of 2 does not matter, and the values themselves are compared with the file's).
/// Differences do not see a share that turns over within a rounding of the exponents, as at delta_phi = 90 degrees, where both lobes have the same exponent, 10^11: there the shares' own derivatives w_j w_k by the exponents are added.
fn natural_scale(row: &Row) -> [f64; 7] {
    const QUARTER_TURN: f64 = std::f64::consts::FRAC_PI_2;
    let angles = row.angles.map(f64::to_radians);
    let inputs: [f64; 9] = std::array::from_fn(|i| if i < 3 { angles[i] } else { row.params[i - 3] });
    let at = |inputs: [f64; 9]| {
        model::<f64>(
            [inputs[0], inputs[1], inputs[2]],
            std::array::from_fn(|i| inputs[3 + i]),
        )
    };
    let lobes = |inputs: [f64; 9]| {
        let geometry = Geometry::new(inputs[0], inputs[1], inputs[2]).expect("a valid pair of directions");
        [geometry.surface().tan2_theta_h, geometry.volume().tan2_theta_h]
    };
    let mut scale = row.values.map(f64::abs);
    let tan2 = lobes(inputs);
    let mut tan2_error = tan2;
    for (i, &input) in inputs.iter().enumerate() {
        // The nearest point where the model is not smooth.
        let room = match i {
            0 | 1 => (QUARTER_TURN - input).min(if input > 0.0 { input } else { 1.0 }),
            7 => {
                if input > 1.0 {
                    input - 1.0
                } else {
                    1e-3
                }
            }
            _ => input,
        };
        let h = 1e-3 * room;
        if h == 0.0 {
            continue;
        }
        let (mut above, mut below) = (inputs, inputs);
        above[i] += h;
        below[i] -= if (i == 7 && input <= 1.0) || (i < 2 && input == 0.0) {
            0.0
        } else {
            h
        };
        let width = above[i] - below[i];
        for (scale, (a, b)) in scale.iter_mut().zip(at(above).into_iter().zip(at(below))) {
            *scale += ((a - b) / width * input).abs();
        }
        if i < 3 {
            let (a, b) = (lobes(above), lobes(below));
            for lobe in 0..2 {
                tan2_error[lobe] += ((a[lobe] - b[lobe]) / width * input).abs();
            }
        }
    }
    // Where two terms of f are about equal, their shares turn over within a rounding of the exponents.
    let share: [f64; 3] = std::array::from_fn(|j| {
        // The derivative by an absent term may be infinite.
        if row.params[j] > 0.0 {
            row.params[j] * row.values[1 + j]
        } else {
            0.0
        }
    });
    let m = row.params[3];
    let exponent: [f64; 3] = std::array::from_fn(|j| if j == 0 { 0.0 } else { tan2_error[j - 1] / (m * m) });
    for j in 0..3 {
        for k in 0..3 {
            if j == k {
                continue;
            }
            let turn = share[j] * share[k] * (exponent[j] + exponent[k]);
            if row.params[j] > 0.0 {
                scale[1 + j] += turn / row.params[j];
            }
            scale[4] += turn * 2.0 / m * (exponent[j] + 1.0);
            // Their gradients are means over the lobes of d ln F / dn and d ln F / dkappa, which are alike or of order 1.
            for q in [5, 6] {
                scale[q] += turn * 2.0 * row.values[q].abs().max(1.0);
            }
        }
    }
    scale
}

/// False for what the program does not promise, or the file does not know.
fn is_target<R: Real>(row: &Row, q: usize) -> bool {
    let angles = row.angles.map(f64::to_radians);
    let geometry = Geometry::new(angles[0], angles[1], angles[2]).expect("a valid pair of directions");
    let m2 = row.params[3] * row.params[3];
    let exponent = [
        geometry.surface().tan2_theta_h / m2,
        geometry.volume().tan2_theta_h / m2,
    ];
    let want = row.values[q];
    // Outside the type's range; the file's numbers are differences of terms of order 1 with 60 digits.
    if !want.is_finite() || want.abs() > R::MAX.f64() || (q > 0 && want.abs() < 1e-45) {
        return false;
    }
    let shining: Vec<f64> = (0..2)
        .filter(|&j| row.params[1 + j] > 0.0)
        .map(|j| exponent[j])
        .collect();
    let brightest = shining.iter().copied().fold(f64::INFINITY, f64::min);
    let (lift, cut) = (R::MOST_EXPONENT.f64() * 0.99, -R::LEAST_EXPONENT.f64() * 0.99);
    let diffuse = row.params[0] > R::LEAST_DIFFUSE.f64();
    // Without enough of a diffuse term the largest exponent is taken out of the sum.
    let shift = if diffuse || shining.is_empty() {
        0.0
    } else {
        brightest.min(-row.params[0].ln())
    };
    match q {
        // `Real::MOST_EXPONENT`: the derivative by an absent diffuse term is limited.
        1 => row.params[0] > 0.0 || shift < lift,
        // `Real::LEAST_EXPONENT`: a lobe with an exponent below that counts as 0.
        2 | 3 => exponent[q - 2] - shift < cut,
        4.. => shining.is_empty() || brightest - shift < cut,
        _ => true,
    }
}

/// Worst error of ln f and of its derivatives, in epsilons of the natural scale, and how many numbers were compared.
fn worst<R: Real>() -> (f64, f64, usize) {
    let (mut value, mut derivative, mut count) = (0.0f64, 0.0f64, 0);
    for row in reference::model() {
        // pi itself where the file says 180 degrees: that is how a scan in the plane of incidence is given.
        let angles = row.angles.map(|angle| {
            if angle == 180.0 {
                R::PI.f64()
            } else {
                angle.to_radians()
            }
        });
        let got = model::<R>(angles, row.params);
        let scale = natural_scale(&row);
        for q in (0..7).filter(|&q| is_target::<R>(&row, q)) {
            let error = (got[q] - row.values[q]).abs() / (scale[q] * R::EPSILON.f64());
            assert!(error < 100.0, "{row:?}: {q} is {} of scale {}", got[q], scale[q]);
            let worst = if q == 0 { &mut value } else { &mut derivative };
            *worst = worst.max(error);
            count += 1;
        }
    }
    (value, derivative, count)
}

#[test]
fn sixty_digits_f64() {
    let (value, derivative, count) = worst::<f64>();
    println!("f64: ln f {value:.2}, derivatives {derivative:.2} epsilons, {count} numbers");
    check(value, tolerance::LN_F_F64);
    check(derivative, tolerance::GRADIENT_F64);
    assert!(count > 10_000, "{count}");
}

#[test]
fn sixty_digits_f32() {
    let (value, derivative, count) = worst::<f32>();
    println!("f32: ln f {value:.2}, derivatives {derivative:.2} epsilons, {count} numbers");
    check(value, tolerance::LN_F_F32);
    check(derivative, tolerance::GRADIENT_F32);
    assert!(count > 8_000, "{count}");
}

/// As for ln f: |q| and, for each input, |dq / d input| |input|.
fn worst_fresnel<R: Real>() -> [f64; 3] {
    let at = |[c, n, kappa]: [f64; 3]| {
        let (f, d_n, d_kappa) = fresnel(c, n, kappa);
        [f, d_n, d_kappa]
    };
    let mut worst = [0.0f64; 3];
    for (inputs, want) in reference::fresnel() {
        let [c, n, kappa] = inputs.map(R::of);
        let (f, d_n, d_kappa) = fresnel(c, n, kappa);
        let got = [f, d_n, d_kappa].map(R::f64);
        let mut scale = want.map(f64::abs);
        for i in 0..3 {
            let h = 1e-3 * [inputs[0], (inputs[1] - 1.0).max(1e-6), inputs[2]][i];
            let (mut above, mut below) = (inputs, inputs);
            above[i] = if i == 0 {
                (inputs[i] + h).min(1.0)
            } else {
                inputs[i] + h
            };
            below[i] = if i == 1 {
                (inputs[i] - h).max(1.0)
            } else {
                inputs[i] - h
            };
            let width = above[i] - below[i];
            if width > 0.0 {
                for (scale, (a, b)) in scale.iter_mut().zip(at(above).into_iter().zip(at(below))) {
                    *scale += ((a - b) / width * inputs[i]).abs();
                }
            }
        }
        // F = |r|^2 with r analytic in n - i kappa, so dF/dn and dF/dkappa are the two parts of one complex number; at grazing incidence on metals one of them is 10^4 times the other.
        if inputs[0] < 0.01 && inputs[2] >= 1.0 {
            let modulus = want[1].hypot(want[2]);
            scale[1] += modulus;
            scale[2] += modulus;
        }
        for q in 0..3 {
            let floor = R::MIN_POSITIVE.f64().max(1e-45);
            if want[q].abs() < floor {
                assert!(
                    got[q].abs() < floor,
                    "{inputs:?}: {q} is {} and not {}",
                    got[q],
                    want[q]
                );
                continue;
            }
            worst[q] = worst[q].max((got[q] - want[q]).abs() / (scale[q] * R::EPSILON.f64()));
        }
    }
    worst
}

#[test]
fn sixty_digits_fresnel() {
    let (double, single) = (worst_fresnel::<f64>(), worst_fresnel::<f32>());
    println!("Fresnel: f64 {double:.2?}, f32 {single:.2?}");
    check(double[0], tolerance::FRESNEL_F64);
    check(double[1].max(double[2]), tolerance::FRESNEL_GRADIENT_F64);
    check(single[0], tolerance::FRESNEL_F32);
    check(single[1].max(single[2]), tolerance::FRESNEL_GRADIENT_F32);
}

/// Ordinary scenes, where the equations as printed lose few digits: half angles from 1 to 40 degrees, m from 0.1.
fn ordinary_scenes() -> Vec<([f64; 3], [f64; 6])> {
    let mut scenes = Vec::new();
    for i in 0..2000 {
        let u: [f64; 9] = std::array::from_fn(|k| start::even::<f64>(k as u64 / 3, i)[k % 3]);
        let angles = [1.3 * u[0], 1.3 * u[1], PI * u[2]];
        let params = [
            0.05 + 0.9 * u[3],
            0.1 + 10.0 * u[4],
            0.01 + u[5],
            0.1 + u[6],
            1.1 + 2.0 * u[7],
            0.01 + 3.0 * u[8],
        ];
        let half_angles =
            [angles[2], angles[2] - PI].map(|azimuth| literal::half_angles(angles[0], angles[1], azimuth));
        if half_angles
            .iter()
            .all(|&(theta_d, theta_h)| theta_d > 0.02 && (0.02..0.7).contains(&theta_h))
        {
            scenes.push((angles, params));
        }
    }
    assert!(scenes.len() > 500, "{}", scenes.len());
    scenes
}

#[test]
fn equations_as_printed() {
    let mut worst = 0.0f64;
    for (angles, params) in ordinary_scenes() {
        let ln_f = model::<f64>(angles, params)[0];
        worst = worst.max((ln_f - literal::f(angles, params).ln()).abs());
    }
    println!("ln f against the printed equations: {worst:.2e}");
    check(worst, tolerance::LITERAL_LN_F);
}

#[test]
fn gradient_is_the_slope_of_the_equations_as_printed() {
    let mut worst = 0.0f64;
    for (angles, params) in ordinary_scenes() {
        let gradient = model::<f64>(angles, params);
        for k in 0..6 {
            let h = 1e-5 * params[k];
            let (mut above, mut below) = (params, params);
            above[k] += h;
            below[k] -= h;
            let slope = (literal::f(angles, above).ln() - literal::f(angles, below).ln()) / (above[k] - below[k]);
            let scale = gradient[1 + k].abs() * params[k] + 1.0;
            worst = worst.max((slope - gradient[1 + k]).abs() * params[k] / scale);
        }
    }
    println!("gradient against differences of the printed equations: {worst:.2e}");
    check(worst, tolerance::LITERAL_GRADIENT);
}
