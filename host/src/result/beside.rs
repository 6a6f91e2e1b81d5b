//! What took part in a fit beside the samples, in words.

use crate::analysis::fit::FittedScan;
use crate::engine::{FitOptions, Outcome};
use crate::input::About;
use crate::number::{percent, shortest, six, two};
use crate::result::words::NOT_DETERMINED;

/// A reflectance from here on is held by `--conserve-energy`.
const HELD: f64 = 1.0 - 1e-4;
const LIMITED: &str = "the reflectance is held to at most 1 at the angles of incidence of the scan";

/// Pairs of what it is about and what there is to say.
pub fn lines(fit: &FittedScan) -> Vec<(&'static str, String)> {
    let held = fit.derived.iter().filter(|at| at.reflectance.value >= HELD);
    let held: Vec<String> = held.map(|at| six(at.theta_i.to_degrees())).collect();
    let energy = match &held[..] {
        [] => "the reflectance is below 1 without being held".into(),
        held => format!("the reflectance is held to 1 at theta_i = {} deg", held.join(", ")),
    };
    let outcome = &fit.outcome;
    let mut lines = of_outcome(outcome, &fit.about);
    lines.extend(of_options(&fit.options, outcome.sigma, energy));
    lines
}

/// The same of a fit of which no reflectance is told.
pub fn of_fit(options: &FitOptions, outcome: &Outcome, about: &About) -> Vec<(&'static str, String)> {
    let mut lines = of_outcome(outcome, about);
    lines.extend(of_options(options, outcome.sigma, LIMITED.into()));
    lines.extend(robust(outcome));
    lines
}

/// The same of several scans that are fitted together.
pub fn of_joint(options: &FitOptions) -> Vec<(&'static str, String)> {
    let mut lines = Vec::new();
    if options.with_prior().next().is_some() {
        lines.push(("priors", priors(options)));
    }
    lines.extend(of_options(options, None, LIMITED.into()));
    if options.robust {
        lines.push((
            "robust",
            "each scan is without what the robust fit of it alone leaves out".into(),
        ));
    }
    lines
}

/// What `--robust` went by.
pub fn robust(outcome: &Outcome) -> Option<(&'static str, String)> {
    let scale = six(outcome.robust.as_ref()?.scale);
    Some((
        "robust",
        format!("standard deviation {scale} of ln f; what is beyond 6 of them is left out"),
    ))
}

/// The offset that was found.
fn of_outcome(outcome: &Outcome, about: &About) -> Vec<(&'static str, String)> {
    let Some(offset) = outcome.offset else {
        return Vec::new();
    };
    let end = if offset.at_bound {
        "; at the end of what keeps all samples above the horizon, or of 10 deg"
    } else {
        ""
    };
    let value = about.counts.of_file(offset.value.to_degrees());
    let error = offset.stderr.to_degrees();
    let (size, side) = (six(value.abs()), if value < 0.0 { "little" } else { "much" });
    let what = match error.is_finite() {
        true => format!("theta_s reads {size} +- {} deg too {side}{end}", two(error)),
        false => format!("{NOT_DETERMINED}: nothing in this fit tells where theta_s is 0"),
    };
    vec![("offset", what)]
}

/// What was asked for, with the standard deviation of ln f by which priors were weighed, and what to say of a limit on energy.
fn of_options(options: &FitOptions, sigma: Option<f64>, energy: String) -> Vec<(&'static str, String)> {
    let instrument = &options.instrument;
    let mut lines = Vec::new();
    if let Some(sigma) = sigma {
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
        lines.push(("energy", energy));
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
