//! Unpolarised Fresnel reflectance of a complex index n - i kappa, with its derivatives.

use crate::pack::Pack;
use crate::real::Real;

/// The index of refraction, and what follows from it alone.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Index<R> {
    pub n: R,
    pub kappa: R,
    n2: R,
    kappa2: R,
    /// Re eps - 1 = n^2 - kappa^2 - 1, without the cancellation at n = 1.
    delta: R,
    /// (Im eps)^2 = 4 n^2 kappa^2.
    beta2: R,
    /// |eps - 1|^2.
    contrast: R,
}

/// F and its derivatives; dF/d(n^2) and dF/d(kappa^2) are the simplest, and dF/dkappa is 0 at kappa = 0, which hides the way off that bound.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fresnel<R, const K: usize> {
    pub f: Pack<R, K>,
    pub d_n2: Pack<R, K>,
    pub d_kappa2: Pack<R, K>,
}

impl<R: Real> Index<R> {
    #[cfg_attr(not(target_os = "none"), inline(always))]
    #[cfg_attr(target_os = "none", inline(never))]
    pub fn new(n: R, kappa2: R) -> Self {
        let n2 = n * n;
        let delta = (n - R::ONE) * (n + R::ONE) - kappa2;
        let beta2 = R::of(4.0) * n2 * kappa2;
        Index {
            n,
            kappa: kappa2.sqrt(),
            n2,
            kappa2,
            delta,
            beta2,
            contrast: delta * delta + beta2,
        }
    }

    /// True if F = 0 in every direction.
    #[inline(always)]
    pub fn is_vacuum(&self) -> bool {
        self.contrast == R::ZERO
    }

    /// F, dF/d(n^2) and dF/d(kappa^2) of each of some cosines; of the derivatives, without `gradient`, nothing.
    #[cfg_attr(target_os = "none", inline(never))]
    #[cfg_attr(not(target_os = "none"), inline(always))]
    pub fn reflect_each(&self, c: &[R], gradient: bool, places: &mut [[R; 3]]) {
        for (&c, place) in c.iter().zip(places) {
            let Fresnel { f, d_n2, d_kappa2 } = self.reflect(Pack([c]), gradient);
            *place = [f.0[0], d_n2.0[0], d_kappa2.0[0]];
        }
    }

    /// F at c = cos theta_d, `0 < c <= 1`, result 0 to 1, and if `gradient` its derivatives.
    ///
    /// r_s = (c - p)/(c + p) and r_p = r_s t with t = (p c - s^2)/(p c + s^2), where p = sqrt(eps - s^2) = a - i b; F = |r_s|^2 (1 + |t|^2)/2.
    /// Multiplied out, r_s = (1 - eps)/(c + p)^2 and t = (p^2 c^2 - s^4)/(p c + s^2)^2: so |r_s| keeps its relative accuracy when eps -> 1, and F = |eps - 1|^2 (v^2 + |p^2 c^2 - s^4|^2) / (2 u^2 v^2) with u = |c + p|^2 and v = |p c + s^2|^2.
    /// With h = N/p = dp/dN of the complex index N = n - i kappa, conj(r_s) dr_s/dp = 2 c conj(eps - 1) / u^2, and likewise for t.
    #[inline(always)]
    pub fn reflect<const K: usize>(&self, c: Pack<R, K>, gradient: bool) -> Fresnel<R, K> {
        let (half, two) = (R::of(0.5), R::of(2.0));
        let c2 = c * c;
        let s2 = c2.map(|c2| R::ONE - c2);
        // p^2 = alpha - i beta, |p|^2 = q.
        let alpha = c2 + self.delta;
        let q2 = alpha * alpha + self.beta2;
        let q = q2 * q2.rsqrt();
        // Of a and b, the larger first, and a from it or from a b = n kappa.
        let larger2 = (q + alpha.map(R::abs)) * half;
        let n_kappa = self.n * self.kappa;
        let times_larger = alpha.zip(larger2, |alpha, a2| if alpha >= R::ZERO { a2 } else { n_kappa });
        let a = times_larger * larger2.rsqrt();
        let two_ac = (a + a) * c;
        let u = q + c2 + two_ac;
        let v = q * c2 + s2 * (s2 + two_ac);
        // p^2 c^2 - s^4 = x - i beta c^2.
        let x = c2 * (self.delta + two) - R::ONE;
        let inverse_uv = (u * v).map(|uv| R::ONE / uv);
        let inverse_uv2 = inverse_uv * inverse_uv;
        let share = (v * v + (x * x + c2 * c2 * self.beta2)) * inverse_uv2;
        let mut fresnel = Fresnel {
            f: share * (half * self.contrast),
            d_n2: c,
            d_kappa2: c,
        };
        if gradient {
            // Re h / n = y / (a q) and Im h / kappa = z / (a q); what is odd in kappa is kept divided by it.
            let a2 = a * a;
            let y = a2 + self.kappa2;
            let z = a2.map(|a2| self.n2 - a2);
            let scale = c / (a * q);
            let d_s = scale * share;
            let d_t = scale * s2 * inverse_uv2 * self.contrast;
            let re = d_s * self.delta + d_t * x;
            let im = d_s + d_t * c2;
            fresnel.d_n2 = y * re - z * im * (two * self.kappa2);
            fresnel.d_kappa2 = z * re + y * im * (two * self.n2);
        }
        fresnel
    }
}

/// F, dF/dn and dF/dkappa of unpolarised light; `0 < cos_theta <= 1`, `n >= 1`, `kappa >= 0`, result 0 to 1.
pub fn fresnel<R: Real>(cos_theta: R, n: R, kappa: R) -> (R, R, R) {
    let [f, d_n, d_kappa2] = Reflecting::new(n, kappa).at(Pack([cos_theta]));
    (f.0[0], d_n.0[0], d_kappa2.0[0] * (R::of(2.0) * kappa))
}

/// A surface of one index of refraction, for [`fresnel`] in many directions.
#[derive(Clone, Copy, Debug)]
pub struct Reflecting<R> {
    index: Index<R>,
}

impl<R: Real> Reflecting<R> {
    /// Of the index n - i kappa; `n >= 1`, `kappa >= 0`.
    #[inline(always)]
    pub fn new(n: R, kappa: R) -> Self {
        Reflecting {
            index: Index::new(n, kappa * kappa),
        }
    }

    /// F, dF/dn and dF/d(kappa^2) at these cosines of theta_d, side by side; compiled into its caller, for the vector instructions that it may use.
    #[inline(always)]
    pub fn at<const K: usize>(&self, cos_theta: Pack<R, K>) -> [Pack<R, K>; 3] {
        let fresnel = self.index.reflect(cos_theta, true);
        [fresnel.f, fresnel.d_n2 * (R::of(2.0) * self.index.n), fresnel.d_kappa2]
    }
}
