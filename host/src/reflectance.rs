//! Directional-hemispherical reflectance: the integral of f cos theta_s over the hemisphere of scattering.

use std::f64::consts::PI;

use brdfit_core::brdf::{Params, fresnel};
use brdfit_core::real::Real;

/// Reflectance at `theta_i`, radians, and its derivatives by the six parameters; dimensionless, above 1 where the model makes energy.
///
/// The lobes are integrated over the slopes of the facets, in units of m, so that a narrow lobe is no harder than a wide one.
/// With d omega_s = 4 cos theta_d d omega_h and d omega_h = cos^3 theta_h d^2 slope, the surface lobe (Eq. 8, 14) leaves `rho_s F G cos theta_d / (cos theta_i cos theta_h)` to be averaged over a Gaussian, and the volume lobe `4 rho_v F cos theta_s cos theta_d / cos theta_h`.
/// The rule is the midpoint rule in both slopes, which for smooth functions under a Gaussian converges faster than any power; the kinks of G and the horizon decide its error.
pub fn reflectance(params: &Params<f64>, theta_i: f64) -> (f64, [f64; 6]) {
    /// Slopes farther out, in units of m, hold 1e-11 of the facets.
    const EXTENT: f64 = 5.0;
    const STEP: f64 = 0.2;
    let (sin_i, cos_i) = Real::sin_cos(theta_i);
    // Without lobes any m does.
    let m = if params.m > 0.0 { params.m } else { 1.0 };
    // Steep facets: the integrand then changes over slopes of 1, not of m.
    let count = (EXTENT / STEP * m.max(1.0)).ceil();
    let step = EXTENT / count;
    // Averages of both lobes with rho = 1, and their derivatives by m, n and kappa.
    let mut sums = [[0.0; 4]; 2];
    for i in 0..2 * count as usize {
        let x = (i as f64 + 0.5 - count) * step;
        for j in 0..count as usize {
            let y = (j as f64 + 0.5) * step;
            let r2 = x * x + y * y;
            let cos_h = 1.0 / Real::sqrt(1.0 + m * m * r2);
            let cos_d = (cos_i + sin_i * m * x) * cos_h;
            let cos_s = 2.0 * cos_d * cos_h - cos_i;
            if cos_d <= 0.0 || cos_s <= 0.0 {
                continue;
            }
            // Both halves in y are alike.
            let share = 2.0 * step * step * Real::exp(-r2) / PI;
            let masking = (2.0 * cos_h * cos_i.min(cos_s) / cos_d).min(1.0);
            let (f, d_n, d_kappa) = fresnel(cos_d.min(1.0), params.n, params.kappa);
            let lobes = [masking / cos_i, 4.0 * cos_s];
            for (sum, lobe) in sums.iter_mut().zip(lobes) {
                let weight = share * lobe * cos_d / cos_h;
                let each = [f, f * (r2 - 1.0) * 2.0 / m, d_n, d_kappa];
                for (sum, value) in sum.iter_mut().zip(each) {
                    *sum += weight * value;
                }
            }
        }
    }
    let [surface, volume] = sums;
    let both = |k: usize| params.rho_s * surface[k] + params.rho_v * volume[k];
    (
        params.rho_d + both(0),
        [1.0, surface[0], volume[0], both(1), both(2), both(3)],
    )
}
