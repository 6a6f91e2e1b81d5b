//! The reflectance of Eq. 14, integrated over the slopes of the facets, so that a narrow lobe is no harder than a wide one.

use std::f64::consts::PI;

use brdfit_core::brdf::fresnel;
use brdfit_core::real::Real;

use crate::analysis::quadrature::integrate;
use crate::engine::Values;
use crate::engine::uncertainty::NEAR_ZERO;

/// Slopes farther out, in units of m, hold 1e-13 of the facets.
const EXTENT: f64 = 5.5;
/// Relative error of the integrals over one slope; they must be smoother than what is asked of their integral.
const INNER: f64 = 1e-7;
/// Relative error of the whole.
const OUTER: f64 = 1e-6;

/// Surface and volume lobe of rho = 1, then their derivatives by m, n and kappa.
type Lobes = [f64; 8];

/// The direction of incidence and the facets.
struct Facets {
    sin_i: f64,
    cos_i: f64,
    m: f64,
    n: f64,
    kappa: f64,
}

/// The reflectance and its derivatives, that by kappa at [`NEAR_ZERO`] where kappa is 0; the parameters in the order of [`brdfit_core::brdf::NAMES`].
///
/// With d omega_s = 4 cos theta_d d omega_h and d omega_h = cos^3 theta_h d^2 slope, the surface lobe (Eq. 8, 14) leaves `rho_s F G cos theta_d / (cos theta_i cos theta_h)` to be averaged over the Gaussian of the slopes, and the volume lobe `4 rho_v F cos theta_s cos theta_d / cos theta_h`.
/// Only facets that send light above the horizon count.
pub fn of_eq_14([rho_d, rho_s, rho_v, m, n, kappa]: [f64; 6], theta_i: f64) -> (f64, Values) {
    let (sin_i, cos_i) = Real::portable_sin_cos(theta_i);
    let facets = Facets {
        sin_i,
        cos_i,
        // Without lobes any m does.
        m: if m > 0.0 { m } else { 1.0 },
        n,
        kappa,
    };
    let sums = facets.lobes();
    let both = |k: usize| rho_s * sums[2 * k] + rho_v * sums[2 * k + 1];
    let gradient = [1.0, sums[0], sums[1], both(1), both(2), both(3)];
    (rho_d + both(0), Values::from(gradient))
}

impl Facets {
    fn lobes(&self) -> Lobes {
        let widest = (EXTENT * self.m).min(1.0 / self.cos_i);
        // Across the plane of incidence: where kinks along it meet, and what the Gaussian is wide.
        let tan_i = self.sin_i / self.cos_i;
        let kinks = [
            1.0,
            0.5 * tan_i,
            1.0 / Real::sqrt(3.0),
            1.0 / tan_i,
            self.m,
            2.5 * self.m,
        ];
        let mut largest = 0.0f64;
        let mut across = |b: f64| {
            let sums = self.along(b, 1e-3 * largest);
            largest = largest.max(sums[0]).max(sums[1]);
            sums
        };
        integrate(&mut across, &parts(0.0, widest, &kinks), 2, OUTER, 0.0)
    }

    /// The integral over the slopes in the plane of incidence, with `b` across it.
    fn along(&self, b: f64, size: f64) -> Lobes {
        let (sin_i, cos_i) = (self.sin_i, self.cos_i);
        // cos theta_s = 0 where cos ti a^2 - 2 sin ti a + cos ti (b^2 - 1) = 0.
        let middle = sin_i / cos_i;
        let reach = Real::sqrt((1.0 / (cos_i * cos_i) - b * b).max(0.0));
        let low = ((b * b - 1.0) / (middle + reach)).max(-EXTENT * self.m);
        let high = (middle + reach).min(EXTENT * self.m);
        if low >= high {
            return [0.0; 8];
        }
        let m = self.m;
        let mut kinks = vec![0.0, m, -m, 2.5 * m, -2.5 * m];
        self.kinks(b, &mut kinks);
        integrate(&mut |a| self.integrand(a, b), &parts(low, high, &kinks), 2, INNER, size)
    }

