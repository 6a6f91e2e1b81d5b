//! Enclosures of the Fresnel reflectance over a rectangle of indices.
//!
//! With the index n - i kappa, S = n^2 + kappa^2, x = 1/S, nu = n^2/S, y = n/S, c = cos theta and s^2 = 1 - c^2, the root sqrt(eps - s^2) = p - i q has
//! g = |p - i q|^2 / S, g^2 = (1 - s^2 x)^2 + 4 s^2 (1 - nu) x, and omega = p/S = y sqrt(1 - zeta), zeta = 2 s^2 x / (1 + s^2 x + g).
//! Then F = (1 - A) / ((1 + A) (1 + B)) with A = 2 c omega / (c^2 x + g) and B = 2 c s^2 omega / (c^2 g + s^4 x): no number in it is a difference that cancels, and for large indices all of x, y, A and B are small.
//! Where F vanishes, at n = 1 and kappa = 0, 1 - A is |eps - 1|^2 x^2 / ((c^2 x + g) (c^2 x + g + 2 c omega)), whose first factors do not depend on the angle.

use super::interval::{Interval, ln_down, ln_up};
use super::jet::Jet;

/// A rectangle of indices in the coordinates a = ln n and b = ln(1 + kappa^2).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Indices {
    /// n^2, of which n >= 1.
    n2: Interval,
    kappa2: Interval,
    x: Jet,
    y: Jet,
    nu: Jet,
    /// Whether F is far from 0 in all the rectangle.
    far: bool,
}

/// Above this least n^2 + kappa^2, F is far from 0.
const FAR: f64 = 3.0;

/// e^a - 1 without the loss of digits near 0; off by less than 1e-14 of it.
fn exp_m1(a: f64, exp: f64) -> f64 {
    if a.abs() < 1e-3 {
        a * (1.0 + a * (0.5 + a * (1.0 / 6.0 + a * (1.0 / 24.0 + a * (1.0 / 120.0)))))
    } else {
        exp - 1.0
    }
}

const ONE: Interval = Interval { lo: 1.0, hi: 1.0 };

impl Indices {
    /// Those of `a` and `b`, neither below 0 by more than rounding.
    pub fn new(a: Interval, b: Interval) -> Self {
        let n2 = (a * 2.0).exp();
        let n2 = Interval::new(n2.lo.max(1.0), n2.hi.max(1.0));
        let e = b.exp();
        // e^b is known to 1e-15, of which e^b - 1 > 1e-3 keeps 1e-12.
        let wide = |x: f64, sign: f64| x + sign * (x.abs() * 1e-11 + 1e-300);
        let kappa2 = Interval::new(
            wide(exp_m1(b.lo, e.lo), -1.0).max(0.0),
            wide(exp_m1(b.hi, e.hi), 1.0).max(0.0),
        );
        let point = Interval::point;
        let sum = n2 + kappa2;
        // Each number is monotonic in n^2 and in kappa^2, so its range is known from corners.
        let share = |n2: f64, kappa2: f64| point(n2) * (point(n2) + point(kappa2)).reciprocal();
        let nu = Interval::new(share(n2.lo, kappa2.hi).lo, share(n2.hi, kappa2.lo).hi.min(1.0));
        let grown = |n2: f64, kappa2: f64| (ONE + point(kappa2)) * (point(n2) + point(kappa2)).reciprocal();
        let beta = Interval::new(grown(n2.hi, kappa2.lo).lo, grown(n2.lo, kappa2.hi).hi.min(1.0));
        let rest = |n2: f64, kappa2: f64| point(kappa2) * (point(n2) + point(kappa2)).reciprocal();
        let less = Interval::new(rest(n2.hi, kappa2.lo).lo.max(0.0), rest(n2.lo, kappa2.hi).hi.min(1.0));
        let real = |n2: f64, kappa2: f64| point(n2).sqrt() * (point(n2) + point(kappa2)).reciprocal();
        // Largest where n = kappa, if that is within.
        let best = kappa2.lo.max(n2.lo).min(n2.hi);
        let y = Interval::new(
            real(n2.lo, kappa2.hi).lo.min(real(n2.hi, kappa2.hi).lo),
            real(best, kappa2.lo).hi,
        );
        let x = sum.reciprocal();
        let bend = beta * (beta * 2.0 - ONE);
        let tilt = ONE - nu * 2.0;
        let x = Jet {
            value: x,
            a: -(nu * x * 2.0),
            b: -(beta * x),
            aa: -(nu * x * tilt * 4.0),
            ab: nu * beta * x * 4.0,
            bb: bend * x,
        };
        let y = Jet {
            value: y,
            a: tilt * y,
            b: -(beta * y),
            aa: (tilt.square() - nu * less * 4.0) * y,
            ab: -(beta * y * (ONE - nu * 4.0)),
            bb: bend * y,
        };
        let nu = Jet {
            value: nu,
            a: nu * less * 2.0,
            b: -(nu * beta),
            aa: nu * less * tilt * 4.0,
            ab: -(nu * beta * tilt * 2.0),
            bb: nu * bend,
        };
        Indices {
            n2,
            kappa2,
            x,
            y,
            nu,
            far: sum.lo > FAR,
        }
    }

