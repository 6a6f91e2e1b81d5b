//! What a scan tells about the parameters of its fit, in the order of their names.

use brdfit_core::brdf::{NAMES, has, slot};
use brdfit_core::lm::{Bounds, Problem};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::uncertainty::{self as core, Axes, Place};

use crate::simd::FastScan;

/// Standard errors and correlations of the six parameters, in the order of [`NAMES`], all dimensionless.
///
/// They hold for independent errors of ln f of equal size, and as far as the model is linear over them.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertainty {
    /// Standard deviation of a residual of ln f; infinite without degrees of freedom.
    pub scale: f64,
    /// Samples less parameters inside their bounds.
    pub degrees_of_freedom: usize,
    /// Where each parameter ended; `None` where it is no part of the model.
    pub places: [Option<Place>; 6],
    /// How far beyond its bound the data want a parameter that is on one, in standard errors, positive towards larger values.
    pub push: [f64; 6],
    /// Standard errors with the parameters on a bound held there; 0 where held or absent, infinite where no sample depends on it.
    pub stderr: [f64; 6],
    /// Their covariance.
    pub cov: [[f64; 6]; 6],
    /// Their correlation; 0 beside a parameter without a standard error.
    pub correlation: [[f64; 6]; 6],
    /// Condition number of J'J, columns scaled to length 1, from 1 to 1 / (P epsilon): over the parameters inside their bounds.
    pub condition: f64,
    /// Standard errors as if no parameter was held by a bound, linear in kappa^2: what is known only because another parameter is on its bound is not known here.
    pub stderr_lifted: [f64; 6],
    /// The principal axes behind `cov`: row k is a displacement of one standard error.
    pub axes: [[f64; 6]; 6],
    /// Those behind `stderr_lifted`.
    pub axes_lifted: [[f64; 6]; 6],
}

impl Uncertainty {
    /// Standard error of a quantity with this gradient by the parameters, whatever is on a bound held there.
    pub fn stderr_of(&self, gradient: &[f64; 6]) -> f64 {
        along(&self.axes, gradient)
    }

    /// The parameters inside their bounds that the samples depend on.
    pub fn inside(&self) -> impl Iterator<Item = usize> {
        (0..NAMES.len()).filter(|&index| self.places[index] == Some(Place::Inside))
    }
}

/// Standard error of a quantity with this gradient from axes of one standard error.
pub fn along(axes: &[[f64; 6]; 6], gradient: &[f64; 6]) -> f64 {
    let part = |axis: &[f64; 6]| -> f64 { axis.iter().zip(gradient).map(|(a, b)| a * b).sum() };
    axes.iter().map(|axis| part(axis) * part(axis)).sum::<f64>().sqrt()
}

/// Of the optimum `x` of a scan of `samples` rows, within `bounds`; one pass.
pub(crate) fn at<const TERMS: u8, const P: usize>(
    scene: &FastScan<f64, TERMS, P>,
    x: &[f64; P],
    bounds: &Bounds<f64, P>,
    samples: usize,
) -> Uncertainty {
    let known = core::Uncertainty::new(&scene.linearize(x), x, bounds, samples);
    let slopes = Scan::<f64, TERMS, P>::slopes(x);
    let held = known.held.transformed(&slopes);
    let mut lifted = known.lifted.transformed(&slopes);
    let kappa = has(TERMS, 5).then(|| slot(TERMS, 5));
    if let Some(kappa) = kappa.filter(|&kappa| x[kappa] == 0.0) {
        // There is no slope at kappa = 0; of kappa^2 = 0 +- error the upper end says how large kappa can be.
        let error = known.lifted.standard_error(kappa);
        let slope = if error > 0.0 { 1.0 / Real::sqrt(error) } else { 0.0 };
        let mut slopes = [1.0; P];
        slopes[kappa] = slope;
        lifted = known.lifted.transformed(&slopes);
    }
    let places = |index| has(TERMS, index).then(|| slot(TERMS, index));
    let place: [Option<usize>; 6] = std::array::from_fn(places);
    let vector = |of: &dyn Fn(usize) -> f64| place.map(|k| k.map_or(0.0, of));
    let matrix = |of: &dyn Fn(usize, usize) -> f64| place.map(|i| i.map_or([0.0; 6], |i| vector(&|j| of(i, j))));
    let rows = |axes: &Axes<f64, P>| matrix(&|i, j| axes.rows[i][j]);
    Uncertainty {
        scale: known.scale,
        degrees_of_freedom: known.degrees_of_freedom,
        places: place.map(|k| k.map(|k| known.places[k])),
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
