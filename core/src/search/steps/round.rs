//! A round: candidates by rank, the best of them by cost, fits from the best of those, and which of these converge.

use super::{BEGUN, GROUP_BEGUN, Kind, Phase, SHORT, SLOPES_BEGUN, SearchIn, Task, Trial, VARIATION_SHORT, at};
use crate::list::List;
use crate::lm::Fit;
use crate::minima::{self, Minimum};
use crate::real::Real;
use crate::search::ends::{NEAR, QUIET};
use crate::search::{Candidate, Region, Scene, Waits};

impl<R: Real, const P: usize, M: List<Item = Minimum<R, P>>, F: List<Item = Trial<R, P>>> SearchIn<R, P, M, F> {
    /// Begins one of these candidates.
    #[cfg_attr(target_os = "none", inline(never))]
    pub(super) fn begin_round(&mut self, first: u32, end: u32, kind: Kind) {
        self.round += 1;
        (self.next, self.end, self.kind) = (first, end, kind);
        self.starts.truncate(0);
        self.fits.truncate(0);
        self.elsewhere = false;
        self.task = Task::Propose;
    }

    #[cfg_attr(target_os = "none", inline(never))]
    pub(super) fn propose(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        let region = match self.kind {
            Kind::Everywhere => Region::Everywhere,
            Kind::Band(band) => Region::Band(band),
            Kind::Corner(band) => Region::Corner(band),
            Kind::Index => Region::Index(&self.centre.0),
            Kind::Slopes => Region::Slopes(&self.centre.0),
        };
        self.candidate = scene.propose(&self.bounds, self.seed, u64::from(self.next), region);
        self.evaluations.cost += self.candidate.passes;
        self.rank();
    }

    #[cfg_attr(target_os = "none", inline(never))]
    pub(super) fn weigh(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        let before = self.candidate.passes;
        scene.weigh(&self.bounds, &mut self.candidate);
        self.evaluations.cost += self.candidate.passes - before;
        self.rank();
    }

    /// Puts a candidate that waits for nothing into its place.
    fn rank(&mut self) {
        if self.candidate.waits != Waits::No {
            self.task = Task::Weigh;
            return;
        }
        let Candidate { x, rank, .. } = &self.candidate;
        // Narrow bounds make one of several.
        if self.starts.iter().all(|start| start.x != *x) {
            let index = u64::from(self.next);
            minima::insert(self.starts.as_mut_view(), &at(*x, *rank, index));
        }
        self.next += 1;
        self.task = Task::Propose;
        if self.next >= self.end {
            (self.levelled, self.place, self.task) = (0, 0, Task::Level);
        }
    }

    /// So many fits of this round begin.
    fn begun(&self) -> u32 {
        let begun = match self.kind {
            Kind::Index => GROUP_BEGUN,
            Kind::Slopes => SLOPES_BEGUN,
            _ => BEGUN,
        };
        begun.min(self.fits.capacity()) as u32
    }

    /// The cost of the next start, which moves to its place among those that have one; these are the first.
    #[cfg_attr(target_os = "none", inline(never))]
    pub(super) fn level(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        let (place, begun) = (self.place as usize, self.begun());
        if let Some(start) = self.starts.get_mut(place) {
            (start.x, start.cost) = scene.level(&self.bounds, &start.x);
            let cost = start.cost;
            self.evaluations.cost += 1;
            self.ends.poorest = self.ends.poorest.max(cost);
            let last = self
                .levelled
                .checked_sub(1)
                .and_then(|last| self.starts.get(last as usize));
            let takes = match last {
                Some(last) if self.levelled == begun => minima::less(cost, last.cost),
                _ => {
                    self.levelled += 1;
                    true
                }
            };
            if takes && let Some(levelled) = self.starts.get_mut(..=place) {
                let count = self.levelled as usize;
                if let Some((new, others)) = levelled.split_last_mut()
                    && let Some(old) = others.get_mut(count - 1)
                {
                    core::mem::swap(old, new);
                }
                minima::sift(levelled.get_mut(..count).unwrap_or_default());
            }
        }
        self.place += 1;
        if self.place as usize >= self.starts.len() {
            (self.place, self.task) = (0, Task::Begin);
        }
    }

    #[cfg_attr(target_os = "none", inline(never))]
    pub(super) fn begin_fit(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        if let Some(&Minimum { x, first_start, .. }) = self.starts.get(self.place as usize) {
            let fit = Fit::begin(scene, &self.bounds, x, &self.rough());
            self.evaluations.linearize += 1;
            self.fits.push(&Trial {
                fit,
                start: first_start,
            });
        }
        self.begun_or_not();
    }

    pub(super) fn short(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        let rough = self.rough();
        if let Some(Trial { fit, .. }) = self.fits.last_mut() {
            self.evaluations.linearize += fit.step(scene, &self.bounds, &rough);
        }
        self.begun_or_not();
    }

    /// After some passes of a fit the next begins.
    fn begun_or_not(&mut self) {
        let short = match (self.phase, self.kind) {
            (Phase::Known, _) => 1,
            (_, Kind::Index) => VARIATION_SHORT,
            _ => SHORT,
        };
        let last = self.fits.last();
        if last.is_some_and(|Trial { fit, .. }| fit.stop.is_none() && fit.passes < short) {
            self.task = Task::Short;
            return;
        }
        let mut rest = &mut *self.fits;
        while let [others @ .., new] = rest
            && let Some(before) = others.last_mut()
            && minima::less(new.fit.at.cost, before.fit.at.cost)
        {
            core::mem::swap(before, new);
            rest = others;
        }
        self.place += 1;
        self.task = Task::Begin;
        if self.place >= self.levelled {
            (self.place, self.task) = (0, Task::Judge);
        }
    }

    #[cfg_attr(target_os = "none", inline(never))]
    pub(super) fn judge(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        let Some(Trial { fit, .. }) = self.fits.get(self.place as usize) else {
            self.task = Task::Choose;
            return;
        };
        let mut elsewhere = self.ends.is_elsewhere(scene, &fit.x);
        if elsewhere && self.phase != Phase::Known {
            self.ends.note_rival(scene, fit);
        }
        let varies = self.kind == Kind::Index;
        let first = if varies {
            self.ends.is_below(R::of(QUIET))
        } else {
            self.place == 0
        };
        // A basin where fits converge slowly would lose every round to one where they are fast.
        elsewhere &= !varies;
        let strays = elsewhere && !self.elsewhere;
        self.elsewhere |= elsewhere;
        if first || strays || self.ends.is_near(fit.at.cost, R::of(NEAR)) {
            (self.until, self.task) = (0, Task::Converge);
        } else {
            self.place += 1;
        }
    }

    pub(super) fn converge(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        let rough = self.rough();
        if let Some(Trial { fit, start }) = self.fits.get_mut(self.place as usize) {
            if fit.stop.is_some() || fit.passes >= self.until {
                if self.ends.is_over(scene, fit, *start, self.round, &mut self.flat) {
                    self.place += 1;
                    self.task = Task::Judge;
                    return;
                }
                self.until = fit.passes + 2;
            }
            self.evaluations.linearize += fit.step(scene, &self.bounds, &rough);
        }
    }
}
