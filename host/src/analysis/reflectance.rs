//! Directional-hemispherical reflectance: the integral of f cos theta_s over the hemisphere of scattering.

use std::f64::consts::{FRAC_PI_2, PI};

use brdfit_core::brdf::fresnel;
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use crate::engine::{Material, Values};

/// Slopes farther out, in units of m, hold 1e-11 of the facets.
const EXTENT: f64 = 5.0;
/// Nodes along the plane of incidence.
const ALONG: usize = 64;
/// Nodes across it, on one side.
const ACROSS: usize = 32;

/// Reflectance at `theta_i`, radians, and its derivatives by the parameters; dimensionless, above 1 where the model makes energy.
pub fn reflectance(material: &Material, theta_i: f64) -> (f64, Values) {
    match <[f64; 6]>::try_from(&material.values[..]) {
        Ok(values) if material.model.is_paper() => of_eq_14(values, theta_i),
        _ => of_any(material, theta_i),
    }
}

/// That of Eq. 14, its parameters in the order of [`brdfit_core::brdf::NAMES`].
///
/// The lobes are integrated over the slopes of the facets, so that a narrow lobe is no harder than a wide one.
/// With d omega_s = 4 cos theta_d d omega_h and d omega_h = cos^3 theta_h d^2 slope, the surface lobe (Eq. 8, 14) leaves `rho_s F G cos theta_d / (cos theta_i cos theta_h)` to be averaged over the Gaussian of the slopes, and the volume lobe `4 rho_v F cos theta_s cos theta_d / cos theta_h`.
/// Only facets that send light above the horizon count; between the ends of that range the nodes are those of the midpoint rule in an angle whose cosine is the slope.
fn of_eq_14([rho_d, rho_s, rho_v, m, n, kappa]: [f64; 6], theta_i: f64) -> (f64, Values) {
    let (sin_i, cos_i) = Real::sin_cos(theta_i);
    // Without lobes any m does.
    let m = if m > 0.0 { m } else { 1.0 };
    let along: [(f64, f64); ALONG] = nodes(PI);
    let across: [(f64, f64); ACROSS] = nodes(FRAC_PI_2);
    // Both lobes with rho = 1, and their derivatives by m, n and kappa.
    let mut sums = [[0.0; 4]; 2];
    let widest = (EXTENT * m).min(1.0 / cos_i);
    for (sin_t, cos_t) in across {
        let b = widest * sin_t;
        // cos theta_s = 0 where cos ti a^2 - 2 sin ti a + cos ti (b^2 - 1) = 0.
        let middle = sin_i / cos_i;
        let reach = Real::sqrt((1.0 / (cos_i * cos_i) - b * b).max(0.0));
        let (low, high) = ((middle - reach).max(-EXTENT * m), (middle + reach).min(EXTENT * m));
        if low >= high {
            continue;
        }
        for (sin_u, cos_u) in along {
            let a = 0.5 * (low + high) - 0.5 * (high - low) * cos_u;
            let slope2 = a * a + b * b;
            let r2 = slope2 / (m * m);
            let cos_h = 1.0 / Real::sqrt(1.0 + slope2);
            let cos_d = (cos_i + sin_i * a) * cos_h;
            let cos_s = 2.0 * cos_d * cos_h - cos_i;
            if cos_d <= 0.0 || cos_s <= 0.0 {
                continue;
            }
            // The area of the node, for both halves across.
            let area = widest * cos_t * (FRAC_PI_2 / ACROSS as f64) * (high - low) * sin_u * (PI / ALONG as f64);
            let share = area * Real::exp(-r2) / (PI * m * m);
            let masking = (2.0 * cos_h * cos_i.min(cos_s) / cos_d).min(1.0);
            let (f, d_n, d_kappa) = fresnel(cos_d.min(1.0), n, kappa);
            for (sum, lobe) in sums.iter_mut().zip([masking / cos_i, 4.0 * cos_s]) {
                let weight = share * lobe * cos_d / cos_h;
                let each = [f, f * (r2 - 1.0) * 2.0 / m, d_n, d_kappa];
                for (sum, value) in sum.iter_mut().zip(each) {
                    *sum += weight * value;
                }
            }
        }
    }
    let [surface, volume] = sums;
    let both = |k: usize| rho_s * surface[k] + rho_v * volume[k];
    (
        rho_d + both(0),
        Values::from([1.0, surface[0], volume[0], both(1), both(2), both(3)]),
    )
}

/// Nodes along a ray from a peak, and rays around it, for any model.
const RADII: usize = 96;
const RAYS: usize = 64;

/// That of any model: f cos theta_s d omega_s is f d^2 beta over the disk of direction cosines beta.
///
/// A half of the disk lies around the specular direction, the other around the direction of incidence, where the peaks are: each is integrated along rays from there, ever denser towards it.
fn of_any(material: &Material, theta_i: f64) -> (f64, Values) {
    let sin_i = Real::sin_cos(theta_i).0;
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
                let (grown, shrunk) = (Real::exp(u), Real::exp(-u));
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
                let part = Real::exp(ln_f) * r * step * (2.0 * PI / RAYS as f64);
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
    Real::ln(x + Real::sqrt(x * x + 1.0))
}

/// Sine and cosine of the midpoints of equal parts of 0 to `end`.
fn nodes<const N: usize>(end: f64) -> [(f64, f64); N] {
    std::array::from_fn(|k| Real::sin_cos((k as f64 + 0.5) * end / N as f64))
}
