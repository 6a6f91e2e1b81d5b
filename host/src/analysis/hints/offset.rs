//! A zero of an axis that is off: every peak is shifted by the same angle.

use brdfit_core::geometry::Sample;

use super::in_plane;
use crate::analysis::choose;
use crate::engine::{FitOptions, Outcome};
use crate::input::{Measurement, plane};

/// Smaller shifts are those of the mechanics, degrees.
const LEAST: f64 = 0.3;
/// The residual must fall by this factor if the shift is undone.
const FALLS: f64 = 0.5;
/// A peak stands out by this in ln f from the median.
const STANDS_OUT: f64 = 1.0;

/// By how many degrees the peaks are beyond theta_i, if that is the same at two or more angles of incidence and more than a step of the scan.
///
/// Rough surfaces shift the peak too, but towards grazing, and the more the larger theta_i is.
pub fn of_peaks(samples: &[Sample<f64>]) -> Option<f64> {
    let groups = plane::by_angle(samples);
    let shifts = groups.iter().filter_map(|(theta_i, group)| {
        let theta_i = theta_i.to_degrees();
        let (peak, step) = peak(&in_plane(group))?;
        Some((theta_i, peak - theta_i, step))
    });
    let shifts: Vec<(f64, f64, f64)> = shifts.collect();
    let (first, last) = (shifts.first()?, shifts.last()?);
    let mean = shifts.iter().map(|shift| shift.1).sum::<f64>() / shifts.len() as f64;
    let step = shifts.iter().map(|shift| shift.2).fold(0.0, f64::max);
    let scatter = shifts.iter().map(|shift| (shift.1 - mean).abs()).fold(0.0, f64::max);
    let wide = last.0 - first.0 >= 5.0;
    let constant = scatter <= (0.3 * mean.abs()).min(step.max(0.5));
    (wide && constant && mean.abs() >= step.max(LEAST)).then_some(mean)
}

/// The middle of the peak of a scan in plane and the step of the scan there, degrees; none if no peak stands out, or it is at an end.
fn peak(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let top = (0..points.len()).max_by(|&a, &b| points[a].1.total_cmp(&points[b].1))?;
    let level = super::median(points.iter().map(|point| point.1));
    if top == 0 || top + 1 == points.len() || points[top].1 - level < STANDS_OUT {
        return None;
    }
    let step = 0.5 * (points[top + 1].0 - points[top - 1].0);
    // The middle between the flanks at half of the height, which noise at the top does not move.
    let half = 0.5 * (points[top].1 + level);
    let crossing = |mut inner: usize, next: &dyn Fn(usize) -> Option<usize>| -> Option<f64> {
        loop {
            let outer = next(inner).filter(|&outer| outer < points.len())?;
            let (a, b) = (points[inner], points[outer]);
            if b.1 <= half {
                return Some(a.0 + (b.0 - a.0) * (a.1 - half) / (a.1 - b.1));
            }
            inner = outer;
        }
    };
    let left = crossing(top, &|k| k.checked_sub(1))?;
    let right = crossing(top, &|k| Some(k + 1))?;
    Some((0.5 * (left + right), step))
}

/// That shift in degrees, and the residual of the fit when it is undone, if that is far less.
pub fn confirmed(measurement: &Measurement, options: &FitOptions, outcome: &Outcome) -> Option<(f64, f64)> {
    let degrees = of_peaks(&measurement.samples)?;
    let moved: Vec<Sample<f64>> = measurement.samples.iter().filter_map(|sample| back(sample, degrees)).collect();
    let (_, fit, _) = choose::fit(&moved, options).ok()?;
    (fit.rms_ln <= FALLS * outcome.rms_ln).then_some((degrees, fit.rms_ln))
}

/// A sample in plane with the shift undone; none beyond the horizon or out of plane.
fn back(sample: &Sample<f64>, degrees: f64) -> Option<Sample<f64>> {
    let theta_s = plane::signed_theta_s(sample)? - degrees;
    (theta_s.abs() < 89.9).then(|| Sample {
        weight: sample.weight,
        ..Sample::in_plane(sample.theta_i, theta_s.to_radians(), sample.brdf)
    })
}
