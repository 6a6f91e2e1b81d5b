//! Profile likelihood: the cost over one parameter, minimised over the others, and the intervals that follow.

use brdfit_core::geometry::Sample;

use super::deviations::Stated;
use crate::engine::threads;
use crate::engine::uncertainty::{UNKNOWN, Uncertainty};
use crate::engine::{self, FitError, FitOptions, Outcome};

pub mod calibrate;
pub mod findings;
pub mod hold;
mod intervals;

use calibrate::LEVELS;
use hold::{Held, Point};
use intervals::referred;
pub use intervals::{End, Interval, Profile};

/// Each step away from the best value is longer than the last by this factor.
const GROWTH: f64 = 1.25;

/// The standard error of a parameter beside its profile; none where it has none, on a bound, or where nothing tells it.
pub fn stderr(index: usize, known: &Uncertainty) -> Option<f64> {
    let error = known.stderr[index];
    // What is rounding of an error without limit is none.
    (error > 0.0 && error < UNKNOWN * f64::EPSILON).then_some(error)
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

/// A point is worth profiles anew if its cost is lower by more than this part.
const BETTER: f64 = 1e-6;
/// A point is below the fit if its cost is lower by more than this part; what is less is rounding, or the end of a valley.
const BELOW: f64 = 1e-9;
/// Better fits that profiles are made anew for, at most.
const RESTARTS: usize = 8;

/// Profiles the parameters in these places; where a point is better than the fit, the fit goes on from there and the profiles are made again.
/// After eight times they are not, but the intervals still refer to the best fit: no point of any profile is below it.
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
    stated: Option<Stated>,
) -> Result<Profiles, FitError> {
    restarted(samples, options, outcome, places, copies, stated, RESTARTS)
}

/// The same with so many restarts.
fn restarted(
    samples: &[Sample<f64>],
    options: &FitOptions,
    outcome: Outcome,
    places: &[usize],
    copies: u32,
    stated: Option<Stated>,
    restarts: usize,
) -> Result<Profiles, FitError> {
    let mut found = Profiles {
        outcome,
        improved_from: None,
        list: Vec::new(),
    };
    let mut restart = 0;
    loop {
        // Copies take most of the time, and are made when the fit is sure.
        found.list = list(samples, options, &found.outcome, places, 0, stated)?;
        if copies > 0 && found.lower(samples, options, BETTER).is_none() {
            found.list = list(samples, options, &found.outcome, places, copies, stated)?;
        }
        let Some(better) = found.lower(samples, options, BETTER).filter(|_| restart < restarts) else {
            break;
        };
        found.adopt(samples, options, &better)?;
        restart += 1;
    }
    // The ends of intervals can be below the fit again that they are sought from, but lower each time. In `f32` a fit may stay above its point.
    let mut least = f64::INFINITY;
    while let Some(better) = found.lower(samples, options, BELOW).filter(|point| point.cost < least) {
        least = better.cost;
        found.adopt(samples, options, &better)?;
        let outcome = &found.outcome;
        let anew = |profile: &Profile| around(profile.clone(), samples, options, outcome, copies, stated);
        found.list = threads::try_map(&found.list, &anew)?;
    }
    Ok(found)
}

impl Profiles {
    /// The best point of all profiles if it is below the fit by more than this part, and by more than what rounding to `f32` may have left.
    fn lower(&self, samples: &[Sample<f64>], options: &FitOptions, part: f64) -> Option<Point> {
        let points = self.list.iter().flat_map(|profile| &profile.points);
        let least = points.min_by(|a, b| a.cost.total_cmp(&b.cost))?;
        let exact = engine::descend(samples, options, &[self.outcome.params]).ok().flatten();
        let cost = exact.map_or(self.outcome.cost, |(cost, _)| cost);
        (least.cost < cost * (1.0 - part)).then_some(*least)
    }

    /// Goes on from a better point.
    fn adopt(&mut self, samples: &[Sample<f64>], options: &FitOptions, better: &Point) -> Result<(), FitError> {
        let before = self.outcome.cost;
        self.outcome = engine::fit_from(samples, options, &[better.params, self.outcome.params])?;
        if self.outcome.cost < before * (1.0 - BETTER) {
            self.improved_from = self.improved_from.or(Some(before));
        }
        Ok(())
    }
}

