//! The bound of second order of a box: a quadratic below the cost.
//!
//! Near the centre of the box the residual of a sample is `r + J d + (d' H d) / 2 + E`.
//! ln f is a log-sum-exp of the exponents of its parts, so J is the mean of their slopes under their shares of f, and H the covariance, plus the mean of the second derivatives of phi; E is of third order, and bounded by third cumulants.
//! With l = J d and q = d' H d + 2 E the square is `(r + l + q/2)^2 = r^2 + 2 r l + r q + (l + q/2)^2`, and where |q| <= Q, `(l + q/2)^2 >= (1 - tau) l^2 - (1/tau - 1) Q^2/4` for each tau in (0, 1].
//! In the sum over the samples the curvatures r H cancel as far as the signs of the residuals do: what is lost is of third order in the size of the box.

use brdfit_core::real::Real;

use super::cell::Cell;
use super::interval::{exp_up, ln_up};
use super::quadratic::Quadratic;
use super::range::{ABSENT, Reach};
use super::region::{Part, Region};
use super::scene::{A, B, D, MU, PARTS, Row, Scene};

/// Sums over the samples.
#[derive(Clone, Debug)]
pub(crate) struct Expansion {
    /// Middle of the box; 0 for parts that are not bright.
    pub centre: [f64; D],
    /// Half its widths.
    pub half: [f64; D],
    /// Cost of the centre, to rounding and what faint parts add.
    pub cost: f64,
    /// What the errors E can take away, the sum of 2 |r| |E|.
    pub lost: f64,
    /// How much of what is not known of ln f belongs to each coordinate.
    pub blame: [f64; D],
    gradient: [f64; D],
    /// J'J.
    normal: [[f64; D]; D],
    /// The sum of r H.
    bend: [[f64; D]; D],
    /// The sum of Q^2 / 4.
    lost_square: f64,
    /// The sum of the absolute values of all terms, for the rounding of the sums.
    size: f64,
}

/// Pairs of parts.
const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

/// The exponents of one sample's parts about the centre.
pub(crate) struct Exponents {
    pub at: [f64; PARTS],
    pub slope: [[f64; D]; PARTS],
    /// Second derivatives of phi by aa, ab and bb.
    pub second: [[f64; 3]; PARTS],
    /// The largest of d' (second derivatives) d.
    pub bent: [f64; PARTS],
    /// What else `at + slope d + second d d / 2` may be wrong by.
    pub error: [f64; PARTS],
    /// The same and `bent`, as far as they grow with a and with b.
    pub unknown: [[f64; 2]; PARTS],
    /// Sum of absolute values, for rounding.
    pub size: [f64; PARTS],
}

/// Of a box with at least one bright part; `reach` is that of a box that contains it.
pub(crate) fn expand(scene: &Scene, cell: &Cell, region: &Region, reach: &[Reach]) -> Expansion {
    let mut out = Expansion {
        centre: [0.0; D],
        half: [0.0; D],
        cost: 0.0,
        lost: 0.0,
        blame: [0.0; D],
        gradient: [0.0; D],
        normal: [[0.0; D]; D],
        bend: [[0.0; D]; D],
        lost_square: 0.0,
        size: 0.0,
    };
    let parts: [Part; PARTS] = std::array::from_fn(|k| region.part(k));
    for i in 0..D {
        if i >= PARTS || parts[i] == Part::Bright {
            let centre = region.lo[i] + 0.5 * (region.hi[i] - region.lo[i]);
            out.centre[i] = centre;
            out.half[i] = (region.hi[i] - centre).max(centre - region.lo[i]) * (1.0 + 4.0 * f64::EPSILON);
        }
    }
    for (row, reach) in scene.rows.iter().zip(reach) {
        let exponents = exponents(cell, row, &parts, &out.centre, &out.half);
        out.add(row, reach, &parts, &exponents);
    }
    for i in 0..D {
        for k in 0..i {
            out.normal[k][i] = out.normal[i][k];
            out.bend[k][i] = out.bend[i][k];
        }
    }
    out
}

