//! Student's t that comes nearest to a mixture of such, of different scales: an error whose size is known only roughly.

use brdfit_core::real::Real;

use crate::analysis::chance::above_t;

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
    let tails = |degrees: f64| {
        let [inner, outer] = one(degrees);
        outer / inner
    };
    let (mut few, mut many) = (1.0f64, degrees.max(1.0));
    if tails(many) < outer / inner {
        for _ in 0..40 {
            let middle = Real::sqrt(few * many);
            *(if tails(middle) > outer / inner {
                &mut few
            } else {
                &mut many
            }) = middle;
        }
    }
    let scale = outer / one(many)[1];
    Student {
        variance: scale * scale,
        degrees: many,
    }
}

/// Where so much of the mixture is outside, on both sides.
fn quantile(parts: &[(f64, f64)], degrees: f64, outside: f64) -> f64 {
    let beyond = |x: f64| -> f64 {
        let of = |&(weight, variance): &(f64, f64)| 2.0 * weight * above_t(x / Real::sqrt(variance), degrees);
        parts.iter().map(of).sum()
    };
    let (mut low, mut high) = (0.0, 1.0);
    while beyond(high) > outside && high < 1e12 {
        high *= 2.0;
    }
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        *(if beyond(middle) > outside { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}
