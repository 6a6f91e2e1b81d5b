//! The table of distinct minima, best first (section 5 of the paper).

use core::marker::PhantomData;

use crate::list::List;
use crate::lm::Fit;
use crate::real::Real;
use crate::saved::Tape;

/// How many minima a table has room for if nothing else is asked for.
pub const MINIMA: usize = 32;

/// One distinct minimum.
///
/// The other lists of a search have it too, in order of cost, so that an image holds one copy of what keeps them in order.
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

/// As many distinct minima as its list holds, in order of cost; where there are more, the worst are left out.
///
/// Two fits are distinct if their costs differ by at least 1 % and a parameter differs by more than 1e-3 of itself.
#[derive(Clone, Debug)]
pub struct Minima<R, const P: usize, S = heapless::Vec<Minimum<R, P>, MINIMA>> {
    list: S,
    of: PhantomData<R>,
}

impl<R: Real, const P: usize> Minimum<R, P> {
    /// None: what the memory of a table holds at first.
    pub const EMPTY: Self = Minimum {
        x: [R::ZERO; P],
        cost: R::ZERO,
        hits: 0,
        first_start: 0,
    };

    pub(crate) fn fields(&mut self, tape: &mut Tape<'_>) {
        tape.reals(&mut self.x);
        tape.reals(core::slice::from_mut(&mut self.cost));
        tape.u32(&mut self.hits);
        tape.u64(&mut self.first_start);
    }
}

impl<R: Real, const P: usize, const M: usize> Default for Minima<R, P, heapless::Vec<Minimum<R, P>, M>> {
    fn default() -> Self {
        Self::over(heapless::Vec::new())
    }
}

impl<R: Real, const P: usize, S: List<Item = Minimum<R, P>>> Minima<R, P, S> {
    /// A table in an empty list.
    pub const fn over(list: S) -> Self {
        Minima { list, of: PhantomData }
    }

    pub(crate) fn fields(&mut self, tape: &mut Tape<'_>) {
        tape.list(&mut self.list, Minimum::EMPTY, |tape, minimum| minimum.fields(tape));
    }

    /// How many it can hold.
    pub fn capacity(&self) -> usize {
        self.list.capacity()
    }

    /// Its list.
    pub(crate) fn list_mut(&mut self) -> &mut S {
        &mut self.list
    }

    /// Forgets all.
    pub(crate) fn clear(&mut self) {
        self.list.truncate(0);
    }

    /// Best first.
    pub fn as_slice(&self) -> &[Minimum<R, P>] {
        &self.list
    }

    /// The best.
    pub fn best(&self) -> Option<&Minimum<R, P>> {
        self.list.first()
    }

