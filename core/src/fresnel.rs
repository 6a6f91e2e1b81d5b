//! Unpolarised Fresnel reflectance of a complex index n - i kappa, with its derivatives.
//!
//! The work is cut into three short stages, each made for all lanes before the next: a processor overlaps the lanes of a short stage, but can not look past the one long chain of the whole formula.

use core::ops::Range;

use crate::real::Real;

/// The index of refraction, and what follows from it alone.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Index<R> {
    n: R,
    pub kappa: R,
    kappa2: R,
    inverse_kappa: R,
    /// Re eps - 1 = n^2 - kappa^2 - 1, without the cancellation at n = 1.
    delta: R,
    /// -Im eps = 2 n kappa.
    beta: R,
    beta2: R,
}

/// F and its derivatives, by lobe and lane; dF/d(kappa^2) rather than dF/dkappa, which is 0 at kappa = 0 and hides the way off that bound.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fresnel<R, const K: usize, const L: usize> {
    pub f: [[R; L]; K],
    pub d_n: [[R; L]; K],
    pub d_kappa2: [[R; L]; K],
}

impl<R: Real> Index<R> {
    #[inline(always)]
    pub fn new(n: R, kappa2: R) -> Self {
        let kappa = kappa2.sqrt();
        let beta = R::of(2.0) * n * kappa;
        Index {
            n,
            kappa,
            kappa2,
            inverse_kappa: R::ONE / kappa.max(R::MIN_POSITIVE),
            delta: (n - R::ONE) * (n + R::ONE) - kappa2,
            beta,
            beta2: beta * beta,
        }
    }

    /// True if F = 0 in every direction.
    #[inline(always)]
    pub fn is_vacuum(&self) -> bool {
        self.delta == R::ZERO && self.beta == R::ZERO
    }

    /// F at cos theta_d, `0 < cos_theta_d <= 1`, result 0 to 1, and if `GRADIENT` its derivatives.
    ///
    /// r_s = (c - p)/(c + p) and r_p = r_s t with t = (p c - s^2)/(p c + s^2), where p = sqrt(eps - s^2) = a - i b; F = |r_s|^2 (1 + |t|^2)/2.
    /// Written as r_s = ((c^2 - |p|^2) + 2 i b c) / |c + p|^2, with c^2 - |p|^2 from delta and beta, it keeps the relative accuracy of |r_s| when n -> 1 and kappa -> 0.
    /// With h = N/p = dp/dN of the complex index N, conj(r_s) dr_s/dp = 2 c (delta + i beta) / |c + p|^4, and likewise for t.
    #[inline(always)]
    pub fn lanes<const K: usize, const L: usize, const GRADIENT: bool>(
        &self,
        cos_theta_d: &[[R; L]; K],
        lobes: Range<usize>,
    ) -> Fresnel<R, K, L> {
        let zero = [[R::ZERO; L]; K];
        let (half, two) = (R::of(0.5), R::of(2.0));
        // p^2 = alpha - i beta, |p|^2 = q.
        let (mut q, mut inverse_q) = (zero, zero);
        for lobe in lobes.clone() {
            for lane in 0..L {
                let c = cos_theta_d[lobe][lane];
                let alpha = self.delta + c * c;
                let q2 = (alpha * alpha + self.beta2).max(R::TINY);
                inverse_q[lobe][lane] = q2.rsqrt();
                q[lobe][lane] = q2 * inverse_q[lobe][lane];
            }
        }
        // The larger of a and b first, the other from a b = n kappa.
        let (mut a, mut b, mut b_over_kappa) = (zero, zero, zero);
        for lobe in lobes.clone() {
            for lane in 0..L {
                let c = cos_theta_d[lobe][lane];
                let alpha = self.delta + c * c;
                let larger2 = half * (q[lobe][lane] + alpha.abs());
                let inverse_larger = larger2.rsqrt();
                let larger = larger2 * inverse_larger;
                let ratio = self.n * inverse_larger;
                let smaller = self.kappa * ratio;
                let dielectric = alpha >= R::ZERO;
                a[lobe][lane] = if dielectric { larger } else { smaller };
                b[lobe][lane] = if dielectric { smaller } else { larger };
                b_over_kappa[lobe][lane] = if dielectric { ratio } else { larger * self.inverse_kappa };
            }
        }
        let (mut inverse_u, mut inverse_v, mut q_less_c2) = (zero, zero, zero);
        for lobe in lobes.clone() {
            for lane in 0..L {
                let c = cos_theta_d[lobe][lane];
                let (a, b) = (a[lobe][lane], b[lobe][lane]);
                let c2 = c * c;
                let s2 = R::ONE - c2;
                let u = (a + c) * (a + c) + b * b;
                let v = (a * c + s2) * (a * c + s2) + (b * c) * (b * c);
                let w = q[lobe][lane] + c2;
                // One division for the three reciprocals.
                let uv = u * v;
                let triple = R::ONE / (uv * w);
                let inverse_uv = triple * w;
                inverse_u[lobe][lane] = inverse_uv * v;
                inverse_v[lobe][lane] = inverse_uv * u;
                // q - c^2 = (q^2 - c^4) / (q + c^2).
                q_less_c2[lobe][lane] = (self.delta * (self.delta + two * c2) + self.beta2) * (triple * uv);
            }
        }
        let mut fresnel = Fresnel {
            f: zero,
            d_n: zero,
            d_kappa2: zero,
        };
        for lobe in lobes {
            for lane in 0..L {
                let c = cos_theta_d[lobe][lane];
                let (inverse_u, inverse_v) = (inverse_u[lobe][lane], inverse_v[lobe][lane]);
                let c2 = c * c;
                let s2 = R::ONE - c2;
                let two_bc = two * b[lobe][lane] * c;
                let s_re = q_less_c2[lobe][lane] * inverse_u;
                let s_im = two_bc * inverse_u;
                let rs = s_re * s_re + s_im * s_im;
                let t_re = (q[lobe][lane] * c2 - s2 * s2) * inverse_v;
                let t_im = two_bc * s2 * inverse_v;
                let half_one_t = half * (R::ONE + (t_re * t_re + t_im * t_im));
                fresnel.f[lobe][lane] = rs * half_one_t;
                if GRADIENT {
                    // The imaginary part of h, and everything odd in kappa, is kept divided by kappa.
                    let h_re = (self.n * a[lobe][lane] + self.kappa * b[lobe][lane]) * inverse_q[lobe][lane];
                    let h_im = (self.n * b_over_kappa[lobe][lane] - a[lobe][lane]) * inverse_q[lobe][lane];
                    let beta = two * self.n;
                    let x_t = (self.delta + c2) * c2 - s2 * s2;
                    let scale_s = two * c * inverse_u * inverse_u;
                    let scale_t = two * c * s2 * inverse_v * inverse_v * (half * rs);
                    let beta_h = self.kappa2 * (beta * h_im);
                    let d_rs_n = two * scale_s * (self.delta * h_re - beta_h);
                    let d_t_n = two * scale_t * (x_t * h_re - c2 * beta_h);
                    let d_rs_kappa2 = scale_s * (self.delta * h_im + beta * h_re);
                    let d_t_kappa2 = scale_t * (x_t * h_im + beta * c2 * h_re);
                    fresnel.d_n[lobe][lane] = d_rs_n * half_one_t + d_t_n;
                    fresnel.d_kappa2[lobe][lane] = d_rs_kappa2 * half_one_t + d_t_kappa2;
                }
            }
        }
        fresnel
    }
}
