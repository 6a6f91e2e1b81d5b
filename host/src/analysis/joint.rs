//! Several scans fitted together, with the model and terms that they support.

use brdfit_core::geometry::Sample;
use rayon::prelude::*;

use super::criteria::Criteria;
use crate::engine::joint::{self, JointFit};
use crate::engine::{FitError, FitOptions, Precision};

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
}

/// Fits every candidate; each comes with which of its parameters are the same in all scans.
///
/// # Errors
/// The place of the scan that cannot be fitted, and why.
pub fn fit(
    scans: &[&[Sample<f64>]],
    candidates: &[(FitOptions, Vec<bool>)],
) -> Result<Vec<Candidate>, (usize, FitError)> {
    let one = |(options, shared): &(FitOptions, Vec<bool>)| {
        let fitted = joint::fit(scans, shared, options)?;
        Ok(Candidate {
            options: *options,
            // A joint fit is in double whatever the options say.
            criteria: Criteria::new(fitted.samples, fitted.parameters, fitted.cost, Precision::F64),
            fitted,
        })
    };
    candidates.par_iter().map(one).collect()
}

/// That of least BIC.
pub fn best(candidates: &[Candidate]) -> Option<&Candidate> {
    let bic = |one: &&Candidate| one.criteria.bic;
    candidates.iter().min_by(|a, b| bic(a).total_cmp(&bic(b)))
}
