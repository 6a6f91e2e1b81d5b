//! Proof of the global optimum: interval branch and bound.
//!
//! `certify` proves that no parameters within the bounds have a cost below `(1 - eps)` of the least one known, or finds better ones, adopts them and goes on.
//!
//! # Coordinates
//! With mu = 1/m^2 and, for each lobe, F at a reference angle, Eq. 14 is a sum of exponentials in u_d = ln rho_d, u_s = ln(rho_s F mu), u_v = ln(rho_v F mu) and mu; n and kappa come in only by phi, how F depends on the angle (`reflect`, `cell`).
//! So the flat valley of rho_s, rho_v, n and kappa lies along the coordinates.
//!
//! # Rigour
//! Every bound is rounded outward: intervals where there is time (`interval`), elsewhere what rounding can add is bounded beside the sums.
//! The elementary functions are those of [`brdfit_core::real`], inflated by more than their tested error.
//! rho = 0 is ln rho = minus infinity, which boxes reach by a side that is open below (`region`).
//! The claim is on Eq. 14 with the geometry as [`brdfit_core::geometry::Geometry`] computes it.
//!
//! # Order
//! A box is bounded by single samples (`range`), by the tangents of ln f (`tangent`), then by a quadratic below the cost (`taylor`, `quadratic`); the first and the last also cut away what has no cost below the target.
//! What is left is split (`branch`); boxes that share a rectangle of n and kappa are handled together, those with the least bound first.
//! Rounds have the same tasks on any number of threads, so boxes and results are the same too.

mod branch;
mod cell;
mod interval;
mod jet;
mod quadratic;
mod queue;
mod range;
mod reflect;
mod region;
mod scene;
mod tangent;
mod taylor;

use brdfit_core::brdf::Params;
use brdfit_core::geometry::Sample;

use branch::{Done, Found, Task};
use queue::Queue;

pub use branch::Visit;
pub use region::Region;
pub use scene::Scene;

use crate::error::FitError;
use crate::least_squares::descend;
use crate::options::FitOptions;
use crate::scale::Scale;
use crate::threads;
use crate::values::Values;

/// What is to be proved, and what may end it.
#[derive(Clone, Copy)]
pub struct Claim<'a> {
    /// No cost is to be below `(1 - eps)` of the least; above 0, below 1.
    pub eps: f64,
    /// End after this many boxes.
    pub boxes: u64,
    /// Work on the calling thread alone, as where many proofs run side by side; boxes and results are the same.
    pub alone: bool,
    /// End soon when this says so.
    pub stop: &'a (dyn Fn() -> bool + Sync),
    /// Is told after each round how far the proof is.
    pub progress: &'a (dyn Fn(&Certificate) + Sync),
    /// Is told of every box, for tests.
    pub watch: Option<&'a (dyn Fn(&Visit) + Sync)>,
}

/// How far a proof went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// It is proved that no parameters within the bounds have a cost below `(1 - eps)` of `cost`, less what rounding makes of it; 1 says nothing.
    pub eps: f64,
    /// Whether that is what was claimed.
    pub complete: bool,
    /// How many boxes were bounded.
    pub boxes: u64,
    /// How many boxes are left.
    pub open: u64,
    /// How often notably better parameters were found; all better ones are adopted.
    pub better: u32,
    /// The best parameters known.
    pub params: Params<f64>,
    /// Their cost, with weights over the largest.
    pub cost: f64,
}

/// Proves a claim on the least cost of `samples` by the terms and bounds of `options`, of which `best` is the best known.
///
/// # Errors
/// [`FitError::Sample`], [`FitError::Terms`], and [`FitError::NoProof`] if the model is not Eq. 14.
pub fn certify(
    samples: &[Sample<f64>],
    options: &FitOptions,
    best: &Params<f64>,
    claim: &Claim,
) -> Result<Certificate, FitError> {
    let Some(scale) = Scale::of(&[samples], options) else {
        return certify_ordinary(samples, options, best, claim);
    };
    let model = options.model;
    let best = paper(&scale.taken(model.parameters, &best.to_array().into())).ok_or(FitError::NoProof(model.name))?;
    let proved = certify_ordinary(&scale.samples(samples), &scale.options(options)?, &best, claim)?;
    let params = scale.given(model.parameters, &proved.params.to_array().into());
    Ok(Certificate {
        params: paper(&params).unwrap_or(proved.params),
        ..proved
    })
}

