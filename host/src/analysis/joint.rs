//! Several scans fitted together, with the model and terms that they support.

mod correlated;
mod errors;
pub mod weights;

use brdfit_core::geometry::Sample;

use super::criteria::Criteria;
use super::deviations::Stated;
use super::misfit::Inflation;
use super::weighed;
use crate::engine::joint::{self, JointFit};
use crate::engine::threads;
use crate::engine::{FitError, FitOptions, Precision};
use correlated::Linear;
pub use errors::Known;

/// One candidate, fitted to all scans.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Candidate {
    /// How it was fitted.
    pub options: FitOptions,
    /// Its fit.
    pub fitted: JointFit,
    /// What it is judged by.
    pub criteria: Criteria,
    /// What is known of its parameters.
    pub known: Known,
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

/// Fits every candidate, of which there is one at least; each comes with which of its parameters are the same in all scans; `stated` is what the files state of standard deviations, if all do ([`weights::weighed`]).
///
/// # Errors
/// The place of the scan that cannot be fitted, and why.
pub fn fit(
    scans: &[&[Sample<f64>]],
    candidates: &[(FitOptions, Vec<bool>)],
    stated: Option<Stated>,
) -> Result<Fits, (usize, FitError)> {
    let one = |(options, shared): &(FitOptions, Vec<bool>)| {
        let mut fitted = joint::fit(scans, shared, options)?;
        let mut linear = Linear::of(scans, options, &fitted);
        // Priors count as in a fit of one scan.
        for _ in 0..weighed::ROUNDS {
            let raised = linear.as_ref().and_then(Linear::weight);
            let Some((raised, sigma)) = raised.zip(fitted.sigma) else {
                break;
            };
            if options.instrument.sigma.is_some() || !(raised > sigma * (1.0 + weighed::SETTLED)) {
                break;
            }
            let mut settled = *options;
            settled.instrument.sigma = Some(raised);
            fitted = joint::fit(scans, shared, &settled)?;
            linear = Linear::of(scans, options, &fitted);
        }
        Ok((*options, fitted, linear))
    };
    let fitted = threads::try_map(candidates, &one)?;
    let inflation = inflation_of_best(&fitted);
    let judged = fitted.into_iter().map(|(options, fitted, linear)| {
        // A joint fit is in double whatever the options say.
        let criteria = Criteria::new(
            fitted.samples,
            inflation,
            fitted.parameters,
            fitted.cost,
            Precision::F64,
        );
        Candidate {
            known: Known::of(&options, &fitted, linear.as_ref(), stated),
            options,
            fitted,
            criteria,
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
