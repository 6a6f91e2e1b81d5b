//! The search for the global optimum: the paper's, and a faster one.
//!
//! # The default method
//! 1. A round proposes candidates (`candidate.rs`), each with the weights that fit best. The most promising are levelled, which gives their cost; the best of those are fitted for a few passes; the best of these converges, and with it each that is near the best cost known, unless it comes so near to an end already found that it would end there.
//! 2. After five rounds most scans are settled: the best end was reached more than once, and no fit with other slopes is anywhere near it. Where that is not so, further rounds look at one part of the range of slopes after the other.
//! 3. Then come variations of the best: the same slopes, other kinds of index. Minima that differ in the regime of F alone (dielectric, metal, n near 1) lie beside each other, and this is what tells them apart. Where other slopes are near, slopes that pairs of samples tell are tried as well.
//! 4. The best is brought to the caller's tolerance; until then 1e-8 is enough.
//!
//! What it misses, and what other designs missed: `benches/results/search.md`, made by `cargo bench --bench missed`.

use core::ops::Range;

use heapless::Vec;

use crate::lm::{self, Bounds, Fit, Options, Problem};
use crate::minima::{self, Minima};
use crate::propose::{GROUPS, INDICES};
use crate::real::Real;
use crate::start;

/// Capacity of the table of minima of a search.
pub const MINIMA: usize = 32;
/// Starts of the paper's method (section 3).
pub const PAPER_STARTS: u32 = 250;
/// The default method makes at most this many candidates, if nothing else is asked for.
pub const CANDIDATES: u32 = (ROUNDS + CYCLES * BANDS) * ROUND;
/// Parts of the range of slopes that rounds look at one by one.
pub const BANDS: u32 = 8;

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
/// A fit goes on that is within this factor of the best cost.
const NEAR: f64 = 1.05;
/// A fit is given up that is beyond this factor of the best cost after so many passes.
const HOPELESS: (f64, u32) = (10.0, 10);
/// An end whose slopes differ from the best by more than this factor, and its cost by less than that one, leaves a scan unsettled.
const RIVAL_END: (f64, f64) = (1.1, 2.0);
/// The same for a fit of a few passes.
const RIVAL_FIT: (f64, f64) = (1.35, 1.3);
/// Rounds that must have led to the best end: after the first rounds, and after the first parts of the range of slopes.
const HITS: (u32, u32) = (2, 3);
/// A scan without noise: the best cost is below this part of that of a poor candidate. Then the cost does not tell what is near, and nothing settles it.
const EXACT: f64 = 1e-9;
/// Ends that are remembered.
const ENDS: usize = 16;
/// Two ends of the same cost, to this part, are one.
const SAME: f64 = 1e-5;
/// [`Options::cost_tolerance`] of the fits of a search; the best is then brought to that of the caller.
const ROUGH: f64 = 1e-8;
/// [`Options::max_passes`] of these fits.
const ROUGH_PASSES: u32 = 100;

/// A start worth a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Candidate<R, const P: usize> {
    /// The start.
    pub x: [R; P],
    /// The lower, the more promising: a sum of squares that came with the start for nothing.
    pub rank: R,
    /// Passes without derivatives that it took, if any.
    pub passes: u32,
}

/// Where a candidate is looked for.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Region<'a, R, const P: usize> {
    /// Everywhere within the bounds.
    Everywhere,
    /// Slopes in one of [`BANDS`] parts of their range.
    Band(u32),
    /// The slopes of a point, with another index: what decides between the minima near it.
    Index(&'a [R; P]),
    /// Slopes that samples near a peak tell, half of them with the index of a point.
    Slopes(&'a [R; P]),
}

/// A problem that can propose good starts.
pub trait Scene<R, const P: usize>: Problem<R, P> {
    /// Candidate `i` of the sequence of `seed` in a region; at most two passes as cheap as [`Problem::cost`].
    fn candidate(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, region: Region<R, P>) -> Candidate<R, P>;

    /// A point with its weights scaled so that the mean residual is 0, as far as the bounds let them, and the cost there; one pass as cheap as [`Problem::cost`].
    fn level(&self, bounds: &Bounds<R, P>, x: &[R; P]) -> ([R; P], R);

    /// Do the slopes of two points differ by more than this factor?
    fn apart(&self, x: &[R; P], y: &[R; P], factor: R) -> bool;
}

/// How many evaluations were made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Evaluations {
    /// Passes over the scan without derivatives.
    pub cost: u32,
    /// Passes with derivatives.
    pub linearize: u32,
}