fn list(
    samples: &[Sample<f64>],
    options: &FitOptions,
    outcome: &Outcome,
    places: &[usize],
    copies: u32,
    stated: Option<Stated>,
) -> Result<Vec<Profile>, FitError> {
    let one = |&place: &usize| profile(samples, options, outcome, place, copies, stated);
    threads::try_map(places, &one)
}

/// The points of a profile with a better fit that was met beside it, and the intervals that refer to that.
fn around(
    mut profile: Profile,
    samples: &[Sample<f64>],
    options: &FitOptions,
    outcome: &Outcome,
    copies: u32,
    stated: Option<Stated>,
) -> Result<Profile, FitError> {
    let held = Held::new(samples, options, outcome, profile.index);
    profile.points.push(exact(samples, options, outcome, profile.index)?);
    referred(profile, &held, outcome, copies, stated)
}

/// The point of a fit; what rounding to `f32` has left is made up.
fn exact(samples: &[Sample<f64>], options: &FitOptions, outcome: &Outcome, index: usize) -> Result<Point, FitError> {
    let (cost, params) =
        engine::descend(samples, options, &[outcome.params])?.unwrap_or((outcome.cost, outcome.params));
    Ok(Point {
        value: params[index],
        cost,
        params,
    })
}

/// Profiles parameter `index` of the model from bound to bound, starting from a fit of these samples with these options; in `f64`.
///
/// Each point is the best of fits from its neighbours on both sides, from the minima of the fit, and from a search of its own.
/// The intervals are those of the F test, with the correlation of the residuals; or those that the stated standard deviations give, as far as chi^2 does not refute them; or with `copies` those of [`calibrate::thresholds`] at the ends that the F test gives.
///
/// # Errors
/// [`FitError`].
pub fn profile(
    samples: &[Sample<f64>],
    options: &FitOptions,
    outcome: &Outcome,
    index: usize,
    copies: u32,
    stated: Option<Stated>,
) -> Result<Profile, FitError> {
    let held = Held::new(samples, options, outcome, index);
    let (lower, upper) = (options.lower[index], options.upper[index]);
    let at = outcome.params[index];
    let best = exact(samples, options, outcome, index)?;
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
    let whole = |value| End { value, at_bound: true };
    let profile = Profile {
        index,
        name: options.model.parameters[index].name,
        best,
        points,
        degrees_of_freedom: outcome.uncertainty.degrees_of_freedom,
        limits: [0.0; 2],
        intervals: LEVELS.map(|level| Interval {
            level,
            low: whole(lower),
            high: whole(upper),
        }),
    };
    referred(profile, &held, outcome, copies, stated)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Method;
    use crate::input::{ReadOptions, parse};

    #[test]
    fn no_point_is_below_the_fit_when_profiles_are_not_made_anew() {
        let table = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/testdata2_sym_seed1.csv"));
        let samples = &parse("scan", table, &ReadOptions::default()).unwrap()[0].samples;
        let options = FitOptions::default();
        let least = engine::fit(samples, &options).unwrap().cost;
        let lazy = FitOptions {
            method: Method::Paper,
            starts: Some(1),
            ..options
        };
        let poor = engine::fit(samples, &lazy).unwrap();
        assert!(poor.cost > 1.1 * least, "{} {least}", poor.cost);
        // Places of rho_d and m.
        let found = restarted(samples, &options, poor.clone(), &[0, 3], 0, None, 0).unwrap();
        assert_eq!(found.improved_from, Some(poor.cost));
        for profile in &found.list {
            for point in &profile.points {
                assert!(found.outcome.cost <= point.cost * (1.0 + BELOW));
                assert!(profile.best.cost <= point.cost);
            }
            assert!((profile.best.cost / found.outcome.cost - 1.0).abs() <= BELOW);
            let at = found.outcome.params[profile.index];
            for interval in profile.intervals {
                assert!(
                    (interval.low.value..=interval.high.value).contains(&at),
                    "{interval:?} {at}"
                );
                for end in [interval.low, interval.high].into_iter().filter(|end| !end.at_bound) {
                    let at = profile.points.iter().find(|point| point.value == end.value).unwrap();
                    let limit = profile.limits[usize::from(interval.level == LEVELS[1])];
                    assert!((profile.rise(at) / limit - 1.0).abs() < 1e-3);
                }
            }
        }
    }
}
