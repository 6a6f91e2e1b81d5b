//! The default method as steps of at most one pass each.

mod plan;
mod round;
mod saved;

use heapless::Vec;

use super::ends::{EXACT, Ends};
use super::{Candidate, Evaluations, Found, MINIMA, Scene, Waits, log};
use crate::list::List;
use crate::lm::{Bounds, Fit, Options, Stop};
use crate::minima::{self, Minima, Minimum};
use crate::real::Real;

pub use plan::CANDIDATES;

/// Fits that [`super::search`] has under way at most; a round needs no more.
pub const FITS: usize = SLOPES_BEGUN;

/// How many of a round's candidates are tried by cost, and for how many of them a fit begins.
const TRIED: usize = 7;
const BEGUN: usize = 3;
/// For how many of a group of variations a fit begins, and for how many with other slopes than the best.
const GROUP_BEGUN: usize = 2;
const SLOPES_BEGUN: usize = 4;
/// Passes of a fit before it is decided which of a round go on; a variation begins nearer to where it ends.
const SHORT: u32 = 4;
const VARIATION_SHORT: u32 = 3;
/// [`Options::cost_tolerance`] of the fits of a search; the best is then brought to that of the caller.
const ROUGH: f64 = 3e-8;
/// [`Options::max_passes`] of these fits.
const ROUGH_PASSES: u32 = 100;
/// Passes at most in which the best, at the end, comes to stand still.
pub const SETTLING: u32 = 10;

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
    /// Candidates of these rounds; of most scans 60 or 75 are made, of those that are hard to settle all.
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
    /// The same, of a fit that was begun once more where the last ended on the limit of passes.
    Again,
    /// A pass of the best when its cost falls no more; the fit that is left has a model of its second derivatives.
    Settle,
}

/// Which candidates a round has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Everywhere,
    Band(u32),
    Corner(u32),
    Index,
    Slopes,
}

/// A fit of a round: what the list of a search holds of fits under way.
#[derive(Clone, Copy, Debug)]
pub struct Trial<R, const P: usize> {
    fit: Fit<R, P>,
    /// The candidate that it began at.
    start: u64,
}

impl<R: Real, const P: usize> Trial<R, P> {
    /// None: what this memory holds at first.
    pub const EMPTY: Self = Trial {
        fit: Fit::nowhere(),
        start: 0,
    };
}

/// A search of the default method under way, which remembers at most `M` minima and has at most `F` fits under way at a time; its state is within it.
pub type Search<R, const P: usize, const M: usize = MINIMA, const F: usize = FITS> =
    SearchIn<R, P, Vec<Minimum<R, P>, M>, Vec<Trial<R, P>, F>>;

/// A search of the default method under way, which remembers as many minima as the list `M` holds, and has as many fits under way as `F` holds: lists of its own ([`Search`]), or in slices of lengths that are known when it runs ([`SearchIn::over`]).
///
/// The state of a [`Search`] is plain data without references: it can lie in static memory, be copied, and be saved ([`crate::saved`]).
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
// In this order: what lies first is reached by shorter instructions.
#[repr(C)]
pub struct SearchIn<R, const P: usize, M, F> {
    phase: Phase,
    task: Task,
    /// Are further rounds and variations needed to settle the scan?
    unsettled: bool,
    /// Have fits ended in the best end with other slopes? Then the scan does not tell these there, but may tell them beside, where a second sample sees the lobe.
    flat: bool,
    /// Had a fit of this round other slopes than the best end?
    elsewhere: bool,
    kind: Kind,
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
    seed: u64,
    bounds: Bounds<R, P>,
    options: Options<R>,
    /// What variations vary, and its cost.
    centre: ([R; P], R),
    candidate: Candidate<R, P>,
    /// Candidates, best first: `cost` is first their rank, and `first_start` which it is.
    starts: Vec<Minimum<R, P>, TRIED>,
    ends: Ends<R, P, M>,
    fits: F,
}

impl<R: Real, const P: usize, const M: usize, const F: usize> Default for Search<R, P, M, F> {
    fn default() -> Self {
        Self::new()
    }
}

impl<R: Real, const P: usize, const M: usize, const F: usize> Search<R, P, M, F> {
    /// Memory for a search that is not begun; all zeros.
    pub const fn new() -> Self {
        // Made when it is compiled: then zeros are what is left to be written.
        const {
            assert!(F > 0, "a search needs room for a fit");
            Self::over(Vec::new(), Vec::new())
        }
    }
}

