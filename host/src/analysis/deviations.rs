//! The standard deviations that a file gives: weights from the fitted f, and errors from them where chi^2 does not refute them.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::chance::below_chi2;
use super::choose::{self, Wanted};
use super::misfit;
use crate::engine::uncertainty::Uncertainty;
use crate::engine::{FitOptions, Outcome, Values};
use crate::input::Measurement;
use crate::input::weight::{self, Deviation};
use crate::number::{percent, two};

/// Fits until the weights are those of the fitted f.
const ROUNDS: usize = 5;
/// Weights that change by less are.
const SETTLED: f64 = 1e-3;
/// Probability of a chi^2 as far from its mean by chance, below which it refutes the standard deviations.
const REFUTED: f64 = 0.01;
/// Degrees of freedom of an error that is known.
const KNOWN: f64 = f64::INFINITY;

/// What became of the standard deviations of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// Errors are theirs.
    Used,
    /// Residuals are so many times what they should be: errors are those of the residuals.
    Refuted(f64),
    /// Errors are theirs because that was asked for; residuals are so many times what they should be.
    Absolute(f64),
    /// Residuals are rounding, which tells nothing of them, and has no errors.
    Exact,
}

impl Verdict {
    /// Its name in tables and JSON.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Used => "used",
            Verdict::Refuted(_) => "refuted",
            Verdict::Absolute(_) => "absolute",
            Verdict::Exact => "exact",
        }
    }
}

/// The scan with weights from its standard deviations over the f of its fit, and with values raised by what their noise takes from ln f on average.
///
/// A deviation over the measured f is too small where noise made f large: such samples count too much, and f comes out high by 1.5 sigma^2 (sigma being relative).
/// And ln f of a value with symmetric noise is low by sigma^2 / 2 on average, to second order ([`Deviation::of_ln`]); the noise is no larger than the residuals.
/// A scan without standard deviations stays as it is, unless its bias is to be corrected; so does one that cannot be fitted.
pub fn settled(measurement: Measurement, wanted: &Wanted) -> Measurement {
    if measurement.sigma_ln.is_none() && measurement.on_deviations.correct_ln_bias {
        return unbiased(measurement, wanted);
    }
    if measurement.sigma_ln.is_none() || measurement.deviations.is_empty() {
        return measurement;
    }
    let mut now = measurement.clone();
    let absolute = measurement.deviations.iter().any(|deviation| deviation.absolute != 0.0);
    let mut part = 1.0;
    let (samples, mut unit) = weighted(&measurement, |sample| sample.brdf, part);
    now.samples = samples;
    for _ in 0..ROUNDS {
        let Ok((_, outcome, _)) = choose::fit(&now.samples, wanted) else {
            return measurement;
        };
        if !outcome.cost.is_finite() {
            return measurement;
        }
        let known = &outcome.uncertainty;
        let (told, before) = (part, now.samples.clone());
        part = seen(known.scale / unit, known.degrees_of_freedom);
        // Relative deviations are the same over any f.
        if !absolute && part == told {
            break;
        }
        let view = outcome.view();
        let f = |sample: &Sample<f64>| view.ln_f(sample).map_or(sample.brdf, Real::portable_exp);
        let unit_before = unit;
        (now.samples, unit) = weighted(&measurement, f, part);
        let change = now.samples.iter().zip(&before);
        let change = change.map(|(sample, old)| (sample.weight / unit / (old.weight / unit_before) - 1.0).abs());
        if change.fold((part / told - 1.0).abs(), f64::max) < SETTLED {
            break;
        }
    }
    now.sigma_ln = Some(unit);
    now.about.notes.push(if part == 1.0 {
        "weights are of the standard deviations over the fitted BRDF, and ln BRDF is raised by what noise of their size takes from it on average"
            .into()
    } else {
        format!(
            "weights are of the standard deviations over the fitted BRDF; residuals are {} of them, and ln BRDF is raised by what noise of the size of the residuals takes from it on average",
            percent(part)
        )
    });
    now
}

/// The part of the standard deviations that residuals of `ratio` times them leave for noise: all of it, unless chi^2 says that it is less.
///
/// What a laboratory states can be the uncertainty of its calibration too, which moves all values together and takes nothing from ln f.
fn seen(ratio: f64, degrees_of_freedom: usize) -> f64 {
    let degrees = degrees_of_freedom as f64;
    if degrees_of_freedom > 0 && ratio < 1.0 && 2.0 * below_chi2(ratio * ratio * degrees, degrees) < REFUTED {
        ratio
    } else {
        1.0
    }
}

