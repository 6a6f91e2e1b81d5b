//! The default method as steps of at most one pass each.

use heapless::Vec;

use super::ends::{Ends, NEAR};
use super::{BANDS, Candidate, Evaluations, Found, MINIMA, Region, Scene, Waits, log};
use crate::lm::{Bounds, Fit, Options};
use crate::minima::{self, Minima, Minimum};
use crate::propose::{GROUPS, INDICES};
use crate::real::Real;
use crate::saved::{Saved, Tape};

/// The default method makes at most this many candidates, if nothing else is asked for.
pub const CANDIDATES: u32 = (ROUNDS + CYCLES * BANDS) * ROUND;
/// Fits that [`super::search`] has under way at most; a round needs no more.
pub const FITS: usize = SLOPES_BEGUN;

/// Candidates of a round.
const ROUND: u32 = 15;
/// Rounds that are made in any case.
const ROUNDS: u32 = 5;
/// After so many parts of the range of slopes a scan can be settled.
const FIRST_BANDS: u32 = 3;
/// How often each part is looked at where that does not settle it.
const CYCLES: u32 = 3;
/// How many of a round's candidates are tried by cost, and for how many of them a fit begins.
const TRIED: usize = 7;
const BEGUN: usize = 3;
/// Candidates with the slopes of the best, and for how many of a group of them a fit begins.
const VARIATIONS: u32 = INDICES.len() as u32;
const GROUP_BEGUN: usize = 2;
/// Candidates with other slopes than the best, and for how many a fit begins.
const SLOPES: u32 = 16;
const SLOPES_BEGUN: usize = 4;
/// Variations are made again of a better end that they lead to, so often at most.
const LOOPS: u32 = 3;
/// Passes of a fit before it is decided which of a round go on; a variation begins nearer to where it ends.
const SHORT: u32 = 4;
const VARIATION_SHORT: u32 = 3;
/// Rounds that must have led to the best end: after the first rounds, and after the first parts of the range of slopes.
const HITS: (u32, u32) = (2, 3);
/// [`Options::cost_tolerance`] of the fits of a search; the best is then brought to that of the caller.
const ROUGH: f64 = 1e-8;
/// [`Options::max_passes`] of these fits.
const ROUGH_PASSES: u32 = 100;

/// How far a search is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Phase {
    /// Fits from points that are known.
    Known,
    /// Rounds of candidates.
    Rounds,
    /// Variations of the best.
    Variations,
    /// The best is brought to the caller's tolerance.
    Last,
    /// It has ended.
    Ended,
}

/// How far a search is, for whoever waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Progress {
    /// What it is at.
    pub phase: Phase,
    /// Rounds that were begun.
    pub rounds: u32,
    /// Candidates of these rounds; of most scans 75 are made, of those that are hard to settle all.
    pub candidates: u32,
    /// Passes so far.
    pub evaluations: Evaluations,
}

/// What the next step does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Task {
    /// It decides what is next.
    Choose,
    /// The next candidate of a round.
    Propose,
    /// A pass for its weights.
    Weigh,
    /// The cost of the next start.
    Level,
    /// The first pass of a fit.
    Begin,
    /// A further one, before it is decided which fits go on.
    Short,
    /// It decides whether the next fit goes on.
    Judge,
    /// A pass of a fit that goes on.
    Converge,
    /// A pass of the best.
    Last,
}

/// Which candidates a round has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Everywhere,
    Band(u32),
    Index,
    Slopes,
}

/// A fit of a round.
#[derive(Clone, Copy, Debug)]
struct Trial<R, const P: usize> {
    fit: Fit<R, P>,
    /// The candidate that it began at.
    start: u64,
}

