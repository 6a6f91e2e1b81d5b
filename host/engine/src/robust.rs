//! A fit that outliers do not draw: least squares of the samples that the most consistent fit of many leaves in.
//!
//! Starts are fits of a few samples drawn at random, among which some hold no outlier whatever the others are (Rousseeuw and Van Driessen 2006); each is drawn to where most samples agree by weights that fall to 0 (Salibian-Barrera and Yohai 2006), and the one with the least scale of all residuals wins.
//! The scale counts every sample, so that a lobe is not left out where a fit is as good with it.

mod lobe;
mod scale;
mod subset;

use brdfit_core::geometry::Sample;

use crate::error::FitError;
use crate::least_squares::{self, descend};
use crate::options::{FitOptions, Method};
use crate::outcome::Outcome;
pub use crate::outcome::Robust;
use crate::threads;
use crate::values::Values;
use scale::Biweight;

/// Residuals beyond this many scales are outliers, of many samples.
const OUTLIER: f64 = 6.0;
/// Fewer samples than this for a free parameter do not tell which of them is an outlier.
const LEAST: usize = 3;
/// Fits of a few samples.
const SUBSETS: usize = 200;
/// Candidates of each.
const CANDIDATES: u32 = 30;
/// Samples that the starts are judged by, at most.
const JUDGES: usize = 600;
/// Of these starts one by one is followed to its end.
const FOLLOWED: usize = 5;
/// Reweighted fits of each of them at most.
const STEPS: usize = 30;
/// A fit that keeps a lobe may have a scale that is larger by this factor.
const DEARER: f64 = 3.0;
/// Least-squares fits at most; the set of outliers settles after a few.
const ROUNDS: usize = 20;

/// The samples that a fit used.
pub fn kept(samples: &[Sample<f64>], outcome: &Outcome) -> Vec<Sample<f64>> {
    let outliers = outcome.robust.as_ref().map_or(&[][..], |robust| &robust.outliers);
    without(samples, outliers)
}

fn without(samples: &[Sample<f64>], outliers: &[usize]) -> Vec<Sample<f64>> {
    let kept = samples
        .iter()
        .enumerate()
        .filter(|(place, _)| outliers.binary_search(place).is_err());
    kept.map(|(_, sample)| *sample).collect()
}

/// The samples around the specular or the retro direction, nearest first, that a fit left out as too bright, if they are enough to be a lobe.
pub fn lobe_left_out(samples: &[Sample<f64>], outcome: &Outcome) -> Option<Vec<usize>> {
    let (view, robust) = (outcome.view(), outcome.robust.as_ref()?);
    let bright = |place: usize| view.residual(&samples[place]).is_some_and(|residual| residual < 0.0);
    lobe::group(samples, |place| {
        robust.outliers.binary_search(&place).is_ok() && bright(place)
    })
}

/// The least-squares fit of the samples that are no outliers; an offset is not fitted.
///
/// # Errors
/// [`FitError`].
pub(crate) fn fit(samples: &[Sample<f64>], options: &FitOptions, known: &[Values]) -> Result<Outcome, FitError> {
    let mut plain = FitOptions {
        robust: false,
        ..*options
    };
    plain.instrument.offsets = None;
    let free = options.free().count();
    let mut outcome = least_squares::fit(samples, &plain, known)?;
    let mut evaluations = outcome.evaluations;
    let counted = samples.iter().filter(|sample| sample.weight != 0.0).count();
    let mut robust = Robust {
        scale: outcome.uncertainty.scale,
        outliers: Vec::new(),
    };
    if counted >= LEAST * free.max(1) {
        let mut at = start(samples, &plain, &outcome)?;
        let threshold = threshold(counted - free);
        for _ in 0..ROUNDS {
            let is_outlier = |place: &usize| at.residuals[*place].abs() > threshold * at.scale;
            let outliers: Vec<usize> = (0..samples.len()).filter(is_outlier).collect();
            let settled = outliers == robust.outliers && outcome.robust.is_some();
            robust = Robust {
                scale: at.scale,
                outliers,
            };
            if settled {
                break;
            }
            let rest = without(samples, &robust.outliers);
            outcome = least_squares::fit(&rest, &plain, &[at.params])?;
            outcome.robust = Some(robust.clone());
            evaluations.cost += outcome.evaluations.cost;
            evaluations.linearize += outcome.evaluations.linearize;
            let residuals = residuals(samples, &plain, &outcome.params);
            let inside = residuals
                .iter()
                .zip(samples)
                .enumerate()
                .filter(|(place, (_, sample))| sample.weight != 0.0 && robust.outliers.binary_search(place).is_err());
            let scale = scale::median(inside.map(|(_, (residual, _))| residual.abs()), free);
            at = At {
                params: outcome.params,
                residuals,
                scale,
            };
        }
    }
    outcome.robust = Some(robust);
    outcome.evaluations = evaluations;
    Ok(outcome)
}

