//! The search for the global optimum: the paper's, and a faster one.
//!
//! # The default method
//! 1. A round proposes candidates (`candidate.rs`), each with the weights that fit best. The most promising are levelled, which gives their cost; the best of those are fitted for a few passes; the best of these converges, and with it the first that has other slopes than the best end, and each that is near the best cost known, unless it comes so near to an end already found that it would end there.
//! 2. After four or five rounds most scans are settled: the best end was reached more than once, with the same slopes, and no fit with other slopes is anywhere near it, nor the best nearly as poor as any candidate. Where that is not so, further rounds look at one part of the range of slopes after the other.
//! 3. Then come variations of the best: the same slopes, other kinds of index. Minima that differ in the regime of F alone (dielectric, metal, n near 1) lie beside each other, and this is what tells them apart. Where other slopes are near, slopes that pairs of samples tell are tried as well; and where the best is then on an upper bound, or the rounds did not settle a scan that the model does not follow well, weights near their bounds, with one part of the range of slopes after the other.
//! 4. The best is brought to the caller's tolerance; until then 3e-8 is enough. If it ends on the limit of passes, as along a valley, it is begun once more from there. If the tolerance is rounding, it then goes on along its valley by the gradient, as costs tell no more, so that the end is the same whatever start led there.
//!
//! It is made in steps of at most one pass each ([`Search::step`]), with its state in memory of the caller; [`search`] takes them all.
//!
//! What it misses, and what other designs missed: `benches/results/search.md`, made by `cargo bench --bench missed`.

mod ends;
mod steps;

use crate::lm::{self, Bounds, Fit, Options, Problem};
pub use crate::minima::MINIMA;
use crate::minima::Minima;
use crate::real::Real;
use crate::start;

pub use steps::{CANDIDATES, FITS, Phase, Progress, SETTLING, Search, SearchIn, Trial};

/// Starts of the paper's method (section 3).
pub const PAPER_STARTS: u32 = 250;
/// Parts of the range of slopes that rounds look at one by one.
pub const BANDS: u32 = 8;

/// What a candidate waits for before it can be compared with others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Waits {
    /// Nothing.
    No,
    /// The weights that fit best; one pass.
    Weights,
    /// The same, and once more after [`crate::model::Model::fade`] if that moves it.
    Fading,
}

/// A start worth a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Candidate<R, const P: usize> {
    /// The start.
    pub x: [R; P],
    /// The lower, the more promising: a sum of squares that came with the start for nothing.
    pub rank: R,
    /// Passes without derivatives that it took so far.
    pub passes: u32,
    /// What it waits for: see [`Scene::weigh`].
    pub waits: Waits,
}

/// Where a candidate is looked for.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Region<'a, R, const P: usize> {
    /// Everywhere within the bounds.
    Everywhere,
    /// Slopes in one of [`BANDS`] parts of their range.
    Band(u32),
    /// The same where weights near their bounds go with an index of refraction at which the model all but vanishes ([`crate::model::Model::fade`]).
    Corner(u32),
    /// The slopes of a point, with another index: what decides between the minima near it.
    Index(&'a [R; P]),
    /// Slopes that samples near a peak tell, half of them with the index of a point.
    Slopes(&'a [R; P]),
}

/// A problem that can propose good starts.
pub trait Scene<R, const P: usize>: Problem<R, P> {
    /// Candidate `i` of the sequence of `seed` in a region, as far as it can be told without a pass.
    fn propose(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, region: Region<R, P>) -> Candidate<R, P>;

    /// Gives a candidate what it waits for; one pass as cheap as [`Problem::cost`], or none if it waits for nothing. After two of them it waits no more.
    fn weigh(&self, bounds: &Bounds<R, P>, candidate: &mut Candidate<R, P>);

    /// Candidate `i` of the sequence of `seed` in a region; at most two passes as cheap as [`Problem::cost`].
    fn candidate(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, region: Region<R, P>) -> Candidate<R, P> {
        let mut candidate = self.propose(bounds, seed, i, region);
        while candidate.waits != Waits::No {
            self.weigh(bounds, &mut candidate);
        }
        candidate
    }

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
    pub minima: Minima<R, P>,
    /// What it cost.
    pub evaluations: Evaluations,
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
    log(&best, minima.as_slice().len(), evaluations);
    Found {
        best,
        minima,
        evaluations,
    }
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
    let mut search = Search::<R, P>::new();
    search.begin(bounds, seed, candidates, options);
    for &x in known {
        while !search.offer(x) {
            search.step(scene);
        }
    }
    while search.step(scene) {}
    search.into_found()
}

/// A line for each search that ends.
fn log<R: Real, const P: usize>(best: &Fit<R, P>, minima: usize, evaluations: Evaluations) {
    #[cfg(feature = "defmt")]
    defmt::info!(
        "search: cost {=f64}, {=usize} minima, {}",
        best.at.cost.f64(),
        minima,
        evaluations
    );
    #[cfg(not(feature = "defmt"))]
    let _ = (best, minima, evaluations);
}
