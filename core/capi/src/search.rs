//! A search in steps, and what a finished fit knows.

use core::mem::MaybeUninit;
use core::ops::{Deref, DerefMut};

use brdfit_core::brdf::{ALL, has, parameters, slot};
use brdfit_core::geometry::Block;
use brdfit_core::list::List;
use brdfit_core::lm::Problem;
use brdfit_core::lobes::Distribution;
use brdfit_core::minima::Minimum;
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::saved::{self, SavedError};
use brdfit_core::search::{Evaluations, SearchIn, Trial};
use brdfit_core::uncertainty::Uncertainty;

use crate::Done;
use crate::fit::{Of, enough, minima_of, with_model, write_found};
use crate::memory::{input, inputs, output, outputs};
use crate::options::{bounds, lm_options, options_at};
use crate::scan::blocks_of;
use crate::types::*;

/// A list in memory of the caller, whose place is told anew in each call, for it may be copied in between.
pub struct Behind<T> {
    first: *mut T,
    capacity: usize,
    len: usize,
}

impl<T> Behind<T> {
    /// For a search that is moved before anything else.
    const fn nowhere() -> Self {
        Behind {
            first: core::ptr::NonNull::dangling().as_ptr(),
            capacity: 0,
            len: 0,
        }
    }
}

impl<T> Deref for Behind<T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        // SAFETY: `search_of` and `begin_of` alone tell places, where they have written an item for all of the capacity, for the time of their caller's call.
        unsafe { core::slice::from_raw_parts(self.first, self.len) }
    }
}

impl<T> DerefMut for Behind<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        // SAFETY: as above; a search has each of its two once.
        unsafe { core::slice::from_raw_parts_mut(self.first, self.len) }
    }
}

impl<T: Copy> List for Behind<T> {
    type Item = T;
    fn capacity(&self) -> usize {
        self.capacity
    }
    fn resize(&mut self, len: usize, with: T) -> bool {
        if len > self.capacity {
            return false;
        }
        let before = core::mem::replace(&mut self.len, len);
        self.iter_mut().skip(before).for_each(|item| *item = with);
        true
    }
    fn push(&mut self, item: &T) {
        if self.len < self.capacity {
            // SAFETY: as above; there is room.
            unsafe { self.first.add(self.len).write(*item) };
            self.len += 1;
        }
    }
    fn truncate(&mut self, len: usize) {
        self.len = self.len.min(len);
    }
}

/// A search whose minima and fits lie behind its [`State`].
type Search<R, const P: usize> = SearchIn<R, P, Behind<Minimum<R, P>>, Behind<Trial<R, P>>>;

/// What lies at the beginning of the memory of a search; its minima follow, and then its fits.
#[repr(C, align(8))]
pub struct State<R> {
    /// [`begun`], if it was.
    begun: u32,
    minima: u32,
    fits: u32,
    options: brdfit_options<R>,
    /// A `Search<R, P>` for the P of the terms.
    search: MaybeUninit<Search<R, { parameters(ALL) }>>,
}

/// The largest numbers of minima and of fits: those that a saved search can tell.
const MOST: (u32, u32) = (0xffff, 0xff);

/// Tells memory that holds a search from memory that holds anything.
fn begun<R>() -> u32 {
    0xb2df_1800 | size_of::<R>() as u32
}

/// Units of `brdfit_search_state` that a search takes, if it can have so many minima and fits.
fn units(minima: u32, fits: u32) -> Result<usize, brdfit_error> {
    if !(1..=MOST.0).contains(&minima) || !(1..=MOST.1).contains(&fits) {
        return Err(brdfit_error::Length);
    }
    Ok(BRDFIT_SEARCH_BASE + BRDFIT_SEARCH_MINIMUM * minima as usize + BRDFIT_SEARCH_FIT * fits as usize)
}

