//! The best fit with one parameter held at a value.

use brdfit_core::geometry::Sample;

use crate::engine::{self, FitError, FitOptions, Method, Outcome, Precision, Values};

/// The best fit with the parameter held at a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Where it is held, dimensionless.
    pub value: f64,
    /// Sum of squared residuals of ln f.
    pub cost: f64,
    /// All parameters.
    pub params: Values,
}

/// The best fit with parameter `index` of the model held at `value`: one point of its profile.
///
/// # Errors
/// [`FitError`].
pub fn hold(
    samples: &[Sample<f64>],
    options: &FitOptions,
    outcome: &Outcome,
    index: usize,
    value: f64,
) -> Result<Point, FitError> {
    Held::new(samples, options, outcome, index).at(value, &[outcome.params], true)
}

/// A scan with one parameter held.
pub(in crate::analysis) struct Held<'a> {
    pub samples: &'a [Sample<f64>],
    pub options: &'a FitOptions,
    pub index: usize,
    minima: Vec<Values>,
}

impl<'a> Held<'a> {
    pub fn new(samples: &'a [Sample<f64>], options: &'a FitOptions, outcome: &Outcome, index: usize) -> Self {
        Held {
            samples,
            options,
            index,
            minima: outcome.minima.iter().map(|minimum| minimum.params).collect(),
        }
    }

    /// The best of the fits from these parameters and from the minima, all with the held one at `value`; of infinite cost if there is none.
    pub fn at(&self, value: f64, starts: &[Values], searched: bool) -> Result<Point, FitError> {
        let with = |params: &Values| {
            let mut all = *params;
            all[self.index] = value;
            all
        };
        let options = FitOptions {
            lower: with(&self.options.lower),
            upper: with(&self.options.upper),
            precision: Precision::F64,
            method: Method::Default,
            starts: None,
            ..*self.options
        };
        let mut starts: Vec<Values> = starts.iter().chain(&self.minima).map(with).collect();
        if searched && let Some(found) = allowed(engine::fit(self.samples, &options))? {
            starts.push(found.params);
        }
        let found = allowed(engine::descend(self.samples, &options, &starts))?.flatten();
        let (cost, params) = found.unwrap_or((f64::INFINITY, starts[0]));
        Ok(Point { value, cost, params })
    }
}

/// Nothing where no parameters conserve energy with the one that is held: then its value is refuted, and the profile goes on.
fn allowed<T>(found: Result<T, FitError>) -> Result<Option<T>, FitError> {
    match found {
        Err(FitError::Limit) => Ok(None),
        found => found.map(Some),
    }
}
