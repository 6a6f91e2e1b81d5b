//! One scan fitted in f64 and in f32, and what the difference costs.

use brdfit_core::geometry::Sample;
use brdfit_core::model::Parameter;
use brdfit_core::real::Real;
use serde::Serialize;

use super::accuracy::{Errors, errors};
use super::condition::condition;
use crate::engine::{self, FitError, FitOptions, Material, Outcome, Precision};
use crate::names;
use crate::terms::term_names;

/// Largest relative excess of MSE^2 that is good enough.
pub const EXCESS: f64 = 1e-3;
/// Largest change of the curve, as a part of the rms residual, that is good enough.
pub const CURVE_PART: f64 = 0.1;
/// A change of the curve by less than this in ln f, 0.01 % of the BRDF, is below what a scatterometer resolves: good enough for any scan.
pub const RESOLUTION: f64 = 1e-4;
/// A parameter that changes by more than this part counts as different.
pub const DIFFERENT: f64 = 1e-2;

/// What f32 does to one scan.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Assessment {
    /// The case, or the scan's file.
    pub name: String,
    /// Number of samples.
    pub samples: usize,
    /// Terms of the fitted model.
    pub terms: Vec<&'static str>,
    /// Condition number of J'J at the optimum, columns scaled to length 1, over the parameters inside their bounds that the scan sees; from 1 to 1e30.
    pub condition: f64,
    /// Number of those parameters.
    pub free: usize,
    /// Errors of the model at the optimum, units in the last place of the natural scale; none of a model other than Eq. 14, whose exact values are not known.
    pub error_ulp: Option<Precisions<Errors>>,
    /// How the fits ended.
    pub fit: Precisions<Ended>,
    /// What f32 loses.
    pub loss: Loss,
    /// Is f32 good enough for this scan?
    pub f32_is_good_enough: bool,
}

/// The same of both number types.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Precisions<T> {
    /// Double precision.
    pub f64: T,
    /// Single precision.
    pub f32: T,
}

/// How a fit ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Ended {
    /// As in the reports of a fit.
    pub stop: &'static str,
    /// Passes over the scan that the whole search made, with or without derivatives.
    pub passes: u64,
    /// Sum of squared residuals of ln f over samples squared (Eq. 17), computed in f64.
    pub mse2: f64,
    /// Root of the mean squared residual of ln f, computed in f64, dimensionless.
    pub rms_ln: f64,
}

/// What f32 loses against f64.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Loss {
    /// MSE^2 of the f32 parameters over that of the f64 ones, less 1; huge where the data have no noise.
    pub excess_mse2: f64,
    /// Root of the mean squared difference of the two fitted curves, in ln f.
    pub curve_rms_ln: f64,
    /// One for each parameter.
    pub parameters: Vec<Change>,
}

/// A parameter in both fits, dimensionless.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Change {
    /// Its name.
    pub name: &'static str,
    /// In the f64 fit.
    pub f64: f64,
    /// In the f32 fit.
    pub f32: f64,
    /// f32 over f64, less 1; the difference itself where f64 has 0.
    pub change: f64,
}

impl Assessment {
    /// The parameters that differ by more than [`DIFFERENT`].
    pub fn different(&self) -> impl Iterator<Item = &Change> {
        self.loss
            .parameters
            .iter()
            .filter(|parameter| parameter.change.abs() > DIFFERENT)
    }
}

/// Fits a scan in both number types with the model and terms of `options` and compares.
///
/// # Errors
/// As [`engine::fit`]; [`FitError::Sample`] also where a sample is not a number of f32.
pub fn assess(name: &str, samples: &[Sample<f64>], options: &FitOptions) -> Result<Assessment, FitError> {
    let double = engine::fit(samples, options)?;
    let precision = Precision::F32;
    let single = engine::fit(samples, &FitOptions { precision, ..*options })?;
    // All of ln f times the weights of the samples, as the fit sees it.
    let curve = |material: &Material| -> Vec<f64> {
        let each = samples.iter();
        each.map(|sample| sample.weight * material.ln_f(sample).unwrap_or(f64::NAN))
            .collect()
    };
    let (double_curve, single_curve) = (curve(&double.material()), curve(&single.material()));
    let measured: Vec<f64> = samples.iter().map(|s| s.weight * Real::portable_ln(s.brdf)).collect();
    let fit = Precisions {
        f64: ended(&double, sum_of_squares(&double_curve, &measured)),
        f32: ended(&single, sum_of_squares(&single_curve, &measured)),
    };
    let loss = Loss {
        excess_mse2: (fit.f32.mse2 - fit.f64.mse2) / fit.f64.mse2.max(f64::MIN_POSITIVE),
        curve_rms_ln: (sum_of_squares(&single_curve, &double_curve) / samples.len() as f64).sqrt(),
        parameters: changes(&double, &single),
    };
    let columns = free_columns(samples, &double);
    let error_ulp = <[f64; 6]>::try_from(&double.params[..]).ok();
    let error_ulp = error_ulp.filter(|_| options.model.is_paper()).map(|params| {
        let (f64, f32) = errors(samples, options.terms, params);
        Precisions { f64, f32 }
    });
    let close = loss.excess_mse2 <= EXCESS && loss.curve_rms_ln <= CURVE_PART * fit.f64.rms_ln;
    let converged = single.stop.converged();
    Ok(Assessment {
        name: name.into(),
        samples: samples.len(),
        terms: term_names(double.terms),
        free: columns.len(),
        condition: condition(columns),
        error_ulp,
        f32_is_good_enough: converged && (close || loss.curve_rms_ln <= RESOLUTION),
        fit,
        loss,
    })
}

fn ended(outcome: &Outcome, cost: f64) -> Ended {
    let count = outcome.samples as f64;
    Ended {
        stop: names::stop(outcome.stop),
        passes: u64::from(outcome.evaluations.cost) + u64::from(outcome.evaluations.linearize),
        mse2: cost / (count * count),
        rms_ln: (cost / count).sqrt(),
    }
}

fn sum_of_squares(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

fn changes(double: &Outcome, single: &Outcome) -> Vec<Change> {
    let both = double.params.iter().zip(single.params.iter());
    let change = |(parameter, (&f64, &f32)): (&Parameter, (&f64, &f64))| Change {
        name: parameter.name,
        f64,
        f32,
        change: if f64 == 0.0 { f32 } else { f32 / f64 - 1.0 },
    };
    double.model.parameters.iter().zip(both).map(change).collect()
}

/// Columns of J of the parameters that are inside their bounds and change the curve at all.
fn free_columns(samples: &[Sample<f64>], outcome: &Outcome) -> Vec<Vec<f64>> {
    let material = outcome.material();
    let rows: Vec<Vec<f64>> = samples
        .iter()
        .filter_map(|sample| {
            let gradient = material.gradient(sample)?.1;
            Some(gradient.iter().map(|slope| sample.weight * slope).collect())
        })
        .collect();
    let name = |k: usize| outcome.model.parameters[k].name;
    let inside = outcome.present().filter(|&k| !outcome.at_bound.contains(&name(k)));
    let columns = inside.map(|k| rows.iter().map(|row| row[k]).collect::<Vec<f64>>());
    // What is below rounding of ln f over the whole range of the parameter is not seen.
    let seen = |column: &Vec<f64>| column.iter().any(|x| x.abs() > 1e-18);
    columns.filter(seen).collect()
}
