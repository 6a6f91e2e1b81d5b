//! A search that is no longer wanted ends at its next pass.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};

use brdfit_core::lm::{Bounds, Linearization, Problem};
use brdfit_core::real::Real;
use brdfit_core::search::{Candidate, Region, Scene, Waits};

use crate::compiled::Kernel;

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

#[cfg(test)]
mod tests {
    use brdfit_core::geometry::Sample;

    use super::*;
    use crate::{FitError, FitOptions, Method, descend, fit, joint};

    #[test]
    fn a_search_that_is_not_wanted_ends() {
        static OVER: AtomicBool = AtomicBool::new(true);
        static GOES_ON: AtomicBool = AtomicBool::new(false);
        let samples: Vec<Sample<f64>> = (0..40)
            .map(|k| Sample::in_plane(0.7, 0.03 * f64::from(k), 0.1 + f64::from(k % 7)))
            .collect();
        for method in [Method::Default, Method::Paper] {
            for robust in [false, true] {
                let options = FitOptions {
                    method,
                    robust,
                    starts: Some(40),
                    ..FitOptions::default()
                };
                let until = |flag| FitOptions {
                    until: Until::set(flag),
                    ..options
                };
                assert_eq!(fit(&samples, &until(&OVER)), Err(FitError::Interrupted));
                assert_eq!(fit(&samples, &until(&GOES_ON)), fit(&samples, &options));
                let descend = |options: &FitOptions| descend(&samples, options, &[options.lower]);
                assert_eq!(descend(&until(&OVER)), Err(FitError::Interrupted));
                assert_eq!(descend(&until(&GOES_ON)), descend(&options));
            }
        }
        let shared = [false, false, false, true, false, false];
        let joint = |flag| {
            let until = Until::set(flag);
            let options = FitOptions {
                until,
                ..FitOptions::default()
            };
            joint::fit(&[&samples, &samples], &shared, &options)
        };
        assert_eq!(joint(&OVER), Err((2, FitError::Interrupted)));
        assert!(joint(&GOES_ON).is_ok());
    }
}
