//! What a search has found so far, and what that says of what is to be done.

use heapless::Vec;

use super::Scene;
use crate::list::List;
use crate::lm::Fit;
use crate::minima::{self, Minima, Minimum};
use crate::real::Real;
use crate::saved::{Saved, Tape};

/// A fit goes on that is within this factor of the best cost.
pub(super) const NEAR: f64 = 1.05;
/// A fit is given up that is beyond this factor of the best cost after so many passes.
const HOPELESS: (f64, u32) = (10.0, 10);
/// An end whose slopes differ from the best by more than this factor, and its cost by less than that one, leaves a scan unsettled.
const RIVAL_END: (f64, f64) = (1.1, 2.0);
/// The same for a fit of a few passes.
const RIVAL_FIT: (f64, f64) = (1.35, 1.3);
/// A scan without noise: the best cost is below this part of that of a poor candidate. Then the cost does not tell what is near, and nothing settles it.
pub(super) const EXACT: f64 = 1e-9;
/// The same of a scan with little noise: a variation of the best can begin far above it.
pub(super) const QUIET: f64 = 1e-4;
/// Above this part the model does not follow the scan, and a minimum that was not met may do so better: the first rounds do not settle it.
pub(super) const FOLLOWED: f64 = 0.1;
/// Below this part it follows it so well that weights near their bounds are tried only where the best has one there.
pub(super) const FOLLOWED_WELL: f64 = 0.03;
/// A fit joins an end within this part of the cost (see [`minima::joins`]); within the second where the model does not follow the scan, as basins differ by less there.
const JOINS: (f64, f64) = (1e-2, 1e-3);
/// Ends that are remembered.
const ENDS: usize = 16;
/// Two ends of the same cost, to this part, are one.
const SAME: f64 = 1e-5;

/// What a search has found.
#[derive(Clone, Debug)]
#[repr(C)]
pub(super) struct Ends<R, const P: usize, S> {
    /// The fit that ended best; of 0 passes if none has ended.
    pub best: Fit<R, P>,
    /// The largest cost of a candidate.
    pub poorest: R,
    /// The best short fit with other slopes than the best end.
    pub rival: Option<([R; P], R)>,
    /// Where fits have ended, best first; unlike a distinct minimum, one for each cost. `hits` are the rounds in which a fit ended there, and `first_start` is the last of them.
    pub list: Vec<Minimum<R, P>, ENDS>,
    pub minima: Minima<R, P, S>,
}

impl<R: Real, const P: usize, S: List<Item = Minimum<R, P>>> Ends<R, P, S> {
    pub const fn over(minima: S) -> Self {
        Ends {
            best: Fit::nowhere(),
            list: Vec::new(),
            poorest: R::ZERO,
            rival: None,
            minima: Minima::over(minima),
        }
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.best.passes = 0;
        self.list.truncate(0);
        self.poorest = R::ZERO;
        self.rival = None;
        self.minima.clear();
    }

    pub fn fields(&mut self, tape: &mut Tape<'_>) {
        self.best.fields(tape);
        tape.list(self.list.as_mut_view(), Minimum::EMPTY, |tape, end| end.fields(tape));
        tape.reals(core::slice::from_mut(&mut self.poorest));
        let mut has_rival = self.rival.is_some();
        tape.flag(&mut has_rival);
        let (mut x, mut cost) = self.rival.unwrap_or(([R::ZERO; P], R::ZERO));
        tape.reals(&mut x);
        tape.reals(core::slice::from_mut(&mut cost));
        self.rival = has_rival.then_some((x, cost));
        self.minima.fields(tape);
    }

    /// Is a cost within this factor of the best?
    pub fn is_near(&self, cost: R, factor: R) -> bool {
        self.list.first().is_none_or(|best| cost < best.cost * factor)
    }

    /// Is the best cost below this part, [`EXACT`], [`QUIET`], [`FOLLOWED`] or [`FOLLOWED_WELL`], of that of a poor candidate?
    #[cfg_attr(target_os = "none", inline(never))]
    pub fn is_below(&self, part: R) -> bool {
        let best = self.list.first();
        best.is_some_and(|best| best.cost < self.poorest * part)
    }

