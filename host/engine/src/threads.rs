//! Work shared among the threads of the pool.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};

use rayon::prelude::*;

/// What `of` gives of 0, 1 ... `count` - 1, in this order.
///
/// What rayon is made of is compiled for each closure that it is given, in thousands of lines; this has one for all.
pub fn each<S: Send + Sync>(count: usize, of: &(dyn Fn(usize) -> S + Sync)) -> Vec<S> {
    let made = places(count);
    run(count, &|k| {
        let _ = made[k].set(of(k));
    });
    made.into_iter().filter_map(OnceLock::into_inner).collect()
}

/// The same, or the first error in this order; what comes after an error is left out, as nobody waits for it.
///
/// # Errors
/// Those of `of`.
pub fn try_each<S: Send + Sync, E: Send + Sync>(
    count: usize,
    of: &(dyn Fn(usize) -> Result<S, E> + Sync),
) -> Result<Vec<S>, E> {
    let made = places(count);
    let first_error = AtomicUsize::new(count);
    run(count, &|k| {
        // What comes before is made to the end, so that the error is the same on any number of threads.
        if k > first_error.load(Ordering::Relaxed) {
            return;
        }
        let one = of(k);
        if one.is_err() {
            first_error.fetch_min(k, Ordering::Relaxed);
        }
        let _ = made[k].set(one);
    });
    made.into_iter().map_while(OnceLock::into_inner).collect()
}

/// The same of each item.
pub fn map<T: Sync, S: Send + Sync>(items: &[T], of: &(dyn Fn(&T) -> S + Sync)) -> Vec<S> {
    each(items.len(), &|k| of(&items[k]))
}

/// The same, or the first error in their order, as [`try_each`].
///
/// # Errors
/// Those of `of`.
pub fn try_map<T: Sync, S: Send + Sync, E: Send + Sync>(
    items: &[T],
    of: &(dyn Fn(&T) -> Result<S, E> + Sync),
) -> Result<Vec<S>, E> {
    try_each(items.len(), &|k| of(&items[k]))
}

/// What [`map`] gives, of each item of a list that nobody needs any more.
pub fn into<T: Send, S: Send + Sync>(items: Vec<T>, of: &(dyn Fn(T) -> S + Sync)) -> Vec<S> {
    let items: Vec<Mutex<Option<T>>> = items.into_iter().map(|item| Mutex::new(Some(item))).collect();
    let one = |k: usize| items[k].lock().ok()?.take().map(of);
    each(items.len(), &one).into_iter().flatten().collect()
}

/// What `of` gives of 0, 1 ... `count` - 1, at least one, added in this order.
pub(crate) fn sum<S: Send + Sync>(count: usize, of: &(dyn Fn(usize) -> S + Sync), add: fn(&mut S, &S)) -> S {
    let mut sums = each(count, of);
    let (first, others) = sums.split_at_mut(1);
    others.iter().for_each(|part| add(&mut first[0], part));
    sums.swap_remove(0)
}

fn places<S>(count: usize) -> Vec<OnceLock<S>> {
    (0..count).map(|_| OnceLock::new()).collect()
}

fn run(count: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().for_each(work);
}