impl<R: Real, const P: usize, M: List<Item = Minimum<R, P>>, F: List<Item = Trial<R, P>>> SearchIn<R, P, M, F> {
    /// A search that is not begun, over empty lists for its minima and for at least one fit: it has no best where there is room for none.
    ///
    /// ```
    /// use brdfit_core::list::Lent;
    /// use brdfit_core::minima::Minimum;
    /// use brdfit_core::search::{SearchIn, Trial};
    ///
    /// // As many as the caller wants today.
    /// let (minima, fits) = (5, 2);
    /// let mut minima = vec![Minimum::<f32, 6>::EMPTY; minima];
    /// let mut fits = vec![Trial::<f32, 6>::EMPTY; fits];
    /// let search = SearchIn::over(Lent::new(&mut minima), Lent::new(&mut fits));
    /// assert_eq!(search.minima().capacity(), 5);
    /// ```
    pub const fn over(minima: M, fits: F) -> Self {
        SearchIn {
            phase: Phase::Known,
            task: Task::Choose,
            kind: Kind::Everywhere,
            unsettled: false,
            flat: false,
            elsewhere: false,
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
            fits,
            ends: Ends::over(minima),
        }
    }

    /// Begins, whatever was there before; no pass. The arguments are those of [`super::search`].
    pub fn begin(&mut self, bounds: &Bounds<R, P>, seed: u64, candidates: u32, options: &Options<R>) {
        (self.phase, self.task, self.kind) = (Phase::Known, Task::Choose, Kind::Everywhere);
        (self.seed, self.candidates) = (seed, candidates.max(1));
        self.unsettled = self.makes_all();
        self.flat = false;
        (self.round, self.made, self.known) = (0, 0, 0);
        self.evaluations = Evaluations::default();
        (self.bounds, self.options) = (*bounds, *options);
        self.starts.truncate(0);
        self.fits.truncate(0);
        self.ends.clear();
    }

    /// The lists of minima and fits: for lists whose memory was copied to another place.
    pub fn lists_mut(&mut self) -> (&mut M, &mut F) {
        (self.ends.minima.list_mut(), &mut self.fits)
    }

    /// Takes a point that is known to be good, before the first round: the next steps are a fit from it. False if the fit of another is still under way, or rounds have begun.
    pub fn offer(&mut self, x: [R; P]) -> bool {
        if (self.phase, self.task) != (Phase::Known, Task::Choose) {
            return false;
        }
        self.starts.truncate(0);
        self.fits.truncate(0);
        let index = u64::from(self.candidates) + u64::from(self.known);
        List::push(&mut self.starts, &at(x, R::ZERO, index));
        self.known += 1;
        (self.levelled, self.place, self.task) = (1, 0, Task::Begin);
        true
    }

    /// Goes on by at most one pass of the scan; false if the search has ended.
    #[cfg_attr(target_os = "none", inline(never))]
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
            Task::Last | Task::Again => self.last(scene),
            Task::Settle => self.settle(scene),
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
        for Trial { fit, .. } in self.fits.iter() {
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
    #[cfg_attr(target_os = "none", inline(never))]
    fn rough(&self) -> Options<R> {
        Options {
            cost_tolerance: self.options.cost_tolerance.max(R::of(ROUGH)),
            max_passes: self.options.max_passes.min(ROUGH_PASSES),
            ..self.options
        }
    }

    fn last(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        let exact = self.ends.is_below(R::of(EXACT));
        let best = &mut self.ends.best;
        if best.stop.is_none() {
            self.evaluations.linearize += best.step(scene, &self.bounds, &self.options);
            return;
        }
        if best.stop == Some(Stop::Passes) && self.task == Task::Last {
            self.again(scene);
            return;
        }
        // The gradient of an exact fit is rounding.
        let settles = best.stop.is_some_and(Stop::converged) && self.options.cost_tolerance <= R::EPSILON && !exact;
        self.until = if settles { best.passes + SETTLING } else { 0 };
        self.fits.truncate(0);
        self.fits.push(&Trial { fit: *best, start: 0 });
        self.task = Task::Settle;
    }

    /// Begins the best once more from where it is: along a valley it has become slow, by what it remembers of where it came from.
    #[cfg_attr(target_os = "none", inline(never))]
    fn again(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        let best = &mut self.ends.best;
        *best = Fit::begin(scene, &self.bounds, best.x, &self.options);
        self.evaluations.linearize += 1;
        self.task = Task::Again;
    }

    fn settle(&mut self, scene: &(impl Scene<R, P> + ?Sized)) {
        let best = &mut self.ends.best;
        if best.passes < self.until
            && let Some(Trial { fit, .. }) = self.fits.first_mut()
        {
            let passes = best.settle(scene, &self.bounds, &mut fit.at.hessian);
            self.evaluations.linearize += passes;
            if passes > 0 {
                return;
            }
        }
        self.fits.truncate(0);
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

/// Candidate `index`.
fn at<R, const P: usize>(x: [R; P], cost: R, index: u64) -> Minimum<R, P> {
    Minimum {
        x,
        cost,
        hits: 0,
        first_start: index,
    }
}
