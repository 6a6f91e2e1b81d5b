//! Several scans fitted together, with the model and terms that they support.

mod correlated;

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use rayon::prelude::*;

use super::criteria::Criteria;
use super::misfit::Inflation;
use super::unseen;
use crate::engine::joint::{self, JointFit};
use crate::engine::uncertainty::Misfit;
use crate::engine::{FitError, FitOptions, Precision};
use correlated::Linear;

/// One candidate, fitted to all scans.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Candidate {
    /// How it was fitted.
    pub options: FitOptions,
    /// Its fit; the errors are those of correlated residuals where they are.
    pub fitted: JointFit,
    /// What it is judged by.
    pub criteria: Criteria,
    /// How the residuals of all scans are correlated along the angle; `None` where independence is not refuted.
    pub misfit: Option<Misfit>,
}

/// Fits of several scans by several candidates.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Fits {
    /// Every candidate.
    pub candidates: Vec<Candidate>,
    /// Place of the one of least BIC.
    pub place: usize,
    /// The correlation of residuals by which all are judged, that of the best fit; `None` where it is not seen.
    pub inflation: Option<Inflation>,
}

impl Fits {
    /// That of least BIC.
    pub fn best(&self) -> &Candidate {
        &self.candidates[self.place]
    }
}

/// Fits every candidate, of which there is one at least; each comes with which of its parameters are the same in all scans.
///
/// # Errors
/// The place of the scan that cannot be fitted, and why.
pub fn fit(scans: &[&[Sample<f64>]], candidates: &[(FitOptions, Vec<bool>)]) -> Result<Fits, (usize, FitError)> {
    let one = |(options, shared): &(FitOptions, Vec<bool>)| {
        let fitted = joint::fit(scans, shared, options)?;
        let linear = Linear::of(scans, options, &fitted);
        Ok((*options, fitted, linear))
    };
    let fitted: Result<Vec<_>, _> = candidates.par_iter().map(one).collect();
    let fitted = fitted?;
    let inflation = inflation_of_best(&fitted);
    let judged = fitted.into_iter().map(|(options, mut fitted, linear)| {
        // A joint fit is in double whatever the options say.
        let criteria = Criteria::new(
            fitted.samples,
            inflation,
            fitted.parameters,
            fitted.cost,
            Precision::F64,
        );
        let misfit = with_errors(&options, &mut fitted, linear);
        Candidate {
            options,
            fitted,
            criteria,
            misfit,
        }
    });
    let candidates: Vec<Candidate> = judged.collect();
    let criteria = |place: &usize| candidates[*place].criteria;
    let place = (0..candidates.len()).min_by(|a, b| criteria(a).order(&criteria(b)));
    Ok(Fits {
        place: place.ok_or((scans.len(), FitError::Terms(0)))?,
        candidates,
        inflation,
    })
}

type Fitted = (FitOptions, JointFit, Option<Linear>);

/// By how much correlation makes samples count less: as [`super::misfit::inflation_of_best`] of one scan.
fn inflation_of_best(fitted: &[Fitted]) -> Option<Inflation> {
    let linear = fitted.iter().filter_map(|(_, _, linear)| linear.as_ref());
    linear.min_by(|a, b| a.scale.total_cmp(&b.scale))?.inflation()
}

/// Puts what correlation makes of the errors in their place; none are left where the fit is exact, and of what is undetermined.
fn with_errors(options: &FitOptions, fitted: &mut JointFit, linear: Option<Linear>) -> Option<Misfit> {
    let degrees = fitted.samples as f64 - fitted.parameters as f64;
    if unseen::exact(Real::sqrt(fitted.cost / degrees.max(1.0))) {
        fitted.errors.iter_mut().flatten().for_each(|error| *error = None);
        return None;
    }
    let (misfit, factors) = linear?.factors(fitted)?;
    let parameters = options.model.parameters;
    for (scan, factors) in factors.iter().enumerate() {
        for (place, factor) in factors.iter().enumerate() {
            let Some(error) = fitted.errors[scan][place] else {
                continue;
            };
            let value = fitted.scans[scan][place];
            let of_scale = match parameters[place].is_weight() {
                true => options.instrument.scale_uncertainty * value,
                false => 0.0,
            };
            let own = Real::sqrt((error * error - of_scale * of_scale).max(0.0)) * factor;
            let size = if parameters[place].is_squared() {
                value.max(1.0)
            } else {
                value
            };
            fitted.errors[scan][place] = (own <= size).then(|| libm::hypot(own, of_scale));
        }
    }
    Some(misfit)
}
