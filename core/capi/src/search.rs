//! A search in steps, and what a finished fit knows.

use core::mem::MaybeUninit;

use brdfit_core::brdf::{ALL, has, parameters, slot};
use brdfit_core::geometry::Block;
use brdfit_core::lm::Problem;
use brdfit_core::lobes::Distribution;
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::saved::{self, SavedError};
use brdfit_core::search::{Evaluations, Search};
use brdfit_core::uncertainty::Uncertainty;

use crate::Done;
use crate::fit::{Of, enough, minima_of, with_model, write_found};
use crate::memory::{changed, input, inputs, output, outputs};
use crate::options::{bounds, lm_options, options_at};
use crate::scan::blocks_of;
use crate::types::*;

/// What lies in a [`brdfit_search_state`].
#[repr(C)]
pub struct State<R> {
    /// [`begun`], if it was.
    begun: u32,
    options: brdfit_options<R>,
    /// A `Search<R, P>` for the P of the terms.
    search: MaybeUninit<Search<R, { parameters(ALL) }>>,
}

/// Tells memory that holds a search from memory that holds anything.
fn begun<R>() -> u32 {
    0xb2df_1800 | size_of::<R>() as u32
}

impl<R> State<R> {
    /// The place of the search.
    fn search<const P: usize>(&self) -> *const Search<R, P> {
        const { assert!(size_of::<Search<R, P>>() <= size_of::<Search<R, { parameters(ALL) }>>()) };
        self.search.as_ptr().cast()
    }

    /// The same, to be changed.
    fn search_mut<const P: usize>(&mut self) -> *mut Search<R, P> {
        const { assert!(size_of::<Search<R, P>>() <= size_of::<Search<R, { parameters(ALL) }>>()) };
        self.search.as_mut_ptr().cast()
    }
}

/// The place of the state of a search that was begun.
///
/// # Safety
/// As for `memory::input`.
unsafe fn state_of<R>(search: *const brdfit_search_state<R>) -> Result<*const State<R>, brdfit_error> {
    // SAFETY: as asked of the caller; a number of 32 bits is there, whatever else.
    let first = *unsafe { input(search.cast::<u32>()) }?;
    if first == begun::<R>() {
        Ok(search.cast())
    } else {
        Err(brdfit_error::NotBegun)
    }
}

pub unsafe fn begin<R: Real>(search: *mut brdfit_search_state<R>, options: *const brdfit_options<R>) -> Done {
    // SAFETY: the contract of the header; a `State` is no larger than a `brdfit_search`.
    let (state, options) = unsafe { (output(search.cast::<State<R>>())?, options_at(options)?) };
    with_model!(options, begin_of::<R>(state, &options))
}

#[expect(
    clippy::extra_unused_type_parameters,
    reason = "the macro gives the distribution to all"
)]
#[inline(never)]
fn begin_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(
    state: &mut MaybeUninit<State<R>>,
    options: &brdfit_options<R>,
) -> Done {
    let state = state.write(State {
        begun: begun::<R>(),
        options: *options,
        search: MaybeUninit::uninit(),
    });
    let place = state.search_mut::<P>();
    // SAFETY: there is room for it, aligned as its largest sibling is.
    let search = unsafe {
        place.write(Search::new());
        &mut *place
    };
    let bounds = bounds::<R, TERMS, P>(options);
    search.begin(&bounds, options.seed, options.candidates, &lm_options(options));
    Ok(())
}

pub unsafe fn step<R: Real>(
    search: *mut brdfit_search_state<R>,
    scan: *const brdfit_scan<R>,
    passes: u32,
    ended: *mut u32,
) -> Done {
    // SAFETY: the contract of the header.
    let (state, (blocks, samples), ended) =
        unsafe { (changed(state_of(search)?.cast_mut())?, blocks_of(scan)?, output(ended)?) };
    let has_ended = with_model!(state.options, step_of::<R>(state, blocks, samples, passes))?;
    ended.write(u32::from(has_ended));
    Ok(())
}

#[inline(never)]
fn step_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(
    state: &mut State<R>,
    blocks: &[Block<R>],
    samples: usize,
    passes: u32,
) -> Result<bool, brdfit_error> {
    enough::<P>(samples)?;
    let scan = Of::<R, D, TERMS, P>::new(blocks);
    // SAFETY: `begin_of` or `restore_of` wrote one of this P there, for the terms are the same.
    let search = unsafe { &mut *state.search_mut::<P>() };
    let made = |evaluations: Evaluations| evaluations.cost.wrapping_add(evaluations.linearize);
    let before = made(search.progress().evaluations);
    let mut goes_on = true;
    while goes_on && made(search.progress().evaluations).wrapping_sub(before) < passes {
        goes_on = search.step(&scan);
    }
    Ok(!goes_on)
}

pub unsafe fn found<R: Real>(
    search: *const brdfit_search_state<R>,
    minima: *mut brdfit_minimum<R>,
    capacity: usize,
    found: *mut brdfit_found<R>,
) -> Done {
    // SAFETY: the contract of the header.
    let (state, found) = unsafe { (input(state_of(search)?)?, output(found)?) };
    // SAFETY: the contract of the header.
    let minima = unsafe { minima_of(minima, capacity) }?;
    found.write(with_model!(state.options, found_of::<R>(state, minima))?);
    Ok(())
}

#[expect(
    clippy::extra_unused_type_parameters,
    reason = "the macro gives the distribution to all"
)]
fn found_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(
    state: &State<R>,
    minima: &mut [MaybeUninit<brdfit_minimum<R>>],
) -> Result<brdfit_found<R>, brdfit_error> {
    // SAFETY: as in `step_of`.
    let search = unsafe { &*state.search::<P>() };
    let best = search.best().filter(|best| best.at.cost.is_finite());
    let best = best.ok_or(brdfit_error::NoFit)?;
    Ok(write_found::<R, TERMS, P>(
        best,
        search.minima().as_slice(),
        search.progress().evaluations,
        minima,
    ))
}

