//! The residuals of a fit and their derivatives, as processes along lines take them.

use brdfit_core::geometry::Sample;
use rayon::prelude::*;

use super::lines;
use super::process::Residuals;
use crate::engine::{Values, View};
use crate::until::until;

/// Residuals that a thread takes at once.
const SHARE: usize = 4096;

/// The residuals in units of their standard deviation and the rows of J along the axes, line by line; `None` if one is not finite, or if nobody waits for them any more.
pub fn residuals(samples: &[Sample<f64>], view: &View, axes: &[&Values], scale: f64) -> Option<Residuals> {
    let slopes = View {
        material: view.material.off_zero(),
        ..*view
    };
    let mut all = Residuals {
        columns: axes.len(),
        ..Residuals::default()
    };
    let mut places = Vec::with_capacity(samples.len());
    for line in lines::of(samples) {
        for (place, angle) in line {
            places.push(place);
            all.angles.push(angle);
            all.offsets.push(angle - samples[place].theta_i);
        }
        all.ends.push(places.len());
    }
    all.values.resize(places.len(), 0.0);
    all.rows.resize(places.len() * axes.len(), 0.0);
    let one = |place: usize, value: &mut f64, row: &mut [f64]| {
        let sample = &samples[place];
        *value = view.residual(sample)? / scale;
        let gradient = slopes.gradient(sample)?.1;
        for (x, axis) in row.iter_mut().zip(axes) {
            let sum: f64 = axis.iter().zip(gradient.iter()).map(|(a, b)| a * b).sum();
            *x = sum * sample.weight / scale;
        }
        (value.is_finite() && row.iter().all(|x| x.is_finite())).then_some(())
    };
    let values = all.values.par_chunks_mut(SHARE);
    let shares = values.zip(all.rows.par_chunks_mut(SHARE * axes.len()));
    let shares = shares.zip(places.par_chunks(SHARE));
    let until = until();
    let whole = shares.map(|((values, rows), places)| {
        if until.is_over() {
            return None;
        }
        let rows = rows.chunks_mut(axes.len());
        let mut points = places.iter().zip(values.iter_mut().zip(rows));
        points.try_for_each(|(&place, (value, row))| one(place, value, row))
    });
    whole.collect::<Option<()>>()?;
    Some(all)
}