/// Where the minima and the fits of a search lie.
///
/// # Safety
/// `state` points to the memory of a search with so many.
unsafe fn behind<R: Real, const P: usize>(state: *mut State<R>, minima: u32) -> (*mut Minimum<R, P>, *mut Trial<R, P>) {
    const {
        assert!(align_of::<Minimum<R, P>>() <= align_of::<State<R>>());
        assert!(size_of::<Minimum<R, P>>().is_multiple_of(align_of::<Trial<R, P>>()));
        assert!(size_of::<Minimum<R, P>>() <= BRDFIT_SEARCH_MINIMUM * size_of::<brdfit_search_state<R>>());
        assert!(size_of::<Trial<R, P>>() <= BRDFIT_SEARCH_FIT * size_of::<brdfit_search_state<R>>());
        assert!(size_of::<Search<R, P>>() <= size_of::<Search<R, { parameters(ALL) }>>());
    }
    // SAFETY: all of it is within that memory, as the sizes above say.
    unsafe {
        let first = state.add(1).cast::<Minimum<R, P>>();
        (first, first.add(minima as usize).cast::<Trial<R, P>>())
    }
}

/// The search that was begun, in this place.
///
/// # Safety
/// `state` comes from [`state_of`], its terms have `P` parameters, and nobody else uses it or what lies behind it during `'a`.
unsafe fn search_of<'a, R: Real, const P: usize>(state: *mut State<R>) -> &'a mut Search<R, P> {
    // SAFETY: `begin_of` wrote one of this P there.
    unsafe {
        let (first_minimum, first_fit) = behind::<R, P>(state, (*state).minima);
        let search = &mut *(&raw mut (*state).search).cast::<Search<R, P>>();
        let (minima, fits) = search.lists_mut();
        (minima.first, fits.first) = (first_minimum, first_fit);
        search
    }
}

/// The place of the state of a search that was begun.
///
/// # Safety
/// As for `memory::changed`, for all the memory that the search was begun with.
unsafe fn state_of<R>(search: *mut brdfit_search_state<R>) -> Result<*mut State<R>, brdfit_error> {
    // SAFETY: as asked of the caller; a number of 32 bits is there, whatever else.
    let first = *unsafe { input(search.cast::<u32>()) }?;
    if !search.is_aligned() {
        Err(brdfit_error::Misaligned)
    } else if first == begun::<R>() {
        Ok(search.cast())
    } else {
        Err(brdfit_error::NotBegun)
    }
}

/// The options of a search, of which [`state_of`] gave the state.
fn options_of<R: Real>(state: *const State<R>) -> brdfit_options<R> {
    // SAFETY: `state_of` alone gives states, and their options are written once.
    unsafe { (*state).options }
}

pub unsafe fn begin<R: Real>(
    search: *mut brdfit_search_state<R>,
    size: usize,
    minima: u32,
    fits: u32,
    options: *const brdfit_options<R>,
) -> Done {
    // SAFETY: the contract of the header.
    let options = unsafe { options_at(options)? };
    let units = units(minima, fits)?;
    // SAFETY: the contract of the header.
    unsafe { output(search)? };
    if size / size_of::<brdfit_search_state<R>>() < units {
        return Err(brdfit_error::Small);
    }
    with_model!(options, begin_of::<R>(search.cast(), minima, fits, &options))
}

