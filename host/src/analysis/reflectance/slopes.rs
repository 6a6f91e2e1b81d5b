//! The reflectance of Eq. 14, integrated over the slopes of the facets, so that a narrow lobe is no harder than a wide one.

use std::cell::Cell;
use std::f64::consts::PI;

use brdfit_core::brdf::Reflecting;
use brdfit_core::pack::Pack;
use brdfit_core::real::Real;

use crate::analysis::quadrature::{Ends, PLACES, integrate};
use crate::engine::Values;
use crate::engine::simd::{NullaryFnOnce, Simd};
use crate::engine::uncertainty::NEAR_ZERO;

/// Slopes farther out, in units of m, hold 1e-13 of the facets.
const EXTENT: f64 = 5.5;
/// Where the Gaussian is cut, in units of m: one rule each tells its middle and its flanks.
const WIDE: f64 = 2.3;
/// Relative error of the integrals over one slope; they must be smoother than what is asked of their integral.
const INNER: f64 = 1e-7;
/// Relative error of the whole.
const OUTER: f64 = 1e-6;

/// Surface and volume lobe of rho = 1, then their derivatives by m, n and kappa^2.
const ALL: usize = 8;
/// The lobes alone; the halvings are by these, so that they have the same bits without the others.
const LOBES: usize = 2;

/// The direction of incidence and the facets.
struct Facets {
    sin_i: f64,
    cos_i: f64,
    m: f64,
    surface: Reflecting<f64>,
    simd: Simd,
}

/// The reflectance and its derivatives, that by kappa at [`NEAR_ZERO`] where kappa is 0; the parameters in the order of [`brdfit_core::brdf::NAMES`].
///
/// With d omega_s = 4 cos theta_d d omega_h and d omega_h = cos^3 theta_h d^2 slope, the surface lobe (Eq. 8, 14) leaves `rho_s F G cos theta_d / (cos theta_i cos theta_h)` to be averaged over the Gaussian of the slopes, and the volume lobe `4 rho_v F cos theta_s cos theta_d / cos theta_h`.
/// Only facets that send light above the horizon count.
pub fn of_eq_14([rho_d, rho_s, rho_v, m, n, kappa]: [f64; 6], theta_i: f64) -> (f64, Values) {
    let sums: [f64; ALL] = Facets::new([m, n, kappa], theta_i).lobes();
    let both = |k: usize| rho_s * sums[2 * k] + rho_v * sums[2 * k + 1];
    let off_zero = if kappa == 0.0 { NEAR_ZERO } else { kappa };
    let gradient = [1.0, sums[0], sums[1], both(1), both(2), 2.0 * off_zero * both(3)];
    (rho_d + both(0), Values::from(gradient))
}

thread_local! {
    /// What the lobes were asked for last, and what they are: all that is asked of one fit is at the same few numbers.
    static LAST: Cell<([f64; 4], [f64; LOBES])> = const { Cell::new(([f64::NAN; 4], [0.0; LOBES])) };
}

/// The same with the derivatives by the three weights alone.
pub fn of_weights([rho_d, rho_s, rho_v, m, n, kappa]: [f64; 6], theta_i: f64) -> (f64, [f64; 3]) {
    let asked = [m, n, kappa, theta_i];
    let (last, mut lobes) = LAST.get();
    if last != asked {
        lobes = Facets::new([m, n, kappa], theta_i).lobes();
        LAST.set((asked, lobes));
    }
    let [surface, volume] = lobes;
    (rho_d + (rho_s * surface + rho_v * volume), [1.0, surface, volume])
}

impl Facets {
    fn new([m, n, kappa]: [f64; 3], theta_i: f64) -> Self {
        let (sin_i, cos_i) = Real::portable_sin_cos(theta_i);
        Facets {
            sin_i,
            cos_i,
            // Without lobes any m does.
            m: if m > 0.0 { m } else { 1.0 },
            surface: Reflecting::new(n, kappa),
            simd: Simd::best(),
        }
    }

