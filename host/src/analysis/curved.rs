//! Errors along valleys that are not straight.
//!
//! Where fits are as good along a curve of parameters, the covariance at the best of them tells how far the curve goes along its tangent there, and of a parameter that the tangent does not move it tells a small error, which is none.
//! Here the curve is followed: one parameter, or the offset of theta_s, is held at values farther and farther from the best, the others fitted, and what the F test at 95 % does not refute is in the errors.

use brdfit_core::geometry::Sample;
use brdfit_core::model::Role;
use brdfit_core::uncertainty::Place;

use super::misfit::coverage_factor;
use super::profile::hold::Held;
use super::undetermined::open;
use crate::engine::instrument::moved;
use crate::engine::{self, FitOptions, Outcome, Values};
use crate::until::until;

/// Each step along a curve is longer than the last by this factor.
const GROWTH: f64 = 1.5;
/// A step of a parameter at first, as a part of it or of 1.
const FIRST: f64 = 0.05;
/// Steps of an offset at most, radians: half a degree.
const TURN: f64 = 0.5 * std::f64::consts::PI / 180.0;

/// The fit of these samples with errors that hold along its curves; `variance` is that of a residual, by the residuals or by the file.
///
/// The index of refraction is behind Fresnel's reflectance, in which n and kappa stand for each other along a circle: where one of them is open, the other is told as far as it stays where it is when the first is moved.
/// An offset of theta_s shares what a scan at one angle of incidence tells of the shape of its peak with all else.
pub fn settled(samples: &[Sample<f64>], options: &FitOptions, mut outcome: Outcome, variance: f64) -> Outcome {
    let known = &outcome.uncertainty;
    let factor = coverage_factor(known);
    let inflation = known.misfit.map_or(1.0, |misfit| misfit.factor.1 * misfit.factor.1);
    let rise = factor * factor * variance * inflation.max(1.0);
    if !(rise.is_finite() && rise > 0.0) || known.scale < known.rounding || until().is_over() {
        return outcome;
    }
    let plain = options.settled(&outcome);
    match outcome.offset {
        Some(_) => along_offset(samples, &plain, &mut outcome, rise, factor),
        None => along_index(samples, &plain, &mut outcome, rise, factor),
    }
    outcome
}

/// How far each parameter goes among fits that are not refuted.
struct Reach {
    from: Values,
    far: Values,
}

impl Reach {
    fn of(outcome: &Outcome) -> Reach {
        Reach {
            from: outcome.params,
            far: Values::from_fn(outcome.params.len(), |_| 0.0),
        }
    }

    fn add(&mut self, params: &Values) {
        for (place, far) in self.far.iter_mut().enumerate() {
            *far = far.max((params[place] - self.from[place]).abs());
        }
    }

    /// Puts it into the errors of these parameters: along a straight line it is what they are.
    fn widen(&self, outcome: &mut Outcome, places: &[usize], factor: f64) {
        let known = &mut outcome.uncertainty;
        for &place in places {
            let error = self.far[place] / factor;
            known.stderr[place] = known.stderr[place].max(error);
            known.stderr_lifted[place] = known.stderr_lifted[place].max(error);
        }
    }
}

/// Values from `from`, exclusive, to `end`, inclusive, in growing steps of at most `most`.
fn outward(from: f64, end: f64, first: f64, most: f64) -> impl Iterator<Item = f64> {
    let step = move |&(value, step): &(f64, f64)| {
        let left: f64 = end - value;
        let next = if left.abs() <= step {
            end
        } else {
            value + step * left.signum()
        };
        (value != end).then_some((next, (GROWTH * step).min(most)))
    };
    std::iter::successors(Some((from, first)), step)
        .skip(1)
        .map(|(value, _)| value)
}

/// Follows each open part of the index of refraction, for the parts that seem to be told.
fn along_index(samples: &[Sample<f64>], options: &FitOptions, outcome: &mut Outcome, rise: f64, factor: f64) {
    let parameters = outcome.model.parameters;
    let names: Vec<&str> = open(&outcome.material(), &outcome.uncertainty).collect();
    let of_index = options
        .free()
        .filter(|&place| matches!(parameters[place].role, Role::Index | Role::Absorption));
    let (free, told): (Vec<usize>, Vec<usize>) = of_index.partition(|&place| names.contains(&parameters[place].name));
    let inside = |place: &usize| outcome.uncertainty.places[*place] == Some(Place::Inside);
    let told: Vec<usize> = told.into_iter().filter(inside).collect();
    if free.is_empty() || told.is_empty() {
        return;
    }
    let mut reach = Reach::of(outcome);
    for &place in &free {
        let held = Held::new(samples, options, outcome, place);
        for end in [options.lower[place], options.upper[place]] {
            let (best, mut params) = (outcome.params[place], outcome.params);
            for value in outward(best, end, FIRST * best.max(1.0), f64::INFINITY) {
                let Ok(point) = held.at(value, &[params], false) else {
                    break;
                };
                params = point.params;
                // Beyond a wall there may be a valley that fits as well.
                if point.cost - outcome.cost <= rise {
                    reach.add(&params);
                }
            }
        }
    }
    reach.widen(outcome, &told, factor);
}

/// Follows the offset to both ends of its range.
fn along_offset(samples: &[Sample<f64>], options: &FitOptions, outcome: &mut Outcome, rise: f64, factor: f64) {
    let (Some(mut offset), Some((least, most))) = (outcome.offset, options.instrument.offsets) else {
        return;
    };
    if !(offset.stderr.is_finite() && offset.stderr > 0.0) {
        return;
    }
    let mut without = *options;
    without.instrument.offsets = None;
    let mut reach = Reach::of(outcome);
    let (mut far, mut ended) = (0.0f64, true);
    for end in [least, most] {
        let (mut params, mut last) = (outcome.params, true);
        for value in outward(offset.value, end, offset.stderr.min(TURN), TURN) {
            // None is beyond the horizon.
            let turned: Option<Vec<Sample<f64>>> = samples.iter().map(|sample| moved(sample, value)).collect();
            let Some(turned) = turned else { break };
            let Ok(Some((cost, fitted))) = engine::descend(&turned, &without, &[params, outcome.params]) else {
                last = true;
                break;
            };
            params = fitted;
            last = cost - outcome.cost <= rise;
            if last {
                far = far.max((value - offset.value).abs());
                reach.add(&params);
            }
        }
        ended &= !last || end == offset.value;
    }
    // What reaches an end of the range is not told by the scan.
    let error = far / factor;
    offset.stderr = if ended { offset.stderr.max(error) } else { f64::INFINITY };
    outcome.offset = Some(offset);
    let inside: Vec<usize> = outcome.uncertainty.inside().collect();
    reach.widen(outcome, &inside, factor);
}
