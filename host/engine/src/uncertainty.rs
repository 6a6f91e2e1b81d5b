//! What a scan tells about the parameters of its fit, in the order of their names.

use brdfit_core::lm::Bounds;
use brdfit_core::real::Real;
use brdfit_core::uncertainty::{self as core, Axes, Place};

use crate::layout::Layout;
pub use crate::material::NEAR_ZERO;
use crate::options::{FitOptions, Precision};
use crate::passes::Kernel;
use crate::values::Values;

/// A displacement of this size stands for one without any limit, of which 0 times a slope of 0 is no number.
pub const UNKNOWN: f64 = f64::MAX;

/// How the residuals of a scan are correlated along the angle, and what follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Misfit {
    /// The angle over which the correlation falls to 1/e, radians.
    pub length: f64,
    /// The part of their variance that is correlated, 0 to 1; the rest is noise of each sample.
    pub part: f64,
    /// How likely it is that the correlated part has a slope, as the misfit of a model has, and the drift of an instrument has not: 0 to 1.
    pub smooth: f64,
    /// Is independence refuted, at a level of 5 %? Otherwise it is only less likely, and errors count both.
    pub sure: bool,
    /// Their variance before the fit took up a part of them, over that of the residuals.
    pub variance: f64,
    /// Standard errors over those of independent residuals: the least and the largest of a parameter inside its bounds.
    pub factor: (f64, f64),
}

/// Standard errors and correlations of the parameters, in the order of [`crate::Model::parameters`] and in their units.
///
/// They hold as far as the model is linear over them.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertainty {
    /// Standard deviation of a residual of ln f; infinite without degrees of freedom.
    pub scale: f64,
    /// Residuals that are smaller than this are rounding: 1e-10, or 1e-5 of a fit in `f32`.
    pub rounding: f64,
    /// Samples less parameters inside their bounds.
    pub degrees_of_freedom: usize,
    /// Those that the standard errors have, for Student's t: the same for independent residuals, fewer for correlated ones.
    pub effective: f64,
    /// The correlation of the residuals, where standard errors account for it; none of [`crate::fit`].
    pub misfit: Option<Misfit>,
    /// Where each parameter ended; `None` where the model does not have it.
    pub places: Vec<Option<Place>>,
    /// How far beyond its bound the data want a parameter that is on one, in standard errors, positive towards larger values.
    pub push: Values,
    /// Standard errors; 0 where held, on a bound or absent, infinite where no sample depends on it.
    ///
    /// A parameter on a bound may be inside it, and the others then follow: that is part of their errors, the less the harder the data push.
    pub stderr: Values,
    /// Their covariance.
    pub cov: Vec<Values>,
    /// Their correlation; 0 beside a parameter without a standard error.
    pub correlation: Vec<Values>,
    /// Condition number of J'J, columns scaled to length 1, from 1 to 1 / (P epsilon): over the parameters inside their bounds.
    pub condition: f64,
    /// Standard errors as if no parameter was held by a bound, linear in kappa^2: what is known only because another parameter is on its bound is not known here.
    pub stderr_lifted: Values,
    /// The principal axes behind `cov`: row k is a displacement of one standard error; that of a parameter on a bound is how far it may be inside, kappa as at [`NEAR_ZERO`].
    pub axes: Vec<Values>,
    /// Those behind `stderr_lifted`.
    pub axes_lifted: Vec<Values>,
}

impl Uncertainty {
    /// Standard error of a quantity with this gradient by the parameters, at [`crate::Material::off_zero`].
    pub fn stderr_of(&self, gradient: &[f64]) -> f64 {
        along(&self.axes, gradient)
    }

    /// The parameters inside their bounds that the samples depend on.
    pub fn inside(&self) -> impl Iterator<Item = usize> {
        (0..self.places.len()).filter(|&index| self.places[index] == Some(Place::Inside))
    }

    /// The same with other axes, and what follows from them.
    pub fn with_axes(mut self, axes: Vec<Values>) -> Self {
        let count = self.places.len();
        let has = |i: usize| matches!(self.places[i], Some(Place::Inside | Place::Unseen));
        // Squares of what is far from 1 are no numbers: a power of two of each parameter is taken out before, which changes no digit.
        let sizes: Vec<i32> = (0..count).map(|i| size(axes.iter().map(|axis| axis[i]))).collect();
        let one = |axis: &Values| Values::from_fn(count, |i| libm::ldexp(axis[i], -sizes[i]));
        let ordinary: Vec<Values> = axes.iter().map(one).collect();
        let product = |i: usize, j: usize| {
            let products = ordinary.iter().map(|axis| axis[i] * axis[j]);
            if has(i) && has(j) { products.sum() } else { 0.0 }
        };
        let root = |i: usize| Real::sqrt(product(i, i));
        let stderr = Values::from_fn(count, |i| libm::ldexp(root(i), sizes[i]));
        let covariance = |i: usize, j: usize| libm::ldexp(product(i, j), sizes[i] + sizes[j]);
        let correlation = |i: usize, j: usize| {
            let scale = root(i) * root(j);
            if scale > 0.0 && scale.is_finite() {
                (product(i, j) / scale).clamp(-1.0, 1.0)
            } else {
                0.0
            }
        };
        let matrix =
            |of: &dyn Fn(usize, usize) -> f64| (0..count).map(|i| Values::from_fn(count, |j| of(i, j))).collect();
        self.cov = matrix(&covariance);
        self.correlation = matrix(&correlation);
        self.stderr = stderr;
        self.axes = axes;
        self
    }
}

