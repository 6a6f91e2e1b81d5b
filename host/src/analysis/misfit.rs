//! Standard errors where the residuals of neighbours are alike: they wander with the angle where the model does not fit, or where the instrument drifts.
//!
//! The residuals along each line of angles are taken for a stationary process whose correlation falls exponentially with the angle, and noise of each sample beside it ([`process`]).
//! The likelihood of what the fit leaves of them (REML, Patterson and Thompson 1971) says how long the correlation reaches and how large a part it is; the fit itself stays that of least squares, whose covariance is the sandwich `(J'J)^-1 J'VJ (J'J)^-1` with the process's covariance V.
//! A sum of weighted autocovariances (Newey and West 1987) needs many correlation lengths in a scan, and a scan has three to ten: the likelihood does not lose what the fit has taken out of the residuals.
//! The covariance is the mean over all lengths and parts, by their likelihood; how much it varies among them widens the tails ([`mixture`]), as fewer degrees of freedom do.

mod along;
mod crossed;
mod lanes;
pub mod likelihood;
pub mod lines;
pub mod mixture;
pub mod nodes;
mod priors;
pub mod process;
pub mod rows;
pub mod sandwich;
pub mod smoothed;

use std::cell::Cell;

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use brdfit_core::uncertainty::Place;

use super::profile::calibrate::threshold;
use super::unseen;
use crate::engine::uncertainty::{Misfit, Uncertainty, along};
use crate::engine::{FitOptions, Outcome, Values, View};
use along::Along;
use mixture::Student;
use nodes::Node;
use priors::Priors;
use process::{Process, Residuals};
use rows::{Rows, UNIT};

/// ln of the likelihood must be above that of independence by more than this, which four in ten scans with independent errors reach; below it errors are those of independent residuals.
///
/// The mean over all processes counts independence too, so that the errors of such scans grow little. With more evidence asked for, a wander that white noise hides would be passed over: of scans of 35 samples few show it.
pub const EVIDENCE: f64 = 0.0;
/// It must be surer to be called a fact, where one process stands for all, and to speak against a file's standard deviations: 4 % of scans with independent errors reach this.
pub const SURE: f64 = 2.0;
/// Of an axis that is known from a prior the samples' part; less is rounding.
const LITTLE: f64 = 1e-6;

/// The uncertainty of a fit of these samples, with the correlation of its residuals if independence is refuted, and none if it is exact.
///
/// What priors leave open stands behind the axes of the parameters.
pub fn uncertainty(samples: &[Sample<f64>], options: &FitOptions, outcome: &Outcome) -> Uncertainty {
    with_evidence(samples, options, outcome, EVIDENCE)
}

/// The same, but of residuals whose correlation is sure: what is only likely does not speak against standard deviations that a file gives.
pub fn surely(samples: &[Sample<f64>], options: &FitOptions, outcome: &Outcome) -> Uncertainty {
    with_evidence(samples, options, outcome, SURE)
}

/// The uncertainty with independent residuals.
pub fn independent(options: &FitOptions, outcome: &Outcome) -> Uncertainty {
    Priors::of(options, outcome).apart(&outcome.uncertainty)
}

fn with_evidence(samples: &[Sample<f64>], options: &FitOptions, outcome: &Outcome, evidence: f64) -> Uncertainty {
    let known = &outcome.uncertainty;
    let priors = Priors::of(options, outcome);
    corrected(samples, &outcome.view(), known, &priors, evidence)
        .unwrap_or_else(|| unseen::doubted(&priors.apart(known)))
}

/// So many standard errors are the half of a 95 % interval: Student's t of the effective degrees of freedom; infinite without any.
pub fn coverage_factor(known: &Uncertainty) -> f64 {
    thread_local! {
        /// The last degrees of freedom that were asked for, and their factor: the same are asked for several times a fit, and of a million samples each takes tenths of a second.
        static LAST: Cell<(f64, f64)> = const { Cell::new((f64::NAN, f64::NAN)) };
    }
    let degrees = known.effective;
    let (last, factor) = LAST.get();
    if last == degrees {
        return factor;
    }
    let factor = Real::sqrt(threshold(0.95, degrees));
    LAST.set((degrees, factor));
    factor
}

