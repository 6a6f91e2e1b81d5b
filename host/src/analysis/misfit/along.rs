//! What a process makes of displacements beside those of the parameters inside their bounds: of one on a bound, and of all without bounds.
//!
//! A misfit that wanders over tens of degrees looks like a change of rho_d, and not like one of the width of a narrow lobe: so each displacement has a factor of its own.

use brdfit_core::real::Real;
use brdfit_core::uncertainty::Place;

use super::nodes::Node;
use super::rows::Rows;
use super::sandwich::{Common, cholesky};
use crate::engine::Values;
use crate::engine::uncertainty::Uncertainty;

/// Rows of J along an axis of one standard error have a length of 1; what is far from that is no such axis.
const UNIT: std::ops::Range<f64> = 0.5..2.0;

/// A fit and the processes that its residuals may be of.
pub struct Along<'a> {
    pub rows: &'a Rows<'a>,
    /// The errors of independent residuals.
    pub known: &'a Uncertainty,
    pub nodes: &'a [Node],
    /// What the tails make of a variance.
    pub tails: f64,
}

impl Along<'_> {
    /// The axis of a parameter on a bound: how far it may lie inside, by what correlation does to that displacement, and no less than independent residuals say.
    pub fn bound(&self, axis: &Values) -> Option<Values> {
        let (covariance, _) = self.covariance(&[axis])?;
        let factor = Real::sqrt(covariance[0][0]).max(1.0);
        Some(axis.iter().map(|part| part * factor).collect())
    }

    /// The axes and the standard errors as if no bound held; `None` if an axis cannot be told.
    pub fn lifted(&self) -> Option<(Vec<Values>, Values)> {
        let known = self.known;
        let free = |place: &usize| matches!(known.places[*place], Some(Place::Inside | Place::Lower | Place::Upper));
        let places: Vec<usize> = (0..known.places.len()).filter(free).collect();
        let old: Vec<&Values> = places.iter().map(|&place| &known.axes_lifted[place]).collect();
        let (covariance, lengths) = self.covariance(&old)?;
        if !lengths.iter().all(|length| UNIT.contains(length)) {
            return None;
        }
        let root = cholesky(&covariance);
        let mut axes = known.axes_lifted.clone();
        for (i, &place) in places.iter().enumerate() {
            axes[place] = Values::from_fn(known.places.len(), |k| {
                (i..old.len()).map(|j| root[j][i] * old[j][k]).sum()
            });
        }
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

    /// The mean covariance of the least-squares fit along some axes, in units of each, and the squared lengths of their rows of J; `None` if the samples do not see one.
    fn covariance(&self, axes: &[&Values]) -> Option<(Vec<Vec<f64>>, Vec<f64>)> {
        let all = self.rows.residuals(axes, self.known.scale)?;
        let length = |k: usize| -> f64 { all.rows.iter().skip(k).step_by(axes.len()).map(|x| x * x).sum() };
        let lengths: Vec<f64> = (0..axes.len()).map(length).collect();
        if !lengths.iter().all(|length| length.is_finite() && *length > 0.0) {
            return None;
        }
        let processes: Vec<_> = self.nodes.iter().map(|node| (node.process, node.variance)).collect();
        let mut mean = vec![vec![0.0; axes.len()]; axes.len()];
        let mut nodes = self.nodes.iter();
        Common::new(&all).each(&all, &processes, |one| {
            let weight = nodes.next().map_or(0.0, |node| node.weight);
            for (mean, one) in mean.iter_mut().flatten().zip(one.iter().flatten()) {
                *mean += weight * one;
            }
        })?;
        for i in 0..axes.len() {
            for j in 0..axes.len() {
                mean[i][j] *= self.tails / Real::sqrt(lengths[i] * lengths[j]);
            }
        }
        Some((mean, lengths))
    }
}
