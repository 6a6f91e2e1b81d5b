//! Samples around the peak of a lobe that stand out together.

use brdfit_core::geometry::{Geometry, Sample};

/// So many side by side are hardly there by chance.
const LEAST: usize = 4;

/// The samples around the specular or the retro direction, nearest first, that stand out, up to where two that follow each other do not; none if they are too few to be a lobe.
pub fn group(samples: &[Sample<f64>], stands_out: impl Fn(usize) -> bool) -> Option<Vec<usize>> {
    let from_peak = |retro: bool| {
        let each = samples.iter().enumerate().filter(|(_, sample)| sample.weight != 0.0);
        let each = each.filter_map(|(place, sample)| {
            let geometry = Geometry::new(sample.theta_i, sample.theta_s, sample.delta_phi).ok()?;
            let lobe = if retro { geometry.volume() } else { geometry.surface() };
            Some((lobe.tan2_theta_h, place))
        });
        let mut order: Vec<(f64, usize)> = each.collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut found, mut misses) = (Vec::new(), 0);
        for (_, place) in order {
            misses = if stands_out(place) { 0 } else { misses + 1 };
            if misses == 2 {
                break;
            }
            if misses == 0 {
                found.push(place);
            }
        }
        (found.len() >= LEAST).then_some(found)
    };
    from_peak(false).or_else(|| from_peak(true))
}
