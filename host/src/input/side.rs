//! On which side of the normal a scan has its specular peak.

use brdfit_core::geometry::Sample;

use super::plane;
use crate::error::Error;

/// Closer to the normal the two sides cannot be told apart, and closer to grazing rough surfaces do scatter back, degrees.
const RANGE: std::ops::RangeInclusive<f64> = 10.0..=75.0;
/// The peak may be this far from where a mirror has it, degrees.
const WINDOW: f64 = 8.0;
/// How many times brighter the other side must be.
const CLEARLY: f64 = 1.5;

/// How many times the samples around theta_s = -theta_i are as bright as those around +theta_i, if all angles of incidence agree that the peak is there.
///
/// Where that brightness falls as theta_i grows, the sample reflects back, as a retroreflector does: a specular peak becomes brighter towards grazing.
pub fn other_side(samples: &[Sample<f64>]) -> Option<f64> {
    let mut backs: Vec<f64> = Vec::new();
    let mut least = f64::INFINITY;
    for (theta_i, group) in plane::by_angle(samples) {
        let near = |centre: f64| {
            let inside = |sample: &&&Sample<f64>| {
                // Most samples are far away whatever their side.
                (sample.theta_s.to_degrees().abs() - centre.abs()).abs() <= WINDOW
                    && plane::signed_theta_s(sample).is_some_and(|angle| (angle - centre).abs() <= WINDOW)
            };
            let values = group.iter().filter(inside).map(|sample| sample.brdf);
            values.fold(None, |most: Option<f64>, f| Some(most.map_or(f, |most| most.max(f))))
        };
        if !RANGE.contains(&theta_i.to_degrees()) {
            continue;
        }
        let degrees = theta_i.to_degrees();
        let (Some(back), Some(front)) = (near(-degrees), near(degrees)) else {
            continue;
        };
        backs.push(back);
        least = least.min(back / front);
    }
    let grows = backs
        .first()
        .zip(backs.last())
        .is_some_and(|(first, last)| *last >= 0.7 * first);
    (grows && least >= CLEARLY).then_some(least)
}

/// Refuses a scan whose peak is on the other side.
///
/// # Errors
/// See [`other_side`].
pub fn refuse(samples: &[Sample<f64>]) -> Result<(), Error> {
    match other_side(samples) {
        None => Ok(()),
        Some(times) => Err(Error::new(format!(
            "the specular peak is on the other side: at theta_s = -theta_i the values are {times:.2} times those at +theta_i, or more"
        ))
        .help("--forward negative takes that side as forward; --forward positive keeps the sign, as for a sample that reflects back")),
    }
}
