//! Which rounds a search makes, and when it has made enough.

use super::{Kind, Phase, Search, Task};
use crate::propose::{GROUPS, INDICES};
use crate::real::Real;
use crate::search::{BANDS, Scene};

/// The default method makes at most this many candidates, if nothing else is asked for.
pub const CANDIDATES: u32 = (ROUNDS + CYCLES * BANDS) * ROUND;

/// Rounds that are made in any case.
const ROUNDS: u32 = 5;
/// After so many parts of the range of slopes a scan can be settled.
const FIRST_BANDS: u32 = 3;
/// How often each part is looked at where that does not settle it.
const CYCLES: u32 = 3;
/// Candidates of a round.
const ROUND: u32 = 15;
/// Variations are made again of a better end that they lead to, so often at most.
const LOOPS: u32 = 3;
/// Rounds that must have led to the best end: after the first rounds, and after the first parts of the range of slopes.
const HITS: (u32, u32) = (2, 3);
/// Candidates with the slopes of the best.
const VARIATIONS: u32 = INDICES.len() as u32;
/// Candidates with other slopes than the best.
const SLOPES: u32 = 16;

impl<R: Real, const P: usize, const M: usize, const F: usize> Search<R, P, M, F> {
    /// Begins the next round, or ends the rounds.
    #[cfg_attr(target_os = "none", inline(never))]
    pub(super) fn choose(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        if self.phase == Phase::Known {
            self.phase = Phase::Rounds;
        }
        if self.phase == Phase::Rounds {
            if self.made < self.candidates && !self.is_settled(scene) {
                let first = self.made;
                self.made = first.saturating_add(ROUND).min(self.candidates);
                return self.begin_round(first, self.made, kind(self.round));
            }
            self.phase = Phase::Variations;
            (self.again, self.group) = (0, 0);
        }
        self.vary();
    }

    /// Are further candidates of no use?
    fn is_settled(&mut self, scene: &(impl Scene<R, P> + ?Sized)) -> bool {
        if self.makes_all() {
            return false;
        }
        let ends = &self.ends;
        if self.round == ROUNDS {
            let rivals = ends.has_rival_fit(scene) || ends.has_rival_end(scene);
            self.unsettled = ends.best_hits() < HITS.0 || rivals || ends.is_exact();
        }
        if self.round == ROUNDS + FIRST_BANDS && self.unsettled {
            return ends.best_hits() >= HITS.1 && !ends.has_rival_end(scene) && !ends.is_exact();
        }
        self.round >= ROUNDS && !self.unsettled
    }

    /// The next round of variations of the best, and again of a better one that they lead to.
    fn vary(&mut self) {
        let groups = GROUPS.len() as u32;
        let rounds = groups + u32::from(self.unsettled);
        if self.group == rounds {
            let least = self.centre.1 * R::of(1.0 - 1e-6);
            self.again += 1;
            self.group = 0;
            if !(self.ends.best.at.cost < least) || self.again == LOOPS {
                (self.phase, self.task) = (Phase::Last, Task::Last);
                self.ends.best.stop = None;
                return;
            }
        }
        if self.group == 0 {
            self.centre = (self.ends.best.x, self.ends.best.at.cost);
        }
        let group = self.group;
        self.group += 1;
        if let Some(&end) = GROUPS.get(group as usize) {
            let before = group.checked_sub(1).and_then(|before| GROUPS.get(before as usize));
            let first = self.again * VARIATIONS;
            self.begin_round(first + before.unwrap_or(&0), first + end, Kind::Index);
        } else {
            let first = self.again * SLOPES;
            self.begin_round(first, first + SLOPES, Kind::Slopes);
        }
    }
}

/// Which candidates a round has: from everywhere at first, and then from one part of the range of slopes after the other.
fn kind(round: u32) -> Kind {
    match round.checked_sub(ROUNDS) {
        Some(band) if band % (2 * BANDS) < BANDS || band < CYCLES * BANDS => {
            // The first of them are spread over the range.
            Kind::Band(band * 5 % BANDS)
        }
        _ => Kind::Everywhere,
    }
}
