//! A zero of an axis that is off: every peak is shifted by the same angle.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::curve::{in_plane, median};
use crate::engine::{self, FitOptions, Outcome};
use crate::input::{Measurement, plane};

/// Smaller shifts are those of the mechanics, degrees.
const LEAST: f64 = 0.3;
/// The residual must fall by this factor if the shift is undone.
const FALLS: f64 = 0.5;
/// A peak stands out by this in ln f from the median.
const STANDS_OUT: f64 = 1.0;
/// How deep below its top in ln f a peak is taken for a parabola.
const CAP: f64 = 0.8;

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
    let constant = scatter <= (0.3 * mean.abs()).min(step.max(0.7));
    (wide && constant && mean.abs() >= step.max(LEAST)).then_some(mean)
}

/// Where the facets of a lobe in plane reflect like mirrors and the step of the scan there, degrees; none if no peak stands out, or it is at an end.
///
/// Around its top ln f of a lobe is a parabola, which the cosine of theta_s in front of it (Eq. 14) moves towards grazing by sigma^2 tan(theta_s), sigma being its width; this is taken off.
fn peak(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let top = (0..points.len()).max_by(|&a, &b| points[a].1.total_cmp(&points[b].1))?;
    let level = median(points.iter().map(|point| point.1));
    if top == 0 || top + 1 == points.len() || points[top].1 - level < STANDS_OUT {
        return None;
    }
    let step = 0.5 * (points[top + 1].0 - points[top - 1].0);
    let high = |place: &usize| points[*place].1 > points[top].1 - CAP;
    let before = (0..top).rev().take_while(high).count().max(1);
    let after = (top..points.len()).take_while(high).count().max(2);
    let cap = &points[top - before..(top + after).min(points.len())];
    let (vertex, curvature) = parabola(cap, points[top].0)?;
    if curvature >= 0.0 || vertex < cap[0].0 || vertex > cap[cap.len() - 1].0 {
        return None;
    }
    // Degrees squared, and the slope of ln cos per degree.
    let sigma2 = -1.0 / (2.0 * curvature);
    let (sin, cos) = Real::portable_sin_cos(vertex.to_radians());
    let moved = sigma2 * (sin / cos).to_radians();
    (vertex.abs() < 85.0).then_some((vertex - moved, step))
}

/// Vertex and second coefficient of the parabola of least squares; `origin` is a place near it.
fn parabola(points: &[(f64, f64)], origin: f64) -> Option<(f64, f64)> {
    let mut sums = [0.0; 5];
    let mut right = [0.0; 3];
    for &(x, y) in points {
        let x = x - origin;
        let powers = [1.0, x, x * x, x * x * x, x * x * x * x];
        sums.iter_mut().zip(powers).for_each(|(sum, power)| *sum += power);
        right.iter_mut().zip(powers).for_each(|(sum, power)| *sum += power * y);
    }
    // Cramer's rule on the three normal equations.
    let matrix = |column: Option<usize>| {
        let at = |row: usize, k: usize| if column == Some(k) { right[row] } else { sums[row + k] };
        at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)) - at(0, 1) * (at(1, 0) * at(2, 2) - at(1, 2) * at(2, 0))
            + at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0))
    };
    let (slope, curvature) = (matrix(Some(1)) / matrix(None), matrix(Some(2)) / matrix(None));
    let vertex = origin - slope / (2.0 * curvature);
    (vertex.is_finite() && curvature.is_finite()).then_some((vertex, curvature))
}

/// That shift in degrees, and the residual of the fit when it is undone, if that is far less; fits with other shifts make it exact.
pub fn confirmed(measurement: &Measurement, options: &FitOptions, outcome: &Outcome) -> Option<(f64, f64)> {
    let seen = of_peaks(&measurement.samples)?;
    let residual = |degrees: f64| {
        let samples = measurement.samples.iter();
        let moved: Vec<Sample<f64>> = samples.filter_map(|sample| back(sample, degrees)).collect();
        engine::fit(&moved, options).map_or(f64::INFINITY, |fit| fit.rms_ln)
    };
    // The parabola's place is right to about a fifth.
    let reach = (0.5 * seen.abs()).max(0.5);
    let (degrees, least) = golden_section(residual, seen - reach, seen + reach);
    (least <= FALLS * outcome.rms_ln).then_some((degrees, least))
}

/// The place of the least value between two ends, to a few thousandths of their distance, and that value.
fn golden_section(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> (f64, f64) {
    const EVALUATIONS: u32 = 13;
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let inner = |low: f64, high: f64| (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut a, mut b) = inner(low, high);
    let (mut at_a, mut at_b) = (f(a), f(b));
    for _ in 2..EVALUATIONS {
        if at_a < at_b {
            high = b;
            (b, at_b) = (a, at_a);
            a = inner(low, high).0;
            at_a = f(a);
        } else {
            low = a;
            (a, at_a) = (b, at_b);
            b = inner(low, high).1;
            at_b = f(b);
        }
    }
    if at_a < at_b { (a, at_a) } else { (b, at_b) }
}

/// A sample in plane with the shift undone; none beyond the horizon or out of plane.
fn back(sample: &Sample<f64>, degrees: f64) -> Option<Sample<f64>> {
    let theta_s = plane::signed_theta_s(sample)? - degrees;
    (theta_s.abs() < 89.9).then(|| Sample {
        weight: sample.weight,
        ..Sample::in_plane(sample.theta_i, theta_s.to_radians(), sample.brdf)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_has_its_vertex() {
        let points: Vec<_> = (0..9)
            .map(|k| f64::from(k) + 40.0)
            .map(|x| (x, 3.0 - 0.5 * (x - 43.3) * (x - 43.3)))
            .collect();
        let (vertex, curvature) = parabola(&points, 44.0).unwrap();
        assert!((vertex - 43.3).abs() < 1e-9 && (curvature + 0.5).abs() < 1e-9);
        assert!(parabola(&points[..2], 40.0).is_none_or(|(vertex, _)| !vertex.is_nan()));
    }

    #[test]
    fn golden_section_finds_the_least() {
        let (at, least) = golden_section(|x| (x - 1.3).abs() + 2.0, -1.0, 4.0);
        assert!((at - 1.3).abs() < 0.02 && least < 2.02);
    }

    #[test]
    fn only_a_constant_shift_is_an_offset() {
        // ln f of a lobe of 5 degrees over a diffuse level.
        let scan = |shift: fn(f64) -> f64| -> Vec<Sample<f64>> {
            let of = |theta_i: f64| {
                (-80..=80).map(move |theta_s| {
                    let away = (f64::from(theta_s) - theta_i - shift(theta_i)) / 5.0;
                    let brdf = 0.02 + Real::portable_exp(-0.5 * away * away);
                    Sample::in_plane(theta_i.to_radians(), f64::from(theta_s).to_radians(), brdf)
                })
            };
            [10.0, 30.0, 50.0].into_iter().flat_map(of).collect()
        };
        let found = of_peaks(&scan(|_| 2.0)).unwrap();
        assert!((found - 2.0).abs() < 0.5, "{found}");
        assert!(of_peaks(&scan(|_| -3.0)).is_some_and(|found| (found + 3.0).abs() < 0.5));
        assert_eq!(of_peaks(&scan(|_| 0.2)), None);
        assert_eq!(of_peaks(&scan(|theta_i| 0.1 * theta_i)), None);
        assert_eq!(of_peaks(&[]), None);
    }
}
