//! Parametric bootstrap: the same scan measured again and again, in the computer.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

use super::misfit::lines;
use crate::engine::threads;
use crate::engine::uncertainty::Misfit;
use crate::engine::{self, FitError, FitOptions, Outcome, Values, View};

/// Random numbers of copy `copy` of `seed`: a function of both alone, whatever thread draws them.
#[derive(Clone, Debug)]
pub struct Noise(Xoshiro256PlusPlus);

impl Noise {
    /// The generator of one copy.
    pub fn new(seed: u64, copy: u64) -> Self {
        // The golden ratio's odd multiples, as in SplitMix64, which spreads them over the state.
        let mixed = seed ^ copy.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        Noise(Xoshiro256PlusPlus::seed_from_u64(mixed))
    }

    /// Uniform in 0 to 1.
    pub fn unit(&mut self) -> f64 {
        f64::unit(self.0.next_u64())
    }

    /// Standard normal (Box and Muller 1958).
    pub fn normal(&mut self) -> f64 {
        let radius = Real::sqrt(-2.0 * Real::portable_ln(1.0 - self.unit()));
        radius * Real::portable_sin_cos(std::f64::consts::TAU * self.unit()).1
    }
}

/// What is seen at the angles of `samples`, with normal errors of ln f of standard deviation `scale` over the sample's weight.
pub fn copy(samples: &[Sample<f64>], view: impl Into<View>, scale: f64, noise: &mut Noise) -> Vec<Sample<f64>> {
    let errors = samples.iter().map(|_| noise.normal()).collect();
    with_errors(samples, &view.into(), scale, errors)
}

/// The same with errors that are correlated along each line of angles as the residuals of a fit are.
///
/// Different lines have nothing in common here, and the correlation is exponential at its mean length.
pub fn correlated_copy(
    samples: &[Sample<f64>],
    view: impl Into<View>,
    scale: f64,
    misfit: &Misfit,
    noise: &mut Noise,
) -> Vec<Sample<f64>> {
    let mut errors: Vec<f64> = samples.iter().map(|_| noise.normal()).collect();
    let [wander, own] = [misfit.part, 1.0 - misfit.part].map(|part| Real::sqrt(misfit.variance * part));
    for line in lines::of(samples) {
        let mut state = noise.normal();
        let mut before = None;
        for (place, angle) in line {
            let kept = before.map_or(1.0, |before: f64| Real::portable_exp((before - angle) / misfit.length));
            state = kept * state + Real::sqrt(1.0 - kept * kept) * noise.normal();
            errors[place] = wander * state + own * errors[place];
            before = Some(angle);
        }
    }
    with_errors(samples, &view.into(), scale, errors)
}

/// What is seen with these errors, in units of `scale` over the sample's weight.
fn with_errors(samples: &[Sample<f64>], view: &View, scale: f64, errors: Vec<f64>) -> Vec<Sample<f64>> {
    // The exponential is a normal number within this.
    const LARGEST_LN: f64 = 700.0;
    let one = |(sample, error): (&Sample<f64>, f64)| {
        let ln_f = view.ln_f(sample).unwrap_or(0.0);
        let weight = if sample.weight == 0.0 { 1.0 } else { sample.weight };
        let ln_f = ln_f + scale / weight * error;
        Sample {
            brdf: Real::portable_exp(ln_f.clamp(-LARGEST_LN, LARGEST_LN)),
            ..*sample
        }
    };
    samples.iter().zip(errors).map(one).collect()
}

/// The parameters of `count` copies, whose errors are correlated where `outcome` says that residuals are, each searched anew and from those of the scan, in order of the copies; the threads of the current rayon pool share them, and change no bit.
///
/// # Errors
/// [`FitError`].
pub fn bootstrap(
    samples: &[Sample<f64>],
    options: &FitOptions,
    outcome: &Outcome,
    count: u32,
) -> Result<Vec<Values>, FitError> {
    let one = |k: u32| {
        let mut noise = Noise::new(options.seed, u64::from(k));
        let (view, scale) = (outcome.view(), outcome.uncertainty.scale);
        let copy = match &outcome.uncertainty.misfit {
            Some(misfit) => correlated_copy(samples, view, scale, misfit, &mut noise),
            None => copy(samples, view, scale, &mut noise),
        };
        let options = redrawn(options, &outcome.params, &mut noise);
        Ok(engine::fit_from(&copy, &options, &[outcome.params])?.params)
    };
    threads::try_each(count as usize, &|k| one(k as u32))
}

/// The options with the priors measured again too, of a material with these values.
pub fn redrawn(options: &FitOptions, values: &Values, noise: &mut Noise) -> FitOptions {
    let mut options = *options;
    for (prior, value) in options.instrument.priors.iter_mut().zip(values.iter()) {
        if let Some(prior) = prior {
            prior.mean = value + prior.sigma * noise.normal();
        }
    }
    options
}

/// The value below which this share of `values` lies, between two of them linearly; NaN if there are none.
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = share * sorted.len().saturating_sub(1) as f64;
    let (below, above) = (place.floor() as usize, place.ceil() as usize);
    match (sorted.get(below), sorted.get(above)) {
        (Some(&a), Some(&b)) => a + (b - a) * (place - below as f64),
        _ => f64::NAN,
    }
}
