//! A fit that outliers do not draw: they are found by repeated searches with Cauchy's weights, and left out of the last ones.

use brdfit_core::geometry::Sample;

use crate::{FitError, FitOptions, Outcome};

/// Residuals beyond this many scales are outliers.
const OUTLIER: f64 = 6.0;
/// Cauchy's constant: 95 % efficient where the noise is Gaussian.
const CAUCHY: f64 = 2.385;
/// The median of the size of a Gaussian residual is its standard deviation over this.
const GAUSSIAN: f64 = 1.4826;
/// Searches with Cauchy's weights; after them the outliers stand out.
const SOFT_ROUNDS: u32 = 6;
/// Searches at most; the set of outliers settles after one or two.
const ROUNDS: u32 = 20;

/// The samples that a fit used.
pub fn kept(samples: &[Sample<f64>], outcome: &Outcome) -> Vec<Sample<f64>> {
    let outliers = outcome.robust.as_ref().map_or(&[][..], |robust| &robust.outliers);
    let kept = samples
        .iter()
        .enumerate()
        .filter(|(place, _)| !outliers.contains(place));
    kept.map(|(_, sample)| *sample).collect()
}

/// What a robust fit left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Robust {
    /// Standard deviation of the residuals of ln f, from the median of their sizes; dimensionless.
    pub scale: f64,
    /// The indices of the outliers, in order: their residuals are beyond 6 scales.
    pub outliers: Vec<usize>,
}

/// Fits with `fit` until the outliers stay the same; the result is the least-squares fit of the others.
///
/// # Errors
/// Those of `fit`.
pub fn fit(
    samples: &[Sample<f64>],
    options: &FitOptions,
    fit: impl Fn(&[Sample<f64>], &FitOptions) -> Result<Outcome, FitError>,
) -> Result<Outcome, FitError> {
    let mut outcome = fit(samples, options)?;
    let mut evaluations = outcome.evaluations;
    // What the last fit left out, if it was one of least squares.
    let mut left_out: Option<Vec<usize>> = None;
    for round in 0..ROUNDS {
        let material = outcome.material();
        let residuals: Vec<f64> = samples
            .iter()
            // A sample that was fitted is above the horizon.
            .map(|sample| material.residual(sample).unwrap_or(0.0))
            .collect();
        let scale = scale(&residuals);
        let is_outlier = |residual: f64| residual.abs() > OUTLIER * scale;
        let outliers: Vec<usize> = (0..samples.len()).filter(|&k| is_outlier(residuals[k])).collect();
        if left_out.as_ref() == Some(&outliers) {
            break;
        }
        let soft = round < SOFT_ROUNDS;
        let pairs = samples.iter().zip(&residuals);
        let next: Vec<Sample<f64>> = if soft {
            pairs
                .map(|(sample, residual)| cauchy(sample, residual / scale))
                .collect()
        } else {
            let others = pairs.filter(|(_, residual)| !is_outlier(**residual));
            others.map(|(sample, _)| *sample).collect()
        };
        outcome = fit(&next, options)?;
        evaluations.cost += outcome.evaluations.cost;
        evaluations.linearize += outcome.evaluations.linearize;
        left_out = (!soft).then(|| outliers.clone());
        outcome.robust = Some(Robust { scale, outliers });
    }
    outcome.evaluations = evaluations;
    Ok(outcome)
}

/// The median of the sizes as a standard deviation; above 0.
fn scale(residuals: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = residuals.iter().map(|residual| residual.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    // Without noise the residuals are rounding, and none of them is an outlier.
    (GAUSSIAN * sizes[sizes.len() / 2]).max(1e-12)
}

/// The sample with Cauchy's weight of a residual of `scales`.
fn cauchy(sample: &Sample<f64>, scales: f64) -> Sample<f64> {
    let part = scales / CAUCHY;
    Sample {
        weight: sample.weight / (1.0 + part * part).sqrt(),
        ..*sample
    }
}
