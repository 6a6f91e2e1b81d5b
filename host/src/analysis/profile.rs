//! Profile likelihood: the cost over one parameter, minimised over the others, and the intervals that follow.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use rayon::prelude::*;

use super::misfit;
use crate::engine::{self, FitError, FitOptions, Outcome};

pub mod calibrate;
pub mod findings;
pub mod hold;

use calibrate::{LEVELS, threshold};
use hold::{Held, Point};

/// Each step away from the best value is longer than the last by this factor.
const GROWTH: f64 = 1.25;

/// An end of an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// The value there, dimensionless.
    pub value: f64,
    /// It is the bound of the parameter: the data do not end the interval.
    pub at_bound: bool,
}

/// The values that the data do not refute at a level; where some between them are refuted too, the hull.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Confidence, 0 to 1.
    pub level: f64,
    /// Least value.
    pub low: End,
    /// Largest value.
    pub high: End,
}

/// The profile of one parameter.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Profile {
    /// Place of the parameter among those of the model.
    pub index: usize,
    /// Its name.
    pub name: &'static str,
    /// The least cost of all points.
    pub best: Point,
    /// In order of value.
    pub points: Vec<Point>,
    /// Samples less parameters inside their bounds.
    pub degrees_of_freedom: usize,
    /// The rises that end the intervals: those of the F test, with the correlation of the residuals.
    pub limits: [f64; 2],
    /// At [`LEVELS`].
    pub intervals: [Interval; 2],
}

impl Profile {
    /// Rise of the cost of a point above the best, over the variance of a residual; dimensionless.
    pub fn rise(&self, point: &Point) -> f64 {
        if point.cost == self.best.cost {
            return 0.0;
        }
        (point.cost - self.best.cost) / self.best.cost * self.degrees_of_freedom as f64
    }
}

/// Profiles of several parameters, all of the best fit that any of them meets.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Profiles {
    /// That fit.
    pub outcome: Outcome,
    /// The cost of the fit that was given, if a profile met a better one.
    pub improved_from: Option<f64>,
    /// One for each parameter.
    pub list: Vec<Profile>,
}

/// A point is better than the fit if its cost is lower by more than this part.
const BETTER: f64 = 1e-6;
/// Better fits that are begun from, at most.
const RESTARTS: usize = 8;

/// Profiles the parameters in these places; where a point is better than the fit, the fit goes on from there and the profiles are made again.
///
/// The threads of the current rayon pool share them, and change no bit; for `copies` see [`profile`].
///
/// # Errors
/// [`FitError`].
pub fn profiles(
    samples: &[Sample<f64>],
    options: &FitOptions,
    outcome: Outcome,
    places: &[usize],
    copies: u32,
) -> Result<Profiles, FitError> {
    let mut outcome = outcome;
    let mut improved_from = None;
    for restart in 0.. {
        // Copies take most of the time, and are made when the fit is sure.
        let mut list = list(samples, options, &outcome, places, 0)?;
        if copies > 0 && least(&list).is_none_or(|point| !is_better(samples, options, &point, &outcome)) {
            list = self::list(samples, options, &outcome, places, copies)?;
        }
        let better = least(&list).filter(|point| is_better(samples, options, point, &outcome));
        let Some(better) = better.filter(|_| restart < RESTARTS) else {
            return Ok(Profiles {
                outcome,
                improved_from,
                list,
            });
        };
        improved_from = improved_from.or(Some(outcome.cost));
        outcome = engine::fit_from(samples, options, &[better.params, outcome.params])?;
    }
    unreachable!("the last restart returns")
}

fn list(
    samples: &[Sample<f64>],
    options: &FitOptions,
    outcome: &Outcome,
    places: &[usize],
    copies: u32,
) -> Result<Vec<Profile>, FitError> {
    let each = places.par_iter();
    each.map(|&place| profile(samples, options, outcome, place, copies))
        .collect()
}

/// The best point of all profiles.
fn least(list: &[Profile]) -> Option<Point> {
    let points = list.iter().flat_map(|profile| &profile.points);
    points.min_by(|a, b| a.cost.total_cmp(&b.cost)).copied()
}

/// Is a point better than a fit, by more than what rounding to `f32` may have left?
fn is_better(samples: &[Sample<f64>], options: &FitOptions, point: &Point, outcome: &Outcome) -> bool {
    let exact = engine::descend(samples, options, &[outcome.params]).ok().flatten();
    point.cost < exact.map_or(outcome.cost, |(cost, _)| cost) * (1.0 - BETTER)
}