/// By how much correlation and the uncertainty of the calibration raise the variance of parameter `index` of the same fit with independent residuals; that of the least known if it has none itself.
pub fn inflation(known: &Uncertainty, independent: &Uncertainty, index: usize) -> f64 {
    let count = independent.places.len();
    // What the engine has behind the axes of the parameters is the calibration, which the samples do not show.
    let noise = match independent.axes.get(..count) {
        Some(noise) if independent.axes.len() > count => along(
            noise,
            &Values::from_fn(count, |place| f64::from(u8::from(place == index))),
        ),
        _ => independent.stderr[index],
    };
    let own = known.stderr[index] / noise;
    let most = known.misfit.map_or(1.0, |misfit| misfit.factor.1);
    let factor = if own.is_finite() && own > 0.0 { own } else { most };
    factor * factor
}

/// `None` where independence is not refuted, or nothing can be said.
fn corrected(
    samples: &[Sample<f64>],
    view: &View,
    known: &Uncertainty,
    priors: &Priors,
    evidence: f64,
) -> Option<Uncertainty> {
    let (rows, all, seen) = of_fit(samples, view, known, !priors.is_empty())?;
    let nodes = nodes::nodes(&all, known.degrees_of_freedom, evidence)?;
    Some(with(&rows, known, &seen, &nodes, priors))
}

/// The samples along their lines, the residuals with the rows of J along the axes of the parameters inside their bounds that can be told from rounding, and the places of these; `None` if there are none, or nothing can be said.
///
/// Along an axis that is known from `priors` too, the samples need not say much.
fn of_fit<'a>(
    samples: &'a [Sample<f64>],
    view: &'a View,
    known: &Uncertainty,
    priors: bool,
) -> Option<(Rows<'a>, Residuals, Vec<usize>)> {
    let inside: Vec<usize> = known.inside().collect();
    if known.degrees_of_freedom < 4 || unseen::is_exact(known) || inside.is_empty() {
        return None;
    }
    let axes: Vec<&Values> = inside.iter().map(|&k| &known.axes[k]).collect();
    let rows = Rows::new(samples, view);
    let mut all = rows.residuals(&axes, known.scale)?;
    let told = if priors { LITTLE..UNIT.end } else { UNIT };
    let seen: Vec<bool> = (0..axes.len())
        .map(|k| {
            let squares: f64 = all.rows.iter().skip(k).step_by(axes.len()).map(|x| x * x).sum();
            told.contains(&squares)
        })
        .collect();
    if !seen.contains(&true) {
        return None;
    }
    all.keep(&seen);
    let places = inside.into_iter().zip(seen).filter(|(_, seen)| *seen);
    Some((rows, all, places.map(|(place, _)| place).collect()))
}

/// What correlated residuals make of a comparison of fits of the same samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inflation {
    /// How they are correlated.
    pub process: Process,
    /// So many samples tell as much as one of them would alone: by so much the correlation raises the variance of the parameters in the mean, at least 1.
    pub factor: f64,
}

impl Inflation {
    /// Of residuals with the rows of J; `None` where independence is not surely refuted.
    ///
    /// The factor is the mean trace of the sandwich, in units of the variance that the residuals have: what the penalty of a criterion grows by where its likelihood leaves correlation out (Varin and Vidoni 2005; Gao and Song 2010).
    /// Lines count as independent, other than in errors: what all have in common is no chance, but what another model may explain.
    pub fn of(all: &Residuals, degrees_of_freedom: usize) -> Option<Inflation> {
        let process = nodes::likeliest(all, degrees_of_freedom, SURE)?;
        let covariance = sandwich::covariance(all, process, 1.0);
        let trace: f64 = covariance.iter().step_by(all.columns + 1).sum();
        let factor = (trace / all.columns as f64).max(1.0);
        factor.is_finite().then_some(Inflation { process, factor })
    }
}

/// That of the best of several fits of the same samples, for all of them; `None` where independence is not refuted, or nothing can be said of it.
///
/// A poor model's own would take its misfit for noise, and fits of equally many parameters would no longer be in the order of their costs (Burnham and Anderson 2002, section 2.5, take that of the richest model).
pub fn inflation_of_best(samples: &[Sample<f64>], fits: &[&Outcome]) -> Option<Inflation> {
    let finite = fits.iter().filter(|fit| fit.uncertainty.scale.is_finite());
    let best = finite.min_by(|a, b| a.uncertainty.scale.total_cmp(&b.uncertainty.scale))?;
    let view = best.view();
    let priors = best.prior_cost > 0.0;
    let (_, all, _) = of_fit(samples, &view, &best.uncertainty, priors)?;
    Inflation::of(&all, best.uncertainty.degrees_of_freedom)
}