    /// The integrals of the first `N` of [`ALL`].
    fn lobes<const N: usize>(&self) -> [f64; N] {
        let widest = (EXTENT * self.m).min(1.0 / self.cos_i);
        let inner = [WIDE * self.m]
            .into_iter()
            .chain(self.ends_of_kinks().into_iter().flatten());
        let mut largest = 0.0f64;
        let mut across = |places: &[f64; PLACES]| {
            let mut sums = [[0.0; PLACES]; N];
            for (place, &b) in places.iter().enumerate().take(PLACES - 1) {
                let along = self.along::<N>(b, 1e-3 * largest);
                largest = largest.max(along[0]).max(along[1]);
                for (sum, one) in sums.iter_mut().zip(along) {
                    sum[place] = one;
                }
            }
            sums
        };
        integrate(&mut across, &Ends::new(0.0, widest, inner), LOBES, OUTER, 0.0)
    }

    /// The integral over the slopes in the plane of incidence, with `b` across it.
    fn along<const N: usize>(&self, b: f64, size: f64) -> [f64; N] {
        let (sin_i, cos_i) = (self.sin_i, self.cos_i);
        // cos theta_s = 0 where cos ti a^2 - 2 sin ti a + cos ti (b^2 - 1) = 0.
        let middle = sin_i / cos_i;
        let reach = Real::sqrt((1.0 / (cos_i * cos_i) - b * b).max(0.0));
        let low = ((b * b - 1.0) / (middle + reach)).max(-EXTENT * self.m);
        let high = (middle + reach).min(EXTENT * self.m);
        if low >= high {
            return [0.0; N];
        }
        let wide = WIDE * self.m;
        let kinks = [wide, -wide].into_iter().chain(self.kinks(b).into_iter().flatten());
        let mut integrand = |places: &[f64; PLACES]| {
            self.simd.run(Integrand::<N> {
                facets: self,
                places,
                b,
            })
        };
        integrate(&mut integrand, &Ends::new(low, high, kinks), LOBES, INNER, size)
    }

    /// Where the masking along the plane of incidence has kinks: its arguments in Eq. 9 are as large as each other, or as 1.
    fn kinks(&self, b: f64) -> [Option<f64>; 6] {
        let tan_i = self.sin_i / self.cos_i;
        let cot_i = 1.0 / tan_i;
        // theta_s < theta_i within the circle a^2 - tan ti a + b^2 = 0.
        let within = |a: f64| a * a - tan_i * a + b * b < 0.0;
        let sum = tan_i + Real::sqrt((tan_i * tan_i - 4.0 * b * b).max(0.0));
        let equal = [0.5 * sum, 2.0 * b * b / sum].map(|a| (a > cot_i).then_some(a));
        // There 2 cos theta_h cos theta_i = cos theta_d.
        let of_incidence = within(cot_i).then_some(cot_i);
        // Elsewhere 2 cos theta_h cos theta_s = cos theta_d, or (1 + tan ti a) (3 - a^2 - b^2) = 2 (1 + a^2 + b^2).
        let of_scattering = if self.sin_i < 1e-8 {
            let root = Real::sqrt((1.0 / 3.0 - b * b).max(0.0));
            [Some(root), Some(-root), None]
        } else {
            cubic(3.0 * cot_i, b * b - 3.0, cot_i * (3.0 * b * b - 1.0))
        };
        let [one, two, three] = of_scattering.map(|root| root.filter(|&a| !within(a)));
        [equal[0], equal[1], of_incidence, one, two, three]
    }

    /// Across the plane of incidence: where the last of these kinks ends, where all three meet, and where that of theta_s = theta_i ends.
    fn ends_of_kinks(&self) -> [Option<f64>; 3] {
        let tan_i = self.sin_i / self.cos_i;
        // The square of b on the kink of scattering is largest where y (y + 3)^2 = 4 tan^2 ti of y = tan ti a.
        let roots = cubic(6.0, 9.0, -4.0 * tan_i * tan_i);
        let y = roots.into_iter().flatten().fold(0.0, f64::max);
        let a = 4.0 * tan_i / ((y + 3.0) * (y + 3.0));
        let square = ((1.0 + y) * (3.0 - a * a) - 2.0 * (1.0 + a * a)) / (3.0 + y);
        let meet = 1.0 - 1.0 / (tan_i * tan_i);
        [
            Some(Real::sqrt(square.max(0.0))),
            (meet > 0.0).then(|| Real::sqrt(meet)),
            (0.5 * tan_i > 1.0 / tan_i).then_some(0.5 * tan_i),
        ]
    }
}

