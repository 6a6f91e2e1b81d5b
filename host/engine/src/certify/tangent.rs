//! The bound of large boxes: tangents of ln f, which is convex but for phi.
//!
//! ln f is a log-sum-exp of its parts' exponents, so it lies above its tangent `T` at the centre, and at most R above it, where R is the largest of a convex function over the differences of the exponents, at a corner of their ranges.
//! Each residual is between `r + J d - below` and `r + J d + above`; the sum of the squares of the distances of 0 from these ranges is convex in d, and its tangent at any point is a bound.
//! So is it for a part of the box at one of its ends: where that bound passes the target, the part is cut away.

use brdfit_core::real::Real;

use super::cell::Cell;
use super::interval::{exp_up, ln_up};
use super::quadratic::Quadratic;
use super::range::Reach;
use super::region::{Part, Region};
use super::scene::{D, PARTS, Row, Scene};
use super::taylor::{exponents, ln_1p_exp};

/// A residual over the box, as the cube `-1 <= z <= 1`: it is between `at + slope z - below` and `at + slope z + above`.
#[derive(Clone, Copy, Debug)]
struct Line {
    weight2: f64,
    at: f64,
    slope: [f64; D],
    below: f64,
    above: f64,
}

/// The sum of squared distances at a point.
struct Sum {
    value: f64,
    /// Half its derivatives.
    gradient: [f64; D],
    /// Half its second derivatives, where they are.
    hessian: [[f64; D]; D],
    /// The sum of the absolute values of all terms, for the rounding of the sums.
    size: f64,
}

/// Steps towards the least value at most.
const STEPS: usize = 6;

/// What is left of a box, as the cube: no cost in it is below `bound`, and none in the rest of the cube below the target.
pub(crate) struct Left {
    pub bound: f64,
    pub lo: [f64; D],
    pub hi: [f64; D],
}

/// A bound of the cost in a box with at least one bright part, whose middle and half widths are given, and what of it has costs below `target`; nothing else is done where the bound passes that.
pub(crate) fn bound(
    scene: &Scene,
    cell: &Cell,
    region: &Region,
    reach: &[Reach],
    middle: &[f64; D],
    half: &[f64; D],
    target: f64,
) -> Left {
    let parts: [Part; PARTS] = std::array::from_fn(|k| region.part(k));
    let line = |(row, reach)| line(cell, row, reach, &parts, middle, half);
    let lines: Vec<Line> = scene.rows.iter().zip(reach).map(line).collect();
    let mut left = Left {
        bound: 0.0,
        lo: [-1.0; D],
        hi: [1.0; D],
    };
    let (bound, model, z) = least(&lines, [0.0; D], &left.lo, &left.hi, target, STEPS);
    left.bound = bound;
    if bound >= target {
        return left;
    }
    for i in 0..D {
        if !(half[i] > 0.0 && model.hessian[i][i] > 0.0) {
            continue;
        }
        for upper in [false, true] {
            for part in SLABS {
                let (mut lo, mut hi) = (left.lo, left.hi);
                let width = hi[i] - lo[i];
                if upper {
                    lo[i] = hi[i] - part * width;
                } else {
                    hi[i] = lo[i] + part * width;
                }
                let within = std::array::from_fn(|k| z[k].max(lo[k]).min(hi[k]));
                let start = model.descend(within, lo, hi);
                // Only what the parabola at the least value promises is worth its passes.
                if model.at(&start) < target {
                    continue;
                }
                if least(&lines, start, &lo, &hi, target, SLAB_STEPS).0 >= target {
                    if upper {
                        left.hi[i] = lo[i];
                    } else {
                        left.lo[i] = hi[i];
                    }
                    break;
                }
            }
        }
    }
    left
}

/// Parts of a box at its ends that are tried, the larger first.
const SLABS: [f64; 2] = [0.5, 0.2];

/// Steps within such a part.
const SLAB_STEPS: usize = 3;

/// A bound of the sum between `lo` and `hi` from Newton's steps that begin at `z`, the parabola at the last, and where that is; it stops where the bound passes `target`, or cannot.
fn least(
    lines: &[Line],
    mut z: [f64; D],
    lo: &[f64; D],
    hi: &[f64; D],
    target: f64,
    steps: usize,
) -> (f64, Quadratic, [f64; D]) {
    let mut best = 0.0f64;
    let mut step = 0;
    loop {
        let sum = sum_at(lines, &z);
        // The tangent, which is below a convex function.
        let mut value = sum.value - (lines.len() as f64 + 64.0) * 8.0 * f64::EPSILON * sum.size;
        for i in 0..D {
            let slope = 2.0 * sum.gradient[i];
            value += (slope * (lo[i] - z[i])).min(slope * (hi[i] - z[i]));
        }
        best = best.max(value);
        // Newton's step within the box.
        let mut quadratic = Quadratic {
            constant: sum.value,
            gradient: sum.gradient,
            hessian: sum.hessian,
        };
        for i in 0..D {
            quadratic.hessian[i][i] += 1e-9 * (sum.hessian[i][i] + 1e-9);
            for k in 0..D {
                quadratic.constant +=
                    (sum.hessian[i][k] * z[k] - if i == k { 2.0 * sum.gradient[i] } else { 0.0 }) * z[i];
                quadratic.gradient[i] -= sum.hessian[i][k] * z[k];
            }
        }
        step += 1;
        if best >= target || sum.value < target || step == steps {
            return (best, quadratic, z);
        }
        z = quadratic.descend(z, *lo, *hi);
    }
}

