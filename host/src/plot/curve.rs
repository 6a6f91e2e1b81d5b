//! The model as a polyline with few points.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use std::f64::consts::LOG10_E;

use super::axis::Axis;
use crate::engine::Material;

/// Lines go this far out of the panel, pixels.
const OUTSIDE: f64 = 8.0;

/// ln f of a model in the directions of a sample, f in sr^-1; none beyond the horizon.
pub type LnF<'a> = Box<dyn Fn(&Sample<f64>) -> Option<f64> + 'a>;

/// That of a material.
pub fn of(material: &Material) -> LnF<'static> {
    let material = *material;
    Box::new(move |sample| material.ln_f(sample))
}

/// The in-plane model over the whole horizontal axis, in pixels, true to `tolerance` pixels.
pub fn curve(ln_f: &LnF, theta_i: f64, x: &Axis, y: &Axis, tolerance: f64) -> Vec<(f64, f64)> {
    let model = values(ln_f, theta_i, x);
    let visible = |at: f64| y.pixel(at).clamp(-OUTSIDE, y.pixels() + OUTSIDE);
    let points: Vec<_> = model
        .map(|(theta_s, log10)| (x.pixel(theta_s), visible(log10)))
        .collect();
    simplify(&points, tolerance)
}

/// The largest log10 of the in-plane model over the horizontal axis.
pub fn peak(ln_f: &LnF, theta_i: f64, x: &Axis) -> f64 {
    values(ln_f, theta_i, x).fold(f64::NEG_INFINITY, |peak, (_, log10)| peak.max(log10))
}

/// Eq. 17: the sum of squared residuals of ln f over the squared number of samples; invalid samples are left out.
pub fn mse2(ln_f: &LnF, samples: &[Sample<f64>]) -> f64 {
    let squares = samples.iter().filter_map(|sample| {
        let residual = sample.weight * (ln_f(sample)? - Real::portable_ln(sample.brdf));
        Some(residual * residual)
    });
    squares.sum::<f64>() / (samples.len() * samples.len()) as f64
}

/// theta_s in degrees and log10 of the model there.
fn values<'a>(ln_f: &'a LnF, theta_i: f64, x: &Axis) -> impl Iterator<Item = (f64, f64)> + 'a {
    angles(theta_i.to_degrees(), x.range())
        .into_iter()
        .filter_map(move |theta_s| {
            let sample = Sample::in_plane(theta_i, theta_s.to_radians(), 1.0);
            Some((theta_s, ln_f(&sample)? * LOG10_E))
        })
}

/// Ascending angles in degrees: every half degree, and ever denser towards the two peaks at theta_i and -theta_i, so one as narrow as m = 1e-5 shows.
fn angles(theta_i: f64, (low, high): (f64, f64)) -> Vec<f64> {
    let steps = (2.0 * (high - low)).ceil();
    let mut angles: Vec<f64> = (0..=steps as usize)
        .map(|k| low + (high - low) * k as f64 / steps)
        .collect();
    for peak in [theta_i, -theta_i] {
        let mut offset = 1e-4;
        angles.push(peak);
        while offset < 10.0 {
            angles.extend([peak - offset, peak + offset]);
            offset *= 1.1;
        }
    }
    angles.retain(|&angle| low <= angle && angle <= high && angle.abs() < 89.9);
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    angles
}

/// Leaves out the points that change the picture by less than `tolerance` pixels (Douglas and Peucker's method).
fn simplify(points: &[(f64, f64)], tolerance: f64) -> Vec<(f64, f64)> {
    let mut keep = vec![false; points.len()];
    let mut open = Vec::new();
    if let Some(last) = points.len().checked_sub(1) {
        (keep[0], keep[last]) = (true, true);
        open.push((0, last));
    }
    while let Some((first, last)) = open.pop() {
        let (a, b) = (points[first], points[last]);
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let length = (dx * dx + dy * dy).sqrt().max(f64::MIN_POSITIVE);
        let distance = |p: (f64, f64)| ((p.0 - a.0) * dy - (p.1 - a.1) * dx).abs() / length;
        let inner = (first + 1..last).map(|k| (k, distance(points[k])));
        let Some((k, far)) = inner.max_by(|a, b| a.1.total_cmp(&b.1)) else {
            continue;
        };
        if far > tolerance {
            keep[k] = true;
            open.extend([(first, k), (k, last)]);
        }
    }
    points
        .iter()
        .zip(keep)
        .filter_map(|(&point, keep)| keep.then_some(point))
        .collect()
}