/// A search of the default method under way, which remembers at most `M` minima and has at most `F` fits under way at a time.
///
/// Its state is plain data without references: it can lie in static memory, be copied, and be saved ([`crate::saved`]).
/// Fewer minima change nothing but the table of them; with fewer than [`FITS`] fits, rounds follow fewer starts, and a minimum is missed more often.
/// The same scene must be given to every step.
///
/// ```
/// # use brdfit_core::{brdf::{ALL, Params}, geometry::{Block, Observation, Sample}, lm::Options, residuals::Scan};
/// use brdfit_core::search::{CANDIDATES, Search, search};
///
/// # let mut blocks = [Block::<f64>::EMPTY; 3];
/// # for row in 0..41 {
/// #     let sample = Sample::in_plane(0.5, (f64::from(row) - 20.0) * 0.05, 0.3 + 0.01 * f64::from(row % 3));
/// #     blocks[row as usize / 16].set(row as usize % 16, &Observation::new(&sample)?);
/// # }
/// # let scan = Scan::<f64, ALL, 6>::new(&blocks);
/// let bounds = Scan::<f64, ALL, 6>::usual_bounds();
/// let mut state = Search::<f64, 6, 4>::new();
/// state.begin(&bounds, 0, CANDIDATES, &Options::default());
/// while state.step(&scan) {
///     // One pass at most since the last time: here the firmware does what else it has to do.
/// }
/// let whole = search(&scan, &bounds, 0, CANDIDATES, &Options::default());
/// assert_eq!(state.best().unwrap().x, whole.best.x);
/// # Ok::<(), brdfit_core::geometry::SampleError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Search<R, const P: usize, const M: usize = MINIMA, const F: usize = FITS> {
    phase: Phase,
    task: Task,
    kind: Kind,
    /// Are further rounds and variations needed to settle the scan?
    unsettled: bool,
    seed: u64,
    /// How many candidates are asked for, and how many rounds and candidates of these were begun.
    candidates: u32,
    round: u32,
    made: u32,
    /// Points that were known.
    known: u32,
    /// Variations: which loop, and which of its rounds is next.
    again: u32,
    group: u32,
    /// The round's next candidate, and where they end.
    next: u32,
    end: u32,
    /// Of `starts`, those that have a cost; then of these, or of `fits`, the one that is next.
    levelled: u32,
    place: u32,
    /// A fit that converges is looked at when it has made so many passes.
    until: u32,
    evaluations: Evaluations,
    bounds: Bounds<R, P>,
    options: Options<R>,
    /// What variations vary, and its cost.
    centre: ([R; P], R),
    candidate: Candidate<R, P>,
    /// Candidates, best first: `cost` is first their rank, and `first_start` which it is.
    starts: Vec<Minimum<R, P>, TRIED>,
    fits: Vec<Trial<R, P>, F>,
    ends: Ends<R, P, M>,
}

impl<R: Real, const P: usize, const M: usize, const F: usize> Default for Search<R, P, M, F> {
    fn default() -> Self {
        Self::new()
    }
}

impl<R: Real, const P: usize, const M: usize, const F: usize> Search<R, P, M, F> {
    /// Memory for a search that is not begun; all zeros.
    pub const fn new() -> Self {
        const { assert!(F > 0, "a search needs room for a fit") };
        Search {
            phase: Phase::Known,
            task: Task::Choose,
            kind: Kind::Everywhere,
            unsettled: false,
            seed: 0,
            candidates: 0,
            round: 0,
            made: 0,
            known: 0,
            again: 0,
            group: 0,
            next: 0,
            end: 0,
            levelled: 0,
            place: 0,
            until: 0,
            evaluations: Evaluations { cost: 0, linearize: 0 },
            bounds: Bounds {
                lower: [R::ZERO; P],
                upper: [R::ZERO; P],
            },
            options: Options {
                cost_tolerance: R::ZERO,
                step_tolerance: R::ZERO,
                max_passes: 0,
                damping: R::ZERO,
            },
            centre: ([R::ZERO; P], R::ZERO),
            candidate: Candidate {
                x: [R::ZERO; P],
                rank: R::ZERO,
                passes: 0,
                waits: Waits::No,
            },
            starts: Vec::new(),
            fits: Vec::new(),
            ends: Ends::new(),
        }
    }

    /// Begins, whatever was there before; no pass. The arguments are those of [`super::search`].
    pub fn begin(&mut self, bounds: &Bounds<R, P>, seed: u64, candidates: u32, options: &Options<R>) {
        (self.phase, self.task, self.kind) = (Phase::Known, Task::Choose, Kind::Everywhere);
        (self.seed, self.candidates) = (seed, candidates.max(1));
        self.unsettled = self.makes_all();
        (self.round, self.made, self.known) = (0, 0, 0);
        self.evaluations = Evaluations::default();
        (self.bounds, self.options) = (*bounds, *options);
        self.starts.clear();
        self.fits.clear();
        self.ends.clear();
    }

    /// Takes a point that is known to be good, before the first round: the next steps are a fit from it. False if the fit of another is still under way, or rounds have begun.
    pub fn offer(&mut self, x: [R; P]) -> bool {
        if (self.phase, self.task) != (Phase::Known, Task::Choose) {
            return false;
        }
        self.starts.clear();
        self.fits.clear();
        let index = u64::from(self.candidates) + u64::from(self.known);
        // There is room.
        let _ = self.starts.push(at(x, R::ZERO, index));
        self.known += 1;
        (self.levelled, self.place, self.task) = (1, 0, Task::Begin);
        true
    }

