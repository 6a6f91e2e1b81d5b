//! Student's t that comes nearest to a mixture of such, of different scales: an error whose size is known only roughly.

use std::cell::Cell;

use brdfit_core::real::Real;

use crate::analysis::chance::tail_of_t;

/// What is left outside of one and of two standard deviations of a normal distribution, nearly: the two quantiles that are matched.
const OUTSIDE: [f64; 2] = [0.317_310_507_862_914, 0.05];

/// Those of the normal distribution, nearly.
const NORMAL: [f64; 2] = [1.0, 1.96];

/// A distribution of Student's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Student {
    /// The square of its scale.
    pub variance: f64,
    /// Its degrees of freedom, at least 1.
    pub degrees: f64,
}

/// The one with the quantiles of 68 and 95 % of a mixture: each part has a weight, of which the sum is 1, a squared scale, and `degrees` degrees of freedom.
pub fn matched(parts: &[(f64, f64)], degrees: f64) -> Student {
    let plain = Plain::of(degrees);
    let [inner, outer] = quantiles(parts, degrees, plain.near);
    let excess = |[one_inner, one_outer]: [f64; 2]| one_outer / one_inner - outer / inner;
    let most = degrees.max(1.0);
    let (degrees, own_outer) = match (excess(plain.few), excess(plain.many)) {
        (_, at_many) if !(at_many < 0.0) => (most, plain.most[1]),
        (at_few, _) if !(at_few > 0.0) => (1.0, plain.few[1]),
        (at_few, at_many) => {
            // Of ln degrees: by how much the tails are too wide, which falls.
            let last = Cell::new((f64::NAN, f64::NAN));
            let too_wide = |ln: f64| {
                let degrees = Real::portable_exp(ln);
                let one = plain.one(degrees);
                last.set((degrees, one[1]));
                excess(one)
            };
            let found = root(too_wide, (0.0, at_few), (Real::portable_ln(most), at_many));
            let degrees = Real::portable_exp(found);
            match last.get() {
                (same, outer) if same == degrees => (degrees, outer),
                _ => (degrees, plain.one(degrees)[1]),
            }
        }
    };
    let scale = outer / own_outer;
    Student {
        variance: scale * scale,
        degrees,
    }
}

/// The quantiles that do not depend on the parts of a mixture, which scans of as many samples share.
#[derive(Clone, Copy)]
struct Plain {
    /// The degrees of freedom of the parts.
    of: f64,
    /// Those of Student's t of these: where others begin.
    near: [f64; 2],
    /// The same from there, of one degree, of these through their logarithm, and of these.
    few: [f64; 2],
    many: [f64; 2],
    most: [f64; 2],
}

impl Plain {
    fn of(degrees: f64) -> Plain {
        /// Numbers of degrees of freedom that are kept.
        const KEPT: usize = 8;
        const NONE: Plain = Plain {
            of: f64::NAN,
            near: NORMAL,
            few: NORMAL,
            many: NORMAL,
            most: NORMAL,
        };
        thread_local! {
            static KNOWN: Cell<[Plain; KEPT]> = const { Cell::new([NONE; KEPT]) };
        }
        let (mut known, place) = (KNOWN.get(), degrees as usize % KEPT);
        if known[place].of != degrees {
            let most = degrees.max(1.0);
            let mut plain = Plain { of: degrees, ..NONE };
            plain.near = plain.one(most);
            plain.few = plain.one(1.0);
            plain.many = plain.one(Real::portable_exp(Real::portable_ln(most)));
            plain.most = plain.one(most);
            known[place] = plain;
            KNOWN.set(known);
        }
        known[place]
    }

    /// The quantiles of Student's t of so many degrees of freedom.
    fn one(&self, degrees: f64) -> [f64; 2] {
        quantiles(&[(1.0, 1.0)], degrees, self.near)
    }
}

/// Where a function that falls from above 0 to below it is 0: secants between both sides, of which one that stays counts half each time (the Illinois method; Dowell and Jarratt 1971).
fn root(f: impl Fn(f64) -> f64, mut above: (f64, f64), mut below: (f64, f64)) -> f64 {
    const ROUNDS: usize = 60;
    const CLOSE: f64 = 1e-13;
    let mut side = 0;
    for _ in 0..ROUNDS {
        if (below.0 - above.0).abs() <= CLOSE * above.0.abs().max(1.0) {
            break;
        }
        let next = above.0 + (below.0 - above.0) * above.1 / (above.1 - below.1);
        let at = f(next);
        if at.abs() <= CLOSE {
            return next;
        }
        let moved = if at > 0.0 { 1 } else { -1 };
        if moved > 0 {
            above = (next, at);
        } else {
            below = (next, at);
        }
        if side == moved {
            *(if moved > 0 { &mut below.1 } else { &mut above.1 }) *= 0.5;
        }
        side = moved;
    }
    0.5 * (above.0 + below.0)
}

/// Where so much of the mixture is outside, on both sides, as [`OUTSIDE`] has it, from values nearby.
fn quantiles(parts: &[(f64, f64)], degrees: f64, near: [f64; 2]) -> [f64; 2] {
    let tail = tail_of_t(degrees);
    // Each part by its weight and the reciprocal of its scale.
    let parts: Vec<(f64, f64)> = parts
        .iter()
        .map(|&(weight, variance)| (weight, 1.0 / Real::sqrt(variance)))
        .collect();
    let outside = |x: f64| {
        let mut all = [0.0; 3];
        for &(weight, per_scale) in &parts {
            let t = x * per_scale;
            let (above, density) = tail(t);
            let slope = 2.0 * weight * density * per_scale;
            all[0] += 2.0 * weight * above;
            all[1] -= slope;
            all[2] += slope * (degrees + 1.0) * t / (degrees + t * t) * per_scale;
        }
        all
    };
    std::array::from_fn(|k| falls_to(outside, OUTSIDE[k], near[k]))
}

/// Where a function that falls, given with its first and second derivative, is `level`: Halley's steps (1694), and halves where they leave what is known of it.
fn falls_to(f: impl Fn(f64) -> [f64; 3], level: f64, near: f64) -> f64 {
    const ROUNDS: usize = 100;
    // The error of a step is of its third power.
    const CLOSE: f64 = 3e-6;
    let (mut low, mut high, mut x) = (0.0, f64::INFINITY, near);
    for _ in 0..ROUNDS {
        let [value, slope, bend] = f(x);
        let more = value - level;
        *(if more > 0.0 { &mut low } else { &mut high }) = x;
        let step = x - 2.0 * more * slope / (2.0 * slope * slope - more * bend);
        let next = if low <= step && step <= high {
            step
        } else {
            (0.5 * (low + high)).min(2.0 * x)
        };
        if (next - x).abs() <= CLOSE * x {
            return next;
        }
        x = next;
    }
    x
}
