//! What the correlation of residuals makes of a joint fit: the lines of all scans are judged together, as those of one scan are in [`crate::analysis::misfit`].

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use crate::analysis::misfit::nodes;
use crate::analysis::misfit::process::Residuals;
use crate::analysis::misfit::rows::Rows;
use crate::analysis::misfit::{Inflation, Mean};
use crate::engine::joint::JointFit;
use crate::engine::uncertainty::{Misfit, rounding};
use crate::engine::{FitOptions, Precision, Values};

/// A column of J that is so nearly a sum of others is none.
const ALIKE: f64 = 1e-6;

/// A joint fit as its residuals, with the rows of J in coordinates in which J'J is 1.
pub struct Linear {
    all: Residuals,
    /// The scan and place of each parameter of the columns; no scan for one that is shared.
    owners: Vec<(Option<usize>, usize)>,
    /// Each column of J in these coordinates, as far as it has some: a triangle.
    triangle: Vec<Vec<f64>>,
    /// The rows of priors, in the same: each a residual that has nothing in common with another.
    priors: Vec<Vec<f64>>,
    /// Standard deviation of each of these residuals, in units of `scale`.
    size: f64,
    degrees_of_freedom: usize,
    /// The standard deviation of a residual.
    pub scale: f64,
}

impl Linear {
    /// Of a fit of these scans; `None` if it says nothing of its residuals.
    pub fn of(scans: &[&[Sample<f64>]], options: &FitOptions, fitted: &JointFit) -> Option<Linear> {
        let inside = |scan: usize, place: usize| {
            let value = fitted.scans[scan][place];
            options.lower[place] < value && value < options.upper[place]
        };
        let shared = options.free().filter(|&place| fitted.shared[place]);
        let mut owners: Vec<_> = shared
            .filter(|&place| inside(0, place))
            .map(|place| (None, place))
            .collect();
        for scan in 0..scans.len() {
            let own = options
                .free()
                .filter(|&place| !fitted.shared[place] && inside(scan, place));
            owners.extend(own.map(|place| (Some(scan), place)));
        }
        let degrees_of_freedom = fitted.samples.checked_sub(owners.len()).filter(|&left| left >= 4)?;
        let scale = Real::sqrt(fitted.of_samples / degrees_of_freedom as f64);
        if scale < rounding(Precision::F64) || owners.is_empty() {
            return None;
        }
        let mut all = Residuals {
            columns: owners.len(),
            ..Residuals::default()
        };
        for (scan, samples) in scans.iter().enumerate() {
            let of_scan = |owner: Option<usize>| owner.is_none_or(|owner| owner == scan);
            let axis = |&(owner, place): &(Option<usize>, usize)| {
                Values::from_fn(fitted.shared.len(), |k| f64::from(k == place && of_scan(owner)))
            };
            let axes: Vec<Values> = owners.iter().map(axis).collect();
            let axes: Vec<&Values> = axes.iter().collect();
            let view = options.view(fitted.scans[scan]);
            let one = Rows::new(samples, &view).residuals(&axes, scale)?;
            let begin = all.values.len();
            all.angles.extend(one.angles);
            all.offsets.extend(one.offsets);
            all.values.extend(one.values);
            all.rows.extend(one.rows);
            all.ends.extend(one.ends.iter().map(|end| begin + end));
        }
        let samples = all.values.len();
        let size = fitted.sigma.map_or(1.0, |sigma| sigma / scale);
        for (k, &(_, place)) in owners.iter().enumerate() {
            if let Some(prior) = options.instrument.priors[place] {
                let slope = size / prior.sigma;
                all.rows
                    .extend((0..owners.len()).map(|j| if j == k { slope } else { 0.0 }));
            }
        }
        let (kept, triangle) = orthogonal(&mut all);
        if triangle.is_empty() {
            return None;
        }
        let priors = all.rows.split_off(samples * all.columns);
        let seen = owners.into_iter().zip(&kept).filter(|(_, kept)| **kept);
        Some(Linear {
            owners: seen.map(|(owner, _)| owner).collect(),
            triangle,
            priors: priors.chunks_exact(all.columns).map(<[f64]>::to_vec).collect(),
            size,
            degrees_of_freedom,
            scale,
            all,
        })
    }

    /// By how much correlation makes the samples count less; `None` where independence is not surely refuted.
    pub fn inflation(&self) -> Option<Inflation> {
        Inflation::of(&self.all, self.degrees_of_freedom)
    }

