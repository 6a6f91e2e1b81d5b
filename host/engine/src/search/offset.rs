//! The angle by which all samples are shifted, fitted with the model.
//!
//! The fit is searched at several offsets, and between the best one's neighbours a search in one dimension finds where the cost of the fit is least.

use brdfit_core::geometry::Sample;

use super::beside::angles;
use crate::error::FitError;
use crate::instrument::signed;
use crate::outcome::Outcome;
use crate::values::Values;

/// Offsets at which the fit is searched, degrees; so is the one that the brightest samples tell.
const SEARCHED: [f64; 9] = [0.0, -1.0, 1.0, -2.0, 2.0, -4.0, 4.0, -8.0, 8.0];
/// The search in one dimension reaches this far to both sides of the best of them, radians.
const REACH: f64 = 0.026;
/// How often that is made again where it ended at an end, or the whole search was better.
const LOOPS: usize = 8;

/// The fit at the best offset within what is [`allowed`]; `search` and `descend` are those at an offset, the first of all minima and the second from given values alone.
pub fn fit(
    samples: &[Sample<f64>],
    (least, most): (f64, f64),
    search: impl Fn(f64, &[Values]) -> Result<Outcome, FitError>,
    descend: impl Fn(f64, &Values) -> Result<Option<(f64, Values)>, FitError>,
) -> Result<(f64, Outcome), FitError> {
    let narrow = most - least < 2.0 * REACH;
    let searched: Vec<f64> = if narrow {
        vec![0.5 * (least + most)]
    } else {
        let all = SEARCHED.iter().map(|degrees| degrees.to_radians());
        let all = all
            .chain(brightest(samples))
            .filter(|offset| (least..=most).contains(offset));
        all.collect()
    };
    let mut best: Option<(f64, Outcome)> = None;
    for offset in searched {
        let found = search(offset, &[])?;
        if best.as_ref().is_none_or(|(_, best)| found.cost < best.cost) {
            best = Some((offset, found));
        }
    }
    // A range without any of them has its nearest end.
    let (mut at, mut outcome) = match best {
        Some(best) => best,
        None => (least.max(0.0).min(most), search(least.max(0.0).min(most), &[])?),
    };
    for _ in 0..LOOPS {
        let (low, high) = ((at - REACH).max(least), (at + REACH).min(most));
        let Some((offset, lowest, params)) = along((low, high), &descend, outcome.params)? else {
            break;
        };
        at = offset;
        outcome = search(at, &[params])?;
        let goes_on = (at == low && low > least) || (at == high && high < most);
        if !goes_on && !(outcome.cost < lowest * (1.0 - 1e-6)) {
            break;
        }
    }
    Ok((at, outcome))
}

/// The least cost within a range of offsets from one start, with the values there; none if no cost is finite.
pub fn least(
    range: (f64, f64),
    descend: impl Fn(f64, &Values) -> Result<Option<(f64, Values)>, FitError>,
    start: Values,
) -> Result<Option<(f64, Values)>, FitError> {
    Ok(along(range, &descend, start)?.map(|(_, cost, values)| (cost, values)))
}

/// The least cost over the offset, each fit from the start and from where the best so far ended: offset, cost and values.
fn along(
    (low, high): (f64, f64),
    descend: &impl Fn(f64, &Values) -> Result<Option<(f64, Values)>, FitError>,
    start: Values,
) -> Result<Option<(f64, f64, Values)>, FitError> {
    let mut best = None::<(f64, f64, Values)>;
    let mut cost = |offset: f64| -> Result<f64, FitError> {
        let mut least = f64::INFINITY;
        // Far from the peak a fit may lose it, and no other should begin there.
        for from in [Some(start), best.map(|best| best.2)].into_iter().flatten() {
            if let Some((cost, values)) = descend(offset, &from)? {
                least = least.min(cost);
                if best.is_none_or(|best| cost < best.1) {
                    best = Some((offset, cost, values));
                }
            }
        }
        Ok(least)
    };
    least_between(&mut cost, low, high)?;
    Ok(best)
}

/// Where the brightest samples are against the direction of a mirror: the median over the angles of incidence, radians.
fn brightest(samples: &[Sample<f64>]) -> Option<f64> {
    let shift = |theta_i: f64| {
        let group = samples.iter().filter(|sample| (sample.theta_i - theta_i).abs() < 1e-6);
        let top = group.max_by(|a, b| a.brdf.total_cmp(&b.brdf))?;
        Some(signed(top)? - theta_i)
    };
    let mut shifts: Vec<f64> = angles(samples).into_iter().filter_map(shift).collect();
    shifts.sort_by(f64::total_cmp);
    shifts.get(shifts.len() / 2).copied()
}

/// Goes to the least value of a smooth function between two ends: by parabolas through the best three points, and by golden sections where those do not halve the way (Brent 1973).
fn least_between(
    f: &mut impl FnMut(f64) -> Result<f64, FitError>,
    mut low: f64,
    mut high: f64,
) -> Result<(), FitError> {
    /// Radians.
    const CLOSE: f64 = 1e-8;
    const STEPS: u32 = 60;
    const SHORTER: f64 = 0.381_966_011_250_105_2;
    // Where the function falls towards an end, that is the least.
    f(low)?;
    f(high)?;
    let first = low + SHORTER * (high - low);
    let mut best = (first, f(first)?);
    let (mut second, mut third) = (best, best);
    let (mut step, mut before) = (0.0f64, 0.0f64);
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if (best.0 - middle).abs() + 0.5 * (high - low) <= 2.0 * CLOSE {
            break;
        }
        let (x, w, v) = (best.0, second.0, third.0);
        let r = (x - w) * (best.1 - third.1);
        let q = (x - v) * (best.1 - second.1);
        let (mut p, mut q2) = ((x - v) * q - (x - w) * r, 2.0 * (q - r));
        if q2 > 0.0 {
            p = -p;
        }
        q2 = q2.abs();
        let good = p.abs() < (0.5 * q2 * before).abs() && p > q2 * (low - x) && p < q2 * (high - x);
        before = step;
        if good {
            step = p / q2;
        } else {
            before = if x < middle { high - x } else { low - x };
            step = SHORTER * before;
        }
        let at = if step.abs() >= CLOSE {
            x + step
        } else {
            x + CLOSE.copysign(step)
        };
        let here = (at, f(at)?);
        if here.1 <= best.1 {
            if at < x {
                high = x
            } else {
                low = x
            }
            (third, second, best) = (second, best, here);
        } else {
            if at < x {
                low = at
            } else {
                high = at
            }
            if here.1 <= second.1 || w == x {
                (third, second) = (second, here);
            } else if here.1 <= third.1 || v == x || v == w {
                third = here;
            }
        }
    }
    Ok(())
}