#[expect(
    clippy::extra_unused_type_parameters,
    reason = "the macro gives the distribution to all"
)]
#[inline(never)]
fn begin_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(
    state: *mut State<R>,
    minima: u32,
    fits: u32,
    options: &brdfit_options<R>,
) -> Done {
    // SAFETY: `begin` alone calls it, with memory of so many minima and fits that nobody else uses.
    let search = unsafe {
        state.write(State {
            begun: begun::<R>(),
            minima,
            fits,
            options: *options,
            search: MaybeUninit::uninit(),
        });
        let (first_minimum, first_fit) = behind::<R, P>(state, minima);
        for place in 0..minima as usize {
            first_minimum.add(place).write(Minimum::EMPTY);
        }
        for place in 0..fits as usize {
            first_fit.add(place).write(Trial::EMPTY);
        }
        let place = (&raw mut (*state).search).cast::<Search<R, P>>();
        // Made when it is compiled, it is zeros to be written; made here, it would lie on the stack first.
        place.write(
            const {
                let (minima, fits) = (Behind::nowhere(), Behind::nowhere());
                SearchIn::over(minima, fits)
            },
        );
        let search = &mut *place;
        let lists = search.lists_mut();
        (lists.0.first, lists.0.capacity) = (first_minimum, minima as usize);
        (lists.1.first, lists.1.capacity) = (first_fit, fits as usize);
        search
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
    let (state, (blocks, samples), ended) = unsafe { (state_of(search)?, blocks_of(scan)?, output(ended)?) };
    let options = options_of(state);
    let has_ended = with_model!(options, step_of::<R>(state, blocks, samples, passes))?;
    ended.write(u32::from(has_ended));
    Ok(())
}

#[inline(never)]
fn step_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(
    state: *mut State<R>,
    blocks: &[Block<R>],
    samples: usize,
    passes: u32,
) -> Result<bool, brdfit_error> {
    enough::<P>(samples)?;
    let scan = Of::<R, D, TERMS, P>::new(blocks);
    // SAFETY: `step` has it of `state_of`, and the terms are those that it was begun with.
    let search = unsafe { search_of::<R, P>(state) };
    let made = |evaluations: Evaluations| evaluations.cost.wrapping_add(evaluations.linearize);
    let before = made(search.progress().evaluations);
    let mut goes_on = true;
    while goes_on && made(search.progress().evaluations).wrapping_sub(before) < passes {
        goes_on = search.step(&scan);
    }
    Ok(!goes_on)
}

pub unsafe fn found<R: Real>(
    search: *mut brdfit_search_state<R>,
    minima: *mut brdfit_minimum<R>,
    capacity: usize,
    found: *mut brdfit_found<R>,
) -> Done {
    // SAFETY: the contract of the header.
    let (state, found) = unsafe { (state_of(search)?, output(found)?) };
    // SAFETY: the contract of the header.
    let minima = unsafe { minima_of(minima, capacity) }?;
    let options = options_of(state);
    found.write(with_model!(options, found_of::<R>(state, minima))?);
    Ok(())
}

#[expect(
    clippy::extra_unused_type_parameters,
    reason = "the macro gives the distribution to all"
)]
fn found_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(
    state: *mut State<R>,
    minima: &mut [MaybeUninit<brdfit_minimum<R>>],
) -> Result<brdfit_found<R>, brdfit_error> {
    // SAFETY: as in `step_of`.
    let search = unsafe { search_of::<R, P>(state) };
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
    let state = unsafe { state_of(search) }?;
    let options = options_of(state);
    with_model!(options, abort_of::<R>(state))
}

#[expect(
    clippy::extra_unused_type_parameters,
    reason = "the macro gives distribution and terms to all"
)]
fn abort_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(state: *mut State<R>) -> Done {
    // SAFETY: as in `step_of`.
    unsafe { search_of::<R, P>(state) }.abort();
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
    let (state, bytes, length) = unsafe { (state_of(search)?, outputs(bytes, capacity)?, output(length)?) };
    // Bytes that hold anything become bytes.
    let bytes = {
        for byte in bytes.iter_mut() {
            byte.write(0);
        }
        // SAFETY: each was just written.
        unsafe { core::slice::from_raw_parts_mut(bytes.as_mut_ptr().cast::<u8>(), capacity) }
    };
    let options = options_of(state);
    length.write(with_model!(options, save_of::<R>(state, bytes))?);
    Ok(())
}

#[expect(
    clippy::extra_unused_type_parameters,
    reason = "the macro gives distribution and terms to all"
)]
fn save_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(
    state: *mut State<R>,
    bytes: &mut [u8],
) -> Result<usize, brdfit_error> {
    // SAFETY: as in `step_of`.
    saved::save(unsafe { search_of::<R, P>(state) }, bytes).map_err(of_saved)
}

pub unsafe fn restore<R: Real>(
    search: *mut brdfit_search_state<R>,
    size: usize,
    minima: u32,
    fits: u32,
    options: *const brdfit_options<R>,
    bytes: *const u8,
    length: usize,
) -> Done {
    // SAFETY: the contract of the header.
    let bytes = unsafe {
        begin(search, size, minima, fits, options)?;
        inputs(bytes, length)
    };
    let state: *mut State<R> = search.cast();
    let options = options_of(state);
    let done = bytes.and_then(|bytes| with_model!(options, restore_of::<R>(state, bytes)));
    if done.is_err() {
        // SAFETY: it was begun just now.
        unsafe { (*state).begun = 0 };
    }
    done
}

#[expect(
    clippy::extra_unused_type_parameters,
    reason = "the macro gives distribution and terms to all"
)]
fn restore_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(state: *mut State<R>, bytes: &[u8]) -> Done {
    // SAFETY: as in `step_of`.
    saved::restore(unsafe { search_of::<R, P>(state) }, bytes).map_err(of_saved)
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
