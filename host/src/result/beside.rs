//! What took part in a fit beside the samples, in words.

use crate::analysis::fit::FittedScan;
use crate::engine::FitOptions;
use crate::number::{percent, shortest, six, two};
use crate::result::words::NOT_DETERMINED;

/// A reflectance from here on is held by `--conserve-energy`.
const HELD: f64 = 1.0 - 1e-4;

/// Pairs of what it is about and what there is to say.
pub fn lines(fit: &FittedScan) -> Vec<(&'static str, String)> {
    let (outcome, options) = (&fit.outcome, &fit.options);
    let instrument = &options.instrument;
    let mut lines = Vec::new();
    if let Some(offset) = outcome.offset {
        let end = if offset.at_bound {
            "; at the end of what keeps all samples above the horizon, or of 10 deg"
        } else {
            ""
        };
        let value = fit.about.counts.of_file(offset.value.to_degrees());
        let error = offset.stderr.to_degrees();
        let (size, side) = (six(value.abs()), if value < 0.0 { "little" } else { "much" });
        lines.push((
            "offset",
            match error.is_finite() {
                true => format!("theta_s reads {size} +- {} deg too {side}{end}", two(error)),
                false => format!("{NOT_DETERMINED}: nothing in this fit tells where theta_s is 0"),
            },
        ));
    }
    if let Some(sigma) = outcome.sigma {
        let weighed = format!("weighed by {} of f a sample", percent(sigma));
        lines.push(("priors", format!("{}; {weighed}", priors(options))));
    }
    if instrument.aperture > 0.0 {
        let degrees = shortest((instrument.aperture.to_degrees() * 1e9).round() / 1e9);
        lines.push((
            "aperture",
            format!("the model is averaged over a half-angle of {degrees} deg"),
        ));
    }
    if instrument.scale_uncertainty > 0.0 {
        let part = percent(instrument.scale_uncertainty);
        lines.push(("scale", format!("a calibration known to {part} is part of the errors")));
    }
    if instrument.limit.is_some() {
        let held = fit.derived.iter().filter(|at| at.reflectance.value >= HELD);
        let held: Vec<String> = held.map(|at| six(at.theta_i.to_degrees())).collect();
        lines.push((
            "energy",
            if held.is_empty() {
                "the reflectance is below 1 without being held".into()
            } else {
                format!("the reflectance is held to 1 at theta_i = {} deg", held.join(", "))
            },
        ));
    }
    lines
}

/// The priors that take part, with commas between; empty without any.
pub fn priors(options: &FitOptions) -> String {
    let each = options.with_prior().filter_map(|place| {
        let prior = options.instrument.priors[place]?;
        let name = options.model.parameters[place].name;
        Some(format!(
            "{name} = {} +- {}",
            shortest(prior.mean),
            shortest(prior.sigma)
        ))
    });
    each.collect::<Vec<_>>().join(", ")
}
