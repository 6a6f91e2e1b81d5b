//! A prior that the scan contradicts.

use brdfit_core::geometry::Sample;

use crate::analysis::misfit;
use crate::engine::{self, FitOptions, Outcome};
use crate::number::{four, two};

/// The prior and what the samples say without any differ by more than this many standard deviations of the difference.
const CLEARLY: f64 = 4.0;

/// The parameters whose priors the samples contradict, with what they say without priors, in words.
pub fn contradicted(samples: &[Sample<f64>], options: &FitOptions, outcome: &Outcome) -> Option<String> {
    options.with_prior().next()?;
    let mut without = *options;
    without.instrument.priors.fill(None);
    let mut found = engine::fit_from(samples, &without, &[outcome.params]).ok()?;
    found.uncertainty = misfit::uncertainty(samples, &without, &found);
    let one = |place: usize| {
        let prior = options.instrument.priors[place]?;
        let (value, error) = (found.params[place], found.uncertainty.stderr[place]);
        let apart = (value - prior.mean).abs() / libm::hypot(prior.sigma, error);
        let known = error > 0.0 && error.is_finite();
        (known && apart > CLEARLY).then(|| {
            format!(
                "without it {} is {} +- {}, {apart:.0} standard deviations from {}",
                options.model.parameters[place].name,
                four(value),
                two(error),
                prior.mean
            )
        })
    };
    let all: Vec<String> = options.with_prior().filter_map(one).collect();
    (!all.is_empty()).then(|| all.join("; "))
}