/// How many scales away an outlier is, with so many degrees of freedom: a scale of few samples may be small by chance.
fn threshold(degrees_of_freedom: usize) -> f64 {
    OUTLIER * (1.0 + 8.0 / degrees_of_freedom as f64)
}

/// A fit with the residuals of all samples.
#[derive(Clone)]
struct At {
    params: Values,
    residuals: Vec<f64>,
    scale: f64,
}

/// Where most samples agree.
fn start(samples: &[Sample<f64>], options: &FitOptions, outcome: &Outcome) -> Result<At, FitError> {
    let judges = subset::spread(samples, JUDGES);
    let free = options.free().count();
    let judge = Biweight::new(judges.len(), free);
    let short = FitOptions {
        starts: Some(CANDIDATES),
        method: Method::Default,
        ..*options
    };
    let each = threads::each(SUBSETS, &|k| {
        let few = subset::draw(&judges, options.seed, k as u64, free + 2);
        let found = least_squares::fit(&few, &short, &[])?;
        // One step tells most of what all would.
        judge.step(&judges, options, &judge.at(&judges, options, found.params))
    });
    let mut starts: Vec<At> = each.into_iter().collect::<Result<_, FitError>>()?;
    starts.push(judge.at(&judges, options, outcome.params));
    starts.extend(
        outcome
            .minima
            .iter()
            .map(|minimum| judge.at(&judges, options, minimum.params)),
    );
    starts.sort_by(|a, b| a.scale.total_cmp(&b.scale));
    starts.dedup_by(|b, a| b.scale == a.scale);
    starts.truncate(FOLLOWED);
    let judge = Biweight::new(samples.len(), free);
    let ends = threads::map(&starts, &|from| follow(samples, options, &judge, from.params));
    let ends: Vec<At> = ends.into_iter().collect::<Result<_, FitError>>()?;
    let best = ends.into_iter().min_by(|a, b| a.scale.total_cmp(&b.scale));
    let best = best.unwrap_or_else(|| judge.at(samples, options, outcome.params));
    let limit = threshold(samples.len().saturating_sub(free).max(1)) * best.scale;
    let Some(lobe) = lobe::group(samples, |place| best.residuals[place] < -limit) else {
        return Ok(best);
    };
    // Few samples make a lobe, and where most others are fitted as well without it no scale tells.
    let is_out = |place: &usize| best.residuals[*place].abs() > limit && !lobe.contains(place);
    let outliers: Vec<usize> = (0..samples.len()).filter(is_out).collect();
    let with = least_squares::fit(&without(samples, &outliers), options, &[])?;
    let with = follow(samples, options, &judge, with.params)?;
    let inside = lobe
        .iter()
        .filter(|&&place| with.residuals[place].abs() <= limit.max(OUTLIER * with.scale))
        .count();
    let keeps = 2 * inside > lobe.len() && with.scale <= DEARER * best.scale;
    Ok(if keeps { with } else { best })
}

/// Reweighted fits from given values until the scale falls no more.
fn follow(samples: &[Sample<f64>], options: &FitOptions, judge: &Biweight, params: Values) -> Result<At, FitError> {
    let mut at = judge.at(samples, options, params);
    for _ in 0..STEPS {
        let next = judge.step(samples, options, &at)?;
        let falls = next.scale < at.scale * (1.0 - 1e-6);
        if next.scale < at.scale {
            at = next;
        }
        if !falls {
            break;
        }
    }
    Ok(at)
}

/// Model less measurement in ln f, times the weight; 0 where there is no model.
fn residuals(samples: &[Sample<f64>], options: &FitOptions, params: &Values) -> Vec<f64> {
    let view = options.view(*params);
    let each = samples.iter().map(|sample| view.residual(sample).unwrap_or(0.0));
    each.collect()
}

impl Biweight {
    fn at(&self, samples: &[Sample<f64>], options: &FitOptions, params: Values) -> At {
        let residuals = residuals(samples, options, &params);
        At {
            params,
            scale: self.scale(&residuals),
            residuals,
        }
    }

    /// A fit with the weights that the residuals have.
    fn step(&self, samples: &[Sample<f64>], options: &FitOptions, from: &At) -> Result<At, FitError> {
        let weighted: Vec<Sample<f64>> = samples
            .iter()
            .zip(&from.residuals)
            .map(|(sample, residual)| Sample {
                weight: sample.weight * self.root_weight(residual / from.scale),
                ..*sample
            })
            .collect();
        let found = descend(&weighted, options, &[from.params])?;
        Ok(found.map_or_else(|| from.clone(), |(_, params)| self.at(samples, options, params)))
    }
}
