//! Peaks where no mirror has one: angles that count from another direction, or the other way round.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::curve;
use crate::input::plane;

/// Closer to the normal directions cannot be told apart, and closer to grazing lobes are far off, degrees.
const RANGE: std::ops::RangeInclusive<f64> = 10.0..=75.0;
/// A peak may be this far from where it is said to be, degrees.
const AT_NORMAL: f64 = 2.0;
const BEHIND: f64 = 8.0;
/// How many times brighter than both sides a peak must be.
const CLEARLY: f64 = 2.0;

/// The least angle of incidence, degrees, if at each that is well away from the normal the peak is narrow and at the normal.
pub fn at_normal(samples: &[Sample<f64>]) -> Option<f64> {
    first(samples, |theta_i, points, (peak, most)| {
        let reach = points[0].0.abs().min(points[points.len() - 1].0);
        let beside = (0.5 * theta_i).min(0.8 * reach);
        peak.abs() <= AT_NORMAL && is_alone(points, (peak, most), |theta_s| theta_s.abs() >= beside)
    })
}

/// The same if the samples are all on the side of incidence, and the peak is where a mirror has it on the other.
pub fn behind(samples: &[Sample<f64>]) -> Option<f64> {
    first(samples, |theta_i, points, (peak, most)| {
        let is_far = |theta_s: f64| (theta_s - peak).abs() >= BEHIND;
        points[points.len() - 1].0 <= BEHIND
            && (peak + theta_i).abs() <= BEHIND
            && is_alone(points, (peak, most), is_far)
    })
}

/// The least of the angles of incidence within [`RANGE`], if what is asked is true of all of these; it is given the angle, the curve, and its peak.
fn first(samples: &[Sample<f64>], is: impl Fn(f64, &[(f64, f64)], (f64, f64)) -> bool) -> Option<f64> {
    let mut least = None;
    for (theta_i, group) in plane::by_angle(samples) {
        let theta_i = theta_i.to_degrees();
        let points = curve::in_plane(&group);
        let peak = points.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1));
        let Some(peak) = peak.filter(|_| RANGE.contains(&theta_i)) else {
            continue;
        };
        if !is(theta_i, &points, peak) {
            return None;
        }
        least.get_or_insert((theta_i * 1e4).round() / 1e4);
    }
    least
}

/// True if all points that are far from the peak, at least two on each side, are clearly below it.
fn is_alone(points: &[(f64, f64)], (peak, most): (f64, f64), is_far: impl Fn(f64) -> bool) -> bool {
    let far = || points.iter().filter(|(theta_s, _)| is_far(*theta_s));
    let before = far().filter(|(theta_s, _)| *theta_s < peak).count();
    let below = most - Real::portable_ln(CLEARLY);
    before >= 2 && far().count() >= before + 2 && far().all(|(_, ln_f)| *ln_f <= below)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lobe around `centre` of each angle of incidence over a floor.
    fn scan(
        theta_i: &[f64],
        range: std::ops::RangeInclusive<i32>,
        centre: fn(f64) -> f64,
        width: f64,
    ) -> Vec<Sample<f64>> {
        let all = theta_i
            .iter()
            .flat_map(|&theta_i| range.clone().map(move |theta_s| (theta_i, f64::from(theta_s))));
        let sample = |(theta_i, theta_s): (f64, f64)| {
            let off = (theta_s - centre(theta_i)) / width;
            let below = 1.0 + off * off;
            Sample::in_plane(theta_i.to_radians(), theta_s.to_radians(), 0.1 + 1.0 / (below * below))
        };
        all.map(sample).collect()
    }

    #[test]
    fn a_peak_at_the_normal_is_seen() {
        let seen = |range, centre, width| at_normal(&scan(&[0.0, 30.0, 60.0], range, centre, width));
        assert_eq!(seen(-80..=80, |_| 0.0, 5.0), Some(30.0));
        assert_eq!(seen(-15..=15, |_| 1.0, 5.0), Some(30.0));
        assert_eq!(seen(-80..=80, |theta_i| theta_i, 5.0), None);
        assert_eq!(
            seen(-80..=80, |theta_i| if theta_i > 50.0 { 0.0 } else { theta_i }, 5.0),
            None
        );
        // A wide lobe may be there, and of half of one nothing is known.
        assert_eq!(seen(-80..=80, |_| 0.0, 50.0), None);
        assert_eq!(seen(0..=80, |_| 0.0, 5.0), None);
        assert_eq!(at_normal(&scan(&[5.0], -80..=80, |_| 0.0, 5.0)), None);
    }

    #[test]
    fn a_peak_on_the_side_of_incidence_alone_is_seen() {
        let seen = |range, centre, width| behind(&scan(&[0.0, 30.0, 60.0], range, centre, width));
        assert_eq!(seen(-80..=0, |theta_i| -theta_i, 5.0), Some(30.0));
        assert_eq!(seen(-80..=0, |theta_i| -1.05 * theta_i, 5.0), Some(30.0));
        assert_eq!(seen(-80..=80, |theta_i| -theta_i, 5.0), None);
        assert_eq!(seen(-80..=0, |_| -30.0, 5.0), None);
        assert_eq!(seen(-80..=0, |theta_i| -theta_i, 80.0), None);
        assert_eq!(seen(-80..=-55, |theta_i| theta_i, 5.0), None);
    }
}
