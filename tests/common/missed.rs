//! The default search beside the best that many methods find, on random scans of every kind.

use std::cell::Cell;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use brdfit::engine::blocks;
use brdfit_core::brdf::{ALL, Params};
use brdfit_core::lm::{self, Bounds, Fit, Linearization, Options, Problem};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::search::{self, Candidate, Region, Scene};

use crate::hard_scenes::{Kind, Task, task};
use crate::random_scenes::brute;

/// A search that ends by more than this part above the least cost known has missed it.
pub const MISSED: f64 = 1e-4;
/// Candidates, and mixed starts, of the searches that the default one is compared with.
const THOROUGH: (u32, u64) = (2000, 120);
/// Their seed, which is none of those that are judged.
const OTHER_SEED: u64 = 77;

type Eq14<'a, R> = Scan<'a, R, ALL, 6>;

/// What one search made of a scan.
#[derive(Clone, Copy, Debug)]
pub struct Ended {
    /// Its cost; that of a search in single precision after a fit in double precision from its end.
    pub cost: f64,
    /// Passes; one without derivatives counts half.
    pub passes: f64,
    /// Passes until the cost was within 1 % of the least known; infinite if it never was.
    pub until: f64,
}

/// What became of the scans of a kind.
#[derive(Clone, Debug, Default)]
pub struct Row {
    /// Searches.
    pub fits: usize,
    /// Scan and excess of those that ended above the least cost known.
    pub missed: Vec<(u64, f64)>,
    /// Passes in the mean.
    pub mean: f64,
    /// Passes at most.
    pub most: f64,
    /// Passes until within 1 %, the median.
    pub until: f64,
}

/// The least costs known of some scans of a kind, those from scan 0 on kept in a file of a folder.
pub struct Known {
    file: Option<PathBuf>,
    first: u64,
    costs: Vec<f64>,
}

impl Known {
    /// What the folder has; the first lines of it are still right for more scans.
    pub fn read(folder: &Path, kind: Kind) -> Self {
        let file = folder.join(format!("{kind:?}.csv"));
        let text = fs::read_to_string(&file).unwrap_or_default();
        let cost = |line: &str| line.split(',').next().and_then(|cost| cost.parse().ok());
        let costs = text.lines().map_while(cost).collect();
        Known {
            file: Some(file),
            first: 0,
            costs,
        }
    }

    /// None yet, from scan `first` on, and kept in no file.
    pub fn from(first: u64) -> Self {
        Known {
            file: None,
            first,
            costs: Vec::new(),
        }
    }

    /// The first scan that it does not have.
    pub fn end(&self) -> u64 {
        self.first + self.costs.len() as u64
    }

    /// Adds the next scan.
    pub fn push(&mut self, cost: f64) {
        self.costs.push(cost);
    }

    /// Lowers the cost of a scan to what was found.
    pub fn lower(&mut self, k: u64, cost: f64) {
        if let Some(old) = self.costs.get_mut((k - self.first) as usize) {
            *old = old.min(cost);
        }
    }

    /// The least cost of a scan.
    pub fn cost(&self, k: u64) -> f64 {
        self.costs
            .get((k - self.first) as usize)
            .copied()
            .unwrap_or(f64::INFINITY)
    }

    /// Writes the file.
    pub fn write(&self) {
        let Some(file) = &self.file else { return };
        let lines: String = self.costs.iter().map(|cost| format!("{cost:e}\n")).collect();
        if let Some(folder) = file.parent() {
            fs::create_dir_all(folder).expect("target is writable");
        }
        fs::write(file, lines).expect("target is writable");
    }
}

/// The least cost that thorough methods find: the default search with many candidates, and mixed starts.
pub fn thorough(kind: Kind, k: u64) -> f64 {
    let task = task(kind, k);
    let blocks = blocks::<f64>(&task.samples).expect("scenes are valid");
    many(kind, k).min(brute(&Eq14::<f64>::new(&blocks), &bounds(&task), THOROUGH.1, k))
}

/// That of the default search with many candidates and a seed of its own.
pub fn many(kind: Kind, k: u64) -> f64 {
    search_in::<f64>(&task(kind, k), OTHER_SEED, THOROUGH.0, 0.0).cost
}

/// The search of scan `k` of a kind with at most `candidates`; `least` is the least cost known.
pub fn ended(kind: Kind, k: u64, seed: u64, candidates: u32, least: f64) -> Ended {
    let task = task(kind, k);
    match kind {
        Kind::Single => search_in::<f32>(&task, seed, candidates, least),
        _ => search_in::<f64>(&task, seed, candidates, least),
    }
}

