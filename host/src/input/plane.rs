//! Samples by their angle of incidence, and which of them lie in the plane of incidence.

use std::collections::BTreeMap;

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use crate::engine::instrument::signed;

/// Scattering angle in degrees, positive forward, of a sample in the plane of incidence; none of another.
pub fn signed_theta_s(sample: &Sample<f64>) -> Option<f64> {
    // Most samples are of a scan in plane.
    if sample.delta_phi == f64::PI {
        return Some(sample.theta_s.to_degrees());
    }
    signed(sample).map(f64::to_degrees)
}

/// The angle between the directions of a sample and of a mirror, degrees.
pub fn from_specular(sample: &Sample<f64>) -> f64 {
    let half = |angle: f64| Real::portable_sin_cos(angle / 2.0).0;
    let (sin_i, sin_s) = (
        Real::portable_sin_cos(sample.theta_i).0,
        Real::portable_sin_cos(sample.theta_s).0,
    );
    let (across, turned) = (half(sample.theta_i - sample.theta_s), half(f64::PI - sample.delta_phi));
    let sine = (across * across + sin_i * sin_s * turned * turned).max(0.0).sqrt();
    2.0 * libm::asin(sine.min(1.0)).to_degrees()
}

/// The samples by incident angle, radians, equal to a hundredth of a degree; ascending.
pub fn by_angle(samples: &[Sample<f64>]) -> Vec<(f64, Vec<&Sample<f64>>)> {
    let mut groups = BTreeMap::new();
    for run in samples.chunk_by(|a, b| a.theta_i == b.theta_i) {
        let theta_i = run[0].theta_i;
        let key = (theta_i.to_degrees() * 100.0).round() as i64;
        let group = groups.entry(key).or_insert_with(|| (theta_i, Vec::new()));
        group.1.extend(run);
    }
    groups.into_values().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_lies_in_the_plane_is_signed() {
        let at = |theta_s: f64, delta_phi: f64| Sample {
            delta_phi: delta_phi.to_radians(),
            ..Sample::in_plane(0.5, theta_s.to_radians(), 1.0)
        };
        let signed =
            |theta_s, delta_phi| signed_theta_s(&at(theta_s, delta_phi)).map(|angle| (angle * 1e6).round() / 1e6);
        assert_eq!(signed(30.0, 180.0), Some(30.0));
        assert_eq!(signed(30.0, 0.0), Some(-30.0));
        assert_eq!(signed(-30.0, 180.0), Some(-30.0));
        assert_eq!(signed(30.0, 90.0), None);
        // The normal lies in every plane.
        assert!(signed(0.0, 90.0).is_some());
        assert!((from_specular(&at(30.0, 180.0)) - (30.0 - 0.5f64.to_degrees()).abs()).abs() < 1e-9);
        assert!((from_specular(&at(30.0, 0.0)) - (30.0 + 0.5f64.to_degrees())).abs() < 1e-9);
    }
}
