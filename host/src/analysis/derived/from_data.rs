//! The surface lobe as the samples have it, where residuals show that the model has another shape.
//!
//! What the model lacks is a function of the angle beside noise (Kennedy and O'Hagan 2001); the mean of the process that the residuals are of is that function, as far as the samples tell it.
//! A quantity of the model then differs from the surface's by an error that more samples do not take away. It is known to lie between 0 and what the data differ by, or about as far to the other side: the variance of that rectangle is added (type B, GUM 4.3.7), as far as the residuals are those of a misfit.

use std::f64::consts::LN_2;

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::shape::{HORIZON, Value, crossing, tops};
use crate::analysis::misfit::lines;
use crate::analysis::misfit::process::Process;
use crate::analysis::misfit::smoothed::smoothed;
use crate::engine::instrument::signed;
use crate::engine::threads;
use crate::engine::uncertainty::{Misfit, Uncertainty};
use crate::engine::{Material, View};

/// Angles of incidence within this are one, radians.
const SAME: f64 = 1.7e-4;

/// ln of the measured BRDF over that of the model, without noise, along one angle of incidence in plane.
pub struct Line {
    theta_i: f64,
    /// Angles, radians, positive forward and ascending, each with the ratio's logarithm.
    points: Vec<(f64, f64)>,
    /// How much surer than not it is that this is a misfit, 0 to 1.
    misfit: f64,
}

/// Every line in the plane of incidence; none where residuals are independent.
pub fn of(samples: &[Sample<f64>], view: &View, known: &Uncertainty) -> Vec<Line> {
    let Some(misfit) = known.misfit else { return Vec::new() };
    of_misfit(samples, view, known.scale, misfit)
}

fn of_misfit(samples: &[Sample<f64>], view: &View, scale: f64, misfit: Misfit) -> Vec<Line> {
    let process = Process {
        length: misfit.length,
        part: misfit.part,
        smooth: misfit.smooth > 0.5,
    };
    let one = |line: &Vec<(usize, f64)>| {
        let sample = |place: &(usize, f64)| &samples[place.0];
        let all: Option<Vec<f64>> = line.iter().map(|at| Some(signed(sample(at))? - view.offset)).collect();
        let angles = all?;
        let residual = |at: &(usize, f64)| Some(view.residual(sample(at))? / scale);
        let values: Option<Vec<f64>> = line.iter().map(residual).collect();
        let mean = smoothed(&angles, &values?, process);
        // A residual is of the model less the measurement.
        let ratios = mean
            .iter()
            .zip(line)
            .map(|(mean, at)| -mean * scale / sample(at).weight);
        Some(Line {
            theta_i: sample(line.first()?).theta_i,
            points: angles.iter().copied().zip(ratios).collect(),
            // As likely as not says nothing.
            misfit: (2.0 * misfit.smooth - 1.0).max(0.0),
        })
    };
    threads::map(&lines::of(samples), &one).into_iter().flatten().collect()
}

impl Line {
    /// That of this angle of incidence.
    pub fn at(lines: &[Line], theta_i: f64) -> Option<&Line> {
        lines.iter().find(|line| (line.theta_i - theta_i).abs() < SAME)
    }

    /// The ratio's logarithm between two samples; none outside.
    fn ratio(&self, theta_s: f64) -> Option<f64> {
        let after = self.points.partition_point(|point| point.0 < theta_s);
        let (right, left) = (self.points.get(after)?, self.points.get(after.checked_sub(1)?)?);
        let part = (theta_s - left.0) / (right.0 - left.0);
        Some(left.1 + part * (right.1 - left.1))
    }

    /// The peak of the lobe and its width, of which each standard error is what the difference from the model's adds to the error of that; none where the samples do not reach to half of the peak.
    pub fn peak(&self, material: &Material, lobe: &Material, f: Value, width: Option<Value>) -> Option<Read> {
        let ln_f = |theta_s: f64| self.ln_lobe(material, lobe, theta_s).unwrap_or(f64::NEG_INFINITY);
        let (top, _) = tops(&ln_f, self.theta_i, lobe.width());
        let ln_top = ln_f(top);
        let half = |end: f64| crossing(|theta_s| ln_f(theta_s) - (ln_top - LN_2), top, end);
        let (first, last) = (self.points.first()?.0, self.points.last()?.0);
        let (left, right) = (half(first.max(-HORIZON))?, half(last.min(HORIZON))?);
        let read = |value: f64, of_model: Value| Value {
            value,
            stderr: Real::sqrt(self.misfit / 3.0) * (value - of_model.value).abs(),
        };
        Some(Read {
            f: read(Real::portable_exp(ln_top), f),
            width: width.map(|width| read(right - left, width)),
        })
    }

    /// The lobe with all that the model lacks.
    fn ln_lobe(&self, material: &Material, lobe: &Material, theta_s: f64) -> Option<f64> {
        let sample = Sample::in_plane(self.theta_i, theta_s, 1.0);
        let lacks = Real::portable_exp(self.ratio(theta_s)?) - 1.0;
        let (all, own) = (material.ln_f(&sample)?, lobe.ln_f(&sample)?);
        let times = 1.0 + Real::portable_exp(all - own) * lacks;
        (times > 0.0).then(|| own + Real::portable_ln(times))
    }
}

/// What the samples say of a lobe where a model of another shape is fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Read {
    /// The BRDF of its peak, sr^-1; the standard error is what the difference adds to that of the model's (type B).
    pub f: Value,
    /// Its width in the same way, radians.
    pub width: Option<Value>,
}
