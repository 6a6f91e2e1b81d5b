//! A box of coordinates.

use super::cell::Cell;
use super::interval::{Interval, exp_down, exp_up, ln_down, ln_up};
use super::scene::{A, B, D, MU, PARTS, Scene};

/// Numbers from `lo` to `hi` of each coordinate; `lo` of a part may be minus infinity, which contains its absence, and with `hi` so too it is absent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Lower ends of ln rho_d, ln(rho_s F mu), ln(rho_v F mu), mu, ln n and ln(1 + kappa^2).
    pub lo: [f64; D],
    /// Upper ends.
    pub hi: [f64; D],
    /// No cost in the box is below this.
    pub bound: f64,
}

/// What a box says about one of the three parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// It adds nothing.
    Absent,
    /// Between nothing and its largest.
    Faint,
    /// Both ends of u are numbers.
    Bright,
}

impl Region {
    /// All that the bounds of a scene allow.
    pub(crate) fn whole(scene: &Scene) -> Self {
        let mut region = Region {
            lo: [0.0; D],
            hi: [0.0; D],
            bound: 0.0,
        };
        for k in 0..PARTS {
            region.lo[k] = f64::NEG_INFINITY;
            // Above every ln(rho F mu) of numbers.
            region.hi[k] = if scene.present[k] { 1e4 } else { f64::NEG_INFINITY };
        }
        if scene.present[1] || scene.present[2] {
            let (lower, upper) = (&scene.lower, &scene.upper);
            let square = |x: f64| Interval::point(x).square();
            let one = Interval::point(1.0);
            (region.lo[MU], region.hi[MU]) = (square(upper.m).reciprocal().lo, square(lower.m).reciprocal().hi);
            (region.lo[A], region.hi[A]) = (ln_down(lower.n), ln_up(upper.n));
            (region.lo[B], region.hi[B]) = ((one + square(lower.kappa)).ln().lo, (one + square(upper.kappa)).ln().hi);
        }
        region
    }

    pub(crate) fn part(&self, k: usize) -> Part {
        debug_assert!(k < PARTS);
        if self.hi[k] == f64::NEG_INFINITY {
            Part::Absent
        } else if self.lo[k] == f64::NEG_INFINITY {
            Part::Faint
        } else {
            Part::Bright
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        (0..D).any(|i| !(self.lo[i] <= self.hi[i]))
    }

    pub(crate) fn width(&self, i: usize) -> f64 {
        self.hi[i] - self.lo[i]
    }

    /// Narrower ends of a coordinate.
    pub(crate) fn clip(&mut self, i: usize, lo: f64, hi: f64) {
        self.lo[i] = self.lo[i].max(lo);
        self.hi[i] = self.hi[i].min(hi);
    }

    /// The part below and the part above `at` of coordinate `i`.
    pub(crate) fn split(&self, i: usize, at: f64) -> [Region; 2] {
        let (mut low, mut high) = (*self, *self);
        low.hi[i] = at;
        high.lo[i] = at;
        [low, high]
    }

    /// Takes away what the bounds of the weights rho exclude, by u = ln(rho F mu).
    pub(crate) fn clip_weights(&mut self, scene: &Scene, cell: &Cell) {
        let (lower, upper) = (scene.lower.to_array(), scene.upper.to_array());
        for k in 0..PARTS {
            if !scene.present[k] {
                continue;
            }
            if !(upper[k] > 0.0) {
                self.hi[k] = f64::NEG_INFINITY;
                continue;
            }
            let (least, most) = (ln_down(lower[k]), ln_up(upper[k]));
            if k == 0 {
                self.clip(k, least, most);
                continue;
            }
            let f = cell.ln_f[k - 1];
            let sum = |x: f64, y: f64, z: f64| Interval::point(x) + Interval::point(y) + Interval::point(z);
            self.clip(k, f64::NEG_INFINITY, sum(most, f.hi, ln_up(self.hi[MU])).hi);
            if self.part(k) == Part::Bright {
                let mu = exp_down(sum(self.lo[k], -most, -f.hi).lo);
                self.lo[MU] = self.lo[MU].max(mu);
            }
            if lower[k] > 0.0 && f.lo > f64::NEG_INFINITY {
                self.clip(k, sum(least, f.lo, ln_down(self.lo[MU])).lo, f64::INFINITY);
                let mu = exp_up(sum(self.hi[k], -least, -f.lo).hi);
                self.hi[MU] = self.hi[MU].min(mu);
            }
        }
    }
}
