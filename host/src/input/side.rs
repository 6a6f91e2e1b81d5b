//! On which side of the normal a scan has its specular peak.

use brdfit_core::geometry::Sample;

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
    let mut sorted: Vec<&Sample<f64>> = samples.iter().collect();
    sorted.sort_by(|a, b| a.theta_i.total_cmp(&b.theta_i));
    let mut rest = sorted.as_slice();
    let mut backs: Vec<f64> = Vec::new();
    let mut least = f64::INFINITY;
    while let Some(first) = rest.first() {
        let theta_i = first.theta_i;
        let (group, others) = rest.split_at(rest.partition_point(|sample| sample.theta_i - theta_i < 1e-4));
        rest = others;
        if !RANGE.contains(&theta_i.to_degrees()) {
            continue;
        }
        let near = |centre: f64| {
            let inside = group
                .iter()
                .filter(|sample| signed(sample).is_some_and(|angle| (angle - centre).abs() <= WINDOW));
            inside
                .map(|sample| sample.brdf)
                .fold(None, |most: Option<f64>, f| Some(most.map_or(f, |most| most.max(f))))
        };
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

/// Scattering angle in degrees, positive forward, of a sample in the plane of incidence.
pub fn signed(sample: &Sample<f64>) -> Option<f64> {
    let turned = sample.delta_phi.abs();
    let degrees = sample.theta_s.to_degrees();
    if (turned - std::f64::consts::PI).abs() < 1e-6 {
        Some(degrees)
    } else if turned < 1e-6 {
        Some(-degrees)
    } else {
        None
    }
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