/// Profiles parameter `index` of the model from bound to bound, starting from a fit of these samples with these options; in `f64`.
///
/// Each point is the best of fits from its neighbours on both sides, from the minima of the fit, and from a search of its own.
/// The intervals are those of the F test, with the correlation of the residuals, or with `copies` those of [`calibrate::thresholds`] at the ends that the F test gives.
///
/// # Errors
/// [`FitError`].
pub fn profile(
    samples: &[Sample<f64>],
    options: &FitOptions,
    outcome: &Outcome,
    index: usize,
    copies: u32,
) -> Result<Profile, FitError> {
    let degrees_of_freedom = outcome.uncertainty.degrees_of_freedom;
    // The ratio of likelihoods of independent residuals, scaled to the variance that they have (Rotnitzky and Jewell 1990).
    let known = misfit::uncertainty(samples, outcome);
    let inflation = misfit::inflation(&known, &outcome.uncertainty, index);
    let limits = LEVELS.map(|level| inflation * threshold(level, known.effective.max(1.0)));
    let held = Held::new(samples, options, outcome, index);
    let (lower, upper) = (options.lower[index], options.upper[index]);
    let at = outcome.params[index];
    // What rounding to f32 has left is made up here.
    let (cost, params) =
        engine::descend(samples, options, &[outcome.params])?.unwrap_or((outcome.cost, outcome.params));
    let best = Point {
        value: params[index],
        cost,
        params,
    };
    let first = first_step(outcome, index, upper - lower);
    let mut points = vec![best];
    for end in [lower, upper] {
        let mut side: Vec<Point> = Vec::new();
        for value in outward(at, end, first) {
            let from = side.last().unwrap_or(&best);
            let point = held.at(value, &[from.params], true)?;
            side.push(point);
        }
        // Back again: a better valley that was met farther out may reach in.
        for k in (1..side.len()).rev() {
            let again = held.at(side[k - 1].value, &[side[k].params], false)?;
            if again.cost < side[k - 1].cost {
                side[k - 1] = again;
            }
        }
        points.extend(side);
    }
    points.sort_by(|a, b| a.value.total_cmp(&b.value));
    points.dedup_by(|b, a| a.value == b.value);
    let mut profile = Profile {
        index,
        name: options.model.parameters[index].name,
        best: *points.iter().min_by(|a, b| a.cost.total_cmp(&b.cost)).unwrap_or(&best),
        points,
        degrees_of_freedom,
        limits,
        intervals: LEVELS.map(|level| Interval {
            level,
            low: End {
                value: lower,
                at_bound: true,
            },
            high: End {
                value: upper,
                at_bound: true,
            },
        }),
    };
    // The wider first: on its way it may meet values that belong to the narrower.
    for (k, limit) in limits.into_iter().enumerate().rev() {
        for high in [false, true] {
            let mut value = crossing(&mut profile, &held, limit, high)?;
            if copies > 0 {
                let at = value.unwrap_or(if high { upper } else { lower });
                let null = profile.points.iter().find(|point| point.value == at).unwrap_or(&best);
                let scale = outcome.uncertainty.scale;
                let limits = calibrate::thresholds(samples, options, index, &null.params, scale, copies)?;
                value = crossing(&mut profile, &held, inflation * limits[k], high)?;
            }
            if let Some(value) = value {
                let end = End { value, at_bound: false };
                let interval = &mut profile.intervals[k];
                *(if high { &mut interval.high } else { &mut interval.low }) = end;
            }
        }
    }
    Ok(profile)
}

/// A first step that is short against the standard error, if there is one, and the value itself.
fn first_step(outcome: &Outcome, index: usize, range: f64) -> f64 {
    let error = outcome.uncertainty.stderr[index];
    let own = 0.05 * outcome.params[index].abs().max(1e-3 * range);
    if error > 0.0 { own.min(0.5 * error) } else { own }
}

/// Values from `at`, exclusive, to `end`, inclusive, in growing steps.
fn outward(at: f64, end: f64, first: f64) -> Vec<f64> {
    const MOST: usize = 200;
    let (mut values, mut step, mut away) = (Vec::new(), first, first);
    while away < 0.95 * (end - at).abs() && values.len() < MOST {
        values.push(at + away * (end - at).signum());
        step *= GROWTH;
        away += step;
    }
    if end != at {
        values.push(end);
    }
    values
}

/// Where the rise passes `limit` outermost on one side; adds the points it makes. `None` if it does not before the bound.
fn crossing(profile: &mut Profile, held: &Held, limit: f64, high: bool) -> Result<Option<f64>, FitError> {
    const ROUNDS: usize = 30;
    const CLOSE: f64 = 1e-4;
    let mut order: Vec<Point> = profile.points.clone();
    if !high {
        order.reverse();
    }
    let Some(last) = order.iter().rposition(|point| profile.rise(point) <= limit) else {
        return Ok(None);
    };
    let Some(mut outside) = order.get(last + 1).copied() else {
        return Ok(None);
    };
    let mut inside = order[last];
    for _ in 0..ROUNDS {
        // The root of the rise is nearly linear in the parameter.
        let root = |rise: f64| Real::sqrt(rise.max(0.0));
        let (a, b) = (root(profile.rise(&inside)), root(profile.rise(&outside).min(1e6)));
        let part = ((root(limit) - a) / (b - a)).clamp(0.05, 0.95);
        let value = inside.value + part * (outside.value - inside.value);
        let point = held.at(value, &[inside.params, outside.params], false)?;
        profile.points.push(point);
        if profile.rise(&point) <= limit {
            inside = point;
        } else {
            outside = point;
        }
        let gap = (outside.value - inside.value).abs();
        if (root(profile.rise(&point)) / root(limit) - 1.0).abs() < CLOSE || gap < CLOSE * CLOSE * value.abs() {
            inside = point;
            break;
        }
    }
    profile.points.sort_by(|a, b| a.value.total_cmp(&b.value));
    Ok(Some(inside.value))
}