    /// ln |eps - 1|^2, which grows with n and kappa; minus infinity for the vacuum.
    fn ln_contrast(&self) -> Interval {
        let at = |n2: f64, kappa2: f64| {
            let (n2, kappa2) = (Interval::point(n2), Interval::point(kappa2));
            // |n - 1 - i kappa|^2 |n + 1 - i kappa|^2, with n - 1 = (n^2 - 1) / (n + 1).
            let more = n2.sqrt() + ONE;
            let less = (n2 - ONE) * more.reciprocal();
            (less.square() + kappa2) * (more.square() + kappa2)
        };
        Interval::new(
            ln_down(at(self.n2.lo, self.kappa2.lo).lo),
            ln_up(at(self.n2.hi, self.kappa2.hi).hi),
        )
    }

    /// ln F at the cosine `c`, less what does not depend on `c`.
    pub fn psi(&self, c: f64) -> Jet {
        let parts = Parts::new(self, Interval::point(c));
        let one = Jet::constant(ONE);
        let tail = (one + parts.b).ln();
        if self.far {
            (one - parts.a).ln() - (one + parts.a).ln() - tail
        } else {
            Jet::constant(Interval::point(0.0)) - (parts.under + parts.over).ln() * Interval::point(2.0) - tail
        }
    }

    /// ln F where `psi` is that of the same indices.
    pub fn ln_f(&self, psi: &Jet) -> Interval {
        let f = if self.far {
            psi.value
        } else {
            self.ln_contrast() + self.x.value.ln() * 2.0 + psi.value
        };
        Interval::new(f.lo.min(0.0), f.hi.min(0.0))
    }

    /// d psi / dc over the cosines in `c`.
    pub fn psi_slope(&self, c: Interval) -> Jet {
        let parts = Parts::new(self, c);
        let Parts {
            s2,
            g,
            omega,
            under,
            over,
            below,
            ..
        } = parts;
        let (x, two) = (self.x, Interval::point(2.0));
        let c2 = c.square();
        let one = Jet::constant(ONE);
        let inverse_g = g.reciprocal();
        let g_c = x * (self.nu * two - one - x * s2) * inverse_g * (c * 2.0);
        let omega_c = x * omega * inverse_g * c;
        let under_c = x * (c * 2.0) + g_c;
        let over_c = omega * two + omega_c * (c * 2.0);
        let below_c = g * (c * 2.0) + g_c * c2 - x * (c * s2 * 4.0);
        let b_c = omega * (s2 * 2.0 - c2 * 4.0) + omega_c * (c * s2 * 2.0) - parts.b * below_c;
        let tail = b_c * (below * (one + parts.b)).reciprocal();
        let head = if self.far {
            // A' / (1 - A^2) of A = over / under.
            (over_c - parts.a * under_c) * (under * (one - parts.a * parts.a)).reciprocal()
        } else {
            (under_c + over_c) * (under + over).reciprocal()
        };
        Jet::constant(Interval::point(0.0)) - head * two - tail
    }
}

/// What psi consists of.
struct Parts {
    s2: Interval,
    g: Jet,
    omega: Jet,
    /// c^2 x + g.
    under: Jet,
    /// 2 c omega.
    over: Jet,
    /// c^2 g + s^4 x.
    below: Jet,
    a: Jet,
    b: Jet,
}

impl Parts {
    fn new(indices: &Indices, c: Interval) -> Self {
        let (x, one) = (indices.x, Jet::constant(ONE));
        let c2 = c.square();
        let s2 = (ONE - c2).not_negative();
        let sx = x * s2;
        let straight = (one - sx) * (one - sx);
        let g = (straight + sx * (one - indices.nu) * Interval::point(4.0)).sqrt();
        let zeta = sx * (one + sx + g).reciprocal() * Interval::point(2.0);
        let omega = indices.y * (one - zeta).sqrt();
        let under = x * c2 + g;
        let over = omega * (c * 2.0);
        let below = g * c2 + x * s2.square();
        Parts {
            s2,
            g,
            omega,
            under,
            over,
            below,
            a: over * under.reciprocal(),
            b: over * s2 * below.reciprocal(),
        }
    }
}