pub(crate) fn exponents(cell: &Cell, row: &Row, parts: &[Part; PARTS], centre: &[f64; D], h: &[f64; D]) -> Exponents {
    let mut out = Exponents {
        at: [ABSENT; PARTS],
        slope: [[0.0; D]; PARTS],
        second: [[0.0; 3]; PARTS],
        bent: [0.0; PARTS],
        error: [0.0; PARTS],
        unknown: [[0.0; 2]; PARTS],
        size: [0.0; PARTS],
    };
    for k in 0..PARTS {
        if parts[k] != Part::Bright {
            continue;
        }
        let term = &row.terms[k];
        out.slope[k][k] = 1.0;
        let mut size = term.size + centre[k].abs();
        let mut at = term.level + centre[k];
        if k > 0 {
            let s = cell.shape(k - 1, term.cosine);
            let (da, db) = (centre[A] - cell.middle[0], centre[B] - cell.middle[1]);
            let (fa, fb) = (da.abs() + h[A], db.abs() + h[B]);
            let falls = term.slope * centre[MU];
            at +=
                s.value + s.a * da + s.b * db + 0.5 * (s.aa * da * da + 2.0 * s.ab * da * db + s.bb * db * db) - falls;
            out.slope[k][MU] = -term.slope;
            out.slope[k][A] = s.a + s.aa * da + s.ab * db;
            out.slope[k][B] = s.b + s.ab * da + s.bb * db;
            out.second[k] = [s.aa, s.ab, s.bb];
            let bent = [
                s.aa.abs() * h[A] * h[A],
                2.0 * s.ab.abs() * h[A] * h[B],
                s.bb.abs() * h[B] * h[B],
            ];
            let third = [s.err_aa * fa * fa, 2.0 * s.err_ab * fa * fb, s.err_bb * fb * fb];
            out.bent[k] = bent[0] + bent[1] + bent[2];
            out.error[k] = s.error + 0.5 * (third[0] + third[1] + third[2]);
            out.unknown[k] = shared(
                out.bent[k] * 0.5 + out.error[k],
                [bent[0] + third[0], bent[2] + third[2]],
                h,
            );
            size += s.value.abs() + falls + term.slope * h[MU];
            size += (s.a.abs() + s.aa.abs() * fa + s.ab.abs() * fb) * fa
                + (s.b.abs() + s.ab.abs() * fa + s.bb.abs() * fb) * fb;
        }
        out.at[k] = at;
        out.error[k] = (out.error[k] + 16.0 * f64::EPSILON * size) * (1.0 + 1e-12);
        out.size[k] = size;
    }
    out
}

/// `all`, in proportion to what a and b have of it, or to their widths if that is not known.
fn shared(all: f64, of: [f64; 2], h: &[f64; D]) -> [f64; 2] {
    let of = if of[0] + of[1] > 0.0 { of } else { [h[A], h[B]] };
    let sum = of[0] + of[1];
    if sum > 0.0 { of.map(|x| all * x / sum) } else { [0.0; 2] }
}

/// More than this is as good as nothing known, in ln f.
const CAP: f64 = 4.0;

/// Parts that fall by less of [`CAP`] than this are not split so that others are known better.
const SHORT: f64 = 0.25;

/// A part that is e^-6 of the measured value, or less, adds next to nothing to a residual.
const NEAR: f64 = 6.0;

/// The largest of s t |s - t| for two shares s and t, 1 / (6 sqrt 3).
const SKEW: f64 = 0.096226;

/// e^x, or `most` if that is less.
fn exp_most(x: f64, most: f64) -> f64 {
    if x >= 0.0 { most } else { exp_up(x).min(most) }
}

/// ln(1 + e^x), rounded up.
pub(crate) fn ln_1p_exp(x: f64) -> f64 {
    if x > 30.0 {
        x + 1e-12 * x
    } else {
        ln_up(1.0 + exp_up(x))
    }
}

