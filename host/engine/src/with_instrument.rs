//! A fit with an instrument: what a single search needs to know is found around it, by several.

use brdfit_core::geometry::Sample;
use brdfit_core::model::Role;

use crate::compiled::{self, Searches};
use crate::error::FitError;
use crate::instrument::moved::{all_moved, allowed};
use crate::instrument::{Offset, View};
use crate::options::FitOptions;
use crate::outcome::Outcome;
use crate::search::beside::{darkened, is_above};
use crate::search::setup::{LEAST, Setup, WALLS};
use crate::search::{nuisance, offset};
use crate::values::Values;

/// Slopes below this part of the half-angle of an aperture are not told apart, and fall between the directions that stand for it.
const FINEST: f64 = 1.0 / 16.0;

/// A fit with what the options tell of the instrument.
pub(crate) fn fit(samples: &[Sample<f64>], options: &FitOptions, known: &[Values]) -> Result<Outcome, FitError> {
    let Some(range) = options.instrument.offsets else {
        return at(samples, options, false, known);
    };
    let range = allowed(samples, range)?;
    let search = |offset: f64, more: &[Values]| {
        let all: Vec<Values> = known.iter().chain(more).copied().collect();
        at(&all_moved(samples, offset)?, options, true, &all)
    };
    let from = |offset: f64, start: &Values| {
        let samples = all_moved(samples, offset)?;
        descend_at(&samples, options, std::slice::from_ref(start))
    };
    let (value, mut outcome) = offset::fit(samples, range, search, from)?;
    let view = View {
        material: outcome.material(),
        aperture: options.instrument.aperture,
        offset: 0.0,
    };
    let inside: Vec<usize> = outcome.uncertainty.inside().collect();
    let sigma = outcome.sigma.unwrap_or(1.0);
    let moved = all_moved(samples, value)?;
    let scale = outcome.uncertainty.scale;
    outcome.offset = Some(Offset {
        value,
        stderr: nuisance::stderr(&moved, &view, options, &inside, scale, sigma),
        at_bound: (value - range.0).min(range.1 - value) < 1e-9,
    });
    Ok(outcome)
}

/// The best end of fits from given values, with its cost.
pub(crate) fn descend(
    samples: &[Sample<f64>],
    options: &FitOptions,
    starts: &[Values],
) -> Result<Option<(f64, Values)>, FitError> {
    let Some(range) = options.instrument.offsets else {
        return descend_at(samples, options, starts);
    };
    let (least, most) = allowed(samples, range)?;
    let mut best: Option<(f64, Values)> = None;
    for start in starts {
        let end = offset::least(
            (least, most),
            |offset, from: &Values| descend_at(&all_moved(samples, offset)?, options, std::slice::from_ref(from)),
            *start,
        )?;
        if let Some(end) = end.filter(|end| best.is_none_or(|best| end.0 < best.0)) {
            best = Some(end);
        }
    }
    Ok(best)
}

/// A fit of samples where they are.
fn at(samples: &[Sample<f64>], options: &FitOptions, nuisance: bool, known: &[Values]) -> Result<Outcome, FitError> {
    let mut setup = Setup {
        nuisance,
        sigma: options.instrument.sigma.unwrap_or(1.0),
        ..Setup::default()
    };
    let mut outcome = run(samples, options, &setup, known)?;
    if options.prior_count() > 0 && options.instrument.sigma.is_none() {
        let rows = samples.len() + options.prior_count();
        let left = rows.saturating_sub(options.free().count());
        let mut failed = Ok(());
        setup.settle(
            |setup, again| {
                let found = if again {
                    run(samples, options, setup, &[outcome.params])
                } else {
                    run_from(samples, options, setup, &outcome)
                };
                match found {
                    Ok(found) => outcome = found,
                    Err(error) => failed = Err(error),
                }
                square(outcome.rms_ln) * outcome.samples as f64
            },
            left,
        );
        failed?;
    }
    if options.instrument.limit.is_some() {
        let mut failed = Ok(());
        let cost = outcome.cost;
        let kept = setup.wall(cost, |setup| {
            if setup.steep > 0.0 {
                // Before the wall, what is darker by a factor is a better start than what the wall has to push down.
                let darker = darkened(options, outcome.params, samples);
                match run(samples, options, setup, &[outcome.params, darker]) {
                    Ok(found) => outcome = found,
                    Err(error) => failed = Err(error),
                }
            }
            is_above(options, outcome.params, samples)
        });
        failed?;
        if !kept {
            return Err(FitError::Limit);
        }
    }
    outcome.sigma = (options.prior_count() > 0).then_some(setup.sigma);
    Ok(outcome)
}

/// The same fit with another weight of the priors, from its values alone.
fn run_from(
    samples: &[Sample<f64>],
    options: &FitOptions,
    setup: &Setup,
    outcome: &Outcome,
) -> Result<Outcome, FitError> {
    let one = FitOptions {
        starts: Some(1),
        ..*options
    };
    run(samples, &one, setup, &[outcome.params])
}

/// Standard deviation of a residual whose sum of squares over the samples is `cost`.
fn deviation(options: &FitOptions, samples: usize, cost: f64) -> f64 {
    let rows = samples + options.prior_count();
    let left = rows.saturating_sub(options.free().count()).max(1);
    (cost / left as f64).sqrt().max(LEAST)
}

/// The best end of fits of samples where they are.
fn descend_at(
    samples: &[Sample<f64>],
    options: &FitOptions,
    starts: &[Values],
) -> Result<Option<(f64, Values)>, FitError> {
    let mut setup = Setup::default();
    let cost = |values: &Values| {
        let view = options.view(*values);
        samples
            .iter()
            .filter_map(|sample| view.residual(sample))
            .map(square)
            .sum::<f64>()
    };
    let least = || starts.iter().map(cost).fold(f64::INFINITY, f64::min);
    if options.prior_count() > 0 {
        setup.sigma = options
            .instrument
            .sigma
            .unwrap_or_else(|| deviation(options, samples.len(), least()));
    }
    if options.instrument.limit.is_some() {
        setup.steep = WALLS[2] * least().max(f64::MIN_POSITIVE);
    }
    let (searches, options) = searches(options)?;
    let end = searches.descend(samples, &options, &setup, starts)?;
    // Where no way leads below the limit, an end may be above it.
    Ok(end.filter(|(_, values)| !is_above(&options, *values, samples)))
}

/// One search.
pub(crate) fn run(
    samples: &[Sample<f64>],
    options: &FitOptions,
    setup: &Setup,
    known: &[Values],
) -> Result<Outcome, FitError> {
    let (searches, options) = searches(options)?;
    searches.fit(samples, &options, setup, known)
}

/// The searches that `options` need, and the options for them.
fn searches(options: &FitOptions) -> Result<(&'static dyn Searches, FitOptions), FitError> {
    let (options, through) = aimed(options)?;
    if through {
        return Ok((compiled::whole(options.model), options));
    }
    compiled::set_of(&options)
}

/// The options for the scene that they need, and whether that is one through an aperture.
pub(crate) fn aimed(options: &FitOptions) -> Result<(FitOptions, bool), FitError> {
    let aperture = options.instrument.aperture;
    if aperture == 0.0 {
        return Ok((*options, false));
    }
    let mut options = options.held()?;
    for (place, parameter) in options.model.parameters.iter().enumerate() {
        let finest = FINEST * aperture;
        if parameter.role == Role::Slope && options.lower[place] < finest && finest < options.upper[place] {
            options.lower[place] = finest;
        }
    }
    Ok((options, true))
}

fn square(x: f64) -> f64 {
    x * x
}
