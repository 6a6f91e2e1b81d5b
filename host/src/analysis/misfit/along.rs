//! What a process makes of displacements beside those of the parameters inside their bounds: of one on a bound, and of all without bounds.
//!
//! A misfit that wanders over tens of degrees looks like a change of rho_d, and not like one of the width of a narrow lobe: so each displacement has a factor of its own.

use brdfit_core::real::Real;
use brdfit_core::uncertainty::Place;

use super::nodes::Node;
use super::priors::Priors;
use super::rows::{Rows, UNIT};
use super::sandwich::{Common, turn};
use crate::engine::Values;
use crate::engine::uncertainty::Uncertainty;

/// A fit and the processes that its residuals may be of.
pub struct Along<'a> {
    pub rows: &'a Rows<'a>,
    /// The errors of independent residuals.
    pub known: &'a Uncertainty,
    pub nodes: &'a [Node],
    /// What the tails make of a variance.
    pub tails: f64,
    /// What is known beside the samples.
    pub priors: &'a Priors,
}

impl Along<'_> {
    /// The axis of a parameter on a bound: how far it may lie inside, by what correlation does to that displacement, and no less than independent residuals say.
    pub fn bound(&self, axis: &Values) -> Option<Values> {
        let (covariance, _) = self.normalised(&[axis])?;
        let factor = Real::sqrt(covariance[0][0]).max(1.0);
        Some(axis.iter().map(|part| part * factor).collect())
    }

    /// The axes and the standard errors as if no bound held; `None` if an axis cannot be told.
    pub fn lifted(&self) -> Option<(Vec<Values>, Values)> {
        let known = self.known;
        let free = |place: &usize| matches!(known.places[*place], Some(Place::Inside | Place::Lower | Place::Upper));
        let places: Vec<usize> = (0..known.places.len()).filter(free).collect();
        let old: Vec<&Values> = places.iter().map(|&place| &known.axes_lifted[place]).collect();
        let (covariance, lengths) = self.normalised(&old)?;
        if !lengths.iter().all(|length| UNIT.contains(length)) {
            return None;
        }
        let mut axes = known.axes_lifted.clone();
        turn(&mut axes, &places, &covariance);
        let size = |axes: &[Values], k: usize| -> f64 {
            let squares = places.iter().map(|&place| axes[place][k] * axes[place][k]);
            Real::sqrt(squares.sum())
        };
        let stderr = Values::from_fn(known.places.len(), |k| {
            let factor = size(&axes, k) / size(&known.axes_lifted, k);
            known.stderr_lifted[k] * if factor.is_finite() { factor } else { 1.0 }
        });
        Some((axes, stderr))
    }

    /// The parameters inside their bounds whose axes samples and priors together tell from rounding, and the covariance along these that the noise of the samples alone makes.
    pub fn inside(&self) -> Option<(Vec<usize>, Vec<Vec<f64>>)> {
        let all: Vec<usize> = self.known.inside().collect();
        let axes = |places: &[usize]| places.iter().map(|&place| &self.known.axes[place]).collect::<Vec<_>>();
        let (_, lengths) = self.covariance(&axes(&all))?;
        let rows = self.priors.rows(&axes(&all));
        let length = |k: usize| lengths[k] + rows.iter().map(|row| row[k] * row[k]).sum::<f64>();
        let told = (0..all.len()).filter(|&k| UNIT.contains(&length(k)));
        let places: Vec<usize> = told.map(|k| all[k]).collect();
        let (covariance, _) = self.covariance(&axes(&places))?;
        Some((places, covariance))
    }

    /// The mean covariance of the fit along some axes, that of priors too, in units of each, and the squared lengths of their rows of J; `None` if nothing tells of one.
    fn normalised(&self, axes: &[&Values]) -> Option<(Vec<Vec<f64>>, Vec<f64>)> {
        let (mut covariance, mut lengths) = self.covariance(axes)?;
        for (row, size) in self.priors.rows(axes).iter().zip(self.priors.sizes()) {
            for i in 0..axes.len() {
                lengths[i] += row[i] * row[i];
                for j in 0..axes.len() {
                    covariance[i][j] += size * row[i] * size * row[j];
                }
            }
        }
        if !lengths.iter().all(|length| length.is_finite() && *length > 0.0) {
            return None;
        }
        for i in 0..axes.len() {
            for j in 0..axes.len() {
                covariance[i][j] /= Real::sqrt(lengths[i] * lengths[j]);
            }
        }
        Some((covariance, lengths))
    }

    /// The mean covariance that the noise of the samples makes along some axes, and the squared lengths of their rows of J.
    fn covariance(&self, axes: &[&Values]) -> Option<(Vec<Vec<f64>>, Vec<f64>)> {
        let all = self.rows.residuals(axes, self.known.scale)?;
        let length = |k: usize| -> f64 { all.rows.iter().skip(k).step_by(axes.len()).map(|x| x * x).sum() };
        let lengths: Vec<f64> = (0..axes.len()).map(length).collect();
        let processes: Vec<_> = self.nodes.iter().map(|node| (node.process, node.variance)).collect();
        let mut mean = vec![vec![0.0; axes.len()]; axes.len()];
        let mut nodes = self.nodes.iter();
        Common::new(&all).each(&all, &processes, |one| {
            let weight = nodes.next().map_or(0.0, |node| node.weight);
            for (mean, one) in mean.iter_mut().flatten().zip(one) {
                *mean += weight * one;
            }
        })?;
        mean.iter_mut().flatten().for_each(|entry| *entry *= self.tails);
        Some((mean, lengths))
    }
}