/// The lobes at some slopes along the plane of incidence, side by side.
struct Integrand<'a, const N: usize> {
    facets: &'a Facets,
    places: &'a [f64; PLACES],
    b: f64,
}

/// Places that go through a formula together, as in the passes of a fit.
const TOGETHER: usize = 2;

impl<const N: usize> NullaryFnOnce for Integrand<'_, N> {
    type Output = [[f64; PLACES]; N];

    #[inline(always)]
    fn call(self) -> [[f64; PLACES]; N] {
        let mut all = [[0.0; PLACES]; N];
        for lane in 0..PLACES / TOGETHER {
            let a = Pack::<f64, TOGETHER>::gather(self.places, lane);
            let lobes = self.facets.integrand(a, self.b);
            for half in 0..TOGETHER {
                for k in 0..N {
                    all[k][lane + half * (PLACES / TOGETHER)] = lobes[k].0[half];
                }
            }
        }
        all
    }
}

impl Facets {
    #[inline(always)]
    fn integrand(&self, a: Pack<f64, TOGETHER>, b: f64) -> [Pack<f64, TOGETHER>; ALL] {
        let slope2 = a * a + b * b;
        let r2 = slope2 * (1.0 / (self.m * self.m));
        let cos_h = slope2.map(|slope2| 1.0 / (1.0 + slope2).sqrt());
        // cos theta_d / cos theta_h.
        let ratio = (a * self.sin_i).map(|a| self.cos_i + a);
        let cos_d = ratio * cos_h;
        let cos_s = cos_d.zip(cos_h, |cos_d, cos_h| 2.0 * cos_d * cos_h - self.cos_i);
        // Other facets send no light above the horizon.
        let lit = ratio.zip(
            cos_s,
            |ratio, cos_s| if ratio <= 0.0 || cos_s <= 0.0 { 0.0 } else { 1.0 },
        );
        // For both halves across.
        let share = r2.map(|r2| -r2).exp() * (2.0 / (PI * self.m * self.m)) * ratio;
        let least = cos_s.map(|cos_s| Real::min(self.cos_i, cos_s));
        let masking = (least * 2.0 / ratio).map(|masking| Real::min(masking, 1.0));
        let cos_d = cos_d.map(|cos_d| Real::min(cos_d, 1.0));
        let [f, d_n, d_kappa2] = self.surface.at(cos_d);
        let (surface, volume) = (share * masking * (1.0 / self.cos_i), share * (cos_s * 4.0));
        let by_m = f * r2.map(|r2| r2 - 1.0) * (2.0 / self.m);
        let mut lobes = [
            surface * f,
            volume * f,
            surface * by_m,
            volume * by_m,
            surface * d_n,
            volume * d_n,
            surface * d_kappa2,
            volume * d_kappa2,
        ];
        for lobe in &mut lobes {
            *lobe = lobe.zip(lit, |lobe, lit| if lit > 0.0 { lobe } else { 0.0 });
        }
        lobes
    }
}

/// The real roots of x^3 + c2 x^2 + c1 x + c0 (Press et al. 2007, section 5.6).
fn cubic(c2: f64, c1: f64, c0: f64) -> [Option<f64>; 3] {
    let q = (c2 * c2 - 3.0 * c1) / 9.0;
    let r = (2.0 * c2 * c2 * c2 - 9.0 * c2 * c1 + 27.0 * c0) / 54.0;
    let less = r * r - q * q * q;
    if less < 0.0 {
        let root = Real::sqrt(q);
        let angle = libm::acos((r / (q * root)).clamp(-1.0, 1.0));
        let one = |turn: f64| -2.0 * root * Real::portable_sin_cos((angle + 2.0 * PI * turn) / 3.0).1 - c2 / 3.0;
        [0.0, 1.0, 2.0].map(|turn| Some(one(turn)))
    } else {
        let a = -libm::copysign(libm::cbrt(r.abs() + Real::sqrt(less)), r);
        let b = if a == 0.0 { 0.0 } else { q / a };
        [Some(a + b - c2 / 3.0), None, None]
    }
}
