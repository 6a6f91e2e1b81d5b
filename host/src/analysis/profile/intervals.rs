//! The intervals of a profile: where the cost has risen too far above the best.

use brdfit_core::real::Real;

use super::calibrate::{LEVELS, threshold, thresholds};
use super::hold::{Held, Point};
use super::{End, Profile};
use crate::analysis::misfit;
use crate::engine::{FitError, Outcome};

/// The profile with intervals that refer to the best of its points; adds the points that end them. `outcome` tells the scatter of the residuals, and for `copies` see [`super::profile`].
///
/// # Errors
/// [`FitError`].
pub(super) fn referred(mut profile: Profile, held: &Held, outcome: &Outcome, copies: u32) -> Result<Profile, FitError> {
    let Held {
        samples,
        options,
        index,
        ..
    } = *held;
    // The ratio of likelihoods of independent residuals, scaled to the variance that they have (Rotnitzky and Jewell 1990).
    let known = misfit::uncertainty(samples, outcome);
    let inflation = misfit::inflation(&known, &outcome.uncertainty, index);
    profile.degrees_of_freedom = outcome.uncertainty.degrees_of_freedom;
    profile.limits = LEVELS.map(|level| inflation * threshold(level, known.effective.max(1.0)));
    let (lower, upper) = (options.lower[index], options.upper[index]);
    let order = |a: &Point, b: &Point| a.value.total_cmp(&b.value).then(a.cost.total_cmp(&b.cost));
    profile.points.sort_by(order);
    profile.points.dedup_by(|b, a| a.value == b.value);
    let best = profile.points.iter().min_by(|a, b| a.cost.total_cmp(&b.cost));
    profile.best = *best.unwrap_or(&profile.best);
    // The wider first: on its way it may meet values that belong to the narrower.
    for (k, limit) in profile.limits.into_iter().enumerate().rev() {
        for high in [false, true] {
            let mut value = crossing(&mut profile, held, limit, high)?;
            let bound = if high { upper } else { lower };
            if copies > 0 {
                let at = value.unwrap_or(bound);
                let null = profile.points.iter().find(|point| point.value == at);
                let null = null.unwrap_or(&profile.best);
                let scale = outcome.uncertainty.scale;
                let limits = thresholds(samples, options, index, &null.params, scale, copies)?;
                value = crossing(&mut profile, held, inflation * limits[k], high)?;
            }
            let end = End {
                value: value.unwrap_or(bound),
                at_bound: value.is_none(),
            };
            let interval = &mut profile.intervals[k];
            *(if high { &mut interval.high } else { &mut interval.low }) = end;
        }
    }
    Ok(profile)
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
