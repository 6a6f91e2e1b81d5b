//! The standard deviations that a file gives: weights from the fitted f, and errors from them where chi^2 does not refute them.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::chance::below_chi2;
use super::choose::{self, Wanted};
use crate::engine::Values;
use crate::engine::uncertainty::Uncertainty;
use crate::input::Measurement;
use crate::input::weight::{self, Deviation};

/// Fits until the weights are those of the fitted f.
const ROUNDS: usize = 5;
/// Weights that change by less are.
const SETTLED: f64 = 1e-3;
/// Probability of a chi^2 as far from its mean by chance, below which it refutes the standard deviations.
const REFUTED: f64 = 0.01;
/// Degrees of freedom of an error that is known.
const KNOWN: f64 = f64::INFINITY;

/// What became of the standard deviations of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// Errors are theirs.
    Used,
    /// Residuals are so many times what they should be: errors are those of the residuals.
    Refuted(f64),
}

/// The scan with weights from its standard deviations over the f of its fit, and with values raised by what their noise takes from ln f on average.
///
/// A deviation over the measured f is too small where noise made f large: such samples count too much, and f comes out high by 1.5 sigma^2 (sigma being relative).
/// And ln f of a value with symmetric noise is low by sigma^2 / 2 on average, to second order ([`Deviation::of_ln`]).
/// A scan without standard deviations, or that cannot be fitted, stays as it is.
pub fn settled(measurement: Measurement, wanted: &Wanted) -> Measurement {
    if measurement.sigma_ln.is_none() || measurement.deviations.is_empty() {
        return measurement;
    }
    let mut now = measurement.clone();
    // Relative deviations are the same over any f.
    let (samples, mut unit) = weighted(&measurement, |sample| sample.brdf);
    now.samples = samples;
    if measurement.deviations.iter().any(|deviation| deviation.absolute != 0.0) {
        for _ in 0..ROUNDS {
            let Ok((_, outcome, _)) = choose::fit(&now.samples, wanted) else {
                return measurement;
            };
            if !outcome.cost.is_finite() {
                return measurement;
            }
            let before: Vec<f64> = now.samples.iter().map(|sample| sample.weight / unit).collect();
            let view = outcome.view();
            let f = |sample: &Sample<f64>| view.ln_f(sample).map_or(sample.brdf, Real::portable_exp);
            (now.samples, unit) = weighted(&measurement, f);
            let change = now.samples.iter().zip(before);
            let change = change.map(|(sample, before)| (sample.weight / unit / before - 1.0).abs());
            if change.fold(0.0, f64::max) < SETTLED {
                break;
            }
        }
    }
    now.sigma_ln = Some(unit);
    now.about.notes.push(
        "weights are of the standard deviations over the fitted BRDF, and ln BRDF is raised by what noise of their size takes from it on average"
            .into(),
    );
    now
}

/// The samples as measured, weighted and raised by what their deviations are over `f`, and what a weight of 1 stands for.
fn weighted(measurement: &Measurement, f: impl Fn(&Sample<f64>) -> f64) -> (Vec<Sample<f64>>, f64) {
    let unit = measurement.sigma_ln.unwrap_or(1.0);
    let pairs = measurement.samples.iter().zip(&measurement.deviations);
    let one = |(sample, deviation): (&Sample<f64>, &Deviation)| {
        let (sigma, low) = deviation.of_ln(f(sample));
        Sample {
            brdf: sample.brdf * Real::portable_exp(low),
            weight: sample.weight / unit * deviation.over(sample.brdf) / sigma,
            ..*sample
        }
    };
    let mut samples: Vec<Sample<f64>> = pairs.map(one).collect();
    let unit = weight::normalised(&mut samples);
    (samples, unit)
}

/// The errors that the standard deviations give, or why not; a weight of 1 stands for `sigma`.
///
/// Correlated residuals are no noise, and say themselves how large errors are.
pub fn judged(known: &Uncertainty, sigma: f64) -> (Uncertainty, Option<Verdict>) {
    let degrees = known.degrees_of_freedom as f64;
    if known.misfit.is_some() || known.degrees_of_freedom == 0 {
        return (known.clone(), None);
    }
    let ratio = known.scale / sigma;
    let below = below_chi2(ratio * ratio * degrees, degrees);
    if 2.0 * below.min(1.0 - below) < REFUTED {
        return (known.clone(), Some(Verdict::Refuted(ratio)));
    }
    let scaled = |axis: &Values| axis.iter().map(|part| part / ratio).collect::<Values>();
    // What stands behind the axes of the parameters is the calibration, which is no noise.
    let all = |axes: &[Values]| -> Vec<Values> {
        let (noise, calibration) = axes.split_at(known.places.len());
        noise.iter().map(scaled).chain(calibration.iter().copied()).collect()
    };
    let mut of_file = known.clone().with_axes(all(&known.axes));
    of_file.axes_lifted = all(&known.axes_lifted);
    of_file.stderr_lifted = scaled(&known.stderr_lifted);
    of_file.effective = KNOWN;
    (of_file, Some(Verdict::Used))
}
