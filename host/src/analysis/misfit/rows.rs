//! The residuals of a fit and their derivatives, as processes along lines take them.

use brdfit_core::geometry::Sample;

use super::lines;
use super::process::Residuals;
use crate::engine::threads;
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
        let push = |place: usize, values: &mut Vec<f64>, rows: &mut Vec<f64>| {
            let sample = self.places[place];
            let (residual, gradient) = match self.known.get(place) {
                Some(known) => (*known)?,
                None => self.computed(sample)?,
            };
            let value = residual / scale;
            let on = |axis: &&Values| {
                let sum: f64 = axis.iter().zip(gradient.iter()).map(|(a, b)| a * b).sum();
                sum * self.samples[sample].weight / scale
            };
            values.push(value);
            let begun = rows.len();
            rows.extend(axes.iter().map(on));
            (value.is_finite() && rows[begun..].iter().all(|x| x.is_finite())).then_some(())
        };
        let (count, until) = (self.places.len(), until());
        let share = |share: usize| {
            if until.is_over() {
                return None;
            }
            let places = share * SHARE..count.min((share + 1) * SHARE);
            let mut values = Vec::with_capacity(places.len());
            let mut rows = Vec::with_capacity(places.len() * axes.len());
            for place in places {
                push(place, &mut values, &mut rows)?;
            }
            Some((values, rows))
        };
        let mut all = Residuals {
            columns: axes.len(),
            values: Vec::with_capacity(count),
            rows: Vec::with_capacity(count * axes.len()),
            ..self.lines.clone()
        };
        for part in threads::each(count.div_ceil(SHARE), &share) {
            let (values, rows) = part?;
            all.values.extend(values);
            all.rows.extend(rows);
        }
        Some(all)
    }
}
