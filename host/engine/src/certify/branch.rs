//! A cell with its boxes: each is excluded, narrowed, or split.

use brdfit_core::brdf::Params;

use super::cell::Cell;
use super::range::{self, Reach};
use super::region::{Part, Region};
use super::scene::{A, D, MU, PARTS, Scene};
use super::tangent;
use super::taylor::{self, Expansion};

/// A rectangle of a and b, and boxes in it.
#[derive(Clone, Debug)]
pub(crate) struct Task {
    pub lo: [f64; 2],
    pub hi: [f64; 2],
    pub regions: Vec<Region>,
}

/// What became of a task.
#[derive(Clone, Debug, Default)]
pub(crate) struct Done {
    /// Boxes to be split by a or by b.
    pub open: Vec<Region>,
    /// How many of them by each.
    pub axes: [usize; 2],
    /// Boxes that are too small to be split.
    pub stuck: Vec<Region>,
    /// Boxes that were not reached.
    pub left: Vec<Region>,
    /// How many boxes were bounded.
    pub boxes: u64,
    /// The least cost that was met within the bounds, and its parameters.
    pub found: Found,
}

/// A cost with its parameters.
pub(crate) type Found = Option<(f64, Params<f64>)>;

/// A box as it was met, and what is left of it: the claim is that no cost in `after` is below its bound, and no cost in the rest of `before` below `target`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Visit {
    /// As it was met.
    pub before: Region,
    /// What is left, if anything is.
    pub after: Option<Region>,
    /// The cost that is sought.
    pub target: f64,
}

impl Task {
    /// The boxes with the least cell that contains them; at least one.
    pub fn new(regions: Vec<Region>) -> Self {
        let end = |i: usize, pick: fn(&Region, usize) -> f64, more: fn(f64, f64) -> f64| {
            regions.iter().map(|region| pick(region, i)).reduce(more).unwrap_or(0.0)
        };
        let lo = [A, A + 1].map(|i| end(i, |region, i| region.lo[i], f64::min));
        let hi = [A, A + 1].map(|i| end(i, |region, i| region.hi[i], f64::max));
        Task { lo, hi, regions }
    }

    /// The least bound of the boxes.
    pub fn bound(&self) -> f64 {
        self.regions
            .iter()
            .fold(f64::INFINITY, |least, region| least.min(region.bound))
    }

    /// Bounds the boxes, and splits them by all but a and b, until each is excluded or is to be split by a or b; the rest is left after [`MOST`] boxes, or where a far lower cost is met, for which others will be excluded.
    pub fn process(&self, scene: &Scene, target: f64, watch: Option<&(dyn Fn(&Visit) + Sync)>) -> Done {
        let cell = Cell::new(scene, self.lo, self.hi);
        let mut done = Done::default();
        let mut reach = Vec::with_capacity(scene.rows.len());
        let mut stack: Vec<Region> = self.regions.iter().rev().copied().collect();
        let much_better = |found: Found| found.is_some_and(|(cost, _)| cost < 0.5 * target);
        while let Some(before) = stack.pop() {
            if done.boxes >= MOST || much_better(done.found) {
                done.left.push(before);
                continue;
            }
            if before.bound >= target {
                continue;
            }
            done.boxes += 1;
            let mut region = before;
            let step = step(scene, &cell, &mut region, target, &mut reach, &mut done.found);
            if let Some(watch) = watch {
                let after = (!matches!(step, Step::Excluded)).then_some(region);
                watch(&Visit { before, after, target });
            }
            match step {
                Step::Excluded => {}
                Step::Split(i, at) if i < A => stack.extend(region.split(i, at)),
                Step::Split(i, _) => {
                    done.axes[i - A] += 1;
                    done.open.push(region);
                }
                Step::Stuck => done.stuck.push(region),
            }
        }
        done
    }
}

impl Done {
    /// What is left, and what is open in two halves of its cell; each box goes where it reaches.
    pub fn tasks(self) -> Vec<Task> {
        let [low, high] = self.halves();
        let boxes = [self.left, low, high].into_iter();
        boxes.filter(|boxes| !boxes.is_empty()).map(Task::new).collect()
    }

    fn halves(&self) -> [Vec<Region>; 2] {
        let whole = Task::new(self.open.clone());
        let axis = if self.axes[0] >= self.axes[1] { 0 } else { 1 };
        let (lo, hi) = (whole.lo[axis], whole.hi[axis]);
        let at = lo + 0.5 * (hi - lo);
        let i = A + axis;
        let mut halves = [Vec::new(), Vec::new()];
        for region in &self.open {
            if region.hi[i] <= at {
                halves[0].push(*region);
            } else if region.lo[i] >= at {
                halves[1].push(*region);
            } else {
                let [low, high] = region.split(i, at);
                halves[0].push(low);
                halves[1].push(high);
            }
        }
        halves
    }
}

/// Boxes that a task bounds at most, so that rounds are short.
const MOST: u64 = 1000;

/// What is to be done with a box.
enum Step {
    Excluded,
    /// Along which coordinate, and where.
    Split(usize, f64),
    Stuck,
}

/// How often a box is bounded anew while that makes it smaller.
const ROUNDS: usize = 6;

