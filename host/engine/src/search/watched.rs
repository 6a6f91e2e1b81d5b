//! One search with a clock beside it: what it had found, when, and after how many passes.

use std::cell::RefCell;

use brdfit_core::lm::{Bounds, Linearization, Options, Problem};
use brdfit_core::model::Parameter;
use brdfit_core::real::Real;
use brdfit_core::search::{self, Candidate, Evaluations, Region, Scene};

use crate::clock::Stopwatch;
use crate::layout::Layout;
use crate::options::{FitOptions, Method};
use crate::passes::Kernel;
use crate::values::Values;

/// An improvement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// Passes until here, this one included.
    pub evaluations: Evaluations,
    /// Wall time until here, s.
    pub elapsed_s: f64,
    /// Where the cost is least so far.
    pub params: Values,
    /// Sum of squared residuals of ln f there, computed in `f64` whatever the number type of the search.
    pub cost: f64,
}

/// The course of one search.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// Its improvements in order; none if no cost was a number.
    pub records: Vec<Record>,
    /// All its passes.
    pub evaluations: Evaluations,
    /// All its wall time, s.
    pub elapsed_s: f64,
}

/// The search of one scan, watched; `exact` is the same scan in `f64`.
pub(crate) fn watch<R: Real, const P: usize>(
    scene: &Kernel<R, P>,
    exact: &Kernel<f64, P>,
    own: &[Parameter; P],
    options: &FitOptions,
) -> Trace {
    let layout = Layout::new(own, options.model);
    let bounds: Bounds<R, P> = layout.bounds(options);
    let (lm, starts) = (Options::default(), options.starts());
    let begun = Stopwatch::start();
    let watched = Timed {
        scene,
        begun,
        seen: RefCell::new(Seen {
            evaluations: Evaluations::default(),
            least: None,
            steps: Vec::with_capacity(256),
        }),
    };
    let watched_scene: &dyn Scene<R, P> = &watched;
    match options.method {
        Method::Default => {
            search::search(watched_scene, &bounds, options.seed, starts, &lm);
        }
        Method::Paper => {
            let fit = |i| search::paper_fit(watched_scene, &bounds, options.seed, i, &lm);
            search::paper(watched_scene, &bounds, (0..u64::from(starts)).map(fit), &lm);
        }
    }
    let elapsed_s = begun.elapsed().as_secs_f64();
    let seen = watched.seen.into_inner();
    let record = |&(evaluations, elapsed_s, x): &(Evaluations, f64, [R; P])| {
        let x = x.map(R::f64);
        Record {
            evaluations,
            elapsed_s,
            params: layout.values(&x),
            cost: exact.cost(&x),
        }
    };
    Trace {
        records: seen.steps.iter().map(record).collect(),
        evaluations: seen.evaluations,
        elapsed_s,
    }
}

struct Seen<R, const P: usize> {
    evaluations: Evaluations,
    least: Option<R>,
    steps: Vec<(Evaluations, f64, [R; P])>,
}

/// A scene that notes each new least cost.
struct Timed<'a, R, const P: usize> {
    scene: &'a Kernel<'a, R, P>,
    begun: Stopwatch,
    seen: RefCell<Seen<R, P>>,
}

impl<R: Real, const P: usize> Timed<'_, R, P> {
    fn note(&self, x: &[R; P], cost: R, linearize: u32) {
        let mut seen = self.seen.borrow_mut();
        seen.evaluations.linearize += linearize;
        seen.evaluations.cost += 1 - linearize;
        if cost.is_finite() && seen.least.is_none_or(|least| cost < least) {
            seen.least = Some(cost);
            let step = (seen.evaluations, self.begun.elapsed().as_secs_f64(), *x);
            seen.steps.push(step);
        }
    }
}

impl<R: Real, const P: usize> Problem<R, P> for Timed<'_, R, P> {
    fn cost(&self, x: &[R; P]) -> R {
        let cost = self.scene.cost(x);
        self.note(x, cost, 0);
        cost
    }
    fn linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        let at = self.scene.linearize(x);
        self.note(x, at.cost, 1);
        at
    }
    fn bend(&self, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P] {
        self.scene.bend(x, step, to)
    }
}

impl<R: Real, const P: usize> Scene<R, P> for Timed<'_, R, P> {
    fn propose(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, region: Region<R, P>) -> Candidate<R, P> {
        self.scene.propose(bounds, seed, i, region)
    }
    fn weigh(&self, bounds: &Bounds<R, P>, candidate: &mut Candidate<R, P>) {
        let before = candidate.passes;
        self.scene.weigh(bounds, candidate);
        self.seen.borrow_mut().evaluations.cost += candidate.passes - before;
    }
    fn level(&self, bounds: &Bounds<R, P>, x: &[R; P]) -> ([R; P], R) {
        let (x, cost) = self.scene.level(bounds, x);
        self.note(&x, cost, 0);
        (x, cost)
    }
    fn apart(&self, x: &[R; P], y: &[R; P], factor: R) -> bool {
        self.scene.apart(x, y, factor)
    }
}
