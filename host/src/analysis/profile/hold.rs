//! The best fit with one parameter held at a value.

use brdfit_core::brdf::Params;
use brdfit_core::geometry::{Block, Sample};

use crate::engine::{self, FitError, FitOptions, Method, Outcome, Precision};

/// The best fit with the parameter held at a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Where it is held, dimensionless.
    pub value: f64,
    /// Sum of squared residuals of ln f.
    pub cost: f64,
    /// All parameters.
    pub params: Params<f64>,
}

/// The best fit with parameter `index` of [`brdfit_core::brdf::NAMES`] held at `value`: one point of its profile.
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
    Held::new(samples, options, outcome, index)?.at(value, &[outcome.params], true)
}

/// A scan with one parameter held.
pub(super) struct Held<'a> {
    samples: &'a [Sample<f64>],
    pub blocks: Vec<Block<f64>>,
    options: &'a FitOptions,
    index: usize,
    minima: Vec<Params<f64>>,
}

impl<'a> Held<'a> {
    pub fn new(
        samples: &'a [Sample<f64>],
        options: &'a FitOptions,
        outcome: &Outcome,
        index: usize,
    ) -> Result<Self, FitError> {
        Ok(Held {
            samples,
            blocks: engine::blocks(samples)?,
            options,
            index,
            minima: outcome.minima.iter().map(|minimum| minimum.params).collect(),
        })
    }

    /// The best of the fits from these parameters and from the minima, all with the held one at `value`.
    pub fn at(&self, value: f64, starts: &[Params<f64>], searched: bool) -> Result<Point, FitError> {
        let with = |params: &Params<f64>| {
            let mut all = params.to_array();
            all[self.index] = value;
            Params::from_array(all)
        };
        let options = FitOptions {
            lower: with(&self.options.lower),
            upper: with(&self.options.upper),
            precision: Precision::F64,
            method: Method::Default,
            starts: None,
            ..*self.options
        };
        let mut starts: Vec<Params<f64>> = starts.iter().chain(&self.minima).map(with).collect();
        if searched {
            starts.push(engine::fit(self.samples, &options)?.params);
        }
        let found = engine::descend(&self.blocks, &options, &starts)?;
        let (cost, params) = found.unwrap_or((f64::INFINITY, starts[0]));
        Ok(Point { value, cost, params })
    }
}
