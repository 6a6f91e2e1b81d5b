//! The samples of one angle of incidence as a curve.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use crate::input::plane;

/// The median; NaN of nothing.
pub fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Signed theta_s in degrees and ln f of the samples in plane, by that angle.
pub fn in_plane(group: &[&Sample<f64>]) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = group
        .iter()
        .filter_map(|sample| Some((plane::signed_theta_s(sample)?, Real::portable_ln(sample.brdf))))
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}
