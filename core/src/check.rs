//! Are the derivatives of a problem those of its cost? For tests of a model of one's own.

use crate::lm::Problem;
use crate::real::Real;

/// The component of J'r that differs most from central differences of the cost: its place, and by how much, as a part of the larger.
///
/// Of derivatives that are right, that is about epsilon^(2/3) where J'r is not small beside |r| times the norm of the column of J: far from the optimum.
/// 1e-9 in `f64` and 1e-3 in `f32` are common; one that is wrong differs by what is wrong with it, and 1 says that there is no such number.
/// The cost must have no kink nearer to `x` than a hundredth of each value in `f32`, and 1e-5 of it in `f64`.
///
/// [`crate::formula::worst_slope`] is exact where the model is a formula.
///
/// ```
/// use brdfit_core::check::worst_gradient;
/// use brdfit_core::lm::{Linearization, Problem};
///
/// /// The points (0, 2), (1, 1), (2, 0.7) by a exp(-b t), with the derivative by b wrong by 1 %.
/// struct Decay;
///
/// impl Problem<f64, 2> for Decay {
///     fn cost(&self, x: &[f64; 2]) -> f64 {
///         self.linearize(x).cost
///     }
///     fn linearize(&self, &[a, b]: &[f64; 2]) -> Linearization<f64, 2> {
///         let mut sums = Linearization::zero();
///         for (t, y) in [(0.0, 2.0), (1.0, 1.0), (2.0, 0.7)] {
///             let model = a * f64::exp(-b * t);
///             sums.add(model - y, &[model / a, -1.01 * t * model]);
///         }
///         sums
///     }
///     fn bend(&self, _x: &[f64; 2], _step: &[f64; 2], to: [f64; 2]) -> [f64; 2] {
///         to
///     }
/// }
///
/// let (place, off) = worst_gradient(&Decay, &[1.0, 0.5]);
/// assert_eq!(place, 1);
/// assert!((off - 0.01).abs() < 1e-3);
/// ```
pub fn worst_gradient<R: Real, const P: usize>(problem: &impl Problem<R, P>, x: &[R; P]) -> (usize, R) {
    // The step for which the error of the difference and that of rounding are about equal.
    let part = (R::EPSILON.portable_ln() / R::of(3.0)).portable_exp();
    let at = problem.linearize(x);
    let mut worst = (0, R::ZERO);
    for k in 0..P {
        // Of a value that is 0, what changes the residuals by as much as they are.
        let scale = match x[k] {
            value if value != R::ZERO => value.abs(),
            _ => at.cost.sqrt() / at.hessian[k][k].sqrt().max(R::MIN_POSITIVE),
        };
        let (mut above, mut below) = (*x, *x);
        above[k] += part * scale;
        below[k] -= part * scale;
        // The cost is r'r, and its derivative 2 J'r.
        let slope = (problem.cost(&above) - problem.cost(&below)) / (R::of(2.0) * (above[k] - below[k]));
        let larger = slope.abs().max(at.gradient[k].abs()).max(R::MIN_POSITIVE);
        let off = (slope - at.gradient[k]).abs() / larger;
        let off = if off.is_finite() { off } else { R::ONE };
        if off > worst.1 {
            worst = (k, off);
        }
    }
    worst
}
