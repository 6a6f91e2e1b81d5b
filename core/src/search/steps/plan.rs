//! Which rounds a search makes, and when it has made enough.

use super::{Kind, Phase, SearchIn, Task, Trial};
use crate::list::List;
use crate::lm::Bounds;
use crate::minima::Minimum;
use crate::propose::{GROUPS, INDICES};
use crate::real::Real;
use crate::search::ends::{EXACT, FOLLOWED, FOLLOWED_WELL};
use crate::search::{BANDS, Scene};

/// The default method makes at most this many candidates, if nothing else is asked for.
pub const CANDIDATES: u32 = (ROUNDS + CYCLES * BANDS) * ROUND;

/// First rounds; a scan can be settled one before their end.
const ROUNDS: u32 = 5;
/// After so many parts of the range of slopes a scan can be settled.
const FIRST_BANDS: u32 = 3;
/// How often each part is looked at where that does not settle it.
const CYCLES: u32 = 3;
/// The same where the model follows the scan.
const CYCLES_FOLLOWED: u32 = 2;
/// Candidates of a round.
const ROUND: u32 = 15;
/// Variations are made again of a better end that they lead to, so often at most.
const LOOPS: u32 = 3;
/// Rounds that must have led to the best end: after the first rounds, and sooner or after the first parts of the range of slopes.
const HITS: (u32, u32) = (2, 3);
/// Candidates with the slopes of the best.
const VARIATIONS: u32 = INDICES.len() as u32;
/// Candidates with other slopes than the best.
const SLOPES: u32 = 16;
/// Rounds with weights near their bounds, where the best is on an upper bound, or rounds did not settle a scan that the model does not follow well.
const CORNERS: u32 = 3 * BANDS;

impl<R: Real, const P: usize, M: List<Item = Minimum<R, P>>, F: List<Item = Trial<R, P>>> SearchIn<R, P, M, F> {
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
        let first_rounds = self.round + 1 == ROUNDS || self.round == ROUNDS;
        if !first_rounds && self.round != ROUNDS + FIRST_BANDS {
            return self.round >= ROUNDS + CYCLES_FOLLOWED * BANDS && ends.is_below(R::of(FOLLOWED));
        }
        let hits = if self.round == ROUNDS { HITS.0 } else { HITS.1 };
        let agreed =
            ends.best_hits() >= hits && !ends.has_rival_end(scene) && !ends.is_below(R::of(EXACT)) && !self.flat;
        if first_rounds {
            self.unsettled = !agreed || ends.has_rival_fit(scene) || !ends.is_below(R::of(FOLLOWED));
            return !self.unsettled;
        }
        agreed
    }

    /// Is a parameter of the best end, which is not held, as large as it may be?
    fn is_on_upper_bound(&self) -> bool {
        let (x, Bounds { lower, upper }) = (&self.ends.best.x, &self.bounds);
        (0..P).any(|k| lower[k] < upper[k] && x[k] >= upper[k])
    }

    /// The next round of variations of the best, and again of a better one that they lead to.
    fn vary(&mut self) {
        let groups = GROUPS.len() as u32;
        let mut rounds = groups;
        if self.unsettled {
            let went_on = self.made > (ROUNDS + FIRST_BANDS) * ROUND;
            let corners = self.is_on_upper_bound() || (went_on && !self.ends.is_below(R::of(FOLLOWED_WELL)));
            rounds += if corners { 1 + CORNERS } else { 1 };
        }
        if self.group >= rounds {
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
        if let Some(&(begin, end)) = GROUPS.get(group as usize) {
            let first = self.again * VARIATIONS;
            self.begin_round(first + begin, first + end, Kind::Index);
        } else if let Some(corner) = group.checked_sub(groups + 1) {
            let first = CANDIDATES + (self.again * CORNERS + corner) * ROUND;
            self.begin_round(first, first + ROUND, Kind::Corner(corner * 5 % BANDS));
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
