//! What a joint fit knows of its parameters, judged as `fit` judges one scan.

use brdfit_core::real::Real;

use super::correlated::Linear;
use crate::analysis::deviations::{Stated, Verdict};
use crate::analysis::misfit::{EVIDENCE, SURE};
use crate::analysis::profile::calibrate::threshold;
use crate::analysis::undetermined::is_open;
use crate::engine::joint::JointFit;
use crate::engine::uncertainty::{Misfit, rounding};
use crate::engine::{FitOptions, Precision};

/// What is known of the parameters of each scan.
#[derive(Clone, Debug, PartialEq)]
pub struct Known {
    /// Standard errors; none of what is held, on a bound or open, nor where the fit is exact.
    pub errors: Vec<Vec<Option<f64>>>,
    /// Which the scans together do not determine ([`is_open`]), or no better than to all that their bounds allow.
    pub open: Vec<Vec<bool>>,
    /// How the residuals of all scans are correlated along the angle; `None` where independence is not refuted.
    pub misfit: Option<Misfit>,
    /// What became of the standard deviations of the files, where all state some.
    pub verdict: Option<Verdict>,
    /// Sum of squared residuals over the variances that the files state.
    pub chi2: Option<f64>,
    /// Residuals are rounding, and tell of no errors.
    pub exact: bool,
}

impl Known {
    /// Of this fit with its residuals.
    pub fn of(options: &FitOptions, fitted: &JointFit, linear: Option<&Linear>, stated: Option<Stated>) -> Known {
        let rounding = rounding(Precision::F64);
        // What is only likely does not speak against standard deviations that a file gives.
        let evidence = if stated.is_some() { SURE } else { EVIDENCE };
        let correlated = linear.and_then(|linear| linear.factors(fitted, evidence));
        let degrees = fitted.degrees_of_freedom;
        let verdict = stated.and_then(|stated| stated.verdict((fitted.scale, rounding), degrees, correlated.is_some()));
        let of_files = matches!(verdict, Some(Verdict::Used | Verdict::Absolute(_)));
        let ratio = match stated {
            Some(stated) if of_files => fitted.scale / stated.sigma,
            _ => 1.0,
        };
        // Absolute errors are without the correlation of residuals.
        let correlated = correlated.filter(|_| !of_files);
        let count = options.model.parameters.len();
        let mut known = Known {
            errors: vec![vec![None; count]; fitted.scans.len()],
            open: vec![vec![false; count]; fitted.scans.len()],
            misfit: correlated.as_ref().map(|(misfit, _)| *misfit),
            verdict,
            chi2: stated.map(|stated| fitted.of_samples / (stated.sigma * stated.sigma)),
            exact: degrees > 0 && fitted.scale < rounding && !of_files,
        };
        if known.exact || degrees == 0 {
            return known;
        }
        let half = match of_files {
            true => Real::sqrt(threshold(0.95, f64::INFINITY)),
            false => Real::sqrt(threshold(0.95, degrees as f64)),
        };
        for (scan, values) in fitted.scans.iter().enumerate() {
            for place in 0..count {
                let value = values[place];
                let factor = correlated.as_ref().map_or(1.0, |(_, factors)| factors[scan][place]) / ratio;
                let of_scale = match options.model.parameters[place].is_weight() {
                    true => options.instrument.scale_uncertainty * value,
                    false => 0.0,
                };
                let with_scale = |error: f64| match of_scale {
                    0.0 => error * factor,
                    _ => libm::hypot(error * factor, of_scale),
                };
                let Some(lifted) = fitted.lifted[scan][place].map(with_scale) else {
                    continue;
                };
                let error = fitted.errors[scan][place].map(with_scale);
                let range = options.upper[place] - options.lower[place];
                // No number is in no range.
                let wide = error.is_some_and(|error| !(half * error < range));
                known.open[scan][place] = wide || is_open(&options.model.parameters[place], value, lifted);
                known.errors[scan][place] = error.filter(|_| !known.open[scan][place]);
            }
        }
        known
    }
}