/// The cost of parameters as [`certify`] counts it, with weights over the largest, and how far rounding can move it.
///
/// # Errors
/// [`FitError::Sample`], and [`FitError::NoProof`] if the model is not Eq. 14.
pub fn cost(samples: &[Sample<f64>], options: &FitOptions, params: &Values) -> Result<(f64, f64), FitError> {
    let of = |scene: Scene, params: &Values| {
        let params = paper(params).ok_or(FitError::NoProof(options.model.name))?;
        let cost = scene.cost(&params);
        Ok((cost, scene.rounding(cost)))
    };
    match Scale::of(&[samples], options) {
        None => of(scene(samples, options)?, params),
        Some(scale) => {
            let plain = scene(&scale.samples(samples), &scale.options(options)?)?;
            of(plain, &scale.taken(options.model.parameters, params))
        }
    }
}

/// The parameters of Eq. 14 that these values are.
fn paper(values: &Values) -> Option<Params<f64>> {
    <[f64; 6]>::try_from(&values[..]).ok().map(Params::from_array)
}

/// The same of samples of an ordinary size.
fn certify_ordinary(
    samples: &[Sample<f64>],
    options: &FitOptions,
    best: &Params<f64>,
    claim: &Claim,
) -> Result<Certificate, FitError> {
    let scene = scene(samples, options)?;
    // Whatever is wrong with the samples or the terms is found here.
    let down = |start: Params<f64>| descend(samples, options, &[Values::from(start.to_array())]);
    down(*best)?;
    let down = |start: Params<f64>| {
        let (_, end) = down(start).ok()??;
        paper(&end)
    };
    Ok(prove(&scene, best, &down, claim))
}

/// The scan as the proof sees it.
///
/// # Errors
/// [`FitError::Sample`], and [`FitError::NoProof`] if the model is not Eq. 14.
pub fn scene(samples: &[Sample<f64>], options: &FitOptions) -> Result<Scene, FitError> {
    let all = |values: &Values| paper(values).filter(|_| options.model.is_paper());
    let (lower, upper) = all(&options.lower)
        .zip(all(&options.upper))
        .ok_or(FitError::NoProof(options.model.name))?;
    Scene::new(samples, options.terms, &lower, &upper).map_err(|(index, error)| FitError::Sample(index, error))
}

/// Less than this share of the cost is what a fit leaves where it converges.
const NOTABLE: f64 = 1e-6;

/// Tasks of a round; not the number of threads, so that all numbers of threads do the same.
const ROUND: usize = 16;

/// The proof itself; `down` fits from a start to the minimum near it.
fn prove(
    scene: &Scene,
    best: &Params<f64>,
    down: &dyn Fn(Params<f64>) -> Option<Params<f64>>,
    claim: &Claim,
) -> Certificate {
    let mut state = Certificate {
        eps: 1.0,
        complete: false,
        boxes: 0,
        open: 1,
        better: 0,
        params: *best,
        cost: scene.cost(best),
    };
    state.adopt(scene, down(*best));
    let mut queue = Queue::default();
    queue.push(Task::new(vec![Region::whole(scene)]));
    // The least bound of boxes that are too small to be split.
    let mut stuck = f64::INFINITY;
    loop {
        let target = (1.0 - claim.eps) * state.cost - scene.rounding(state.cost);
        let bound = queue.bound().min(stuck);
        state.open = queue.boxes();
        if bound >= target {
            (state.eps, state.complete) = (claim.eps, true);
            return state;
        }
        // Costs grow less than bounds: the proof of an eps stays one when better parameters are adopted.
        let so_far = 1.0 - (bound + scene.rounding(state.cost)) / state.cost;
        state.eps = so_far.clamp(claim.eps, 1.0);
        if queue.boxes() == 0 || stuck <= queue.bound() || state.boxes >= claim.boxes || (claim.stop)() {
            return state;
        }
        (claim.progress)(&state);
        let round = queue.pop(ROUND);
        let watch = claim.watch;
        let process = |task: &Task| task.process(scene, target, watch);
        let done: Vec<Done> = if claim.alone {
            round.iter().map(process).collect()
        } else {
            threads::map(&round, &process)
        };
        let mut found: Found = None;
        for done in done {
            state.boxes += done.boxes;
            stuck = done.stuck.iter().fold(stuck, |least, region| least.min(region.bound));
            if let Some((cost, params)) = done.found
                && found.is_none_or(|(least, _)| cost < least)
            {
                found = Some((cost, params));
            }
            done.tasks().into_iter().for_each(|task| queue.push(task));
        }
        state.adopt(scene, found.and_then(|(_, params)| down(params)));
    }
}

impl Certificate {
    /// Takes what was found as the best, if it is better by more than rounding.
    fn adopt(&mut self, scene: &Scene, found: Option<Params<f64>>) {
        if let Some(params) = found {
            let cost = scene.cost(&params);
            if cost < self.cost - scene.rounding(self.cost) {
                self.better += u32::from(cost < self.cost * (1.0 - NOTABLE));
                (self.cost, self.params) = (cost, params);
            }
        }
    }
}
