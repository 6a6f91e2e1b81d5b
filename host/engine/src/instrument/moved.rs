//! A zero of theta_s that is off: samples where they are, if the instrument reads an angle too much.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use crate::error::FitError;

/// A sample whose direction is nearer to the plane of incidence than this lies in it, as a sine: 0.1 degrees.
const IN_PLANE: f64 = 1.745e-3;
/// Samples stay this far above the horizon, radians (0.1 degrees).
const HORIZON: f64 = 0.001_745;
/// The offset of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset {
    /// What the instrument reads for theta_s = 0, radians, positive forward.
    pub value: f64,
    /// Its standard error, radians.
    pub stderr: f64,
    /// It is at an end of what was allowed.
    pub at_bound: bool,
}

/// Scattering angle, radians, positive forward, of a sample in the plane of incidence; none of another.
pub fn signed(sample: &Sample<f64>) -> Option<f64> {
    let (sin_phi, cos_phi) = Real::portable_sin_cos(sample.delta_phi);
    let across = Real::portable_sin_cos(sample.theta_s).0 * sin_phi;
    (across.abs() <= IN_PLANE).then_some(if cos_phi < 0.0 { sample.theta_s } else { -sample.theta_s })
}

/// The sample where it is, if the instrument reads `offset` too much; none out of plane or beyond the horizon.
pub fn moved(sample: &Sample<f64>, offset: f64) -> Option<Sample<f64>> {
    if offset == 0.0 {
        return Some(*sample);
    }
    let theta_s = signed(sample)? - offset;
    (theta_s.abs() < 0.5 * f64::PI).then(|| Sample {
        weight: sample.weight,
        ..Sample::in_plane(sample.theta_i, theta_s, sample.brdf)
    })
}

/// All samples moved.
pub fn all_moved(samples: &[Sample<f64>], offset: f64) -> Result<Vec<Sample<f64>>, FitError> {
    let each = samples.iter().enumerate();
    each.map(|(place, sample)| moved(sample, offset).ok_or(FitError::OutOfPlane(place)))
        .collect()
}

/// The part of a range of offsets that keeps every sample above the horizon.
pub fn allowed(samples: &[Sample<f64>], (least, most): (f64, f64)) -> Result<(f64, f64), FitError> {
    let (mut low, mut high) = (0.0f64, 0.0f64);
    for (place, sample) in samples.iter().enumerate() {
        let theta_s = signed(sample).ok_or(FitError::OutOfPlane(place))?;
        (low, high) = (low.min(theta_s), high.max(theta_s));
    }
    let end = 0.5 * f64::PI - HORIZON;
    let (least, most) = (least.max(high - end), most.min(low + end));
    Ok((least.min(most), most))
}
