//! What priors add to the budget over runs: they are the same in all, so that the spread of the runs does not show how far off they may be.

use super::super::derived::{self, Derived};
use crate::analysis::fit::FittedScan;
use crate::engine::{self, Material, robust};
use crate::input::Measurement;

/// Means are displaced by this part of their standard uncertainty: so little that everything is linear, as standard errors are.
const STEP: f64 = 0.1;

/// The fits of one run with each prior's mean a little above and below what it is.
pub struct Displaced<'a> {
    fit: &'a FittedScan,
    ends: Vec<Option<[Material; 2]>>,
}

impl<'a> Displaced<'a> {
    /// From the values of the fit, and as it weighed samples and priors; a prior without a fit on both sides has no ends.
    pub fn of(measurement: &Measurement, fit: &'a FittedScan) -> Self {
        let samples = robust::kept(&measurement.samples, &fit.outcome);
        let options = fit.options.settled(&fit.outcome);
        let end = |place: usize, side: f64| {
            let mut options = options;
            let prior = options.instrument.priors[place].as_mut()?;
            prior.mean += side * STEP * prior.sigma;
            let (_, values) = engine::descend(&samples, &options, &[fit.outcome.params]).ok()??;
            Some(Material {
                values,
                ..fit.outcome.material()
            })
        };
        let both = |place| Some([end(place, 1.0)?, end(place, -1.0)?]);
        Displaced {
            fit,
            ends: options.with_prior().map(both).collect(),
        }
    }

    /// How far each prior's uncertainty moves a parameter.
    pub fn parameter(&self, place: usize) -> Vec<f64> {
        self.moved(|end| Some(end.values[place]))
    }

    /// How far it moves what is derived at an angle of incidence, radians.
    pub fn derived(&self, theta_i: f64, of: impl Fn(&Derived) -> Option<f64>) -> Vec<f64> {
        self.moved(|end| of(&derived::at(theta_i, end, &self.fit.outcome.uncertainty)))
    }

    fn moved(&self, of: impl Fn(&Material) -> Option<f64>) -> Vec<f64> {
        let one = |ends: &Option<[Material; 2]>| {
            let [above, below] = ends.as_ref()?;
            Some((of(above)? - of(below)?) / (2.0 * STEP))
        };
        self.ends.iter().map(|ends| one(ends).unwrap_or(0.0)).collect()
    }
}

/// The standard uncertainty of the mean of the runs by all priors, each of which moves all runs at once.
pub fn of_mean(runs: &[Vec<f64>]) -> f64 {
    let Some(first) = runs.first() else { return 0.0 };
    let mean = |prior: usize| runs.iter().map(|moved| moved[prior]).sum::<f64>() / runs.len() as f64;
    root_of_squares((0..first.len()).map(mean))
}

/// The standard error of a run without what is the priors'; at least a fifth of it, as the rest of nearly equal squares is not known better.
pub fn without(stderr: f64, moved: &[f64]) -> f64 {
    const LEAST: f64 = 0.2;
    let part = root_of_squares(moved.iter().copied());
    if part == 0.0 {
        return stderr;
    }
    let rest = (stderr - part) * (stderr + part);
    rest.max(0.0).sqrt().max(LEAST * stderr)
}

fn root_of_squares(parts: impl Iterator<Item = f64>) -> f64 {
    parts.map(|part| part * part).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_one_prior_add_up_over_runs_and_those_of_several_as_squares() {
        let runs = [vec![0.3, 0.5], vec![0.3, 0.3]];
        assert!((of_mean(&runs) - 0.5).abs() < 1e-15);
        assert_eq!(of_mean(&[vec![], vec![]]), 0.0);
        assert!((without(1.3, &[0.5]) - 1.2).abs() < 1e-15);
        assert_eq!((without(1.0, &[]), without(1.0, &[1.1])), (1.0, 0.2));
    }
}
