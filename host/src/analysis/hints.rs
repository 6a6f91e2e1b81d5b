//! What a person who knows scatterometers would say of a scan or a fit, each from the data.

mod curve;
mod offset;
mod peak;
mod prior;
mod shadow;
mod unmeasured;

use brdfit_core::geometry::Sample;
use serde::Serialize;

use super::copies::copies;
use crate::engine::scale::Scale;
use crate::engine::{FitOptions, Outcome, robust};
use crate::input::kind::Kind;
use crate::input::units::{Forward, Quantity};
use crate::input::{Measurement, side};
use crate::number::four;

/// A hint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Hint {
    /// What it is about, as a word for programs.
    pub about: &'static str,
    /// What a person would say.
    pub text: String,
}

impl Hint {
    fn new(about: &'static str, text: String) -> Hint {
        Hint { about, text }
    }
}

/// A residual from which on another model is worth a try.
const LARGE: f64 = 0.3;

/// What the samples alone tell, before any fit.
pub fn of_scan(measurement: &Measurement) -> Vec<Hint> {
    let mut hints = before_fit(measurement);
    hints.extend(offset::of_peaks(&measurement.samples).map(|degrees| {
        Hint::new(
            "offset",
            format!("the peaks are at theta_i {degrees:+.2} deg at every angle of incidence: is the zero of an axis off by that?"),
        )
    }));
    hints
}

/// What the samples tell apart from their peaks.
fn before_fit(measurement: &Measurement) -> Vec<Hint> {
    let mut hints = Vec::new();
    let copies = copies(&measurement.samples);
    if copies > 0 {
        let (rows, are) = if copies == 1 {
            ("row", "is a copy")
        } else {
            ("rows", "are copies")
        };
        hints.push(Hint::new(
            "copies",
            format!("{copies} {rows} {are} of others, with the same direction and value: they count as measured anew, which makes errors too small if they were not"),
        ));
    }
    hints.extend(side::other_side(&measurement.samples).map(|times| {
        let other = match measurement.read_as.forward {
            Forward::Positive => "negative",
            Forward::Negative => "positive",
        };
        Hint::new(
            "side",
            format!(
                "opposite to the specular direction the values are {times:.2} times those around it: --forward {other}?"
            ),
        )
    }));
    hints.extend(peak::at_normal(&measurement.samples).map(|theta_i| {
        Hint::new(
            "peak",
            format!("the values peak at theta_s = 0 for theta_i = {theta_i} deg: is theta_s counted from the specular direction? then add theta_i to it"),
        )
    }));
    if measurement.about.asked.forward.is_none() && measurement.about.kind != Kind::Own {
        hints.extend(peak::behind(&measurement.samples).map(|theta_i| {
            Hint::new(
                "side",
                format!("all samples are on the side of incidence and peak where theta_s = -theta_i, at theta_i = {theta_i} deg: if that is the specular peak, --forward negative"),
            )
        }));
    }
    hints.extend(shadow::width(&measurement.samples).map(|degrees| {
        Hint::new(
            "shadow",
            format!("the values drop within {degrees} deg of the direction of incidence, where a detector blocks the beam: --mask-retro {degrees}?"),
        )
    }));
    hints
}

/// What the samples and their fit tell together; the reflectances are those at each angle of incidence.
pub fn of_fit(measurement: &Measurement, options: &FitOptions, outcome: &Outcome, reflectances: &[f64]) -> Vec<Hint> {
    let mut hints = before_fit(measurement);
    hints.extend(unit(&measurement.samples, options));
    hints.extend(quantity(measurement, options, outcome, reflectances));
    let moved = match outcome.offset {
        Some(_) => None,
        None => offset::confirmed(measurement, options, outcome),
    };
    hints.extend(moved.map(|(degrees, rms)| {
        Hint::new(
            "offset",
            format!(
                "the peaks are at theta_i {degrees:+.2} deg at every angle of incidence; with {:+.2} deg added to theta_s the residual would be {:.1} % in place of {:.1} %: is the zero of an axis off? --fit-offset fits that angle too",
                -degrees,
                100.0 * rms,
                100.0 * outcome.rms_ln
            ),
        )
    }));
    hints.extend(lobe_left_out(&measurement.samples, outcome).map(|(count, degrees)| {
        Hint::new(
            "robust",
            format!("--robust left out {count} samples side by side at the specular or retro direction of theta_i = {degrees} deg, which are brighter than the fit: if they are a peak of the material, fit without it"),
        )
    }));
    hints.extend(unmeasured::specular(&measurement.samples).map(|degrees| {
        Hint::new(
            "range",
            format!("no sample is within {degrees:.0} deg of the specular direction: a narrow lobe there would not be seen, and the reflectance is without it"),
        )
    }));
    if unmeasured::lobes_coincide(&measurement.samples, options) {
        hints.push(Hint::new(
            "lobes",
            "at normal incidence the surface and the volume lobe are in one direction, and this scan tells them apart by the model alone: --terms diffuse,surface or --terms diffuse,volume says which is there, or measure at another theta_i too".to_string(),
        ));
    }
    hints.extend(
        prior::contradicted(&measurement.samples, options, outcome)
            .map(|how| Hint::new("prior", format!("the scan contradicts a prior: {how}"))),
    );
    if outcome.rms_ln >= LARGE {
        hints.push(Hint::new(
            "model",
            format!(
                "the residual is {:.0} %: brdfit compare shows whether another model fits better",
                100.0 * outcome.rms_ln
            ),
        ));
    }
    hints
}

