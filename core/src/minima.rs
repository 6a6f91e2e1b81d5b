//! The table of distinct minima, best first (section 5 of the paper).

use heapless::Vec;

use crate::lm::Fit;
use crate::real::Real;

/// One distinct minimum.
#[derive(Clone, Copy, Debug)]
pub struct Minimum<R, const P: usize> {
    /// The best fit that ended here.
    pub fit: Fit<R, P>,
    /// How many fits ended here.
    pub hits: u32,
    /// The least index of a start that led here.
    pub first_start: u64,
}

/// At most `M` distinct minima, in order of cost; where there are more, the worst are left out.
///
/// Two fits are distinct if their costs differ by at least 1 % and a parameter differs by more than 1e-3 of itself.
#[derive(Clone, Debug)]
pub struct Minima<R, const P: usize, const M: usize> {
    list: Vec<Minimum<R, P>, M>,
}

impl<R: Real, const P: usize, const M: usize> Default for Minima<R, P, M> {
    fn default() -> Self {
        Minima { list: Vec::new() }
    }
}

impl<R: Real, const P: usize, const M: usize> Minima<R, P, M> {
    /// Best first.
    pub fn as_slice(&self) -> &[Minimum<R, P>] {
        &self.list
    }

    /// The best.
    pub fn best(&self) -> Option<&Minimum<R, P>> {
        self.list.first()
    }

    /// The best, to be improved.
    pub(crate) fn best_mut(&mut self) -> Option<&mut Minimum<R, P>> {
        self.list.first_mut()
    }

    /// True, and a hit more, if an unfinished fit has come so near to a minimum of the table that it would end there: within 1 % of cost, and 5 % of each parameter.
    pub(crate) fn join(&mut self, fit: &Fit<R, P>, start: u64) -> bool {
        let near = |old: &Minimum<R, P>| {
            close(old.fit.at.cost, fit.at.cost, R::of(0.01))
                && old
                    .fit
                    .x
                    .iter()
                    .zip(&fit.x)
                    .all(|(&x, &y)| close(x, y, R::of(0.05)) || (x - y).abs() < R::of(1e-3))
        };
        match self.list.iter_mut().find(|old| near(old)) {
            Some(old) => {
                old.hits += 1;
                old.first_start = old.first_start.min(start);
                if fit.at.cost < old.fit.at.cost {
                    old.fit = *fit;
                }
                true
            }
            None => false,
        }
    }

    /// Takes a further fit of the minimum found from `start` in place of the old one, if it is no worse; not counted as a hit.
    pub fn refine(&mut self, fit: &Fit<R, P>, start: u64) {
        if let Some(old) = self.list.iter_mut().find(|old| old.first_start == start)
            && fit.at.cost <= old.fit.at.cost
        {
            old.fit = *fit;
        }
    }

    /// Adds the fit of start `start`; the table depends on the order of the calls only through ties.
    pub fn add(&mut self, fit: &Fit<R, P>, start: u64) {
        let mut new = Minimum {
            fit: *fit,
            hits: 1,
            first_start: start,
        };
        // Joined with one minimum, a better fit may come within 1 % of the next.
        while let Some(place) = self.list.iter().position(|old| same(&old.fit, &new.fit)) {
            let old = self.list.remove(place);
            new.hits += old.hits;
            new.first_start = new.first_start.min(old.first_start);
            if old.fit.at.cost <= new.fit.at.cost {
                new.fit = old.fit;
            }
        }
        let place = self
            .list
            .iter()
            .position(|old| new.fit.at.cost < old.fit.at.cost)
            .unwrap_or(self.list.len());
        if self.list.is_full() {
            if place >= self.list.len() {
                return;
            }
            self.list.pop();
        }
        // There is room, and place is at most the length.
        let _ = self.list.insert(place, new);
    }

    /// (high - low) / high over the costs of the table (Table 3); 0 if there are fewer than two.
    pub fn improvement_potential(&self) -> R {
        match (self.list.first(), self.list.last()) {
            (Some(low), Some(high)) if high.fit.at.cost > R::ZERO => {
                (high.fit.at.cost - low.fit.at.cost) / high.fit.at.cost
            }
            _ => R::ZERO,
        }
    }
}

fn same<R: Real, const P: usize>(a: &Fit<R, P>, b: &Fit<R, P>) -> bool {
    close(a.at.cost, b.at.cost, R::of(0.01)) || a.x.iter().zip(&b.x).all(|(&x, &y)| close(x, y, R::of(1e-3)))
}

/// Do two numbers of one sign differ by at most this part of the larger?
fn close<R: Real>(x: R, y: R, part: R) -> bool {
    (x - y).abs() <= part * x.abs().max(y.abs())
}
