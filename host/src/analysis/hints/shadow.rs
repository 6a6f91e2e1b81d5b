//! The shadow of a detector that stands in the incident beam.

use brdfit_core::geometry::Sample;

use super::curve::{in_plane, median};
use crate::input::plane;

/// The shadow is looked for this close to the direction of incidence, degrees.
const CLOSE: f64 = 3.0;
/// Its surroundings, degrees from the direction of incidence.
const AROUND: std::ops::RangeInclusive<f64> = 8.0..=16.0;
/// ln of how much darker it must be than both sides: a factor of 1.5.
const DARKER: f64 = 0.4;

/// How far the shadow reaches from the direction of incidence, whole degrees; none if at fewer than half of the angles of incidence there is one.
pub fn width(samples: &[Sample<f64>]) -> Option<f64> {
    let groups = plane::by_angle(samples);
    let found = groups
        .iter()
        .filter_map(|(theta_i, group)| one(theta_i.to_degrees(), &in_plane(group)));
    let (mut seen, mut widths) = (0, Vec::new());
    for width in found {
        seen += 1;
        widths.extend(width);
    }
    let widest = widths.iter().copied().fold(0.0, f64::max);
    (!widths.is_empty() && 2 * widths.len() >= seen).then_some(widest)
}

/// At one angle of incidence: whether it can be seen, and how wide it is.
fn one(theta_i: f64, points: &[(f64, f64)]) -> Option<Option<f64>> {
    let side = |sign: f64| {
        let there = points
            .iter()
            .filter(|point| AROUND.contains(&(sign * (point.0 + theta_i))));
        median(there.map(|point| point.1))
    };
    // A lobe on one side must not make the other side look dark.
    let around = side(-1.0).min(side(1.0));
    let close = points.iter().filter(|point| (point.0 + theta_i).abs() <= CLOSE);
    let close: Vec<f64> = close.map(|point| point.1).collect();
    if close.is_empty() || !around.is_finite() {
        return None;
    }
    if !(median(close.into_iter()) < around - DARKER) {
        return Some(None);
    }
    let dark = points.iter().filter(|point| point.1 < around - 0.5 * DARKER);
    let reach = dark
        .map(|point| (point.0 + theta_i).abs())
        .filter(|&far| far < *AROUND.start());
    Some(Some(reach.fold(0.0, f64::max).floor() + 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scan(depth: f64) -> Vec<Sample<f64>> {
        let at = |theta_i: f64, theta_s: f64| {
            let hidden = (theta_i + theta_s).abs() <= 4.0;
            Sample::in_plane(
                theta_i.to_radians(),
                theta_s.to_radians(),
                if hidden { 0.1 * depth } else { 0.1 },
            )
        };
        let of = |theta_i| (-80..=80).map(move |theta_s| at(theta_i, f64::from(theta_s)));
        [10.0, 30.0, 60.0].into_iter().flat_map(of).collect()
    }

    #[test]
    fn only_a_hole_is_a_shadow() {
        assert_eq!(width(&scan(0.1)), Some(5.0));
        assert_eq!(width(&scan(1.0)), None);
        assert_eq!(width(&scan(3.0)), None);
        assert_eq!(width(&[]), None);
    }
}