/// What a search found.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Found<R, const P: usize> {
    /// The fit that ended in the best of them.
    pub best: Fit<R, P>,
    /// Distinct minima, best first.
    pub minima: Minima<R, P, MINIMA>,
    /// What it cost.
    pub evaluations: Evaluations,
}

impl<R: Real, const P: usize> Found<R, P> {
    fn new(best: Fit<R, P>, minima: Minima<R, P, MINIMA>, evaluations: Evaluations) -> Self {
        #[cfg(feature = "defmt")]
        defmt::info!(
            "search: cost {=f64}, {=usize} minima, {}",
            best.at.cost.f64(),
            minima.as_slice().len(),
            evaluations
        );
        Found {
            best,
            minima,
            evaluations,
        }
    }
}

/// Fit `i` of the paper's method: from a start uniform over the bounds to convergence (section 3 of the paper).
pub fn paper_fit<R: Real, const P: usize>(
    problem: &(impl Problem<R, P> + ?Sized),
    bounds: &Bounds<R, P>,
    seed: u64,
    i: u64,
    options: &Options<R>,
) -> Fit<R, P> {
    lm::fit(problem, bounds, start::uniform(seed, i, bounds), options)
}

/// The paper's method: `starts` fits, their distinct minima, and the best fitted again from its own parameters.
///
/// `fits` are those of [`paper_fit`] in order of start, made one by one or on many threads.
pub fn paper<R: Real, const P: usize>(
    problem: &(impl Problem<R, P> + ?Sized),
    bounds: &Bounds<R, P>,
    fits: impl IntoIterator<Item = Fit<R, P>>,
    options: &Options<R>,
) -> Found<R, P> {
    let mut minima = Minima::default();
    let mut evaluations = Evaluations::default();
    for (i, fit) in fits.into_iter().enumerate() {
        evaluations.linearize += fit.passes;
        minima.add(&fit, i as u64);
    }
    let start = minima.best().map_or(bounds.lower, |best| best.x);
    let best = lm::fit(problem, bounds, start, options);
    evaluations.linearize += best.passes;
    minima.refine(&best);
    Found::new(best, minima, evaluations)
}

/// The default method.
///
/// At most `candidates` are made, not counting the variations of the best.
/// Up to [`CANDIDATES`], it ends as soon as more of them would be of no use; of a larger number, all are made.
pub fn search<R: Real, const P: usize>(
    scene: &(impl Scene<R, P> + ?Sized),
    bounds: &Bounds<R, P>,
    seed: u64,
    candidates: u32,
    options: &Options<R>,
) -> Found<R, P> {
    search_from(scene, bounds, seed, candidates, &[], options)
}

/// The same from points that are known too: it ends no higher than the nearest points to them within the bounds.
pub fn search_from<R: Real, const P: usize>(
    scene: &(impl Scene<R, P> + ?Sized),
    bounds: &Bounds<R, P>,
    seed: u64,
    candidates: u32,
    known: &[[R; P]],
    options: &Options<R>,
) -> Found<R, P> {
    let rough = Options {
        cost_tolerance: options.cost_tolerance.max(R::of(ROUGH)),
        max_passes: options.max_passes.min(ROUGH_PASSES),
        ..*options
    };
    let mut search = Search {
        scene,
        bounds,
        seed,
        options: &rough,
        round: 0,
        best: None,
        ends: Vec::new(),
        poorest: R::ZERO,
        rival: None,
        minima: Minima::default(),
        evaluations: Evaluations::default(),
    };
    for (&x, start) in known.iter().zip(u64::from(candidates)..) {
        let mut fit = Fit::begin(scene, bounds, x, &rough);
        search.converge(&mut fit, start);
        search.evaluations.linearize += fit.passes;
    }
    let unsettled = search.rounds(candidates);
    search.variations(unsettled);
    let Search {
        best,
        mut minima,
        mut evaluations,
        ..
    } = search;
    let mut best = best.unwrap_or_else(|| Fit::begin(scene, bounds, bounds.lower, options));
    let before = best.passes;
    best.stop = None;
    best.run(scene, bounds, options, u32::MAX);
    evaluations.linearize += best.passes - before;
    minima.refine(&best);
    Found::new(best, minima, evaluations)
}

