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

/// Fits `to` to the mean of `channels`, least squares of ln f over the hemisphere and near the specular direction, and then its first parameter to each of them.
///
/// No material of a renderer has a lobe of its own at the retro direction: what a model has there counts in the deviation alone, as it would raise the diffuse part everywhere.
///
/// # Errors
/// There is nothing to fit.
pub fn refit(channels: &[Model], to: &'static engine::Model) -> Result<Refit, Error> {
    let [specular, all_over, retro] = directions(channels)?;
    let fitted_at = [specular, all_over].concat();
    let f = |model: &Model, at: &Sample<f64>| model.f(at.theta_i, at.theta_s, at.delta_phi);
    let seen = |directions: &[Sample<f64>], f: &dyn Fn(&Sample<f64>) -> f64| -> Vec<Sample<f64>> {
        let samples = directions.iter().map(|at| Sample { brdf: f(at), ..*at });
        samples.filter(|sample| sample.brdf > DARK).collect()
    };
    let fit = |samples: &[Sample<f64>], options: &FitOptions| {
        let outcome = engine::fit(samples, options);
        outcome.map_err(|error| Error::new(format!("{} cannot be fitted to this model: {error}", to.name)))
    };
    let mean = |at: &Sample<f64>| channels.iter().map(|model| f(model, at)).sum::<f64>() / channels.len() as f64;
    let common = fit(&seen(&fitted_at, &mean), &FitOptions::of(to))?.params;
    let mut deviations = Vec::new();
    let mut fitted = Vec::new();
    for model in channels {
        let mut values = common;
        if channels.len() > 1 {
            let mut options = FitOptions::of(to);
            // All but the colour are those of the mean.
            options.lower[1..].copy_from_slice(&common[1..]);
            options.upper[1..].copy_from_slice(&common[1..]);
            values = fit(&seen(&fitted_at, &|at| f(model, at)), &options)?.params;
        }
        let near = Material { model: to, values };
        let all = [&fitted_at[..], &retro].concat();
        deviations.extend(seen(&all, &|at| f(model, at)).iter().map(|sample| {
            let near = near.ln_f(sample);
            near.map_or(-1.0, |ln_f| libm::exp(ln_f) / sample.brdf - 1.0)
        }));
        fitted.push(values);
    }
    Ok(Refit {
        channels: fitted,
        deviation: sentence(channels, &deviations),
    })
}

fn sentence(channels: &[Model], deviations: &[f64]) -> String {
    let colours = match channels {
        [red, green, blue] => format!("red is {}, green {} and blue {}; ", red.name, green.name, blue.name),
        _ => String::new(),
    };
    let percent = |of: f64| 100.0 * of;
    let least = deviations.iter().copied().fold(0.0, f64::min);
    let most = deviations.iter().copied().fold(0.0, f64::max);
    let mut sizes: Vec<f64> = deviations.iter().map(|off| off.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let half = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
    format!(
        "{colours}against the fitted model {:+.1} to {:+.1} %, half within {:.1} %, at {DIRECTIONS} pairs of directions up to {LARGEST} deg",
        percent(least),
        percent(most),
        percent(half)
    )
}

/// Directions near the specular one, all over the hemisphere, and near the retro one, a third each.
fn directions(channels: &[Model]) -> Result<[Vec<Sample<f64>>; 3], Error> {
    let widths = channels.iter().map(|model| model.material.width());
    let width = widths.reduce(f64::min).ok_or_else(|| Error::new("there is no model"))?;
    let width = 3.0 * libm::atan(width).to_degrees();
    // Two irrational steps, which never fall into a grid.
    let part = |k: u32, step: f64| (f64::from(k) * step).fract();
    let mut parts = [const { Vec::new() }; 3];
    for k in 0..DIRECTIONS {
        let theta_i = LARGEST * f64::from(k) / f64::from(DIRECTIONS - 1);
        let (u, v) = (part(k, 0.754_877_666_246_692_8), part(k, 0.569_840_290_998_053_3));
        let near = |peak: f64| (peak + (2.0 * u - 1.0) * width).clamp(-LARGEST, LARGEST);
        let (place, theta_s, phi) = match k % 3 {
            0 => (0, near(theta_i), 180.0),
            1 => (2, near(-theta_i), 180.0),
            _ => (1, LARGEST * u, 360.0 * v),
        };
        parts[place].push(Sample {
            delta_phi: f64::to_radians(phi),
            ..Sample::in_plane(theta_i.to_radians(), theta_s.to_radians(), 1.0)
        });
    }
    Ok(parts)
}
