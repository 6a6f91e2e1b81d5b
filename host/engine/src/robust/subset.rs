//! A few samples of many.

use brdfit_core::geometry::{Geometry, Sample};
use brdfit_core::start;

/// Samples of a draw at most.
pub const MOST: usize = 16;

/// At most `most` of the samples that count, evenly spread over their distance from the specular peak, nearest first.
pub fn spread(samples: &[Sample<f64>], most: usize) -> Vec<Sample<f64>> {
    let distance = |sample: &Sample<f64>| {
        Geometry::new(sample.theta_i, sample.theta_s, sample.delta_phi)
            .map_or(f64::INFINITY, |geometry| geometry.surface().tan2_theta_h)
    };
    let mut order: Vec<(f64, Sample<f64>)> = samples
        .iter()
        .filter(|sample| sample.weight != 0.0)
        .map(|sample| (distance(sample), *sample))
        .collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let step = order.len().div_ceil(most).max(1);
    order.into_iter().step_by(step).map(|(_, sample)| sample).collect()
}

/// Draw `k` of `seed`: `size` different samples of those of [`spread`]; every other draw is denser towards the peak, where few samples may be all that there are.
pub fn draw(samples: &[Sample<f64>], seed: u64, k: u64, size: usize) -> Vec<Sample<f64>> {
    let uniform: [f64; MOST] = start::unit(seed, k);
    let mut places: Vec<usize> = Vec::new();
    for part in uniform.into_iter().take(size) {
        let part = if k.is_multiple_of(2) { part } else { part * part * part };
        let mut place = ((part * samples.len() as f64) as usize).min(samples.len() - 1);
        while places.contains(&place) {
            place = (place + 1) % samples.len();
        }
        places.push(place);
    }
    places.into_iter().map(|place| samples[place]).collect()
}
