//! Numbers for the page's own drawings: angles in degrees, BRDF in sr^-1.

use brdfit::engine::{Material, Model};
use brdfit::error::Error;
use brdfit::input::left_out::Reason;
use brdfit::input::{Measurement, plane};
use brdfit::plot;
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use serde::Serialize;

use crate::request::Draw;

/// Samples as columns of numbers.
#[derive(Default, Serialize)]
pub struct Points {
    /// Angle of incidence.
    theta_i: Vec<f64>,
    /// Scattering angle, positive forward; out of plane the angle from the specular direction.
    x: Vec<f64>,
    /// True of samples out of plane.
    out_of_plane: Vec<bool>,
    /// BRDF.
    f: Vec<f64>,
    /// Weight.
    weight: Vec<f64>,
    /// Line of the file, or 0.
    line: Vec<u64>,
    /// Why it was left out, if it was.
    reason: Vec<&'static str>,
}

impl Points {
    fn add(&mut self, sample: &Sample<f64>, line: u64, reason: Option<Reason>) {
        let signed = plane::signed_theta_s(sample);
        self.theta_i.push(rounded(sample.theta_i.to_degrees()));
        self.x
            .push(rounded(signed.unwrap_or_else(|| plane::from_specular(sample))));
        self.out_of_plane.push(signed.is_none());
        self.f.push(sample.brdf);
        self.weight.push(sample.weight);
        self.line.push(line);
        self.reason.extend(reason.map(Reason::title));
    }
}

/// Samples that are drawn at most.
const DRAWN: usize = 40_000;

/// One in so many samples of a scan is drawn.
pub fn stride(scan: &Measurement) -> usize {
    scan.samples.len().div_ceil(DRAWN).max(1)
}

/// Those of a scan that are drawn, in order, and those left out although they are valid.
pub fn points(scan: &Measurement) -> (Points, Points) {
    let (mut kept, mut left_out) = (Points::default(), Points::default());
    for (sample, line) in scan.samples.iter().zip(&scan.lines).step_by(stride(scan)) {
        kept.add(sample, *line, None);
    }
    for (reason, sample) in scan.masked.iter().step_by(stride(scan)) {
        left_out.add(sample, 0, Some(*reason));
    }
    (kept, left_out)
}

/// A model over a scan.
#[derive(Serialize)]
pub struct Drawn {
    /// One curve an angle of incidence, ascending.
    curves: Vec<Curve>,
    /// ln of the model over the measured value, times the weight, of each sample that is drawn, in order; null beyond the horizon.
    residuals: Vec<Option<f64>>,
}

/// The model in the plane of incidence.
#[derive(Serialize)]
struct Curve {
    theta_i: f64,
    /// Scattering angles, ascending.
    x: Vec<f64>,
    /// BRDF there.
    f: Vec<f64>,
}

/// Points of a curve between the ends of what is seen.
const EVEN: usize = 400;
/// Points on each side of the specular direction, ever closer to it.
const NEAR: i32 = 60;

/// The model with these values, drawn over a scan.
///
/// # Errors
/// There is no such model, or it has other parameters.
pub fn drawn(scan: &Measurement, draw: &Draw) -> Result<Drawn, Error> {
    let model = Model::find(&draw.model).ok_or_else(|| Error::new("there is no such model"))?;
    if model.parameters.len() != draw.values.len() || !(draw.from < draw.to) {
        return Err(Error::new("these are not all parameters of the model, or not a range"));
    }
    let material = Material {
        model,
        values: draw.values.iter().copied().collect(),
    };
    let groups = plane::by_angle(&scan.samples);
    Ok(Drawn {
        curves: groups
            .iter()
            .map(|(theta_i, _)| curve(&material, *theta_i, draw))
            .collect(),
        residuals: scan
            .samples
            .iter()
            .step_by(stride(scan))
            .map(|sample| material.residual(sample))
            .collect(),
    })
}

fn curve(material: &Material, theta_i: f64, draw: &Draw) -> Curve {
    let ln_f = plot::of(material);
    let (center, width) = (theta_i.to_degrees(), draw.to - draw.from);
    let even = (0..=EVEN).map(|k| draw.from + width * k as f64 / EVEN as f64);
    let near = (0..=NEAR).flat_map(|k| {
        let off = 20.0 * Real::portable_exp(-0.2 * f64::from(k));
        [center - off, center + off]
    });
    let mut x: Vec<f64> = even
        .chain(near)
        .filter(|x| (draw.from..=draw.to).contains(x) && x.abs() < 90.0)
        .collect();
    x.sort_by(f64::total_cmp);
    x.dedup();
    let f = |x: &f64| ln_f(&Sample::in_plane(theta_i, x.to_radians(), 1.0)).map(Real::portable_exp);
    let (x, f) = x.into_iter().filter_map(|x| Some((x, f(&x)?))).unzip();
    Curve {
        theta_i: rounded(center),
        x,
        f,
    }
}

/// Degrees as they were measured, without what the way through radians adds.
fn rounded(degrees: f64) -> f64 {
    (degrees * 1e9).round() / 1e9
}