pub unsafe fn abort<R: Real>(search: *mut brdfit_search_state<R>) -> Done {
    // SAFETY: the contract of the header.
    let state = unsafe { changed(state_of(search)?.cast_mut()) }?;
    with_model!(state.options, abort_of::<R>(state))
}

#[expect(
    clippy::extra_unused_type_parameters,
    reason = "the macro gives distribution and terms to all"
)]
fn abort_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(state: &mut State<R>) -> Done {
    // SAFETY: as in `step_of`.
    unsafe { &mut *state.search_mut::<P>() }.abort();
    Ok(())
}

fn of_saved(error: SavedError) -> brdfit_error {
    match error {
        SavedError::Length => brdfit_error::Length,
        _ => brdfit_error::Saved,
    }
}

pub unsafe fn save<R: Real>(
    search: *mut brdfit_search_state<R>,
    bytes: *mut u8,
    capacity: usize,
    length: *mut usize,
) -> Done {
    // SAFETY: the contract of the header.
    let (state, bytes, length) = unsafe {
        (
            changed(state_of(search)?.cast_mut())?,
            outputs(bytes, capacity)?,
            output(length)?,
        )
    };
    // Bytes that hold anything become bytes.
    let bytes = {
        for byte in bytes.iter_mut() {
            byte.write(0);
        }
        // SAFETY: each was just written.
        unsafe { core::slice::from_raw_parts_mut(bytes.as_mut_ptr().cast::<u8>(), capacity) }
    };
    length.write(with_model!(state.options, save_of::<R>(state, bytes))?);
    Ok(())
}

#[expect(
    clippy::extra_unused_type_parameters,
    reason = "the macro gives distribution and terms to all"
)]
fn save_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(
    state: &mut State<R>,
    bytes: &mut [u8],
) -> Result<usize, brdfit_error> {
    // SAFETY: as in `step_of`.
    saved::save(unsafe { &mut *state.search_mut::<P>() }, bytes).map_err(of_saved)
}

pub unsafe fn restore<R: Real>(
    search: *mut brdfit_search_state<R>,
    options: *const brdfit_options<R>,
    bytes: *const u8,
    length: usize,
) -> Done {
    // SAFETY: the contract of the header.
    unsafe {
        begin(search, options)?;
        let (state, bytes) = (changed(search.cast::<State<R>>())?, inputs(bytes, length)?);
        let done = with_model!(state.options, restore_of::<R>(state, bytes));
        if done.is_err() {
            state.begun = 0;
        }
        done
    }
}

#[expect(
    clippy::extra_unused_type_parameters,
    reason = "the macro gives distribution and terms to all"
)]
fn restore_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(state: &mut State<R>, bytes: &[u8]) -> Done {
    // SAFETY: as in `step_of`.
    saved::restore(unsafe { &mut *state.search_mut::<P>() }, bytes).map_err(of_saved)
}

pub unsafe fn uncertainty<R: Real>(
    scan: *const brdfit_scan<R>,
    options: *const brdfit_options<R>,
    params: *const brdfit_params<R>,
    uncertainty: *mut brdfit_uncertainty<R>,
) -> Done {
    // SAFETY: the contract of the header.
    let ((blocks, samples), options, params, uncertainty) = unsafe {
        (
            blocks_of(scan)?,
            options_at(options)?,
            input(params)?,
            output(uncertainty)?,
        )
    };
    crate::options::check_params(params)?;
    uncertainty.write(with_model!(
        options,
        uncertainty_of::<R>(blocks, samples, &options, params)
    )?);
    Ok(())
}

#[inline(never)]
fn uncertainty_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(
    blocks: &[Block<R>],
    samples: usize,
    options: &brdfit_options<R>,
    params: &brdfit_params<R>,
) -> Result<brdfit_uncertainty<R>, brdfit_error> {
    enough::<P>(samples)?;
    let scan = Of::<R, D, TERMS, P>::new(blocks);
    let bounds = bounds::<R, TERMS, P>(options);
    let x = bounds.clamp(Scan::<R, TERMS, P>::coordinates(&(*params).into()));
    let known = Uncertainty::new(&scan.linearize(&x), &x, &bounds, samples);
    let condition = known.held.condition;
    let axes = known.held.transformed(&Of::<R, D, TERMS, P>::slopes(&x));
    let mut correlations = [R::ZERO; 36];
    for (row, line) in correlations.chunks_exact_mut(6).enumerate() {
        if has(TERMS, row) {
            let place = slot(TERMS, row);
            line.copy_from_slice(&spread::<R, TERMS>(|other| axes.correlation(place, other)));
        }
    }
    let [rho_d, rho_s, rho_v, m, n, kappa] = spread::<R, TERMS>(|k| axes.standard_error(k));
    Ok(brdfit_uncertainty {
        standard_errors: brdfit_params {
            rho_d,
            rho_s,
            rho_v,
            m,
            n,
            kappa,
        },
        correlations,
        scale: known.scale,
        condition,
    })
}

/// One number for each parameter of Eq. 14, from that of each coordinate; those of absent terms are 0.
fn spread<R: Real, const TERMS: u8>(of: impl Fn(usize) -> R) -> [R; 6] {
    core::array::from_fn(|index| {
        if has(TERMS, index) {
            of(slot(TERMS, index))
        } else {
            R::ZERO
        }
    })
}
