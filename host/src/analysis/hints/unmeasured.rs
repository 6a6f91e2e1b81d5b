//! What a scan cannot tell for the directions that it has.

use brdfit_core::brdf::{SURFACE, VOLUME};
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use crate::engine::FitOptions;
use crate::input::plane;

/// Where no sample is nearer to the specular direction than this, a narrow peak there would not be seen, degrees.
const FAR: f64 = 5.0;
/// Up to this angle of incidence the specular and the retro direction are one, degrees.
const NORMAL: f64 = 0.5;

/// How far the nearest sample is from the specular direction of its angle of incidence, degrees, if it is far from it at all of them.
pub fn specular(samples: &[Sample<f64>]) -> Option<f64> {
    let away = |sample: &Sample<f64>| {
        let (sin_i, cos_i) = Real::portable_sin_cos(sample.theta_i);
        let (sin_s, cos_s) = Real::portable_sin_cos(sample.theta_s);
        let turned = -Real::portable_sin_cos(sample.delta_phi).1;
        let cos = sin_i * sin_s * turned + cos_i * cos_s;
        // Half of the angle by its tangent, which is sure at 0 too.
        let tan = Real::sqrt((1.0 - cos).max(0.0) / (1.0 + cos).max(f64::MIN_POSITIVE));
        2.0 * Real::portable_atan(tan).to_degrees()
    };
    let nearest = samples.iter().map(away).fold(f64::INFINITY, f64::min);
    (nearest.is_finite() && nearest > FAR).then_some(nearest)
}

/// Are all samples at normal incidence, where a surface lobe and a volume lobe coincide, and are both fitted?
pub fn lobes_coincide(samples: &[Sample<f64>], options: &FitOptions) -> bool {
    let both = SURFACE | VOLUME;
    let fitted = options.terms & options.model.terms & both == both;
    let weights = ["rho_s", "rho_v"].map(|name| options.model.place(name));
    let free = weights
        .iter()
        .flatten()
        .all(|&place| options.lower[place] < options.upper[place]);
    let steepest = plane::by_angle(samples).last().map(|(theta_i, _)| theta_i.to_degrees());
    fitted && free && steepest.is_some_and(|theta_i| theta_i <= NORMAL)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scan(theta_i: f64, theta_s: std::ops::RangeInclusive<i32>) -> Vec<Sample<f64>> {
        let at = |theta_s: i32| Sample::in_plane(theta_i.to_radians(), f64::from(theta_s).to_radians(), 0.1);
        theta_s.map(at).collect()
    }

    #[test]
    fn a_specular_direction_that_was_not_measured_is_told() {
        assert!((specular(&scan(45.0, -80..=30)).unwrap() - 15.0).abs() < 1e-3);
        assert_eq!(specular(&scan(45.0, -80..=41)), None);
        // One angle of incidence at which it was measured is enough.
        let both = [scan(45.0, -80..=30), scan(20.0, -80..=30)].concat();
        assert_eq!(specular(&both), None);
    }

    #[test]
    fn lobes_coincide_at_normal_incidence_alone() {
        let options = FitOptions::default();
        assert!(lobes_coincide(&scan(0.0, 0..=80), &options));
        assert!(!lobes_coincide(&scan(5.0, 0..=80), &options));
        let one = FitOptions {
            terms: options.terms & !VOLUME,
            ..options
        };
        assert!(!lobes_coincide(&scan(0.0, 0..=80), &one));
    }
}