/// The scan with ln f raised by what symmetric noise of BRDF takes from it on average, the noise being that of the residuals of a first fit, over the weight of each sample.
///
/// Where the model misses the scan the residuals are not noise alone, and this raises ln f by too much.
fn unbiased(measurement: Measurement, wanted: &Wanted) -> Measurement {
    let Ok((_, outcome, _)) = choose::fit(&measurement.samples, wanted) else {
        return measurement;
    };
    let scale = outcome.uncertainty.scale;
    if !(scale.is_finite() && outcome.cost.is_finite()) {
        return measurement;
    }
    let low = |sample: &Sample<f64>| match sample.weight {
        0.0 => 0.0,
        weight => Deviation::of_residual(scale / weight).of_ln(1.0).1,
    };
    let mut now = measurement;
    let most = now.samples.iter().map(low).fold(0.0, f64::max);
    for sample in &mut now.samples {
        sample.brdf *= Real::portable_exp(low(sample));
    }
    now.about.notes.push(format!(
        "ln BRDF is raised by {} at most: symmetric noise of the size of the residuals, {}, takes that from it on average",
        two(most),
        percent(scale)
    ));
    now
}

/// The samples as measured, weighted by what their deviations are over `f` and raised by what noise of this part of them takes from ln f, and what a weight of 1 stands for.
fn weighted(measurement: &Measurement, f: impl Fn(&Sample<f64>) -> f64, part: f64) -> (Vec<Sample<f64>>, f64) {
    let unit = measurement.sigma_ln.unwrap_or(1.0);
    let pairs = measurement.samples.iter().zip(&measurement.deviations);
    let one = |(sample, deviation): (&Sample<f64>, &Deviation)| {
        let (sigma, low) = deviation.times(part).of_ln(f(sample));
        Sample {
            brdf: sample.brdf * Real::portable_exp(low),
            weight: sample.weight / unit * deviation.over(sample.brdf) / sigma * part,
            ..*sample
        }
    };
    let mut samples: Vec<Sample<f64>> = pairs.map(one).collect();
    let unit = weight::normalised(&mut samples);
    (samples, unit)
}

/// What a file states of the standard deviations of its values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stated {
    /// That of ln f which a weight of 1 stands for.
    pub sigma: f64,
    /// Errors are of it whatever chi^2 says.
    pub absolute: bool,
}

impl Stated {
    /// What the file of a measurement states.
    pub fn of(measurement: &Measurement) -> Option<Self> {
        Some(Stated {
            sigma: measurement.sigma_ln?,
            absolute: measurement.on_deviations.absolute,
        })
    }

    /// What residuals of a standard deviation of `scale`, of which less than `rounding` is rounding, make of it; none where they are surely `correlated`, or have no degrees of freedom.
    ///
    /// Correlated residuals are no noise, and say themselves how large errors are, unless these are to be absolute.
    pub fn verdict(
        self,
        (scale, rounding): (f64, f64),
        degrees_of_freedom: usize,
        correlated: bool,
    ) -> Option<Verdict> {
        let (degrees, ratio) = (degrees_of_freedom as f64, scale / self.sigma);
        // Errors of the deviations are those of the residuals, scaled, which nothing gives where they are 0.
        if self.absolute && scale.is_finite() && scale > 0.0 {
            return Some(Verdict::Absolute(ratio));
        }
        if degrees_of_freedom == 0 || correlated {
            return None;
        }
        if scale < rounding {
            return Some(Verdict::Exact);
        }
        let below = below_chi2(ratio * ratio * degrees, degrees);
        if 2.0 * below.min(1.0 - below) < REFUTED {
            return Some(Verdict::Refuted(ratio));
        }
        Some(Verdict::Used)
    }
}

/// The uncertainty of a fit of these samples: with the correlation of its residuals ([`misfit::uncertainty`]), or of the standard deviations that the file states; and what became of these.
pub fn uncertainty(
    samples: &[Sample<f64>],
    options: &FitOptions,
    outcome: &Outcome,
    stated: Option<Stated>,
) -> (Uncertainty, Option<Verdict>) {
    let Some(Stated { sigma, absolute }) = stated else {
        return (misfit::uncertainty(samples, options, outcome), None);
    };
    let stated = Stated { sigma, absolute };
    let known = misfit::surely(samples, options, outcome);
    let verdict = stated.verdict(
        (known.scale, known.rounding),
        known.degrees_of_freedom,
        known.misfit.is_some(),
    );
    let ratio = known.scale / sigma;
    let errors = match verdict {
        Some(Verdict::Absolute(_)) => scaled(&misfit::independent(options, outcome), ratio),
        Some(Verdict::Used) => scaled(&known, ratio),
        Some(Verdict::Refuted(_) | Verdict::Exact) | None => known,
    };
    (errors, verdict)
}

/// The errors of residuals, which are `ratio` times their standard deviations, as those of the standard deviations.
fn scaled(known: &Uncertainty, ratio: f64) -> Uncertainty {
    let scaled = |axis: &Values| axis.iter().map(|part| part / ratio).collect::<Values>();
    // What stands behind the axes of the parameters is of priors and calibration, which are no noise.
    let all = |axes: &[Values]| -> Vec<Values> {
        let (noise, calibration) = axes.split_at(known.places.len());
        noise.iter().map(scaled).chain(calibration.iter().copied()).collect()
    };
    let mut of_file = known.clone().with_axes(all(&known.axes));
    of_file.axes_lifted = all(&known.axes_lifted);
    of_file.stderr_lifted = scaled(&known.stderr_lifted);
    of_file.effective = KNOWN;
    of_file
}
