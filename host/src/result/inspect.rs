//! What was read of a scan, before any fit.

mod json;
mod text;

use brdfit_core::geometry::Sample;

use crate::analysis::hints::{self, Hint};
use crate::input::{Measurement, plane};
pub use json::json;
pub use text::text;

/// What is said of one scan.
pub struct Inspected<'a> {
    /// The scan.
    pub measurement: &'a Measurement,
    /// Its angles of incidence, ascending.
    pub angles: Vec<Angle>,
    /// What a person would say of it.
    pub hints: Vec<Hint>,
}

/// The samples of one angle of incidence; angles in degrees, BRDF in sr^-1.
pub struct Angle {
    /// The angle.
    pub theta_i: f64,
    /// Number of samples.
    pub samples: usize,
    /// Number of those in the plane of incidence.
    pub in_plane: usize,
    /// Least and largest scattering angle, signed in plane.
    pub theta_s: (f64, f64),
    /// Least and largest azimuth, if some samples are out of plane.
    pub delta_phi: Option<(f64, f64)>,
    /// Least and largest BRDF.
    pub brdf: (f64, f64),
    /// Scattering angle of the brightest sample in plane.
    pub brightest: Option<f64>,
}

impl<'a> Inspected<'a> {
    /// Looks at a scan.
    pub fn new(measurement: &'a Measurement) -> Self {
        let groups = plane::by_angle(&measurement.samples);
        Inspected {
            measurement,
            angles: groups
                .iter()
                .map(|(theta_i, group)| Angle::new(*theta_i, group))
                .collect(),
            hints: hints::of_scan(measurement),
        }
    }
}

impl Angle {
    fn new(theta_i: f64, group: &[&Sample<f64>]) -> Angle {
        let signed = |sample: &&&Sample<f64>| plane::signed_theta_s(sample);
        let in_plane: Vec<&&Sample<f64>> = group.iter().filter(|sample| signed(sample).is_some()).collect();
        let theta_s = group
            .iter()
            .map(|sample| plane::signed_theta_s(sample).unwrap_or(sample.theta_s.to_degrees()));
        let brightest = in_plane.iter().max_by(|a, b| a.brdf.total_cmp(&b.brdf));
        Angle {
            theta_i: tidy(theta_i.to_degrees()),
            samples: group.len(),
            in_plane: in_plane.len(),
            theta_s: range(theta_s.map(tidy)),
            delta_phi: (in_plane.len() < group.len())
                .then(|| range(group.iter().map(|sample| tidy(sample.delta_phi.to_degrees())))),
            brdf: range(group.iter().map(|sample| sample.brdf)),
            brightest: brightest.and_then(|sample| plane::signed_theta_s(sample)).map(tidy),
        }
    }
}

/// Degrees as they were measured, without what the way through radians adds.
fn tidy(degrees: f64) -> f64 {
    (degrees * 1e9).round() / 1e9
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    })
}