    /// Has a fit other slopes than the best end?
    pub fn is_elsewhere(&self, scene: &(impl Scene<R, P> + ?Sized), x: &[R; P]) -> bool {
        let best = self.list.first();
        best.is_some_and(|best| scene.apart(x, &best.x, R::of(RIVAL_FIT.0)))
    }

    /// In how many rounds a fit has ended in the best.
    pub fn best_hits(&self) -> u32 {
        self.list.first().map_or(0, |best| best.hits)
    }

    /// Remembers a short fit, which has other slopes than the best.
    pub fn note_rival(&mut self, scene: &(impl Scene<R, P> + ?Sized), fit: &Fit<R, P>) {
        let old = self.rival.as_ref().filter(|(x, _)| self.is_elsewhere(scene, x));
        if old.is_none_or(|&(_, cost)| fit.at.cost < cost) {
            self.rival = Some((fit.x, fit.at.cost));
        }
    }

    /// Came a short fit with other slopes near the best?
    pub fn has_rival_fit(&self, scene: &(impl Scene<R, P> + ?Sized)) -> bool {
        let rival = self.rival.as_ref();
        rival.is_some_and(|(x, cost)| self.is_near(*cost, R::of(RIVAL_FIT.1)) && self.is_elsewhere(scene, x))
    }

    /// Is an end with other slopes near the best?
    pub fn has_rival_end(&self, scene: &(impl Scene<R, P> + ?Sized)) -> bool {
        let [best, others @ ..] = &*self.list else {
            return false;
        };
        let mut near = others.iter().filter(|end| self.is_near(end.cost, R::of(RIVAL_END.1)));
        near.any(|end| scene.apart(&end.x, &best.x, R::of(RIVAL_END.0)))
    }

    /// Does a fit of candidate `start` need no further pass? It has converged, or it is plain that it joins an end already found, or leads nowhere; where it ends is noted, and whether fits end in the best with other slopes.
    #[cfg_attr(target_os = "none", inline(never))]
    pub fn is_over(
        &mut self,
        scene: &(impl Scene<R, P> + ?Sized),
        fit: &Fit<R, P>,
        start: u64,
        round: u32,
        flat: &mut bool,
    ) -> bool {
        let converged = fit.stop.is_some();
        let joins = R::of(if self.is_below(R::of(FOLLOWED)) {
            JOINS.0
        } else {
            JOINS.1
        });
        let place = self.list.iter().position(|end| {
            if converged {
                minima::close(end.cost, fit.at.cost, R::of(SAME))
            } else {
                minima::joins((&end.x, end.cost), fit, joins)
            }
        });
        if place.is_some() || converged {
            if let Some(best) = self.list.first() {
                let same = place == Some(0);
                *flat |= same && converged && scene.apart(&fit.x, &best.x, R::of(RIVAL_END.0));
                *flat &= place.is_some() || !(fit.at.cost < best.cost);
            }
            self.end(fit, place, round);
            self.minima.add(fit, start);
            return true;
        }
        fit.passes > HOPELESS.1 && !self.is_near(fit.at.cost, R::of(HOPELESS.0))
    }

    /// Takes note that a fit ends in the end at `place`, or in a new one.
    fn end(&mut self, fit: &Fit<R, P>, place: Option<usize>, round: u32) {
        let mut end = Minimum {
            x: fit.x,
            cost: fit.at.cost,
            hits: u32::from(round > 0),
            first_start: u64::from(round),
        };
        if let Some(place) = place {
            let (hits, last) = minima::join(self.list.as_mut_view(), place, &mut end);
            end.hits = hits + u32::from(last < end.first_start);
        }
        minima::insert(self.list.as_mut_view(), &end);
        if self.best.passes == 0 || minima::less(fit.at.cost, self.best.at.cost) {
            self.best = *fit;
        }
    }
}
