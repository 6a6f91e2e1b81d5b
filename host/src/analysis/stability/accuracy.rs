//! The error of ln f and of its gradient, in units in the last place of their natural scale.

use brdfit_core::brdf::{ALL, Brdf, Params, has};
use brdfit_core::geometry::{Geometry, Sample};
use brdfit_core::real::Real;
use serde::Serialize;

/// Largest errors over a scan, in epsilons of the number type times the natural scale.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Errors {
    /// Of ln f.
    pub ln_f: f64,
    /// Of its derivatives by the six parameters.
    pub gradient: f64,
}

/// ln f and its gradient, computed in `R`.
pub fn model<R: Real>(sample: &Sample<f64>, params: [f64; 6]) -> Option<[f64; 7]> {
    let [theta_i, theta_s, delta_phi] = [sample.theta_i, sample.theta_s, sample.delta_phi].map(R::of);
    let geometry = Geometry::new(theta_i, theta_s, delta_phi).ok()?;
    let (ln_f, gradient) = Brdf::<R, ALL>::new(&Params::from_array(params.map(R::of))).gradient(&geometry);
    Some(std::array::from_fn(|q| {
        if q == 0 { ln_f } else { gradient[q - 1] }.f64()
    }))
}

/// What one epsilon is worth in each of ln f and its derivatives q: |q|, and |dq / d input| |input| for each angle and parameter, because those are rounded before the model sees them.
///
/// By differences in f64 over 1e-5 of the way to where the model is not smooth.
pub fn natural_scale(sample: &Sample<f64>, params: [f64; 6], exact: [f64; 7]) -> [f64; 7] {
    const STEP: f64 = 1e-5;
    const QUARTER_TURN: f64 = std::f64::consts::FRAC_PI_2;
    let angles = [sample.theta_i, sample.theta_s, sample.delta_phi];
    let mut scale = exact.map(f64::abs);
    for i in 0..9 {
        let input = if i < 3 { angles[i] } else { params[i - 3] };
        let room = match i {
            0 | 1 => (QUARTER_TURN - input.abs()).min(input.abs()),
            // In plane delta phi is pi exactly.
            2 if input.abs() == f64::PI => 0.0,
            7 => input - 1.0,
            _ => input.abs(),
        };
        let step = STEP * room;
        if !(step > 0.0) {
            continue;
        }
        let at = |by: f64| {
            let mut inputs = [angles[0], angles[1], angles[2]];
            let mut params = params;
            let value = if i < 3 { &mut inputs[i] } else { &mut params[i - 3] };
            *value = input + by;
            let moved = *value - input;
            let [theta_i, theta_s, delta_phi] = inputs;
            let sample = Sample {
                theta_i,
                theta_s,
                delta_phi,
                brdf: 1.0,
                weight: 1.0,
            };
            model::<f64>(&sample, params).map(|values| (values, moved))
        };
        let (Some((above, up)), Some((below, down))) = (at(step), at(-step)) else {
            continue;
        };
        for q in 0..7 {
            scale[q] += ((above[q] - below[q]) / (up - down) * input).abs();
        }
    }
    scale
}

/// False for a derivative by an absent diffuse term that [`Real::MOST_EXPONENT`] limits, which is documented and no error.
fn is_promised<R: Real>(q: usize, params: [f64; 6], exact: [f64; 7]) -> bool {
    let faint = q == 1 && params[0] == 0.0 && exact[0] < -R::MOST_EXPONENT.f64() * 0.9;
    !faint && exact[q].abs() < R::MAX.f64()
}

/// Largest errors over a scan at `params`, of ln f and of its derivatives by those of `terms`, of f64 and of f32, against the exact values.
///
/// A derivative below epsilon times the largest of its column is measured against that: it does not count in J'J.
pub fn errors(samples: &[Sample<f64>], terms: u8, params: [f64; 6]) -> (Errors, Errors) {
    let rows: Vec<_> = samples
        .iter()
        .map(|sample| {
            let exact = super::exact::gradient(sample, params);
            let scale = natural_scale(sample, params, exact);
            (exact, scale, model::<f64>(sample, params), model::<f32>(sample, params))
        })
        .collect();
    let double = largest::<f64>(terms, params, rows.iter().map(|row| (row.0, row.1, row.2)));
    let single = largest::<f32>(terms, params, rows.iter().map(|row| (row.0, row.1, row.3)));
    (double, single)
}

type Compared = ([f64; 7], [f64; 7], Option<[f64; 7]>);

fn largest<R: Real>(terms: u8, params: [f64; 6], rows: impl Iterator<Item = Compared> + Clone) -> Errors {
    let counts = |q: usize, exact| (q == 0 || has(terms, q - 1)) && is_promised::<R>(q, params, exact);
    let mut column = [0.0f64; 7];
    for (exact, ..) in rows.clone() {
        for q in (0..7).filter(|&q| counts(q, exact)) {
            column[q] = column[q].max(exact[q].abs());
        }
    }
    let epsilon = R::EPSILON.f64();
    let mut errors = Errors::default();
    for (exact, scale, got) in rows {
        let Some(got) = got else { continue };
        for q in (0..7).filter(|&q| counts(q, exact)) {
            let unit = epsilon * scale[q].max(epsilon * column[q]).max(f64::MIN_POSITIVE);
            let error = (got[q] - exact[q]).abs() / unit;
            let worst = if q == 0 { &mut errors.ln_f } else { &mut errors.gradient };
            *worst = worst.max(error);
        }
    }
    errors
}
