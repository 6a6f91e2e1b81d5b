//! The table of distinct minima, best first (section 5 of the paper).

use heapless::Vec;

use crate::lm::Fit;
use crate::real::Real;

/// One distinct minimum.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Minimum<R, const P: usize> {
    /// Parameters of the best fit that ended here.
    pub x: [R; P],
    /// Its sum of squared residuals.
    pub cost: R,
    /// How many fits ended here.
    pub hits: u32,
    /// The least index of a start that led here.
    pub first_start: u64,
}

/// At most `M` distinct minima, in order of cost; where there are more, the worst are left out.
///
/// Two fits are distinct if their costs differ by at least 1 % and a parameter differs by more than 1e-3 of itself.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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

    /// True, and a hit more, if an unfinished fit has come so near to a minimum of the table that it would end there: within 1 % of cost, and 5 % of each parameter.
    pub(crate) fn join(&mut self, fit: &Fit<R, P>, start: u64) -> bool {
        let near = |old: &Minimum<R, P>| {
            close(old.cost, fit.at.cost, R::of(0.01))
                && old
                    .x
                    .iter()
                    .zip(&fit.x)
                    .all(|(&x, &y)| close(x, y, R::of(0.05)) || (x - y).abs() < R::of(1e-3))
        };
        match self.list.iter_mut().find(|old| near(old)) {
            Some(old) => {
                old.hits += 1;
                old.first_start = old.first_start.min(start);
                if fit.at.cost < old.cost {
                    (old.x, old.cost) = (fit.x, fit.at.cost);
                }
                true
            }
            None => false,
        }
    }

    /// Takes a further fit of the best minimum in place of the old one, if it is no worse; not counted as a hit.
    pub fn refine(&mut self, fit: &Fit<R, P>) {
        if let Some(old) = self.list.first_mut()
            && fit.at.cost <= old.cost
        {
            (old.x, old.cost) = (fit.x, fit.at.cost);
        }
    }

    /// Adds the fit of start `start`; the table depends on the order of the calls only through ties.
    pub fn add(&mut self, fit: &Fit<R, P>, start: u64) {
        let mut new = Minimum {
            x: fit.x,
            cost: fit.at.cost,
            hits: 1,
            first_start: start,
        };
        // Joined with one minimum, a better fit may come within 1 % of the next.
        while let Some(old) = self.take(|old| same(old, &new)) {
            new.hits += old.hits;
            new.first_start = new.first_start.min(old.first_start);
            if old.cost <= new.cost {
                (new.x, new.cost) = (old.x, old.cost);
            }
        }
        insert(&mut self.list, M, new, |minimum| minimum.cost);
    }

    /// Takes the first that is as wanted out of the table.
    fn take(&mut self, wanted: impl Fn(&Minimum<R, P>) -> bool) -> Option<Minimum<R, P>> {
        let place = self.list.iter().position(wanted)?;
        let mut rest = self.list.get_mut(place..)?;
        while let [first, others @ ..] = rest
            && let Some(next) = others.first_mut()
        {
            core::mem::swap(first, next);
            rest = others;
        }
        self.list.pop()
    }

    /// (high - low) / high over the costs of the table (Table 3); 0 if there are fewer than two.
    pub fn improvement_potential(&self) -> R {
        match (self.list.first(), self.list.last()) {
            (Some(low), Some(high)) if high.cost > R::ZERO => (high.cost - low.cost) / high.cost,
            _ => R::ZERO,
        }
    }
}

fn same<R: Real, const P: usize>(a: &Minimum<R, P>, b: &Minimum<R, P>) -> bool {
    close(a.cost, b.cost, R::of(0.01)) || a.x.iter().zip(&b.x).all(|(&x, &y)| close(x, y, R::of(1e-3)))
}

/// Puts `new` into its place in a list of at most `most` items in order of cost; where there are more, the last is left out.
pub(crate) fn insert<R: Real, T, const N: usize>(list: &mut Vec<T, N>, most: usize, new: T, cost: impl Fn(&T) -> R) {
    if list.len() >= most.min(N) {
        match list.last() {
            Some(last) if less(cost(&new), cost(last)) => list.pop(),
            _ => return,
        };
    }
    // There is room.
    let _ = list.push(new);
    sift(list, cost);
}

/// Moves the last item of a list that is otherwise in order of cost to its place, after its equals.
pub(crate) fn sift<R: Real, T>(list: &mut [T], cost: impl Fn(&T) -> R) {
    let mut rest = list;
    while let [others @ .., item] = rest
        && let Some(before) = others.last_mut()
        && less(cost(item), cost(before))
    {
        core::mem::swap(before, item);
        rest = others;
    }
}

/// Order of costs, in which NaN comes last.
fn less<R: Real>(a: R, b: R) -> bool {
    a < b || (a.is_finite() && !b.is_finite())
}

/// Do two numbers of one sign differ by at most this part of the larger?
fn close<R: Real>(x: R, y: R, part: R) -> bool {
    (x - y).abs() <= part * x.abs().max(y.abs())
}