/// Is the BRDF of a size that no surface has, so that it has another unit?
fn unit(samples: &[Sample<f64>], options: &FitOptions) -> Option<Hint> {
    let scale = Scale::of(&[samples], options)?;
    let largest = samples.iter().map(|sample| sample.brdf).fold(0.0, f64::max);
    scale.is_of_another_unit().then(|| {
        Hint::new(
            "unit",
            format!(
                "the largest BRDF is {} per steradian, which no surface has: the weights are in the unit of the file, whichever that is, and so are their bounds if no others were given",
                four(largest)
            ),
        )
    })
}

/// Are the values a reflectance factor, or not calibrated? More light comes back than went in, and not only by a lobe: rho_d is on its bound, or near 1 and the excess clear at all angles of incidence.
fn quantity(measurement: &Measurement, options: &FitOptions, outcome: &Outcome, reflectances: &[f64]) -> Option<Hint> {
    const BRIGHT: f64 = 0.8;
    const CLEARLY: f64 = 1.2;
    let least = reflectances.iter().copied().fold(f64::INFINITY, f64::min);
    let most = reflectances.iter().copied().fold(0.0, f64::max);
    let place = outcome.model.place("rho_d")?;
    let (rho_d, upper) = (outcome.params[place], options.upper[place]);
    let on_bound = outcome.at_bound.contains(&"rho_d") && rho_d >= upper && upper >= 1.0;
    if reflectances.is_empty() || !(on_bound && most > 1.0 || rho_d >= BRIGHT && least > CLEARLY) {
        return None;
    }
    let bound = if on_bound { "rho_d is on its bound and " } else { "" };
    let begin = format!("{bound}the reflectance is {most:.2}");
    let darkest = measurement
        .samples
        .iter()
        .map(|sample| sample.brdf)
        .fold(f64::INFINITY, f64::min);
    let is_brdf = measurement.read_as.quantity == Quantity::Brdf;
    // As a reflectance factor the darkest direction must be possible.
    Some(Hint::new(
        "quantity",
        if is_brdf && darkest <= 1.1 {
            format!("{begin}: are the values reflectance factors, --quantity brf?")
        } else {
            format!("{begin}: are the values calibrated, and in which unit?")
        },
    ))
}

/// How many samples that may be a lobe a robust fit left out, and the angle of incidence of the nearest to its peak, degrees.
fn lobe_left_out(samples: &[Sample<f64>], outcome: &Outcome) -> Option<(usize, f64)> {
    let lobe = robust::lobe_left_out(samples, outcome)?;
    let theta_i = samples[*lobe.first()?].theta_i.to_degrees();
    Some((lobe.len(), (theta_i * 1e4).round() / 1e4))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{self, robust::Robust};

    #[test]
    fn a_lobe_that_a_robust_fit_left_out_is_seen() {
        let brdf = |theta_s: i32| {
            if (theta_s - 30).abs() <= 3 {
                50.0
            } else {
                0.1 + 0.001 * f64::from(theta_s % 7)
            }
        };
        let samples: Vec<Sample<f64>> = (-80..=80)
            .map(|theta_s| Sample::in_plane(30f64.to_radians(), f64::from(theta_s).to_radians(), brdf(theta_s)))
            .collect();
        let dark: Vec<Sample<f64>> = samples.iter().filter(|sample| sample.brdf < 1.0).copied().collect();
        let mut outcome = engine::fit(&dark, &FitOptions::default()).unwrap();
        let mut seen = |outliers: Vec<usize>| {
            outcome.robust = Some(Robust { scale: 0.01, outliers });
            lobe_left_out(&samples, &outcome)
        };
        assert_eq!(seen((107..=113).collect()), Some((7, 30.0)));
        // Scattered outliers, a few beside the peak, and many elsewhere are no lobe.
        assert_eq!(seen((0..160).step_by(3).collect()), None);
        assert_eq!(seen(vec![109, 110, 111]), None);
        assert_eq!(seen((20..40).collect()), None);
        outcome.robust = None;
        assert_eq!(lobe_left_out(&samples, &outcome), None);
    }
}