    /// Goes on by at most one pass of the scan; false if the search has ended.
    pub fn step(&mut self, scene: &(impl Scene<R, P> + ?Sized)) -> bool {
        match self.task {
            _ if self.phase == Phase::Ended => {}
            Task::Choose => self.choose(scene),
            Task::Propose => self.propose(scene),
            Task::Weigh => self.weigh(scene),
            Task::Level => self.level(scene),
            Task::Begin => self.begin_fit(scene),
            Task::Short => self.short(scene),
            Task::Judge => self.judge(scene),
            Task::Converge => self.converge(scene),
            Task::Last => self.last(scene),
        }
        self.phase != Phase::Ended
    }

    /// Ends the search where it is: its best stays.
    pub fn abort(&mut self) {
        self.phase = Phase::Ended;
    }

    /// The best fit so far; none before the first.
    pub fn best(&self) -> Option<&Fit<R, P>> {
        let mut best = &self.ends.best;
        for Trial { fit, .. } in &self.fits {
            if best.passes == 0 || minima::less(fit.at.cost, best.at.cost) {
                best = fit;
            }
        }
        (best.passes > 0).then_some(best)
    }

    /// Distinct minima so far, best first.
    pub fn minima(&self) -> &Minima<R, P, M> {
        &self.ends.minima
    }

    /// How far it is.
    pub fn progress(&self) -> Progress {
        Progress {
            phase: self.phase,
            rounds: self.round,
            candidates: self.made,
            evaluations: self.evaluations,
        }
    }

    /// Are all candidates made that are asked for, even if they are of no use?
    fn makes_all(&self) -> bool {
        self.candidates > CANDIDATES
    }

    /// How the fits are made, but the last.
    fn rough(&self) -> Options<R> {
        Options {
            cost_tolerance: self.options.cost_tolerance.max(R::of(ROUGH)),
            max_passes: self.options.max_passes.min(ROUGH_PASSES),
            ..self.options
        }
    }