    /// The standard deviation by which priors should be weighed, which have nothing in common with samples that are correlated; `None` where these are not surely so.
    pub fn weight(&self) -> Option<f64> {
        Some(self.scale * Real::sqrt(self.inflation()?.factor))
    }

    /// How the residuals are correlated, and by how much that raises the standard error of each parameter of each scan; `None` where independence is not refuted with so much evidence.
    pub fn factors(&self, fitted: &JointFit, evidence: f64) -> Option<(Misfit, Vec<Vec<f64>>)> {
        let nodes = nodes::nodes(&self.all, self.degrees_of_freedom, evidence)?;
        let mean = Mean::of(&nodes, self.degrees_of_freedom);
        let mut covariance = mean.covariance.clone();
        for row in &self.priors {
            for i in 0..row.len() {
                for j in 0..row.len() {
                    covariance[i][j] += self.size * row[i] * self.size * row[j];
                }
            }
        }
        let factors: Vec<f64> = (0..self.owners.len()).map(|k| self.factor(k, &covariance)).collect();
        let all = factors.iter().filter(|factor| factor.is_finite());
        let (least, most) = all.fold((f64::INFINITY, 0.0f64), |(a, b), &x| (a.min(x), b.max(x)));
        let one = |scan: usize, place: usize| {
            let own = self
                .owners
                .iter()
                .position(|&(owner, at)| at == place && owner.is_none_or(|owner| owner == scan));
            // What no sample tells of beside the others has the largest.
            own.map_or(most, |k| factors[k])
        };
        let of_scan = |scan: usize| (0..fitted.shared.len()).map(|place| one(scan, place)).collect();
        let factors = (0..fitted.scans.len()).map(of_scan).collect();
        Some((mean.misfit((least, most)), factors))
    }

    /// Of parameter `k`, the standard error by this covariance over that of independent residuals.
    fn factor(&self, k: usize, covariance: &[Vec<f64>]) -> f64 {
        let count = self.owners.len();
        // The row of the inverse triangle.
        let mut row = vec![0.0; count];
        for j in k..count {
            let known: f64 = (k..j).map(|i| row[i] * self.triangle[j][i]).sum();
            row[j] = (f64::from(j == k) - known) / self.triangle[j][j];
        }
        let products = |i: usize| (k..count).map(move |j| (i, j));
        let sandwich: f64 = (k..count)
            .flat_map(products)
            .map(|(i, j)| row[i] * covariance[i][j] * row[j])
            .sum();
        Real::sqrt(sandwich / row.iter().map(|x| x * x).sum::<f64>())
    }
}

/// Makes the columns of the rows orthogonal and of length 1 (Gram and Schmidt), dropping those that are sums of others; which are kept, and the old ones that are in the new.
fn orthogonal(all: &mut Residuals) -> (Vec<bool>, Vec<Vec<f64>>) {
    let count = all.columns;
    let mut columns: Vec<Vec<f64>> = (0..count)
        .map(|k| all.rows.iter().skip(k).step_by(count).copied().collect())
        .collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut kept = vec![false; count];
    let mut new: Vec<Vec<f64>> = Vec::new();
    let mut triangle: Vec<Vec<f64>> = Vec::new();
    for (column, kept) in columns.iter_mut().zip(&mut kept) {
        // Squares of what is far from 1 are no numbers.
        let largest = column.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        column.iter_mut().for_each(|x| *x /= largest);
        let size = Real::sqrt(dot(column, column));
        let mut parts = vec![0.0; new.len()];
        // Twice is enough (Giraud et al. 2005).
        for _ in 0..2 {
            for (part, unit) in parts.iter_mut().zip(&new) {
                let along = dot(column, unit);
                *part += along;
                column.iter_mut().zip(unit).for_each(|(x, unit)| *x -= along * unit);
            }
        }
        let length = Real::sqrt(dot(column, column));
        *kept = length > ALIKE * size;
        if *kept {
            column.iter_mut().for_each(|x| *x /= length);
            parts.push(length);
            new.push(std::mem::take(column));
            triangle.push(parts);
        }
    }
    all.columns = new.len();
    all.rows = (0..all.rows.len() / count)
        .flat_map(|place| new.iter().map(move |column| column[place]))
        .collect();
    (kept, triangle)
}
