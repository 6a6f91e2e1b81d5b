//! The search for the global optimum: the paper's, and a faster one.

use heapless::Vec;

use crate::lm::{self, Bounds, Fit, Options, Problem};
use crate::minima::Minima;
use crate::real::Real;
use crate::start;

/// Capacity of the table of minima of a search.
pub const MINIMA: usize = 64;
/// Candidates of the default method, if nothing else is asked for.
pub const CANDIDATES: u32 = 128;
/// Starts of the paper's method (section 3).
pub const PAPER_STARTS: u32 = 250;

/// Candidates that get a short fit.
const SHORT: usize = 24;
/// Passes of a short fit.
const SHORT_PASSES: u32 = 7;
/// Short fits that are brought to convergence.
const LONG: usize = 8;

/// A problem that can propose good starts.
pub trait Scene<R, const P: usize>: Problem<R, P> {
    /// Candidate `i` of the sequence of `seed`; one pass as cheap as [`Problem::cost`].
    fn candidate(&self, bounds: &Bounds<R, P>, seed: u64, i: u64) -> [R; P];
}

/// How many evaluations were made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Evaluations {
    /// Passes over the scan without derivatives.
    pub cost: u32,
    /// Passes with derivatives.
    pub linearize: u32,
}

/// What a search found.
#[derive(Clone, Debug)]
pub struct Found<R, const P: usize> {
    /// Distinct minima, best first.
    pub minima: Minima<R, P, MINIMA>,
    /// What it cost.
    pub evaluations: Evaluations,
}

/// Fit `i` of the paper's method: from a start uniform over the bounds to convergence (section 3 of the paper).
pub fn paper_fit<R: Real, const P: usize>(
    problem: &impl Problem<R, P>,
    bounds: &Bounds<R, P>,
    seed: u64,
    i: u64,
    options: &Options<R>,
) -> Fit<R, P> {
    lm::fit(problem, bounds, start::uniform(seed, i, bounds), options)
}

/// The paper's method: `starts` fits, their distinct minima, and the best fitted again from its own parameters.
///
/// `fits` are those of [`paper_fit`] in order of start, made one by one or on many threads.
pub fn paper<R: Real, const P: usize>(
    problem: &impl Problem<R, P>,
    bounds: &Bounds<R, P>,
    fits: impl IntoIterator<Item = Fit<R, P>>,
    options: &Options<R>,
) -> Found<R, P> {
    let mut minima = Minima::default();
    let mut evaluations = Evaluations::default();
    for (i, fit) in fits.into_iter().enumerate() {
        evaluations.linearize += fit.passes;
        minima.add(&fit, i as u64);
    }
    if let Some(best) = minima.best() {
        let start = best.first_start;
        let again = lm::fit(problem, bounds, best.fit.x, options);
        evaluations.linearize += again.passes;
        minima.refine(&again, start);
    }
    Found { minima, evaluations }
}

/// The default method: candidates by cost, short fits of the best, convergence of the best of those.
pub fn search<R: Real, const P: usize>(
    scene: &impl Scene<R, P>,
    bounds: &Bounds<R, P>,
    seed: u64,
    candidates: u32,
    options: &Options<R>,
) -> Found<R, P> {
    let mut evaluations = Evaluations::default();
    let mut best: Vec<(R, u64, [R; P]), SHORT> = Vec::new();
    for i in 0..candidates as u64 {
        let x = scene.candidate(bounds, seed, i);
        let cost = scene.cost(&x);
        evaluations.cost += 2;
        let place = best.iter().position(|other| cost < other.0).unwrap_or(best.len());
        if best.is_full() {
            if place >= best.len() {
                continue;
            }
            best.pop();
        }
        let _ = best.insert(place, (cost, i, x));
    }
    let mut fits: Vec<(Fit<R, P>, u64), SHORT> = Vec::new();
    for &(_, i, x) in &best {
        let mut fit = Fit::begin(scene, bounds, x, options);
        fit.run(scene, bounds, options, SHORT_PASSES);
        let place = fits
            .iter()
            .position(|(other, _)| fit.at.cost < other.at.cost)
            .unwrap_or(fits.len());
        let _ = fits.insert(place, (fit, i));
    }
    let mut minima = Minima::default();
    for (place, (fit, i)) in fits.iter_mut().enumerate() {
        if place < LONG {
            fit.run(scene, bounds, options, u32::MAX);
            minima.add(fit, *i);
        }
        evaluations.linearize += fit.passes;
    }
    Found { minima, evaluations }
}
