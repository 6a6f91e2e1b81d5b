//! Directional-hemispherical reflectance: the integral of f cos theta_s over the hemisphere of scattering.

mod slopes;

use std::f64::consts::PI;

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use crate::engine::{Material, Values};

/// Reflectance at `theta_i`, radians, and its derivatives by the parameters at [`Material::off_zero`]; dimensionless, above 1 where the model makes energy.
pub fn reflectance(material: &Material, theta_i: f64) -> (f64, Values) {
    match eq_14(material) {
        Some(values) => slopes::of_eq_14(values, theta_i),
        None => {
            let (value, gradient) = of_any(material, theta_i);
            let slopes = material.off_zero();
            let gradient = if slopes == *material {
                gradient
            } else {
                of_any(&slopes, theta_i).1
            };
            (value, gradient)
        }
    }
}

/// The reflectance alone, of the same bits.
pub fn reflectance_alone(material: &Material, theta_i: f64) -> f64 {
    match eq_14(material) {
        Some(values) => slopes::of_weights(values, theta_i).0,
        None => of_any(material, theta_i).0,
    }
}

/// The derivative of the reflectance by the weight in `place`, of the same bits.
pub fn slope_by_weight(material: &Material, theta_i: f64, place: usize) -> f64 {
    match eq_14(material) {
        Some(values) => slopes::of_weights(values, theta_i).1[place],
        None => reflectance(material, theta_i).1[place],
    }
}

/// The parameters of Eq. 14, if it is that model.
fn eq_14(material: &Material) -> Option<[f64; 6]> {
    let values = <[f64; 6]>::try_from(&material.values[..]).ok()?;
    material.model.is_paper().then_some(values)
}

/// Nodes along a ray from a peak, and rays around it, for any model.
const RADII: usize = 96;
const RAYS: usize = 64;

/// That of any model: f cos theta_s d omega_s is f d^2 beta over the disk of direction cosines beta.
///
/// A half of the disk lies around the specular direction, the other around the direction of incidence, where the peaks are: each is integrated along rays from there, ever denser towards it.
fn of_any(material: &Material, theta_i: f64) -> (f64, Values) {
    let sin_i = Real::portable_sin_cos(theta_i).0;
    let width = material.width();
    let rays: [(f64, f64); RAYS] = nodes(2.0 * PI);
    let (mut sum, mut sums) = (0.0, Values::from_fn(material.values.len(), |_| 0.0));
    for side in [1.0, -1.0] {
        let centre = side * sin_i;
        for (sin_t, cos_t) in rays {
            // To the edge of the disk, or to the line between both halves.
            let along = centre * cos_t;
            let rim = -along + Real::sqrt((along * along + 1.0 - sin_i * sin_i).max(0.0));
            let middle = if side * cos_t < 0.0 {
                sin_i / cos_t.abs()
            } else {
                f64::INFINITY
            };
            let reach = rim.min(middle);
            // r = width sinh(u), with midpoints of equal parts of u.
            let end = asinh(reach / width);
            for k in 0..RADII {
                let u = (k as f64 + 0.5) * end / RADII as f64;
                let (grown, shrunk) = (Real::portable_exp(u), Real::portable_exp(-u));
                let r = 0.5 * width * (grown - shrunk);
                let step = 0.5 * width * (grown + shrunk) * end / RADII as f64;
                let (x, y) = (centre + r * cos_t, r * sin_t);
                let sample = Sample {
                    theta_i,
                    theta_s: libm::asin(Real::sqrt(x * x + y * y).min(1.0)),
                    delta_phi: PI - libm::atan2(y, x),
                    brdf: 1.0,
                    weight: 1.0,
                };
                let Some((ln_f, gradient)) = material.gradient(&sample) else {
                    continue;
                };
                let part = Real::portable_exp(ln_f) * r * step * (2.0 * PI / RAYS as f64);
                sum += part;
                for (sum, slope) in sums.iter_mut().zip(gradient.iter()) {
                    *sum += part * slope;
                }
            }
        }
    }
    (sum, sums)
}

fn asinh(x: f64) -> f64 {
    Real::portable_ln(x + Real::sqrt(x * x + 1.0))
}

/// Sine and cosine of the midpoints of equal parts of 0 to `end`.
fn nodes<const N: usize>(end: f64) -> [(f64, f64); N] {
    std::array::from_fn(|k| Real::portable_sin_cos((k as f64 + 0.5) * end / N as f64))
}
