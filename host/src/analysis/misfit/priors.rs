//! What is known of parameters beside the samples, in the errors of their fit.
//!
//! A prior is a residual of its own, which has nothing in common with those of the samples: however these are correlated, and whatever becomes of their size, it adds its own part to the covariance.
//! With H = J'J + S^2 e e'/sigma^2, where S is the standard deviation by which priors were weighed, the fit moves by H^-1 S^2 e / sigma for one standard uncertainty of a prior; that is an axis of its own, behind those of the parameters.

use super::sandwich::turn;
use crate::engine::uncertainty::Uncertainty;
use crate::engine::{FitOptions, Outcome, Values};

/// One prior.
struct Prior {
    place: usize,
    /// Derivative of its residual by the parameter, in units of the scale of the fit.
    slope: f64,
    /// Standard deviation of its residual, in the same.
    size: f64,
}

/// Those that took part in a fit.
pub struct Priors(Vec<Prior>);

impl Priors {
    /// Of this fit.
    pub fn of(options: &FitOptions, outcome: &Outcome) -> Self {
        let Some(sigma) = outcome.sigma else {
            return Priors(Vec::new());
        };
        let size = sigma / outcome.uncertainty.scale;
        let one = |place: usize| {
            let prior = options.instrument.priors[place]?;
            Some(Prior {
                place,
                slope: size / prior.sigma,
                size,
            })
        };
        Priors(options.with_prior().filter_map(one).collect())
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// For each prior the derivatives of its residual along some axes.
    pub fn rows(&self, axes: &[&Values]) -> Vec<Vec<f64>> {
        let row = |prior: &Prior| axes.iter().map(|axis| prior.slope * axis[prior.place]).collect();
        self.0.iter().map(row).collect()
    }

    /// Their standard deviations, in units of the scale of the fit.
    pub fn sizes(&self) -> impl Iterator<Item = f64> {
        self.0.iter().map(|prior| prior.size)
    }

    /// The same uncertainty with what the samples and what the priors leave open on axes of their own.
    pub fn apart(&self, known: &Uncertainty) -> Uncertainty {
        let places: Vec<usize> = known.inside().collect();
        let rows = self.rows(&places.iter().map(|&place| &known.axes[place]).collect::<Vec<_>>());
        let of_priors = |i: usize, j: usize| rows.iter().map(|row| row[i] * row[j]).sum::<f64>();
        // More than all of an axis is from no prior: its parameter cannot be told, or is kappa at 0.
        let whole = (0..places.len()).all(|k| of_priors(k, k) < 1.0 + 1e-6);
        if self.is_empty() || !whole {
            return known.clone();
        }
        let of_samples = |i: usize, j: usize| f64::from(u8::from(i == j)) - of_priors(i, j);
        let matrix: Vec<Vec<f64>> = (0..places.len())
            .map(|i| (0..places.len()).map(|j| of_samples(i, j)).collect())
            .collect();
        let mut axes = known.axes.clone();
        turn(&mut axes, &places, &matrix);
        self.add(known, &places, &mut axes);
        known.clone().with_axes(axes)
    }

    /// Adds the axis of each prior to `axes`, made of those that a fit has in these places.
    pub fn add(&self, known: &Uncertainty, places: &[usize], axes: &mut Vec<Values>) {
        let old: Vec<&Values> = places.iter().map(|&place| &known.axes[place]).collect();
        for (row, size) in self.rows(&old).iter().zip(self.sizes()) {
            axes.push(Values::from_fn(known.places.len(), |k| {
                row.iter().zip(&old).map(|(part, axis)| size * part * axis[k]).sum()
            }));
        }
    }
}