fn step(
    scene: &Scene,
    cell: &Cell,
    region: &mut Region,
    target: f64,
    reach: &mut Vec<Reach>,
    found: &mut Found,
) -> Step {
    let mut blame = [0.0; D];
    for _ in 0..ROUNDS {
        region.clip_weights(scene, cell);
        if region.is_empty() {
            return Step::Excluded;
        }
        let bound = range::bound(scene, cell, region, target, reach);
        region.bound = region.bound.max(bound);
        if bound >= target {
            return Step::Excluded;
        }
        let before = *region;
        let narrower = range::narrow(scene, region, target, bound, reach);
        if region.is_empty() {
            return Step::Excluded;
        }
        let brighter = |k: usize| before.part(k) != region.part(k) || before.width(k) > region.width(k) + 0.5;
        if narrower && (0..PARTS).any(brighter) {
            continue;
        }
        if (0..PARTS).all(|k| region.part(k) != Part::Bright) {
            blame = faint_blame(scene, region, reach);
            break;
        }
        let expansion = taylor::expand(scene, cell, region, reach);
        blame = expansion.blame;
        if found.is_none_or(|(least, _)| expansion.cost < least) {
            let params = scene.clamp(&scene.params(&point(region, &expansion)));
            let cost = scene.cost(&params);
            if found.is_none_or(|(least, _)| cost < least) {
                *found = Some((cost, params));
            }
        }
        let tangent = tangent::bound(scene, cell, region, reach, &expansion.centre, &expansion.half, target);
        region.bound = region.bound.max(tangent.bound);
        if tangent.bound >= target {
            return Step::Excluded;
        }
        if cut(region, &expansion, &tangent.lo, &tangent.hi) {
            continue;
        }
        if region.is_empty() {
            return Step::Excluded;
        }
        if expansion.lost > HOPELESS * (target + expansion.cost) {
            if narrower {
                continue;
            }
            break;
        }
        match quadratic_step(scene, region, &expansion, target) {
            None => return Step::Excluded,
            Some(true) => continue,
            Some(false) => break,
        }
    }
    split(region, &blame)
}

/// Where more than this share of the cost is lost, no quadratic helps.
const HOPELESS: f64 = 10.0;

/// Bounds and narrows a box by the quadratic below its cost; returns whether that was much of it, and nothing if the box is excluded.
fn quadratic_step(scene: &Scene, region: &mut Region, expansion: &Expansion, target: f64) -> Option<bool> {
    let mut tau = 0.3;
    let mut convex = expansion.below(scene, tau).convex();
    for _ in 0..2 {
        let better = expansion.best_tau(&convex.least);
        if (better / tau - 1.0).abs() < 0.2 {
            break;
        }
        tau = better;
        let next = expansion.below(scene, tau).convex();
        if next.bound > convex.bound {
            convex = next;
        }
    }
    region.bound = region.bound.max(convex.bound);
    if convex.bound >= target {
        return None;
    }
    let (lo, hi) = convex.narrowed(target);
    let narrower = cut(region, expansion, &lo, &hi);
    if region.is_empty() { None } else { Some(narrower) }
}

/// Takes away what of the cube about the centre of an expansion is not between `lo` and `hi`; returns whether that was much of it.
fn cut(region: &mut Region, expansion: &Expansion, lo: &[f64; D], hi: &[f64; D]) -> bool {
    let mut narrower = false;
    for i in 0..D {
        let (c, h) = (expansion.centre[i], expansion.half[i]);
        if h > 0.0 {
            let old = region.width(i);
            let pad = 4.0 * f64::EPSILON * (c.abs() + h);
            if lo[i] > -1.0 {
                region.lo[i] = region.lo[i].max(c + lo[i] * h - pad);
            }
            if hi[i] < 1.0 {
                region.hi[i] = region.hi[i].min(c + hi[i] * h + pad);
            }
            narrower |= region.width(i) < 0.75 * old;
        }
    }
    narrower
}

/// The centre, with minus infinity for parts that are not bright.
fn point(region: &Region, expansion: &Expansion) -> [f64; D] {
    std::array::from_fn(|i| {
        if i < PARTS && region.part(i) != Part::Bright {
            f64::NEG_INFINITY
        } else {
            expansion.centre[i]
        }
    })
}

/// Where no part is bright: how much each could add.
fn faint_blame(scene: &Scene, region: &Region, reach: &[Reach]) -> [f64; D] {
    let mut blame = [0.0; D];
    for (row, one) in scene.rows.iter().zip(reach) {
        for k in 0..PARTS {
            if region.part(k) == Part::Faint {
                blame[k] += row.weight2 * (one.most[k] + 3.0).clamp(0.0, 4.0);
            }
        }
    }
    blame
}

/// The part of u that is split off from what reaches down to minus infinity.
const STEP: f64 = 2.0;

/// A cell is shared by many boxes, so its coordinates are split earlier.
const CELL_FIRST: f64 = 4.0;

/// The coordinate with the largest blame that can be split.
fn split(region: &Region, blame: &[f64; D]) -> Step {
    let mut best: Option<(f64, usize, f64)> = None;
    for i in 0..D {
        let (lo, hi) = (region.lo[i], region.hi[i]);
        let at = if lo == f64::NEG_INFINITY {
            hi - STEP
        } else if i == MU && hi > 2.0 * lo {
            (lo * hi).sqrt()
        } else {
            lo + 0.5 * (hi - lo)
        };
        let own = blame[i] * if i < A { 1.0 } else { CELL_FIRST };
        if lo < at && at < hi && best.is_none_or(|(most, ..)| own > most) {
            best = Some((own, i, at));
        }
    }
    best.map_or(Step::Stuck, |(_, i, at)| Step::Split(i, at))
}