/// Where the candidates of a round are looked for: everywhere at first, and then in one part of the range of slopes after the other.
fn region<'a, R, const P: usize>(round: u32) -> Region<'a, R, P> {
    match round.checked_sub(ROUNDS) {
        Some(band) if band % (2 * BANDS) < BANDS || band < CYCLES * BANDS => {
            // The first of them are spread over the range.
            Region::Band(band * 5 % BANDS)
        }
        _ => Region::Everywhere,
    }
}

/// Where fits have ended; unlike a distinct minimum, one for each cost.
struct End<R, const P: usize> {
    x: [R; P],
    cost: R,
    /// In how many rounds a fit ended here, and the last of them.
    hits: u32,
    round: u32,
}

struct Search<'a, R, S: ?Sized, const P: usize> {
    scene: &'a S,
    bounds: &'a Bounds<R, P>,
    seed: u64,
    options: &'a Options<R>,
    /// Number of rounds so far.
    round: u32,
    /// The fit that ended best.
    best: Option<Fit<R, P>>,
    /// The ends of least cost, best first.
    ends: Vec<End<R, P>, ENDS>,
    /// The largest cost of a candidate.
    poorest: R,
    /// The best short fit with other slopes than the best end.
    rival: Option<([R; P], R)>,
    minima: Minima<R, P, MINIMA>,
    evaluations: Evaluations,
}

