//! An offset of theta_s that is fitted with the parameters: what it leaves open of them, and its own standard error.

use brdfit_core::geometry::Sample;

use crate::instrument::View;
use crate::options::FitOptions;
use crate::values::Values;

/// The derivative of each residual by the offset, and those by the solver's coordinates, of which only what is at right angles to it is known apart from it.
pub struct Nuisance<const P: usize> {
    /// J'c.
    pub cross: [f64; P],
    /// c'c.
    pub square: f64,
}

impl<const P: usize> Nuisance<P> {
    /// `gradient` gives the derivatives of ln f by the coordinates.
    pub fn new(samples: &[Sample<f64>], view: &View, gradient: impl Fn(&Sample<f64>) -> [f64; P]) -> Self {
        let mut nuisance = Nuisance {
            cross: [0.0; P],
            square: 0.0,
        };
        for sample in samples {
            let slope = sample.weight * slope(sample, view);
            let row = gradient(sample);
            nuisance.square += slope * slope;
            for k in 0..P {
                nuisance.cross[k] += slope * sample.weight * row[k];
            }
        }
        nuisance
    }
}

/// Derivative of ln f by the offset at a sample that stands where it is, per radian.
fn slope(sample: &Sample<f64>, view: &View) -> f64 {
    const STEP: f64 = 1e-5;
    let at = |offset: f64| View { offset, ..*view }.ln_f(sample);
    match (at(STEP), at(-STEP)) {
        (Some(right), Some(left)) => (right - left) / (2.0 * STEP),
        _ => 0.0,
    }
}

/// Standard error of the offset beside the parameters inside their bounds, radians, for residuals of standard deviation `scale`.
pub fn stderr(
    samples: &[Sample<f64>],
    view: &View,
    options: &FitOptions,
    inside: &[usize],
    scale: f64,
    sigma: f64,
) -> f64 {
    let rows: Vec<(f64, Option<Values>)> = samples
        .iter()
        .map(|sample| {
            let gradient = view.gradient(sample).map(|(_, gradient)| gradient);
            (sample.weight, gradient)
        })
        .collect();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    // What is left of a column beside the others (modified Gram and Schmidt).
    let rest = |basis: &[Vec<f64>], mut column: Vec<f64>| {
        for axis in basis {
            let part: f64 = column.iter().zip(axis).map(|(a, b)| a * b).sum();
            column.iter_mut().zip(axis).for_each(|(a, b)| *a -= part * b);
        }
        let length = column.iter().map(|a| a * a).sum::<f64>().sqrt();
        (column, length)
    };
    for &place in inside {
        let slope =
            |(weight, gradient): &(f64, Option<Values>)| gradient.map_or(0.0, |gradient| weight * gradient[place]);
        let mut column: Vec<f64> = rows.iter().map(slope).collect();
        let priors = options.instrument.priors.iter().enumerate();
        column.extend(priors.map(|(other, prior)| match prior {
            Some(prior) if other == place => sigma / prior.sigma,
            _ => 0.0,
        }));
        let before = column.iter().map(|a| a * a).sum::<f64>().sqrt();
        let (column, length) = rest(&basis, column);
        if length > 1e-10 * before {
            basis.push(column.into_iter().map(|a| a / length).collect());
        }
    }
    let mut column: Vec<f64> = samples
        .iter()
        .map(|sample| sample.weight * slope(sample, view))
        .collect();
    column.extend(options.instrument.priors.iter().map(|_| 0.0));
    scale / rest(&basis, column).1
}
