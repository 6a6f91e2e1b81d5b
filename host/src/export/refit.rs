//! A fitted model, fitted again with a model that a renderer has.

use brdfit_core::geometry::Sample;

use super::model::Model;
use crate::engine::{self, FitOptions, Material, Values};
use crate::error::Error;

/// Pairs of directions that are compared, up to 85 degrees from the normal.
const DIRECTIONS: u32 = 1000;
/// The largest angle from the normal, degrees.
const LARGEST: f64 = 85.0;
/// A BRDF below this does not count, sr^-1.
const DARK: f64 = 1e-9;

/// The nearest values of another model, one a channel.
pub struct Refit {
    /// Values of the other model's parameters for each channel; they differ in the first one alone.
    pub channels: Vec<Values>,
    /// How far it is off, as a sentence.
    pub deviation: String,
}

/// Fits `to` to the mean of `channels`, least squares of ln f over the hemisphere, and then its first parameter to each of them.
///
/// # Errors
/// There is nothing to fit.
pub fn refit(channels: &[Model], to: &'static engine::Model) -> Result<Refit, Error> {
    let directions = directions(channels)?;
    let f = |model: &Model, at: &Sample<f64>| model.f(at.theta_i, at.theta_s, at.delta_phi);
    let seen = |f: &dyn Fn(&Sample<f64>) -> f64| -> Vec<Sample<f64>> {
        let samples = directions.iter().map(|at| Sample { brdf: f(at), ..*at });
        samples.filter(|sample| sample.brdf > DARK).collect()
    };
    let fit = |samples: &[Sample<f64>], options: &FitOptions| {
        let outcome = engine::fit(samples, options);
        outcome.map_err(|error| Error::new(format!("{} cannot be fitted to this model: {error}", to.name)))
    };
    let mean = |at: &Sample<f64>| channels.iter().map(|model| f(model, at)).sum::<f64>() / channels.len() as f64;
    let common = fit(&seen(&mean), &FitOptions::of(to))?.params;
    let mut range = (0.0f64, 0.0f64);
    let mut fitted = Vec::new();
    for model in channels {
        let samples = seen(&|at| f(model, at));
        let mut values = common;
        if channels.len() > 1 {
            let mut options = FitOptions::of(to);
            // All but the colour are those of the mean.
            options.lower[1..].copy_from_slice(&common[1..]);
            options.upper[1..].copy_from_slice(&common[1..]);
            values = fit(&samples, &options)?.params;
        }
        let near = Material { model: to, values };
        for sample in &samples {
            let off = near
                .ln_f(sample)
                .map_or(-1.0, |ln_f| libm::exp(ln_f) / sample.brdf - 1.0);
            range = (range.0.min(off), range.1.max(off));
        }
        fitted.push(values);
    }
    Ok(Refit {
        channels: fitted,
        deviation: format!(
            "against the fitted model {:+.1} to {:+.1} % at {DIRECTIONS} pairs of directions up to {LARGEST} deg",
            100.0 * range.0,
            100.0 * range.1
        ),
    })
}

/// A third of the directions near the specular one, a third near the retro one, the others all over the hemisphere.
fn directions(channels: &[Model]) -> Result<Vec<Sample<f64>>, Error> {
    let widths = channels.iter().map(|model| model.material.width());
    let width = widths.reduce(f64::min).ok_or_else(|| Error::new("there is no model"))?;
    let width = 3.0 * libm::atan(width).to_degrees();
    // Two irrational steps, which never fall into a grid.
    let part = |k: u32, step: f64| (f64::from(k) * step).fract();
    let direction = |k: u32| {
        let theta_i = LARGEST * f64::from(k) / f64::from(DIRECTIONS - 1);
        let (u, v) = (part(k, 0.754_877_666_246_692_8), part(k, 0.569_840_290_998_053_3));
        let near = |peak: f64| (peak + (2.0 * u - 1.0) * width).clamp(-LARGEST, LARGEST);
        let (theta_s, phi) = match k % 3 {
            0 => (near(theta_i), 180.0),
            1 => (near(-theta_i), 180.0),
            _ => (LARGEST * u, 360.0 * v),
        };
        Sample {
            delta_phi: f64::to_radians(phi),
            ..Sample::in_plane(theta_i.to_radians(), theta_s.to_radians(), 1.0)
        }
    };
    Ok((0..DIRECTIONS).map(direction).collect())
}
