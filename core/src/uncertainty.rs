//! What a fit tells about its parameters: standard errors and correlations from J'J at the optimum; knows no BRDF.

use crate::lm::{Bounds, Linearization};
use crate::real::Real;

/// Where a parameter ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Place {
    /// Between its bounds.
    Inside,
    /// On its lower bound.
    Lower,
    /// On its upper bound.
    Upper,
    /// Held by equal bounds.
    Fixed,
    /// No residual depends on it: its column of J, times the larger of 1 and its own size, is rounding.
    Unseen,
}

/// The principal axes of the cost around the optimum: one standard error along each.
///
/// Sums over the axes are sums of squares, so that what is determined keeps its digits beside what is not.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Axes<R, const P: usize> {
    /// Row k is the displacement of the parameters along axis k that raises the cost by [`Uncertainty::scale`] squared; 0 for parameters that are held.
    ///
    /// Along what rounding cannot tell from undetermined it is what rounding allows, a lower bound; for a parameter that no residual sees it is the largest number.
    pub rows: [[R; P]; P],
    /// Ratio of the largest to the least eigenvalue of J'J after each column of J is scaled to length 1: 1 to 1 / (P epsilon).
    pub condition: R,
}

impl<R: Real, const P: usize> Axes<R, P> {
    /// Covariance of parameters i and j, in their units; 0 where one is held, infinite on the diagonal where nothing is known.
    pub fn covariance(&self, i: usize, j: usize) -> R {
        let at = |row: &[R; P], place: usize| row.get(place).copied().unwrap_or(R::ZERO);
        let mut sum = R::ZERO;
        for row in &self.rows {
            sum += at(row, i) * at(row, j);
        }
        sum
    }

    /// Standard error of a quantity that depends on the parameters with this gradient.
    pub fn standard_error_of(&self, gradient: &[R; P]) -> R {
        let mut sum = R::ZERO;
        for row in &self.rows {
            let part = dot(row, gradient);
            sum += part * part;
        }
        sum.sqrt()
    }

    /// Standard error of parameter i, in its unit.
    pub fn standard_error(&self, i: usize) -> R {
        self.covariance(i, i).sqrt()
    }

    /// Correlation of parameters i and j, -1 to 1; 0 where one is held or unseen.
    pub fn correlation(&self, i: usize, j: usize) -> R {
        let (a, b) = (self.standard_error(i), self.standard_error(j));
        let scale = a * b;
        if scale > R::ZERO && scale.is_finite() {
            (self.covariance(i, j) / scale).min(R::ONE).max(-R::ONE)
        } else {
            R::ZERO
        }
    }

    /// The same in other coordinates, each a function of one parameter with this derivative (the delta method).
    pub fn transformed(mut self, derivative: &[R; P]) -> Self {
        for row in &mut self.rows {
            for i in 0..P {
                row[i] = (row[i] * derivative[i]).min(R::MAX).max(-R::MAX);
            }
        }
        self
    }
}

/// What the residuals at an optimum tell about its parameters, for residuals of equal and independent errors.
///
/// Where residuals wander along the angle, as those of most measured scans do, true errors are several times larger: the program `brdfit` estimates their correlation, the core does not.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Uncertainty<R, const P: usize> {
    /// Standard deviation of a residual, the root of cost over degrees of freedom; infinite without any.
    pub scale: R,
    /// Number of residuals less number of parameters inside their bounds; 0 if negative.
    pub degrees_of_freedom: usize,
    /// Where each parameter ended.
    pub places: [Place; P],
    /// How far beyond its bound the linear model wants a parameter that is on one, the others inside following: in standard errors, positive towards larger values; 0 for the others.
    pub push: [R; P],
    /// Row i, of a parameter on a bound: the displacement if it lies one standard error from there, the others inside following; 0 for the others.
    pub along: [[R; P]; P],
    /// With the parameters on a bound held there.
    pub held: Axes<R, P>,
    /// As if those could move too: a parameter that is known only because another is on its bound is not known here.
    pub lifted: Axes<R, P>,
}

impl<R: Real, const P: usize> Uncertainty<R, P> {
    /// Of the optimum `x` within `bounds`, where `residuals` numbers have the linearization `at`.
    pub fn new(at: &Linearization<R, P>, x: &[R; P], bounds: &Bounds<R, P>, residuals: usize) -> Self {
        let places: [Place; P] = core::array::from_fn(|i| place(at, x, bounds, i));
        let inside = places.map(|place| place == Place::Inside);
        let degrees_of_freedom = residuals.saturating_sub(inside.iter().filter(|&&free| free).count());
        let scale = (at.cost / R::of(degrees_of_freedom as f64)).sqrt();
        let scale = if degrees_of_freedom > 0 {
            scale
        } else {
            R::ONE / R::ZERO
        };
        let unseen = places.map(|place| place == Place::Unseen);
        let mut push = [R::ZERO; P];
        let mut along = [[R::ZERO; P]; P];
        for i in 0..P {
            if matches!(places[i], Place::Lower | Place::Upper) {
                let mut free = inside;
                free[i] = true;
                // The minimum over the others that are inside, where their gradient is 0, is at -g / S with 1 / S their variance of i.
                let freed = axes(&at.hessian, free, [false; P], R::ONE);
                let error = freed.standard_error(i);
                let ratio = -at.gradient[i] * error / scale;
                push[i] = if ratio.is_finite() { ratio } else { R::ZERO };
                for j in 0..P {
                    let step = freed.covariance(i, j) / error * scale;
                    along[i][j] = if step.is_finite() { step } else { R::ZERO };
                }
            }
        }
        let lifted = places.map(|place| !matches!(place, Place::Fixed | Place::Unseen));
        Uncertainty {
            scale,
            degrees_of_freedom,
            places,
            push,
            along,
            held: axes(&at.hessian, inside, unseen, scale),
            lifted: axes(&at.hessian, lifted, unseen, scale),
        }
    }
}

