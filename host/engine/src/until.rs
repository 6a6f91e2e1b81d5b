//! A search that is no longer wanted ends at its next pass.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};

use brdfit_core::lm::{Bounds, Linearization, Problem};
use brdfit_core::real::Real;
use brdfit_core::search::{Candidate, Region, Scene, Waits};

use crate::passes::Kernel;

/// Until when a search is wanted: for good, or until a flag is set.
///
/// The flag is looked at before each pass; it changes no bit of a search that ends by itself.
#[derive(Clone, Copy, Default)]
pub struct Until(Option<&'static AtomicBool>);

impl Until {
    /// For good.
    pub const NEVER: Until = Until(None);

    /// Until this flag is set.
    pub fn set(flag: &'static AtomicBool) -> Self {
        Until(Some(flag))
    }

    /// Is it no longer wanted?
    pub fn is_over(self) -> bool {
        self.0.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }
}

/// What is asked of two searches is the same, however long they are wanted.
impl PartialEq for Until {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl fmt::Debug for Until {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Until")
    }
}

/// A scan whose passes give nothing any more once the search is not wanted, so that it ends.
pub(crate) struct Watched<'a, R, const P: usize> {
    pub scene: &'a Kernel<'a, R, P>,
    pub until: Until,
}

impl<R: Real, const P: usize> Problem<R, P> for Watched<'_, R, P> {
    fn cost(&self, x: &[R; P]) -> R {
        if self.until.is_over() {
            return R::of(f64::NAN);
        }
        self.scene.cost(x)
    }
    fn linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        if self.until.is_over() {
            return Linearization {
                cost: R::of(f64::NAN),
                gradient: [R::ZERO; P],
                hessian: [[R::ZERO; P]; P],
            };
        }
        self.scene.linearize(x)
    }
    fn bend(&self, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P] {
        self.scene.bend(x, step, to)
    }
}

impl<R: Real, const P: usize> Scene<R, P> for Watched<'_, R, P> {
    fn propose(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, region: Region<R, P>) -> Candidate<R, P> {
        self.scene.propose(bounds, seed, i, region)
    }
    fn weigh(&self, bounds: &Bounds<R, P>, candidate: &mut Candidate<R, P>) {
        if self.until.is_over() {
            candidate.waits = Waits::No;
            return;
        }
        self.scene.weigh(bounds, candidate);
    }
    fn level(&self, bounds: &Bounds<R, P>, x: &[R; P]) -> ([R; P], R) {
        if self.until.is_over() {
            return (*x, R::of(f64::NAN));
        }
        self.scene.level(bounds, x)
    }
    fn apart(&self, x: &[R; P], y: &[R; P], factor: R) -> bool {
        self.scene.apart(x, y, factor)
    }
}
