//! What a scan tells about the parameters of its fit, in the order of their names.

use brdfit_core::lm::Bounds;
use brdfit_core::real::Real;
use brdfit_core::uncertainty::{self as core, Axes, Place};

use crate::compiled::Kernel;
use crate::layout::Layout;
use crate::{FitOptions, Values};

/// Standard errors and correlations of the parameters, in the order of [`crate::Model::parameters`] and in their units.
///
/// They hold for independent errors of ln f of equal size, and as far as the model is linear over them.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertainty {
    /// Standard deviation of a residual of ln f; infinite without degrees of freedom.
    pub scale: f64,
    /// Samples less parameters inside their bounds.
    pub degrees_of_freedom: usize,
    /// Where each parameter ended; `None` where the model does not have it.
    pub places: Vec<Option<Place>>,
    /// How far beyond its bound the data want a parameter that is on one, in standard errors, positive towards larger values.
    pub push: Values,
    /// Standard errors with the parameters on a bound held there; 0 where held or absent, infinite where no sample depends on it.
    pub stderr: Values,
    /// Their covariance.
    pub cov: Vec<Values>,
    /// Their correlation; 0 beside a parameter without a standard error.
    pub correlation: Vec<Values>,
    /// Condition number of J'J, columns scaled to length 1, from 1 to 1 / (P epsilon): over the parameters inside their bounds.
    pub condition: f64,
    /// Standard errors as if no parameter was held by a bound, linear in kappa^2: what is known only because another parameter is on its bound is not known here.
    pub stderr_lifted: Values,
    /// The principal axes behind `cov`: row k is a displacement of one standard error.
    pub axes: Vec<Values>,
    /// Those behind `stderr_lifted`.
    pub axes_lifted: Vec<Values>,
}

impl Uncertainty {
    /// Standard error of a quantity with this gradient by the parameters, whatever is on a bound held there.
    pub fn stderr_of(&self, gradient: &[f64]) -> f64 {
        along(&self.axes, gradient)
    }

    /// The parameters inside their bounds that the samples depend on.
    pub fn inside(&self) -> impl Iterator<Item = usize> {
        (0..self.places.len()).filter(|&index| self.places[index] == Some(Place::Inside))
    }
}

/// Standard error of a quantity with this gradient from axes of one standard error.
pub fn along(axes: &[Values], gradient: &[f64]) -> f64 {
    let part = |axis: &Values| -> f64 { axis.iter().zip(gradient).map(|(a, b)| a * b).sum() };
    axes.iter().map(|axis| part(axis) * part(axis)).sum::<f64>().sqrt()
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
    let matrix = |of: &dyn Fn(usize, usize) -> f64| -> Vec<Values> {
        let row = |place: usize| match coordinate(place) {
            Some(i) => vector(&|j| of(i, j)),
            None => vector(&|_| 0.0),
        };
        (0..count).map(row).collect()
    };
    let rows = |axes: &Axes<f64, P>| matrix(&|i, j| axes.rows[i][j]);
    Uncertainty {
        scale: known.scale,
        degrees_of_freedom: known.degrees_of_freedom,
        places: (0..count)
            .map(|place| coordinate(place).map(|k| known.places[k]))
            .collect(),
        push: vector(&|k| known.push[k]),
        stderr: vector(&|k| held.standard_error(k)),
        cov: matrix(&|i, j| held.covariance(i, j)),
        correlation: matrix(&|i, j| held.correlation(i, j)),
        condition: held.condition,
        stderr_lifted: vector(&|k| lifted.standard_error(k)),
        axes: rows(&held),
        axes_lifted: rows(&lifted),
    }
}
