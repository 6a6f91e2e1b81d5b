//! A fit with an instrument: what a single search needs to know is found around it, by several.

use brdfit_core::geometry::Sample;
use brdfit_core::model::Role;

use super::beside::angles;
use super::{Limit, Offset, View, offset};
use crate::{FitError, FitOptions, MOST, Material, Outcome, Values};

/// What one search needs to know.
#[derive(Clone, Copy, Debug)]
pub struct Setup {
    /// Standard deviation of a residual of ln f, by which priors weigh.
    pub sigma: f64,
    /// Part of each prior that counts: all of it, or for one of several scans that share the parameter the root of its share.
    pub share: [f64; MOST],
    /// The square of what is above its limit counts this much; 0 for not at all.
    pub steep: f64,
    /// The samples are shifted by an offset that is fitted.
    pub nuisance: bool,
}

impl Default for Setup {
    fn default() -> Self {
        Setup {
            sigma: 1.0,
            share: [1.0; MOST],
            steep: 0.0,
            nuisance: false,
        }
    }
}

/// Slopes below this part of the half-angle of an aperture are not told apart, and fall between the directions that stand for it.
const FINEST: f64 = 1.0 / 16.0;
/// How steep the wall before a limit is, over the cost without it, step by step.
const WALLS: [f64; 5] = [1e3, 1e5, 1e7, 1e9, 1e11];
/// Rounds for the weight of priors at most.
const ROUNDS: usize = 60;
/// Searches for it at most.
const SEARCHES: usize = 3;
/// The least standard deviation of ln f: of rounding.
const LEAST: f64 = 1e-12;
/// The weight of priors is settled when it changes by less than this part.
const SETTLED: f64 = 1e-7;

/// A fit with what the options tell of the instrument.
pub fn fit(samples: &[Sample<f64>], options: &FitOptions, known: &[Values]) -> Result<Outcome, FitError> {
    let Some(range) = options.instrument.offsets else {
        return at(samples, options, false, known);
    };
    let range = offset::allowed(samples, range)?;
    let search = |offset: f64, more: &[Values]| {
        let all: Vec<Values> = known.iter().chain(more).copied().collect();
        at(&offset::all_moved(samples, offset)?, options, true, &all)
    };
    let from = |offset: f64, start: &Values| {
        let samples = offset::all_moved(samples, offset)?;
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
    let moved = offset::all_moved(samples, value)?;
    let scale = outcome.uncertainty.scale;
    outcome.offset = Some(Offset {
        value,
        stderr: offset::stderr(&moved, &view, options, &inside, scale, sigma),
        at_bound: (value - range.0).min(range.1 - value) < 1e-9,
    });
    Ok(outcome)
}

/// The best end of fits from given values, with its cost.
pub fn descend(
    samples: &[Sample<f64>],
    options: &FitOptions,
    starts: &[Values],
) -> Result<Option<(f64, Values)>, FitError> {
    let Some(range) = options.instrument.offsets else {
        return descend_at(samples, options, starts);
    };
    let (least, most) = offset::allowed(samples, range)?;
    let mut best: Option<(f64, Values)> = None;
    for start in starts {
        let end = offset::least(
            (least, most),
            |offset, from: &Values| {
                descend_at(
                    &offset::all_moved(samples, offset)?,
                    options,
                    std::slice::from_ref(from),
                )
            },
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
                match run(samples, options, setup, &[outcome.params]) {
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

impl Setup {
    /// Finds the weight of the priors: the standard deviation that agrees with what is left of the residuals, over `left` degrees of freedom, in the fit with it.
    ///
    /// `fit` makes the fit, by a search if it is told so, and gives the sum of squared residuals of the samples.
    /// It begins where samples are off by 100 %, and so ends at the largest that agrees with itself: less would let any prior go that a few samples contradict.
    pub fn settle(&mut self, mut fit: impl FnMut(&Setup, bool) -> f64, left: usize) {
        let deviation = |cost: f64| (cost / left.max(1) as f64).sqrt().max(LEAST);
        for _ in 0..SEARCHES {
            let mut cost = fit(self, true);
            for _ in 0..ROUNDS {
                let sigma = deviation(cost);
                let settled = (sigma / self.sigma - 1.0).abs() < SETTLED;
                self.sigma = sigma;
                cost = fit(self, false);
                if settled {
                    break;
                }
            }
            let searched = fit(self, true);
            if (deviation(searched) / self.sigma - 1.0).abs() < 1e3 * SETTLED {
                break;
            }
        }
    }

    /// Makes the wall before a limit steeper until `fit`, which tells whether something is above, keeps it; false if none does.
    pub fn wall(&mut self, cost: f64, mut fit: impl FnMut(&Setup) -> bool) -> bool {
        let mut above = fit(self);
        for wall in WALLS {
            if !above {
                break;
            }
            self.steep = wall * cost.max(f64::MIN_POSITIVE);
            above = fit(self);
        }
        !above
    }
}

/// Is what is limited above 1 at an angle of incidence of the samples?
pub fn is_above(options: &FitOptions, values: Values, samples: &[Sample<f64>]) -> bool {
    let material = Material {
        model: options.model,
        values,
    };
    let Some(Limit(of)) = options.instrument.limit else {
        return false;
    };
    angles(samples)
        .into_iter()
        .any(|theta_i| of(&material, theta_i).0 > 1.0)
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
    let (options, through) = aimed(options)?;
    if through {
        return (options.model.whole.through_from)(samples, &options, &setup, starts);
    }
    let (compiled, options) = options.model.compiled(&options)?;
    (compiled.descend)(samples, &options, &setup, starts)
}

/// One search.
pub fn run(
    samples: &[Sample<f64>],
    options: &FitOptions,
    setup: &Setup,
    known: &[Values],
) -> Result<Outcome, FitError> {
    let (options, through) = aimed(options)?;
    if through {
        return (options.model.whole.through)(samples, &options, setup, known);
    }
    let (compiled, options) = options.model.compiled(&options)?;
    (compiled.fit)(samples, &options, setup, known)
}

/// The options for the scene that they need, and whether that is one through an aperture.
pub fn aimed(options: &FitOptions) -> Result<(FitOptions, bool), FitError> {
    let aperture = options.instrument.aperture;
    if aperture == 0.0 {
        return Ok((*options, false));
    }
    let mut options = options.model.whole_of(options)?;
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
