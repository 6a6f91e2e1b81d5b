//! The profile of one parameter and its intervals: where the cost has risen too far above the best.

use brdfit_core::real::Real;

use super::calibrate::{LEVELS, threshold, thresholds};
use super::hold::{Held, Point};
use crate::analysis::deviations::{self, Stated};
use crate::analysis::misfit;
use crate::engine::{FitError, Outcome};

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

/// The profile with intervals that refer to the best of its points; adds the points that end them. `outcome` tells the scatter of the residuals, and for `copies` see [`thresholds`].
///
/// # Errors
/// [`FitError`].
pub(super) fn referred(
    mut profile: Profile,
    held: &Held,
    outcome: &Outcome,
    copies: u32,
    stated: Option<Stated>,
) -> Result<Profile, FitError> {
    let Held {
        samples,
        options,
        index,
        ..
    } = *held;
    // The ratio of likelihoods of independent residuals, scaled to the variance that they have (Rotnitzky and Jewell 1990).
    let known = deviations::uncertainty(samples, options, outcome, stated).0;
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
    profile.intervals = nested(profile.intervals);
    Ok(profile)
}

/// The intervals, of which the wider one holds the narrower.
/// Where the rise jumps, as at the end of a valley, both end in the jump, each at its own side of it; and thresholds of copies scatter.
fn nested([narrow, wide]: [Interval; 2]) -> [Interval; 2] {
    let low = if narrow.low.value < wide.low.value {
        narrow.low
    } else {
        wide.low
    };
    let high = if narrow.high.value > wide.high.value {
        narrow.high
    } else {
        wide.high
    };
    [narrow, Interval { low, high, ..wide }]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wider_interval_holds_the_narrower() {
        let interval = |level: f64, low: f64, high: f64| {
            let end = |value: f64| End {
                value,
                at_bound: value == 0.0,
            };
            Interval {
                level,
                low: end(low),
                high: end(high),
            }
        };
        let [narrow, wide] = [interval(0.68, 0.0, 3.0), interval(0.95, 1.0, 2.0)];
        assert_eq!(nested([narrow, wide]), [narrow, interval(0.95, 0.0, 3.0)]);
        let wide = interval(0.95, 0.0, 4.0);
        assert_eq!(nested([narrow, wide]), [narrow, wide]);
    }
}