    /// Takes a further fit of the best minimum in place of the old one; not counted as a hit.
    pub fn refine(&mut self, fit: &Fit<R, P>) {
        if let Some(old) = self.list.first_mut() {
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
        while let Some(place) = self.list.iter().position(|old| same(old, &new)) {
            let (hits, first_start) = join(&mut self.list, place, &mut new);
            new.hits += hits;
            new.first_start = new.first_start.min(first_start);
        }
        insert(&mut self.list, &new);
    }

    /// (high - low) / high over the costs of the table (Table 3); 0 if there are fewer than two.
    pub fn improvement_potential(&self) -> R {
        match (self.list.first(), self.list.last()) {
            (Some(low), Some(high)) if high.cost > R::ZERO => (high.cost - low.cost) / high.cost,
            _ => R::ZERO,
        }
    }
}

#[cfg(feature = "defmt")]
impl<R: Real + defmt::Format, const P: usize, S: List<Item = Minimum<R, P>>> defmt::Format for Minima<R, P, S> {
    fn format(&self, to: defmt::Formatter<'_>) {
        defmt::write!(to, "{=[?]}", self.as_slice());
    }
}

/// Has an unfinished fit come so near to an end, of which coordinates and cost are given, that it would end there? Within this part of cost, and where the residuals, linear as the fit sees them, change by no more than this part of the cost on the way: along a valley that is far.
pub(crate) fn joins<R: Real, const P: usize>((x, cost): (&[R; P], R), fit: &Fit<R, P>, part: R) -> bool {
    let mut change = R::ZERO;
    for i in 0..P {
        for j in 0..P {
            change += (x[i] - fit.x[i]) * (x[j] - fit.x[j]) * fit.at.hessian[i][j];
        }
    }
    close(cost, fit.at.cost, part) && change < part * cost
}

fn same<R: Real, const P: usize>(a: &Minimum<R, P>, b: &Minimum<R, P>) -> bool {
    close(a.cost, b.cost, R::of(0.01)) || a.x.iter().zip(&b.x).all(|(&x, &y)| close(x, y, R::of(1e-3)))
}

/// Takes an item out of a list, and joins it with `new`, which gets its coordinates unless it has the lower cost; its hits and its first start.
pub(crate) fn join<R: Real, const P: usize>(
    list: &mut (impl List<Item = Minimum<R, P>> + ?Sized),
    place: usize,
    new: &mut Minimum<R, P>,
) -> (u32, u64) {
    let of_old = to_end(list, place, new);
    list.truncate(list.len().saturating_sub(1));
    of_old
}

/// Moves an item of a list to its end, while the others stay in order; the rest of [`join`].
#[cfg_attr(target_os = "none", inline(never))]
fn to_end<R: Real, const P: usize>(list: &mut [Minimum<R, P>], place: usize, new: &mut Minimum<R, P>) -> (u32, u64) {
    let mut rest = list.get_mut(place..).unwrap_or_default();
    while let [first, others @ ..] = rest
        && let Some(next) = others.first_mut()
    {
        core::mem::swap(first, next);
        rest = others;
    }
    let [old] = rest else {
        return (0, new.first_start);
    };
    if old.cost <= new.cost {
        (new.x, new.cost) = (old.x, old.cost);
    }
    (old.hits, old.first_start)
}

/// Puts `new` into its place in a list in order of cost; where there is no room, the last is left out.
pub(crate) fn insert<R: Real, const P: usize>(
    list: &mut (impl List<Item = Minimum<R, P>> + ?Sized),
    new: &Minimum<R, P>,
) {
    let full = list.len() == list.capacity();
    if !full {
        list.push(new);
    }
    place_last(list, new, full);
}

/// Puts `new` in the place of the last item, if that is worse or does not count, and then into its own.
#[cfg_attr(target_os = "none", inline(never))]
fn place_last<R: Real, const P: usize>(list: &mut [Minimum<R, P>], new: &Minimum<R, P>, counts: bool) {
    if let Some(last) = list.last_mut()
        && (!counts || less(new.cost, last.cost))
    {
        *last = *new;
        sift(list);
    }
}

/// Moves the last item of a list that is otherwise in order of cost to its place, after its equals.
#[cfg_attr(target_os = "none", inline(never))]
pub(crate) fn sift<R: Real, const P: usize>(list: &mut [Minimum<R, P>]) {
    let mut rest = list;
    while let [others @ .., item] = rest
        && let Some(before) = others.last_mut()
        && less(item.cost, before.cost)
    {
        core::mem::swap(before, item);
        rest = others;
    }
}

/// Order of costs, in which NaN comes last.
#[cfg_attr(target_os = "none", inline(never))]
pub(crate) fn less<R: Real>(a: R, b: R) -> bool {
    a < b || (a.is_finite() && !b.is_finite())
}

/// Do two numbers of one sign differ by at most this part of the larger?
#[cfg_attr(target_os = "none", inline(never))]
pub(crate) fn close<R: Real>(x: R, y: R, part: R) -> bool {
    (x - y).abs() <= part * x.abs().max(y.abs())
}