    /// Where the masking along the plane of incidence has kinks.
    fn kinks(&self, b: f64, list: &mut Vec<f64>) {
        let (sin_i, cos_i) = (self.sin_i, self.cos_i);
        if sin_i < 1e-8 {
            return;
        }
        // G leaves 1 at 2 cos theta_h cos theta_i = cos theta_d.
        list.push(cos_i / sin_i);
        // theta_s = theta_i where cos ti a^2 - sin ti a + cos ti b^2 = 0.
        let square = sin_i * sin_i - 4.0 * cos_i * cos_i * b * b;
        if square > 0.0 {
            let sum = sin_i + Real::sqrt(square);
            list.extend([sum / (2.0 * cos_i), 2.0 * cos_i * b * b / sum]);
        }
        // 2 cos theta_h cos theta_s = cos theta_d where (cos ti + sin ti a) (3 - a^2 - b^2) = 2 cos ti (1 + a^2 + b^2).
        list.extend(cubic(
            3.0 * cos_i / sin_i,
            b * b - 3.0,
            cos_i * (3.0 * b * b - 1.0) / sin_i,
        ));
    }

    fn integrand(&self, a: f64, b: f64) -> Lobes {
        let slope2 = a * a + b * b;
        let r2 = slope2 / (self.m * self.m);
        let cos_h = 1.0 / Real::sqrt(1.0 + slope2);
        let cos_d = (self.cos_i + self.sin_i * a) * cos_h;
        let cos_s = 2.0 * cos_d * cos_h - self.cos_i;
        if cos_d <= 0.0 || cos_s <= 0.0 {
            return [0.0; 8];
        }
        // For both halves across.
        let share = 2.0 * Real::portable_exp(-r2) / (PI * self.m * self.m) * cos_d / cos_h;
        let masking = (2.0 * cos_h * self.cos_i.min(cos_s) / cos_d).min(1.0);
        let (f, d_n, mut d_kappa) = fresnel(cos_d.min(1.0), self.n, self.kappa);
        if self.kappa == 0.0 {
            d_kappa = fresnel(cos_d.min(1.0), self.n, NEAR_ZERO).2;
        }
        let (surface, volume) = (share * masking / self.cos_i, share * 4.0 * cos_s);
        let by_m = f * (r2 - 1.0) * 2.0 / self.m;
        [
            surface * f,
            volume * f,
            surface * by_m,
            volume * by_m,
            surface * d_n,
            volume * d_n,
            surface * d_kappa,
            volume * d_kappa,
        ]
    }
}

/// `low`, those of `inner` that lie between, in order, and `high`.
fn parts(low: f64, high: f64, inner: &[f64]) -> Vec<f64> {
    let mut ends: Vec<f64> = inner.iter().copied().filter(|&x| low < x && x < high).collect();
    ends.extend([low, high]);
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    ends
}

/// The real roots of x^3 + c2 x^2 + c1 x + c0 (Press et al. 2007, section 5.6).
fn cubic(c2: f64, c1: f64, c0: f64) -> Vec<f64> {
    let q = (c2 * c2 - 3.0 * c1) / 9.0;
    let r = (2.0 * c2 * c2 * c2 - 9.0 * c2 * c1 + 27.0 * c0) / 54.0;
    let less = r * r - q * q * q;
    if less < 0.0 {
        let root = Real::sqrt(q);
        let angle = libm::acos((r / (q * root)).clamp(-1.0, 1.0));
        let one = |turn: f64| -2.0 * root * Real::portable_sin_cos((angle + 2.0 * PI * turn) / 3.0).1 - c2 / 3.0;
        vec![one(0.0), one(1.0), one(2.0)]
    } else {
        let a = -libm::copysign(libm::cbrt(r.abs() + Real::sqrt(less)), r);
        let b = if a == 0.0 { 0.0 } else { q / a };
        vec![a + b - c2 / 3.0]
    }
}