/// The mean over the processes that the residuals may be of, scaled to Student's t that they together come nearest to.
pub struct Mean {
    /// Covariance of the fit in the coordinates of the rows.
    pub covariance: Vec<Vec<f64>>,
    student: Student,
    /// Of the covariances, the mean trace.
    size: f64,
    length: f64,
    part: f64,
    smooth: f64,
    sure: bool,
    variance: f64,
}

impl Mean {
    /// Of these processes.
    pub fn of(nodes: &[Node], degrees_of_freedom: usize) -> Mean {
        let count = nodes.first().map_or(0, |node| node.covariance.len().isqrt());
        let mean = |of: &dyn Fn(&Node) -> f64| nodes.iter().map(|node| node.weight * of(node)).sum::<f64>();
        let trace = |node: &Node| node.covariance.iter().step_by(count + 1).sum::<f64>();
        let size = mean(&trace);
        let sizes: Vec<(f64, f64)> = nodes.iter().map(|node| (node.weight, trace(node) / size)).collect();
        let student = mixture::matched(&sizes, degrees_of_freedom as f64);
        let entry = |i: usize, j: usize| mean(&|node| node.covariance[i * count + j]) * student.variance;
        Mean {
            covariance: (0..count).map(|i| (0..count).map(|j| entry(i, j)).collect()).collect(),
            student,
            size,
            length: mean(&|node| node.process.length),
            part: mean(&|node| node.process.part),
            smooth: mean(&|node| f64::from(u8::from(node.process.smooth))),
            sure: nodes.iter().any(|node| node.evidence > SURE),
            variance: mean(&|node| node.variance),
        }
    }

    /// What is told of it, with the least and the largest factor of a standard error.
    pub fn misfit(&self, factor: (f64, f64)) -> Misfit {
        Misfit {
            length: self.length,
            part: self.part,
            smooth: self.smooth,
            sure: self.sure,
            variance: self.variance,
            factor,
        }
    }
}

/// The uncertainty with the mean covariance of the nodes.
fn with(rows: &Rows, known: &Uncertainty, seen: &[usize], nodes: &[Node], priors: &Priors) -> Uncertainty {
    let count = seen.len();
    let mean = Mean::of(nodes, known.degrees_of_freedom);
    let student = mean.student;
    let along = Along {
        rows,
        known,
        nodes,
        tails: student.variance,
        priors,
    };
    let mut axes = known.axes.clone();
    let beside_priors = (!priors.is_empty()).then(|| along.inside()).flatten();
    match beside_priors {
        Some((places, covariance)) => {
            sandwich::turn(&mut axes, &places, &covariance);
            priors.add(known, &places, &mut axes);
        }
        None => sandwich::turn(&mut axes, seen, &mean.covariance),
    }
    // Where nothing is told of a displacement of its own, it has the factor of all together.
    let whole = Real::sqrt(mean.size * student.variance / count as f64).max(1.0);
    for (axis, place) in axes.iter_mut().zip(&known.places) {
        if matches!(place, Some(Place::Lower | Place::Upper)) {
            let own = along.bound(axis);
            *axis = own.unwrap_or_else(|| axis.iter().map(|part| part * whole).collect());
        }
    }
    let mut corrected = known.clone().with_axes(axes);
    let lift = |values: &Values| values.iter().map(|x| x * whole).collect::<Values>();
    (corrected.axes_lifted, corrected.stderr_lifted) = along.lifted().unwrap_or_else(|| {
        let axes = known.axes_lifted.iter().map(lift).collect();
        (axes, lift(&known.stderr_lifted))
    });
    let factors = known.inside().map(|k| corrected.stderr[k] / known.stderr[k]);
    let factors = factors.filter(|factor| factor.is_finite());
    let factor = factors.fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), factor| {
        (a.min(factor), b.max(factor))
    });
    corrected.effective = student.degrees;
    corrected.misfit = Some(mean.misfit(factor));
    corrected
}
