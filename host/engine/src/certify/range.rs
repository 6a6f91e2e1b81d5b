//! The plain bound of a box: how far each sample lies from what the model can reach there, and what of the box single samples exclude.

use brdfit_core::real::Real;

use super::cell::Cell;
use super::interval::{exp_down, exp_up, ln_down, ln_up};
use super::region::{Part, Region};
use super::scene::{MU, PARTS, Scene};

/// What the model can reach in a box at one sample, as logarithms over the measured f.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Reach {
    /// The least f.
    pub lo: f64,
    /// The largest f.
    hi: f64,
    /// The largest of each part.
    pub most: [f64; PARTS],
    /// Of each part the least less the least u, and the largest less the largest u.
    base: [[f64; 2]; PARTS],
    /// Weighted square of the distance of the measured value from the reach.
    square: f64,
}

/// ln of an absent part.
pub(crate) const ABSENT: f64 = -1e300;

/// Relative error of a sum of a few numbers, with room to spare.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Finds the reach of every sample, and returns a bound of the cost; it stops where that passes `target`.
pub(crate) fn bound(scene: &Scene, cell: &Cell, region: &Region, target: f64, reach: &mut Vec<Reach>) -> f64 {
    // The sum of as many rounded squares.
    let certain = 1.0 - scene.rows.len() as f64 * f64::EPSILON - ROUNDING;
    reach.clear();
    let mut sum = 0.0;
    for row in &scene.rows {
        let mut one = Reach::default();
        let (mut least, mut most) = ([ABSENT; PARTS], [ABSENT; PARTS]);
        for k in 0..PARTS {
            if region.part(k) == Part::Absent {
                one.most[k] = ABSENT;
                continue;
            }
            let term = &row.terms[k];
            let [low, high] = if k == 0 {
                [0.0, 0.0]
            } else {
                cell.shape(k - 1, term.cosine).range
            };
            let (near, far) = (term.slope * region.lo[MU], term.slope * region.hi[MU]);
            let lo = term.level + low - far - ROUNDING * (term.size + low.abs() + far);
            let hi = term.level + high - near + ROUNDING * (term.size + high.abs() + near);
            one.base[k] = [lo, hi];
            if region.part(k) == Part::Bright {
                least[k] = region.lo[k] + lo - ROUNDING * (region.lo[k].abs() + lo.abs());
            }
            most[k] = region.hi[k] + hi + ROUNDING * (region.hi[k].abs() + hi.abs());
            one.most[k] = most[k];
        }
        one.lo = ln_sum(&least, exp_down, |x| ln_down(x * (1.0 - ROUNDING)), -ROUNDING);
        one.hi = ln_sum(&most, exp_up, |x| ln_up(x * (1.0 + ROUNDING)), ROUNDING);
        let distance = one.lo.max(-one.hi).max(0.0) * (1.0 - ROUNDING);
        one.square = row.weight2 * distance * distance;
        sum += one.square;
        reach.push(one);
        if sum * certain >= target {
            break;
        }
    }
    sum * certain
}

/// ln of the sum of e^x, rounded as `exp`, `ln` and the sign of `rounding` say.
fn ln_sum(x: &[f64; PARTS], exp: fn(f64) -> f64, ln: impl Fn(f64) -> f64, rounding: f64) -> f64 {
    let most = x[0].max(x[1]).max(x[2]);
    let sum: f64 = x.iter().map(|x| exp(x - most)).sum();
    most + ln(sum) + rounding * (most.abs() + 1.0)
}

/// Takes away what has no cost below `target`, of which [`bound`] has found `least` and `reach`; returns whether that was much of the box.
///
/// The squares of all other samples are taken as they are, which leaves each sample a band about its measured value: no part may exceed it, and all parts together must reach it.
pub(crate) fn narrow(scene: &Scene, region: &mut Region, target: f64, least: f64, reach: &[Reach]) -> bool {
    let before = *region;
    for (row, one) in scene.rows.iter().zip(reach) {
        let room = (target - least).max(0.0) + one.square + target * 1e-12;
        let band = (room / row.weight2).sqrt() * (1.0 + 1e-12);
        let bottom = exp_down(-band);
        for k in 0..PARTS {
            if before.part(k) == Part::Absent {
                continue;
            }
            let slope = row.terms[k].slope;
            let [lo, hi] = one.base[k];
            // The part alone: u + lo <= band, where lo belongs to the largest mu.
            let over = before.lo[k] + lo - band;
            region.hi[k] = region.hi[k].min(band - lo + pad(band, lo));
            if slope > 0.0 && before.part(k) == Part::Bright {
                let step = (over - pad(before.lo[k], lo)) / slope;
                region.lo[MU] = region.lo[MU].max(before.hi[MU] + step - pad(before.hi[MU], step));
            }
            // All together: u + hi >= need, where hi belongs to the least mu.
            let others: f64 = (0..PARTS).filter(|&l| l != k).map(|l| exp_up(one.most[l])).sum();
            let lack = bottom - others * (1.0 + ROUNDING);
            if lack > f64::MIN_POSITIVE {
                let need = Real::portable_ln(lack) - 1e-12;
                region.lo[k] = region.lo[k].max(need - hi - pad(need, hi));
                if slope > 0.0 {
                    let step = (before.hi[k] + hi - need + pad(before.hi[k], hi)) / slope;
                    region.hi[MU] = region.hi[MU].min(before.lo[MU] + step + pad(before.lo[MU], step));
                }
            }
        }
    }
    (0..=MU).any(|i| region.width(i) < 0.8 * before.width(i))
}

/// Far more than the rounding of sums of `x` and `y`.
fn pad(x: f64, y: f64) -> f64 {
    1e-12 * (1.0 + x.abs() + y.abs())
}