impl<R: Real, S: Scene<R, P> + ?Sized, const P: usize> Search<'_, R, S, P> {
    /// Rounds until the scan is settled or `candidates` are made; true if it is not settled.
    fn rounds(&mut self, candidates: u32) -> bool {
        let ends_early = candidates <= CANDIDATES;
        let mut unsettled = !ends_early;
        let mut made = 0;
        while made < candidates.max(1) {
            let round = self.round;
            if ends_early && round == ROUNDS {
                let rivals = self.has_rival_fit() || self.has_rival_end();
                unsettled = self.best_hits() < HITS.0 || rivals || self.is_exact();
            }
            let settled = if round == ROUNDS + FIRST_BANDS {
                !unsettled || self.best_hits() >= HITS.1 && !self.has_rival_end() && !self.is_exact()
            } else {
                round >= ROUNDS && !unsettled
            };
            if ends_early && settled {
                break;
            }
            let end = made.saturating_add(ROUND).min(candidates.max(1));
            self.round(made..end, region(round), BEGUN);
            made = end;
        }
        unsettled
    }

    /// Variations of the best, and again of a better one that they lead to.
    fn variations(&mut self, unsettled: bool) {
        for again in 0..LOOPS {
            let Some(before) = self.best else { return };
            let mut start = again * VARIATIONS;
            for group in GROUPS {
                let end = again * VARIATIONS + group;
                self.round(start..end, Region::Index(&before.x), GROUP_BEGUN);
                start = end;
            }
            if unsettled {
                let slopes = again * SLOPES..(again + 1) * SLOPES;
                self.round(slopes, Region::Slopes(&before.x), SLOPES_BEGUN);
            }
            let least = before.at.cost * R::of(1.0 - 1e-6);
            if !self.best.is_some_and(|best| best.at.cost < least) {
                return;
            }
        }
    }

    /// Candidates by rank, the best of them by cost, short fits of the best of those, convergence of the best of these.
    fn round(&mut self, indices: Range<u32>, region: Region<R, P>, begun: usize) {
        self.round += 1;
        let mut ranked: Vec<(R, u32, [R; P]), TRIED> = Vec::new();
        for i in indices {
            let candidate = self.scene.candidate(self.bounds, self.seed, u64::from(i), region);
            self.evaluations.cost += candidate.passes;
            // Narrow bounds make one of several.
            if ranked.iter().all(|&(_, _, x)| x != candidate.x) {
                minima::insert(&mut ranked, TRIED, (candidate.rank, i, candidate.x), |ranked| ranked.0);
            }
        }
        let mut levelled: Vec<(R, u32, [R; P]), SLOPES_BEGUN> = Vec::new();
        for &(_, i, x) in &ranked {
            self.evaluations.cost += 1;
            let (x, cost) = self.scene.level(self.bounds, &x);
            self.poorest = self.poorest.max(cost);
            minima::insert(&mut levelled, begun, (cost, i, x), |levelled| levelled.0);
        }
        let mut fits: Vec<(Fit<R, P>, u32), SLOPES_BEGUN> = Vec::new();
        let varies = matches!(region, Region::Index(_));
        let short = if varies { VARIATION_SHORT } else { SHORT };
        for &(_, i, x) in &levelled {
            let mut fit = Fit::begin(self.scene, self.bounds, x, self.options);
            fit.run(self.scene, self.bounds, self.options, short);
            let _ = fits.push((fit, i));
            minima::sift(&mut fits, |(fit, _)| fit.at.cost);
        }
        for (place, (fit, i)) in fits.iter_mut().enumerate() {
            self.note_rival(fit);
            if place == 0 && !varies || self.is_near(fit.at.cost, NEAR) {
                self.converge(fit, u64::from(*i));
            }
            self.evaluations.linearize += fit.passes;
        }
    }

    /// Is a cost within this factor of the best?
    fn is_near(&self, cost: R, factor: f64) -> bool {
        self.ends.first().is_none_or(|best| cost < best.cost * R::of(factor))
    }

    /// Is there no noise in the scan?
    fn is_exact(&self) -> bool {
        self.ends
            .first()
            .is_some_and(|best| best.cost < self.poorest * R::of(EXACT))
    }

    /// In how many rounds a fit has ended in the best.
    fn best_hits(&self) -> u32 {
        self.ends.first().map_or(0, |best| best.hits)
    }

    /// Remembers a short fit with other slopes than the best.
    fn note_rival(&mut self, fit: &Fit<R, P>) {
        let Some(best) = self.ends.first() else { return };
        let is_rival = |x: &[R; P]| self.scene.apart(x, &best.x, R::of(RIVAL_FIT.0));
        let old = self.rival.filter(|(x, _)| is_rival(x));
        if is_rival(&fit.x) && old.is_none_or(|(_, cost)| fit.at.cost < cost) {
            self.rival = Some((fit.x, fit.at.cost));
        }
    }

    /// Came a short fit with other slopes near the best?
    fn has_rival_fit(&self) -> bool {
        let (Some(best), Some((x, cost))) = (self.ends.first(), &self.rival) else {
            return false;
        };
        self.is_near(*cost, RIVAL_FIT.1) && self.scene.apart(x, &best.x, R::of(RIVAL_FIT.0))
    }

    /// Is an end with other slopes near the best?
    fn has_rival_end(&self) -> bool {
        let [best, others @ ..] = self.ends.as_slice() else {
            return false;
        };
        let mut near = others.iter().filter(|end| self.is_near(end.cost, RIVAL_END.1));
        near.any(|end| self.scene.apart(&end.x, &best.x, R::of(RIVAL_END.0)))
    }

    /// Fits to convergence, or until it is plain that the fit joins an end already found, or leads nowhere.
    fn converge(&mut self, fit: &mut Fit<R, P>, start: u64) {
        loop {
            let converged = fit.stop.is_some();
            let place = self.ends.iter().position(|end| {
                if converged {
                    minima::close(end.cost, fit.at.cost, R::of(SAME))
                } else {
                    minima::joins((&end.x, end.cost), fit)
                }
            });
            if place.is_some() || converged {
                self.end(fit, place);
                return self.minima.add(fit, start);
            }
            if fit.passes > HOPELESS.1 && !self.is_near(fit.at.cost, HOPELESS.0) {
                return;
            }
            let passes = fit.passes + 2;
            fit.run(self.scene, self.bounds, self.options, passes);
        }
    }

    /// Takes note that a fit ends in the end at `place`, or in a new one.
    fn end(&mut self, fit: &Fit<R, P>, place: Option<usize>) {
        let old = place.and_then(|place| minima::take(&mut self.ends, place));
        let mut end = old.unwrap_or(End {
            x: fit.x,
            cost: fit.at.cost,
            hits: 0,
            round: 0,
        });
        if end.round < self.round {
            (end.hits, end.round) = (end.hits + 1, self.round);
        }
        if fit.at.cost < end.cost {
            (end.x, end.cost) = (fit.x, fit.at.cost);
        }
        minima::insert(&mut self.ends, ENDS, end, |end| end.cost);
        if self.best.is_none_or(|best| minima::less(fit.at.cost, best.at.cost)) {
            self.best = Some(*fit);
        }
    }
}
