//! Several scans of one material fitted together: chosen parameters are shared, the others are each scan's own.

use crate::lm::{Bounds, Linearization, Problem};
use crate::real::Real;

/// Scans of `P` parameters each as one problem of `Q` coordinates: first the shared parameters in their order, then the own ones of each scan in turn.
///
/// `Q` is at least [`Joint::coordinates`]; further coordinates do nothing, and equal bounds hold them.
#[derive(Clone, Copy, Debug)]
pub struct Joint<'a, S, const P: usize> {
    scans: &'a [S],
    shared: [bool; P],
}

impl<'a, S, const P: usize> Joint<'a, S, P> {
    /// `scans` of which the parameters with `shared` are the same.
    pub fn new(scans: &'a [S], shared: [bool; P]) -> Self {
        Joint { scans, shared }
    }

    fn count(&self) -> usize {
        self.shared.iter().filter(|&&shared| shared).count()
    }

    /// Number of coordinates that count.
    pub fn coordinates(&self) -> usize {
        self.count() + self.scans.len() * (P - self.count())
    }

    /// Place of parameter `i` of scan `s`.
    pub fn place(&self, s: usize, i: usize) -> usize {
        let same = |k: usize| self.shared[k] == self.shared[i];
        let before = (0..i).filter(|&k| same(k)).count();
        if self.shared[i] {
            before
        } else {
            self.count() + s * (P - self.count()) + before
        }
    }

    /// The parameters of scan `s`.
    pub fn of<R: Real, const Q: usize>(&self, x: &[R; Q], s: usize) -> [R; P] {
        core::array::from_fn(|i| x.get(self.place(s, i)).copied().unwrap_or(R::ZERO))
    }

    /// Coordinates from the parameters of each scan; a shared one is the mean over the scans.
    pub fn join<R: Real, const Q: usize>(&self, each: impl Iterator<Item = [R; P]>) -> [R; Q] {
        let mut x = [R::ZERO; Q];
        let share = R::ONE / R::of(self.scans.len() as f64);
        for (s, own) in each.enumerate().take(self.scans.len()) {
            for i in 0..P {
                if let Some(place) = x.get_mut(self.place(s, i)) {
                    *place += if self.shared[i] { own[i] * share } else { own[i] };
                }
            }
        }
        x
    }

    /// The bounds of every coordinate, from those of one scan.
    pub fn bounds<R: Real, const Q: usize>(&self, one: &Bounds<R, P>) -> Bounds<R, Q> {
        Bounds {
            lower: self.join(self.scans.iter().map(|_| one.lower)),
            upper: self.join(self.scans.iter().map(|_| one.upper)),
        }
    }
}

impl<R: Real, S: Problem<R, P>, const P: usize, const Q: usize> Problem<R, Q> for Joint<'_, S, P> {
    fn cost(&self, x: &[R; Q]) -> R {
        let mut cost = R::ZERO;
        for (s, scan) in self.scans.iter().enumerate() {
            cost += scan.cost(&self.of(x, s));
        }
        cost
    }

    fn linearize(&self, x: &[R; Q]) -> Linearization<R, Q> {
        let mut sums = Linearization {
            cost: R::ZERO,
            gradient: [R::ZERO; Q],
            hessian: [[R::ZERO; Q]; Q],
        };
        for (s, scan) in self.scans.iter().enumerate() {
            let own = scan.linearize(&self.of(x, s));
            sums.cost += own.cost;
            let places: [usize; P] = core::array::from_fn(|i| self.place(s, i));
            for (i, &row) in places.iter().enumerate() {
                if let Some(gradient) = sums.gradient.get_mut(row) {
                    *gradient += own.gradient[i];
                }
                for (j, &column) in places.iter().enumerate() {
                    if let Some(entry) = sums.hessian.get_mut(row).and_then(|row| row.get_mut(column)) {
                        *entry += own.hessian[i][j];
                    }
                }
            }
        }
        sums
    }

    /// Each scan bends its own parameters, if all that it bends are its own: others would have to agree.
    fn bend(&self, x: &[R; Q], step: &[R; Q], to: [R; Q]) -> [R; Q] {
        let mut bent = to;
        for (s, scan) in self.scans.iter().enumerate() {
            let straight = self.of(&to, s);
            let own = scan.bend(&self.of(x, s), &self.of(step, s), straight);
            if (0..P).all(|i| !self.shared[i] || own[i] == straight[i]) {
                for i in 0..P {
                    if let Some(place) = bent.get_mut(self.place(s, i)) {
                        *place = own[i];
                    }
                }
            }
        }
        bent
    }
}
