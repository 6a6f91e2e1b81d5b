//! A zero of theta_s that is off: the angle by which all samples are shifted, fitted with the model.
//!
//! The fit is searched at several offsets, and between the best one's neighbours a search in one dimension finds where the cost of the fit is least.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::View;
use crate::{FitError, FitOptions, Outcome, Values};

/// A sample whose direction is nearer to the plane of incidence than this lies in it, as a sine: 0.1 degrees.
const IN_PLANE: f64 = 1.745e-3;
/// Samples stay this far above the horizon, radians (0.1 degrees).
const HORIZON: f64 = 0.001_745;
/// Offsets at which the fit is searched, degrees; so is the one that the brightest samples tell.
const SEARCHED: [f64; 9] = [0.0, -1.0, 1.0, -2.0, 2.0, -4.0, 4.0, -8.0, 8.0];
/// The search in one dimension reaches this far to both sides of the best of them, radians.
const REACH: f64 = 0.026;
/// How often that is made again where it ended at an end, or the whole search was better.
const LOOPS: usize = 8;

/// The offset of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset {
    /// What the instrument reads for theta_s = 0, radians, positive forward.
    pub value: f64,
    /// Its standard error, radians.
    pub stderr: f64,
    /// It is at an end of what was allowed.
    pub at_bound: bool,
}

/// Scattering angle, radians, positive forward, of a sample in the plane of incidence; none of another.
pub fn signed(sample: &Sample<f64>) -> Option<f64> {
    let (sin_phi, cos_phi) = Real::portable_sin_cos(sample.delta_phi);
    let across = Real::portable_sin_cos(sample.theta_s).0 * sin_phi;
    (across.abs() <= IN_PLANE).then_some(if cos_phi < 0.0 { sample.theta_s } else { -sample.theta_s })
}

/// The sample where it is, if the instrument reads `offset` too much; none out of plane or beyond the horizon.
pub fn moved(sample: &Sample<f64>, offset: f64) -> Option<Sample<f64>> {
    if offset == 0.0 {
        return Some(*sample);
    }
    let theta_s = signed(sample)? - offset;
    (theta_s.abs() < 0.5 * f64::PI).then(|| Sample {
        weight: sample.weight,
        ..Sample::in_plane(sample.theta_i, theta_s, sample.brdf)
    })
}

/// All samples moved.
pub fn all_moved(samples: &[Sample<f64>], offset: f64) -> Result<Vec<Sample<f64>>, FitError> {
    let each = samples.iter().enumerate();
    each.map(|(place, sample)| moved(sample, offset).ok_or(FitError::OutOfPlane(place)))
        .collect()
}

/// The part of a range of offsets that keeps every sample above the horizon.
pub fn allowed(samples: &[Sample<f64>], (least, most): (f64, f64)) -> Result<(f64, f64), FitError> {
    let (mut low, mut high) = (0.0f64, 0.0f64);
    for (place, sample) in samples.iter().enumerate() {
        let theta_s = signed(sample).ok_or(FitError::OutOfPlane(place))?;
        (low, high) = (low.min(theta_s), high.max(theta_s));
    }
    let end = 0.5 * f64::PI - HORIZON;
    let (least, most) = (least.max(high - end), most.min(low + end));
    Ok((least.min(most), most))
}

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
    let mut shifts: Vec<f64> = super::beside::angles(samples).into_iter().filter_map(shift).collect();
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

/// The derivative of each residual by the offset, and those by the solver's coordinates, of which only what is at right angles to it is known apart from it.
pub struct Nuisance<const P: usize> {
    /// J'c.
    pub cross: [f64; P],
    /// c'c.
    pub square: f64,
}

impl<const P: usize> Nuisance<P> {
    /// `gradient` gives the derivatives of ln f by the coordinates.
    pub fn new(samples: &[Sample<f64>], view: &View, gradient: impl Fn(&Sample<f64>) -> [f64; P]) -> Self {
        let mut nuisance = Nuisance {
            cross: [0.0; P],
            square: 0.0,
        };
        for sample in samples {
            let slope = sample.weight * slope(sample, view);
            let row = gradient(sample);
            nuisance.square += slope * slope;
            for k in 0..P {
                nuisance.cross[k] += slope * sample.weight * row[k];
            }
        }
        nuisance
    }
}

/// Derivative of ln f by the offset at a sample that stands where it is, per radian.
fn slope(sample: &Sample<f64>, view: &View) -> f64 {
    const STEP: f64 = 1e-5;
    let at = |offset: f64| View { offset, ..*view }.ln_f(sample);
    match (at(STEP), at(-STEP)) {
        (Some(right), Some(left)) => (right - left) / (2.0 * STEP),
        _ => 0.0,
    }
}

/// Standard error of the offset beside the parameters inside their bounds, radians, for residuals of standard deviation `scale`.
pub fn stderr(
    samples: &[Sample<f64>],
    view: &View,
    options: &FitOptions,
    inside: &[usize],
    scale: f64,
    sigma: f64,
) -> f64 {
    let rows: Vec<(f64, Option<Values>)> = samples
        .iter()
        .map(|sample| {
            let gradient = view.gradient(sample).map(|(_, gradient)| gradient);
            (sample.weight, gradient)
        })
        .collect();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    // What is left of a column beside the others (modified Gram and Schmidt).
    let rest = |basis: &[Vec<f64>], mut column: Vec<f64>| {
        for axis in basis {
            let part: f64 = column.iter().zip(axis).map(|(a, b)| a * b).sum();
            column.iter_mut().zip(axis).for_each(|(a, b)| *a -= part * b);
        }
        let length = column.iter().map(|a| a * a).sum::<f64>().sqrt();
        (column, length)
    };
    for &place in inside {
        let slope =
            |(weight, gradient): &(f64, Option<Values>)| gradient.map_or(0.0, |gradient| weight * gradient[place]);
        let mut column: Vec<f64> = rows.iter().map(slope).collect();
        let priors = options.instrument.priors.iter().enumerate();
        column.extend(priors.map(|(other, prior)| match prior {
            Some(prior) if other == place => sigma / prior.sigma,
            _ => 0.0,
        }));
        let before = column.iter().map(|a| a * a).sum::<f64>().sqrt();
        let (column, length) = rest(&basis, column);
        if length > 1e-10 * before {
            basis.push(column.into_iter().map(|a| a / length).collect());
        }
    }
    let mut column: Vec<f64> = samples
        .iter()
        .map(|sample| sample.weight * slope(sample, view))
        .collect();
    column.extend(options.instrument.priors.iter().map(|_| 0.0));
    scale / rest(&basis, column).1
}