/// Mean square of a normal number of mean -`push` and variance 1 that is known to be above 0: how far inside its bound a parameter on it may lie, in standard errors.
///
/// 1 where the data want it on the bound, and 2 / push^2 where they push hard.
pub fn inside_of_bound(push: f64) -> f64 {
    let push = push.abs();
    // Mills' ratio by Laplace's continued fraction where the two parts below cancel.
    let mean = if push > 6.0 {
        (1..=20).rev().fold(push, |rest, k| push + f64::from(k) / rest)
    } else {
        let density = Real::portable_exp(-0.5 * push * push) / Real::sqrt(2.0 * std::f64::consts::PI);
        density / (0.5 * libm::erfc(push * std::f64::consts::FRAC_1_SQRT_2))
    };
    // With mean = push + 1 / (push + 2 / (...)): 1 - push (mean - push).
    1.0 - push * (mean - push)
}

/// Standard error of a quantity with this gradient from axes of one standard error.
pub fn along(axes: &[Values], gradient: &[f64]) -> f64 {
    let product = |(&a, &b): (&f64, &f64)| match f64::abs(a) == UNKNOWN && b != 0.0 {
        true => f64::INFINITY,
        false => a * b,
    };
    let part = |axis: &Values| -> f64 { axis.iter().zip(gradient).map(product).sum() };
    let size = size(axes.iter().map(part));
    let ordinary = |axis: &Values| libm::ldexp(part(axis), -size);
    let squares = axes.iter().map(|axis| ordinary(axis) * ordinary(axis));
    libm::ldexp(squares.sum::<f64>().sqrt(), size)
}

/// The exponent of the largest of some numbers, where squares of them may be no numbers or lose digits; else 0.
fn size(numbers: impl Iterator<Item = f64>) -> i32 {
    const ORDINARY: i32 = 400;
    let known = numbers.map(f64::abs).filter(|&x| x < UNKNOWN);
    let size = libm::frexp(known.fold(0.0, f64::max)).1;
    if size.abs() > ORDINARY { size } else { 0 }
}

/// Residuals of ln f that are smaller than this are rounding.
pub const fn rounding(precision: Precision) -> f64 {
    match precision {
        Precision::F64 => 1e-10,
        Precision::F32 => 1e-5,
    }
}

/// Of the optimum `x` of a scan of `samples` rows, within `bounds`; one pass.
pub(crate) fn at<const P: usize>(
    scene: &Kernel<f64, P>,
    x: &[f64; P],
    bounds: &Bounds<f64, P>,
    layout: &Layout<P>,
    options: &FitOptions,
    samples: usize,
) -> Uncertainty {
    let known = core::Uncertainty::new(&scene.linearize(x), x, bounds, samples);
    let slopes = layout.slopes(x);
    let held = known.held.transformed(&slopes);
    let mut lifted = known.lifted.transformed(&slopes);
    if let Some(kappa) = layout.squared().filter(|&kappa| x[kappa] == 0.0) {
        // There is no slope at kappa = 0; of kappa^2 = 0 +- error the upper end says how large kappa can be.
        let error = known.lifted.standard_error(kappa);
        let slope = if error > 0.0 { 1.0 / Real::sqrt(error) } else { 0.0 };
        let mut slopes = [1.0; P];
        slopes[kappa] = slope;
        lifted = known.lifted.transformed(&slopes);
    }
    let count = options.model.parameters.len();
    let coordinate = |place: usize| {
        let part = !options.model.left_out(options.terms, place);
        layout.coordinate(place).filter(|_| part)
    };
    let vector = |of: &dyn Fn(usize) -> f64| Values::from_fn(count, |place| coordinate(place).map_or(0.0, of));
    let rows = |axes: &Axes<f64, P>| -> Vec<Values> {
        let row = |place: usize| match coordinate(place) {
            Some(i) => vector(&|j| axes.rows[i][j]),
            None => vector(&|_| 0.0),
        };
        (0..count).map(row).collect()
    };
    let mut with_bounds = held;
    for i in 0..P {
        if matches!(known.places[i], Place::Lower | Place::Upper) {
            // It cannot lie farther inside than the other bound.
            let most = (bounds.upper[i] - bounds.lower[i]) / known.along[i][i];
            let size = Real::sqrt(inside_of_bound(known.push[i])).min(most.abs());
            for j in 0..P {
                let slope = if layout.squared() == Some(j) && x[j] == 0.0 {
                    0.5 / NEAR_ZERO
                } else {
                    slopes[j]
                };
                with_bounds.rows[i][j] = known.along[i][j] * size * slope;
            }
        }
    }
    let of_axes = Uncertainty {
        scale: known.scale,
        rounding: rounding(options.precision),
        degrees_of_freedom: known.degrees_of_freedom,
        effective: known.degrees_of_freedom as f64,
        misfit: None,
        places: (0..count)
            .map(|place| coordinate(place).map(|k| known.places[k]))
            .collect(),
        push: vector(&|k| known.push[k]),
        stderr: vector(&|_| 0.0),
        cov: Vec::new(),
        correlation: Vec::new(),
        condition: held.condition,
        stderr_lifted: vector(&|k| lifted.standard_error(k)),
        axes: Vec::new(),
        axes_lifted: rows(&lifted),
    };
    of_axes.with_axes(rows(&with_bounds))
}