fn sum_at(lines: &[Line], z: &[f64; D]) -> Sum {
    let mut sum = Sum {
        value: 0.0,
        gradient: [0.0; D],
        hessian: [[0.0; D]; D],
        size: 0.0,
    };
    for line in lines {
        let mut t = line.at;
        let mut length = line.at.abs();
        for i in 0..D {
            t += line.slope[i] * z[i];
            length += line.slope[i].abs();
        }
        // What is skipped here has no less than 0.
        let (distance, side) = if t > line.below {
            (t - line.below, line.below)
        } else if t < -line.above {
            (t + line.above, line.above)
        } else {
            continue;
        };
        sum.value += line.weight2 * distance * distance;
        sum.size += line.weight2 * distance.abs() * (length + distance.abs() + side);
        for i in 0..D {
            let ws = line.weight2 * line.slope[i];
            sum.gradient[i] += ws * distance;
            for k in 0..=i {
                sum.hessian[i][k] += ws * line.slope[k];
            }
        }
    }
    for i in 0..D {
        for k in 0..i {
            sum.hessian[k][i] = sum.hessian[i][k];
        }
    }
    sum
}

fn line(cell: &Cell, row: &Row, reach: &Reach, parts: &[Part; PARTS], middle: &[f64; D], h: &[f64; D]) -> Line {
    let of = exponents(cell, row, parts, middle, h);
    let top = of.at[0].max(of.at[1]).max(of.at[2]);
    let e = of.at.map(|x| Real::portable_exp(x - top));
    let total = e[0] + e[1] + e[2];
    let share = e.map(|e| e / total);
    let at = top + Real::portable_ln(total);
    let pivot = (0..PARTS).fold(0, |best, k| if share[k] > share[best] { k } else { best });
    let mut slope = [0.0; D];
    let (mut below, mut above, mut own, mut size) = (0.0, 0.0f64, 0.0, 0.0);
    // What the exponents of the others can move against that of the pivot.
    let (mut others, mut count) = ([Other::default(); PARTS - 1], 0);
    for k in 0..PARTS {
        if parts[k] != Part::Bright {
            continue;
        }
        let bent = 0.5 * of.bent[k] + of.error[k];
        below += share[k] * bent;
        above = above.max(bent);
        own += share[k] * of.size[k];
        for i in 0..D {
            slope[i] += share[k] * of.slope[k][i];
            size += share[k] * of.slope[k][i].abs() * h[i];
        }
        if k != pivot {
            let apart = (0..D).map(|i| (of.slope[k][i] - of.slope[pivot][i]).abs() * h[i]).sum();
            others[count] = Other::new(share[k], of.at[k] - at, apart);
            count += 1;
            size += share[k] * apart;
        }
    }
    above += excess(share[pivot], &others);
    for k in 0..PARTS {
        if parts[k] == Part::Faint {
            above += ln_1p_exp(reach.most[k] - reach.lo);
        }
    }
    let rounding = 64.0 * f64::EPSILON * (1.0 + at.abs() + own) * (1.0 + size);
    Line {
        weight2: row.weight2,
        at,
        slope: std::array::from_fn(|i| slope[i] * h[i]),
        below: (below + rounding) * (1.0 + 1e-12),
        above: (above + rounding) * (1.0 + 1e-12),
    }
}

/// A part beside the pivot, at both ends of the range of its exponent against the pivot's: its part of f, and that of the tangent.
#[derive(Clone, Copy, Debug, Default)]
struct Other {
    ends: [(f64, f64); 2],
}

impl Other {
    fn new(share: f64, ln_share: f64, apart: f64) -> Self {
        let end = |apart: f64| (exp_up(ln_share + apart), share * apart);
        Other {
            ends: [end(apart), end(-apart)],
        }
    }
}

/// The largest of ln f over its tangent: of ln(s + t e^p + u e^q) - t p - u q at the corners of the ranges of p and q, as it is convex.
fn excess(pivot: f64, others: &[Other; PARTS - 1]) -> f64 {
    let mut most = 0.0f64;
    for (e, s) in others[0].ends {
        for (f, t) in others[1].ends {
            most = most.max(ln_up(pivot + e + f) - (s + t));
        }
    }
    most
}