/// What became of scans, given scan and end of each search.
pub fn row(known: &Known, ended: &[(u64, Ended)]) -> Row {
    let excess = |&(k, ended): &(u64, Ended)| (k, ended.cost / known.cost(k) - 1.0);
    let mut until: Vec<f64> = ended.iter().map(|(_, ended)| ended.until).collect();
    until.sort_by(f64::total_cmp);
    Row {
        fits: ended.len(),
        missed: ended
            .iter()
            .map(excess)
            .filter(|&(_, excess)| excess > MISSED)
            .collect(),
        mean: ended.iter().map(|(_, ended)| ended.passes).sum::<f64>() / ended.len().max(1) as f64,
        most: ended.iter().map(|(_, ended)| ended.passes).fold(0.0, f64::max),
        until: until.get(until.len() / 2).copied().unwrap_or(f64::NAN),
    }
}

/// A line of the table.
pub fn line(out: &mut String, name: &str, row: &Row) {
    let _ = writeln!(
        out,
        "| {name} | {} | {} | {:.0} | {:.0} | {:.0} |",
        row.fits,
        row.missed.len(),
        row.mean,
        row.most,
        row.until
    );
}

fn bounds<R: Real>(task: &Task) -> Bounds<R, 6> {
    let side = |params: &Params<f64>| Params::from_array(params.to_array().map(R::of));
    Eq14::<R>::bounds(&side(&task.lower), &side(&task.upper))
}

fn search_in<R: Real>(task: &Task, seed: u64, candidates: u32, least: f64) -> Ended {
    let own = blocks::<R>(&task.samples).expect("scenes are valid");
    let watched = Watched {
        scan: Eq14::<R>::new(&own),
        within: least * 1.01,
        passes: Cell::new(0.0),
        until: Cell::new(f64::INFINITY),
    };
    let found = search::search(&watched, &bounds::<R>(task), seed, candidates, &Options::default());
    let mut cost = found.best.at.cost.f64();
    if size_of::<R>() < size_of::<f64>() {
        let exact = blocks::<f64>(&task.samples).expect("scenes are valid");
        let (scan, bounds) = (Eq14::<f64>::new(&exact), bounds::<f64>(task));
        let fit: Fit<f64, 6> = lm::fit(&scan, &bounds, found.best.x.map(R::f64), &Options::default());
        cost = fit.at.cost;
    }
    Ended {
        cost,
        passes: watched.passes.get(),
        until: watched.until.get(),
    }
}

/// A scan that counts passes.
struct Watched<'a, R> {
    scan: Eq14<'a, R>,
    within: f64,
    passes: Cell<f64>,
    until: Cell<f64>,
}

impl<R: Real> Watched<'_, R> {
    fn count(&self, passes: f64) {
        self.passes.set(self.passes.get() + passes);
    }
    fn note(&self, cost: R) {
        if cost.f64() <= self.within && self.until.get().is_infinite() {
            self.until.set(self.passes.get());
        }
    }
}

impl<R: Real> Problem<R, 6> for Watched<'_, R> {
    fn cost(&self, x: &[R; 6]) -> R {
        let cost = self.scan.cost(x);
        self.count(0.5);
        self.note(cost);
        cost
    }
    fn linearize(&self, x: &[R; 6]) -> Linearization<R, 6> {
        let at = self.scan.linearize(x);
        self.count(1.0);
        self.note(at.cost);
        at
    }
    fn bend(&self, x: &[R; 6], step: &[R; 6], to: [R; 6]) -> [R; 6] {
        self.scan.bend(x, step, to)
    }
}

impl<R: Real> Scene<R, 6> for Watched<'_, R> {
    fn propose(&self, bounds: &Bounds<R, 6>, seed: u64, i: u64, region: Region<R, 6>) -> Candidate<R, 6> {
        self.scan.propose(bounds, seed, i, region)
    }
    fn weigh(&self, bounds: &Bounds<R, 6>, candidate: &mut Candidate<R, 6>) {
        let before = candidate.passes;
        self.scan.weigh(bounds, candidate);
        self.count(0.5 * f64::from(candidate.passes - before));
    }
    fn level(&self, bounds: &Bounds<R, 6>, x: &[R; 6]) -> ([R; 6], R) {
        let (x, cost) = self.scan.level(bounds, x);
        self.count(0.5);
        self.note(cost);
        (x, cost)
    }
    fn apart(&self, x: &[R; 6], y: &[R; 6], factor: R) -> bool {
        self.scan.apart(x, y, factor)
    }
}