    #[cfg_attr(target_os = "none", inline(never))]
    fn choose(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
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

    fn begin_round(&mut self, first: u32, end: u32, kind: Kind) {
        self.round += 1;
        (self.next, self.end, self.kind) = (first, end, kind);
        self.starts.clear();
        self.fits.clear();
        self.task = Task::Propose;
    }

    #[cfg_attr(target_os = "none", inline(never))]
    fn propose(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        let region = match self.kind {
            Kind::Everywhere => Region::Everywhere,
            Kind::Band(band) => Region::Band(band),
            Kind::Index => Region::Index(&self.centre.0),
            Kind::Slopes => Region::Slopes(&self.centre.0),
        };
        self.candidate = scene.propose(&self.bounds, self.seed, u64::from(self.next), region);
        self.evaluations.cost += self.candidate.passes;
        self.rank();
    }

    #[cfg_attr(target_os = "none", inline(never))]
    fn weigh(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
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
        let Candidate { x, rank, .. } = self.candidate;
        // Narrow bounds make one of several.
        if self.starts.iter().all(|start| start.x != x) {
            let index = u64::from(self.next);
            minima::insert(&mut self.starts, &at(x, rank, index));
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
        begun.min(F) as u32
    }

    /// The cost of the next start, which moves to its place among those that have one; these are the first.
    #[cfg_attr(target_os = "none", inline(never))]
    fn level(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        let (place, begun) = (self.place as usize, self.begun());
        if let Some(start) = self.starts.get_mut(place) {
            let (x, cost) = scene.level(&self.bounds, &start.x);
            (start.x, start.cost) = (x, cost);
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
    fn begin_fit(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        if let Some(&Minimum { x, first_start, .. }) = self.starts.get(self.place as usize) {
            let fit = Fit::begin(scene, &self.bounds, x, &self.rough());
            self.evaluations.linearize += 1;
            // There is room.
            let _ = self.fits.push(Trial {
                fit,
                start: first_start,
            });
        }
        self.begun_or_not();
    }

    fn short(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
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
        let mut rest = self.fits.as_mut_slice();
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
    fn judge(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        let Some(Trial { fit, .. }) = self.fits.get(self.place as usize) else {
            self.task = Task::Choose;
            return;
        };
        if self.phase != Phase::Known {
            self.ends.note_rival(scene, fit);
        }
        if self.place == 0 && self.kind != Kind::Index || self.ends.is_near(fit.at.cost, R::of(NEAR)) {
            (self.until, self.task) = (0, Task::Converge);
        } else {
            self.place += 1;
        }
    }

    #[cfg_attr(target_os = "none", inline(never))]
    fn converge(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        let rough = self.rough();
        if let Some(Trial { fit, start }) = self.fits.get_mut(self.place as usize) {
            if fit.stop.is_some() || fit.passes >= self.until {
                if self.ends.is_over(fit, *start, self.round) {
                    self.place += 1;
                    self.task = Task::Judge;
                    return;
                }
                self.until = fit.passes + 2;
            }
            self.evaluations.linearize += fit.step(scene, &self.bounds, &rough);
        }
    }

    fn last(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        let best = &mut self.ends.best;
        if best.stop.is_none() {
            self.evaluations.linearize += best.step(scene, &self.bounds, &self.options);
            return;
        }
        self.ends.minima.refine(best);
        self.phase = Phase::Ended;
        log(best, self.ends.minima.as_slice().len(), self.evaluations);
    }
}

impl<R: Real, const P: usize> Search<R, P> {
    /// What it found.
    pub(super) fn into_found(self) -> Found<R, P> {
        Found {
            best: self.ends.best,
            minima: self.ends.minima,
            evaluations: self.evaluations,
        }
    }
}

impl<R: Real, const P: usize, const M: usize, const F: usize> Saved for Search<R, P, M, F> {
    fn shape(&self) -> [u32; 3] {
        let capacities = (P as u32) << 24 | (F as u32 & 0xff) << 16 | M as u32 & 0xffff;
        [3, size_of::<R>() as u32, capacities]
    }
    fn fields(&mut self, tape: &mut Tape<'_>) {
        use Task::{Begin, Choose, Converge, Judge, Last, Level, Propose, Short, Weigh};
        let phases = [
            Phase::Known,
            Phase::Rounds,
            Phase::Variations,
            Phase::Last,
            Phase::Ended,
        ];
        tape.one_of(&mut self.phase, &phases);
        let tasks = [Choose, Propose, Weigh, Level, Begin, Short, Judge, Converge, Last];
        tape.one_of(&mut self.task, &tasks);
        let bands: [Kind; BANDS as usize] = core::array::from_fn(|band| Kind::Band(band as u32));
        let mut band = bands.contains(&self.kind);
        tape.flag(&mut band);
        if band {
            tape.one_of(&mut self.kind, &bands);
        } else {
            tape.one_of(&mut self.kind, &[Kind::Everywhere, Kind::Index, Kind::Slopes]);
        }
        tape.flag(&mut self.unsettled);
        tape.u64(&mut self.seed);
        for number in [
            &mut self.candidates,
            &mut self.round,
            &mut self.made,
            &mut self.known,
            &mut self.again,
            &mut self.group,
            &mut self.next,
            &mut self.end,
            &mut self.levelled,
            &mut self.place,
            &mut self.until,
            &mut self.evaluations.cost,
            &mut self.evaluations.linearize,
            &mut self.options.max_passes,
            &mut self.candidate.passes,
        ] {
            tape.u32(number);
        }
        tape.one_of(&mut self.candidate.waits, &[Waits::No, Waits::Weights, Waits::Fading]);
        for numbers in [
            &mut self.bounds.lower,
            &mut self.bounds.upper,
            &mut self.centre.0,
            &mut self.candidate.x,
        ] {
            tape.reals(numbers);
        }
        for number in [
            &mut self.options.cost_tolerance,
            &mut self.options.step_tolerance,
            &mut self.options.damping,
            &mut self.centre.1,
            &mut self.candidate.rank,
        ] {
            tape.reals(core::slice::from_mut(number));
        }
        tape.list(&mut self.starts, &Minimum::EMPTY, |tape, start| start.fields(tape));
        let empty = Trial {
            fit: Fit::nowhere(),
            start: 0,
        };
        tape.list(&mut self.fits, &empty, |tape, trial| {
            trial.fit.fields(tape);
            tape.u64(&mut trial.start);
        });
        self.ends.fields(tape);
    }
}

/// Candidate `index`.
fn at<R, const P: usize>(x: [R; P], cost: R, index: u64) -> Minimum<R, P> {
    Minimum {
        x,
        cost,
        hits: 0,
        first_start: index,
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