fn place<R: Real, const P: usize>(at: &Linearization<R, P>, x: &[R; P], bounds: &Bounds<R, P>, i: usize) -> Place {
    let size = x[i].abs().max(R::ONE);
    if bounds.lower[i] >= bounds.upper[i] {
        Place::Fixed
    } else if x[i] <= bounds.lower[i] {
        Place::Lower
    } else if x[i] >= bounds.upper[i] {
        Place::Upper
    } else if at.hessian[i][i].sqrt() * size > R::EPSILON {
        Place::Inside
    } else {
        Place::Unseen
    }
}

/// The axes of the parameters that are `free`; those `unknown` may be anything.
fn axes<R: Real, const P: usize>(hessian: &[[R; P]; P], free: [bool; P], unknown: [bool; P], scale: R) -> Axes<R, P> {
    let length: [R; P] = core::array::from_fn(|i| hessian[i][i].sqrt().max(R::MIN_POSITIVE));
    let mut a = [[R::ZERO; P]; P];
    for i in 0..P {
        for j in 0..P {
            if free[i] && free[j] && i != j {
                a[i][j] = hessian[i][j] / length[i] / length[j];
            }
        }
        a[i][i] = R::ONE;
    }
    let vectors = diagonalize(&mut a);
    let (mut least, mut most) = (R::MAX, R::ZERO);
    for k in 0..P {
        if free[k] {
            least = least.min(a[k][k]);
            most = most.max(a[k][k]);
        }
    }
    let floor = most * R::EPSILON * R::of(P as f64);
    let mut rows = [[R::ZERO; P]; P];
    for k in 0..P {
        if free[k] && scale.is_finite() {
            let along = scale / a[k][k].max(floor).sqrt();
            for i in 0..P {
                if free[i] {
                    rows[k][i] = (along * vectors[i][k] / length[i]).min(R::MAX).max(-R::MAX);
                }
            }
        } else if free[k] || unknown[k] {
            rows[k][k] = R::MAX;
        }
    }
    Axes {
        rows,
        condition: if most > R::ZERO {
            most / least.max(floor)
        } else {
            R::ONE
        },
    }
}

/// Jacobi's cyclic rotations: leaves the eigenvalues on the diagonal of a symmetric `a`, and gives the eigenvectors as columns.
///
/// A row of `a` that is 0 beside its diagonal keeps its place.
fn diagonalize<R: Real, const P: usize>(a: &mut [[R; P]; P]) -> [[R; P]; P] {
    // Six are usual for nine parameters; the last of them only sees that nothing is left.
    const SWEEPS: usize = 20;
    let mut vectors = [[R::ZERO; P]; P];
    for i in 0..P {
        vectors[i][i] = R::ONE;
    }
    for _ in 0..SWEEPS {
        let mut turned = false;
        for q in 1..P {
            for p in 0..q {
                // Relative to both eigenvalues, so that small ones keep their digits (Demmel and Veselic 1992).
                let small = (a[p][p] * a[q][q]).max(R::EPSILON * R::EPSILON).sqrt() * R::EPSILON;
                if a[p][q].abs() <= small {
                    continue;
                }
                turned = true;
                let half_cot = (a[q][q] - a[p][p]) / (a[p][q] + a[p][q]);
                let size = R::ONE / (half_cot.abs() + (half_cot * half_cot + R::ONE).sqrt());
                let tan = if half_cot < R::ZERO { -size } else { size };
                let cos = R::ONE / (tan * tan + R::ONE).sqrt();
                let sin = tan * cos;
                for row in a.iter_mut().chain(&mut vectors) {
                    (row[p], row[q]) = (cos * row[p] - sin * row[q], sin * row[p] + cos * row[q]);
                }
                for k in 0..P {
                    (a[p][k], a[q][k]) = (cos * a[p][k] - sin * a[q][k], sin * a[p][k] + cos * a[q][k]);
                }
            }
        }
        if !turned {
            break;
        }
    }
    vectors
}

fn dot<R: Real, const P: usize>(a: &[R; P], b: &[R; P]) -> R {
    let mut sum = R::ZERO;
    for i in 0..P {
        sum += a[i] * b[i];
    }
    sum
}
