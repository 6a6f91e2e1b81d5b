//! Student's t that comes nearest to a mixture of such, of different scales: an error whose size is known only roughly.

use brdfit_core::real::Real;

use crate::analysis::chance::{above_t, density_of_t};

/// What is left outside of one and of two standard deviations of a normal distribution, nearly: the two quantiles that are matched.
const OUTSIDE: [f64; 2] = [0.317_310_507_862_914, 0.05];

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
    let [inner, outer] = OUTSIDE.map(|outside| quantile(parts, degrees, outside));
    let one = |degrees: f64| OUTSIDE.map(|outside| quantile(&[(1.0, 1.0)], degrees, outside));
    // Of ln degrees: by how much the tails are too wide, which falls.
    let too_wide = |ln: f64| {
        let [one_inner, one_outer] = one(Real::portable_exp(ln));
        one_outer / one_inner - outer / inner
    };
    let (few, many) = (0.0, Real::portable_ln(degrees.max(1.0)));
    let degrees = match (too_wide(few), too_wide(many)) {
        (_, at_many) if !(at_many < 0.0) => degrees.max(1.0),
        (at_few, _) if !(at_few > 0.0) => 1.0,
        (at_few, at_many) => Real::portable_exp(root(too_wide, (few, at_few), (many, at_many))),
    };
    let scale = outer / one(degrees)[1];
    Student {
        variance: scale * scale,
        degrees,
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

/// Where so much of the mixture is outside, on both sides: Newton's steps, and halves where they leave what is known of it.
fn quantile(parts: &[(f64, f64)], degrees: f64, outside: f64) -> f64 {
    const ROUNDS: usize = 100;
    const CLOSE: f64 = 1e-13;
    let density = density_of_t(degrees);
    let beyond = |x: f64| -> (f64, f64) {
        let (mut more, mut slope) = (-outside, 0.0);
        for &(weight, variance) in parts {
            let scale = Real::sqrt(variance);
            more += 2.0 * weight * above_t(x / scale, degrees);
            slope -= 2.0 * weight * density(x / scale) / scale;
        }
        (more, slope)
    };
    let (mut low, mut high, mut x) = (0.0, f64::INFINITY, 1.0);
    for _ in 0..ROUNDS {
        let (more, slope) = beyond(x);
        *(if more > 0.0 { &mut low } else { &mut high }) = x;
        let step = x - more / slope;
        let next = if low < step && step < high {
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
