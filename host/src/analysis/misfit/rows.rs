//! The residuals of a fit and their derivatives, as processes along lines take them.

use brdfit_core::geometry::Sample;
use rayon::prelude::*;

use super::lines;
use super::process::Residuals;
use crate::engine::{Values, View};
use crate::until::until;

/// Residuals that a thread takes at once; of longer scans nothing is kept of each sample but its place.
const SHARE: usize = 4096;
/// Rows of J along an axis of one standard error have a squared length of 1; what is far from that is no such axis.
pub const UNIT: std::ops::Range<f64> = 0.5..2.0;

/// The samples of a scan along its lines, and what a fit makes of them.
pub struct Rows<'a> {
    samples: &'a [Sample<f64>],
    view: &'a View,
    /// The same where kappa has a derivative.
    slopes: View,
    /// Without values and rows.
    lines: Residuals,
    /// Which sample is in each place of these.
    places: Vec<usize>,
    /// The residual and the derivatives of ln f of each, unless the scan is long.
    known: Vec<Option<(f64, Values)>>,
}

impl<'a> Rows<'a> {
    /// Of the samples of a fit.
    pub fn new(samples: &'a [Sample<f64>], view: &'a View) -> Self {
        let slopes = View {
            material: view.material.off_zero(),
            ..*view
        };
        let (mut lines, mut places) = (Residuals::default(), Vec::with_capacity(samples.len()));
        for line in lines::of(samples) {
            for (place, angle) in line {
                places.push(place);
                lines.angles.push(angle);
                lines.offsets.push(angle - samples[place].theta_i);
            }
            lines.ends.push(places.len());
        }
        let mut rows = Rows {
            samples,
            view,
            slopes,
            lines,
            places,
            known: Vec::new(),
        };
        if rows.places.len() <= SHARE {
            rows.known = rows.places.iter().map(|&sample| rows.computed(sample)).collect();
        }
        rows
    }

    fn computed(&self, sample: usize) -> Option<(f64, Values)> {
        let sample = &self.samples[sample];
        Some((self.view.residual(sample)?, self.slopes.gradient(sample)?.1))
    }

    /// The residuals in units of their standard deviation and the rows of J along the axes, line by line; `None` if one is not finite, or if nobody waits for them any more.
    pub fn residuals(&self, axes: &[&Values], scale: f64) -> Option<Residuals> {
        let mut all = Residuals {
            columns: axes.len(),
            ..self.lines.clone()
        };
        let count = self.places.len();
        all.values.resize(count, 0.0);
        all.rows.resize(count * axes.len(), 0.0);
        let one = |place: usize, value: &mut f64, row: &mut [f64]| {
            let sample = self.places[place];
            let (residual, gradient) = match self.known.get(place) {
                Some(known) => (*known)?,
                None => self.computed(sample)?,
            };
            *value = residual / scale;
            for (x, axis) in row.iter_mut().zip(axes) {
                let sum: f64 = axis.iter().zip(gradient.iter()).map(|(a, b)| a * b).sum();
                *x = sum * self.samples[sample].weight / scale;
            }
            (value.is_finite() && row.iter().all(|x| x.is_finite())).then_some(())
        };
        let values = all.values.par_chunks_mut(SHARE);
        let shares = values.zip(all.rows.par_chunks_mut(SHARE * axes.len()));
        let until = until();
        let whole = shares.enumerate().map(|(share, (values, rows))| {
            if until.is_over() {
                return None;
            }
            let mut points = values.iter_mut().zip(rows.chunks_mut(axes.len())).enumerate();
            points.try_for_each(|(place, (value, row))| one(share * SHARE + place, value, row))
        });
        whole.collect::<Option<()>>()?;
        Some(all)
    }
}