impl Expansion {
    fn add(&mut self, row: &Row, reach: &Reach, parts: &[Part; PARTS], of: &Exponents) {
        let h = self.half;
        let w = row.weight2;
        let top = of.at[0].max(of.at[1]).max(of.at[2]);
        let e = of.at.map(|x| Real::portable_exp(x - top));
        let total = e[0] + e[1] + e[2];
        let bright = top + Real::portable_ln(total);
        let share = e.map(|e| e / total);
        let ln_share = of.at.map(|x| x - bright);
        // How far the exponents of two parts can move apart in the box, and what of that is not linear.
        let (mut apart, mut bent) = ([0.0; PARTS], [0.0; PARTS]);
        for (p, (k, l)) in PAIRS.into_iter().enumerate() {
            if parts[k] == Part::Bright && parts[l] == Part::Bright {
                bent[p] = 0.5 * (of.bent[k] + of.bent[l]) + of.error[k] + of.error[l];
                apart[p] = bent[p];
                for i in 0..D {
                    apart[p] += (of.slope[k][i] - of.slope[l][i]).abs() * h[i];
                }
            }
        }
        let from_mean = [
            share[1] * apart[0] + share[2] * apart[1],
            share[0] * apart[0] + share[2] * apart[2],
            share[0] * apart[1] + share[1] * apart[2],
        ];
        // Shares and their products are nowhere larger than these.
        let share_most: [f64; PARTS] = std::array::from_fn(|k| exp_most(ln_share[k] + from_mean[k], 1.0));
        let (mut variance, mut third, mut cross) = (0.0, 0.0, 0.0);
        let mut pair_most = [0.0; PARTS];
        for (p, (k, l)) in PAIRS.into_iter().enumerate() {
            if apart[p] == 0.0 {
                continue;
            }
            let pair = share[k] * share[l];
            let most = exp_most(ln_share[k] + ln_share[l] + from_mean[k] + from_mean[l], 0.25);
            pair_most[p] = most;
            let square = apart[p] * apart[p];
            let others = apart[0] + apart[1] + apart[2] - apart[p];
            variance += pair * square;
            // The third cumulant is the sum over pairs of s_k s_l (x_k - x_l)^2 (x_k + x_l - 2 mean).
            third += square * (most.min(SKEW) * apart[p] + most * share_most[3 - k - l] * others);
            cross += pair * bent[p] * (apart[p] + 0.5 * bent[p]);
        }
        let mut error = cross + third * (1.0 / 6.0);
        let mut q = variance;
        let mut j = [0.0; D];
        let (mut size, mut size2, mut own) = (0.0, 0.0, 0.0);
        for k in 0..PARTS {
            error += share[k] * of.error[k];
            q += share[k] * of.bent[k];
            let mut length = 0.0;
            for i in 0..D {
                j[i] += share[k] * of.slope[k][i];
                length += of.slope[k][i].abs() * h[i];
            }
            own += share[k] * of.size[k];
            size += share[k] * length;
            size2 += share[k] * length * length;
        }
        // The faint parts add between 0 and this: half of it moves the residual, half is an error.
        let mut added = 0.0;
        for k in 0..PARTS {
            if parts[k] == Part::Faint {
                let most = ln_1p_exp(reach.most[k] - reach.lo);
                // Far below the measured value it matters to nothing, however dark the others can be.
                self.blame[k] += w * most.min((reach.most[k] + NEAR).clamp(0.0, CAP));
                // It stands out, by as much as is not known, where the bright parts fall far.
                for i in 0..D {
                    let falls: f64 = (0..PARTS).map(|l| share[l] * of.slope[l][i].abs() * h[i]).sum();
                    self.blame[i] += w * most.min(CAP) * (falls / CAP - SHORT).clamp(0.0, 1.0);
                }
                added += most;
            }
        }
        let r = bright + 0.5 * added;
        error += 0.5 * added;
        error += 64.0 * f64::EPSILON * (1.0 + r.abs() + own) * (1.0 + size + size2);
        error *= 1.0 + 1e-12;
        let q = q + 2.0 * error;
        self.cost += w * r * r;
        self.lost += 2.0 * w * r.abs() * error;
        self.lost_square += 0.25 * w * q * q;
        let reach_most = reach.most;
        let reach = r.abs() + size + q;
        self.size += w * (reach * reach + r.abs() * size2);
        let wr = w * r;
        for i in 0..D {
            let wj = w * j[i];
            self.gradient[i] += wr * j[i];
            for k in 0..=i {
                self.normal[i][k] += wj * j[k];
                let mut covariance = -j[i] * j[k];
                for p in 0..PARTS {
                    covariance += share[p] * of.slope[p][i] * of.slope[p][k];
                }
                self.bend[i][k] += wr * covariance;
            }
        }
        for k in 1..PARTS {
            self.bend[A][A] += wr * share[k] * of.second[k][0];
            self.bend[B][A] += wr * share[k] * of.second[k][1];
            self.bend[B][B] += wr * share[k] * of.second[k][2];
            for i in 0..2 {
                self.blame[A + i] += w * share[k] * of.unknown[k][i].min(CAP);
            }
        }
        for (p, (k, l)) in PAIRS.into_iter().enumerate() {
            if pair_most[p] == 0.0 {
                continue;
            }
            // Two parts of which neither comes near the measured value do not matter.
            let seen = (reach_most[k].max(reach_most[l]) + NEAR).clamp(0.0, 1.0);
            let width = w * seen * pair_most[p] * apart[p].min(CAP);
            for i in 0..D {
                let mut mine = (of.slope[k][i] - of.slope[l][i]).abs() * h[i];
                if i >= A {
                    mine += of.unknown[k][i - A] + of.unknown[l][i - A];
                }
                self.blame[i] += width * mine.min(CAP);
            }
        }
    }

    /// The quadratic below the cost, over the box as the cube from -1 to 1.
    pub fn below(&self, scene: &Scene, tau: f64) -> Quadratic {
        let h = &self.half;
        let rounding = (scene.rows.len() as f64 + 64.0) * 4.0 * f64::EPSILON;
        let lost = self.lost + (1.0 / tau - 1.0) * self.lost_square;
        Quadratic {
            constant: self.cost - lost * (1.0 + 1e-9) - rounding * self.size,
            gradient: std::array::from_fn(|i| self.gradient[i] * h[i]),
            hessian: std::array::from_fn(|i| {
                std::array::from_fn(|k| ((1.0 - tau) * self.normal[i][k] + self.bend[i][k]) * h[i] * h[k])
            }),
        }
    }

    /// The tau that loses least where the linear part of the residuals is that of `z`.
    pub fn best_tau(&self, z: &[f64; D]) -> f64 {
        let mut square = 0.0;
        for i in 0..D {
            for k in 0..D {
                square += z[i] * self.half[i] * self.normal[i][k] * self.half[k] * z[k];
            }
        }
        (self.lost_square / square.max(f64::MIN_POSITIVE))
            .sqrt()
            .clamp(1e-3, 1.0)
    }
}
