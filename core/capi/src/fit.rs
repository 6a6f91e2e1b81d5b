//! Fits and searches, for the model and the set of terms that were chosen.

use core::mem::MaybeUninit;

use brdfit_core::brdf::{ALL, Params, parameters};
use brdfit_core::geometry::Block;
use brdfit_core::lm::Fit;
use brdfit_core::lobes::Distribution;
use brdfit_core::microfacet::Microfacet;
use brdfit_core::minima::Minimum;
use brdfit_core::real::Real;
use brdfit_core::residuals::{Residuals, Scan};
use brdfit_core::search::{Evaluations, Region, Scene};

use crate::Done;
use crate::memory::{changed, input, output, outputs};
use crate::options::{bounds, lm_options, options_at};
use crate::scan::blocks_of;
use crate::types::*;

/// What lies in a [`brdfit_fit`].
#[repr(C)]
pub struct State<R> {
    /// [`begun`], if it was.
    begun: u32,
    options: brdfit_options<R>,
    /// A `Fit<R, P>` for the P of the terms.
    fit: MaybeUninit<Fit<R, { parameters(ALL) }>>,
}

/// Tells memory that holds a fit from memory that holds anything.
fn begun<R>() -> u32 {
    0xb2df_1700 | size_of::<R>() as u32
}

impl<R> State<R> {
    /// The place of the fit.
    fn fit<const P: usize>(&self) -> *const Fit<R, P> {
        const { assert!(size_of::<Fit<R, P>>() <= size_of::<Fit<R, { parameters(ALL) }>>()) };
        self.fit.as_ptr().cast()
    }

    /// The same, to be changed.
    fn fit_mut<const P: usize>(&mut self) -> *mut Fit<R, P> {
        const { assert!(size_of::<Fit<R, P>>() <= size_of::<Fit<R, { parameters(ALL) }>>()) };
        self.fit.as_mut_ptr().cast()
    }
}

/// The residuals of a model of Eq. 14 with distribution `D`; its parameters are those of [`Scan`].
pub type Of<'a, R, D, const TERMS: u8, const P: usize> = Residuals<'a, R, Microfacet<TERMS, D>, P>;

/// Calls a function of any model and set of terms with those chosen at run time.
macro_rules! with_model {
    ($options:expr, $function:ident::<$R:ident>($($argument:expr),*)) => {
        match ($options.model, $options.terms) {
            #[cfg(feature = "ggx")]
            ($crate::BRDFIT_MODEL_GGX, 0b1111) => $function::<$R, brdfit_core::lobes::Ggx, 0b1111, 6>($($argument),*),
            (1.., _) => Err($crate::brdfit_error::Terms),
            ($crate::BRDFIT_MODEL_BECKMANN, 0b1111) => $function::<$R, brdfit_core::lobes::Beckmann, 0b1111, 6>($($argument),*),
            #[cfg(feature = "sets")]
            (_, 0b0001) => $function::<$R, brdfit_core::lobes::Beckmann, 0b0001, 1>($($argument),*),
            #[cfg(feature = "sets")]
            (_, 0b0010) => $function::<$R, brdfit_core::lobes::Beckmann, 0b0010, 3>($($argument),*),
            #[cfg(feature = "sets")]
            (_, 0b1010) => $function::<$R, brdfit_core::lobes::Beckmann, 0b1010, 4>($($argument),*),
            #[cfg(feature = "sets")]
            (_, 0b1110) => $function::<$R, brdfit_core::lobes::Beckmann, 0b1110, 5>($($argument),*),
            #[cfg(feature = "sets")]
            (_, 0b0011) => $function::<$R, brdfit_core::lobes::Beckmann, 0b0011, 4>($($argument),*),
            #[cfg(feature = "sets")]
            (_, 0b1011) => $function::<$R, brdfit_core::lobes::Beckmann, 0b1011, 5>($($argument),*),
            #[cfg(feature = "sets")]
            (_, 0b0111) => $function::<$R, brdfit_core::lobes::Beckmann, 0b0111, 5>($($argument),*),
            _ => Err($crate::brdfit_error::Terms),
        }
    };
}
pub(crate) use with_model;

pub fn enough<const P: usize>(samples: usize) -> Done {
    if samples < P { Err(brdfit_error::TooFew) } else { Ok(()) }
}

pub unsafe fn candidate<R: Real>(
    scan: *const brdfit_scan<R>,
    options: *const brdfit_options<R>,
    index: u64,
    start: *mut brdfit_params<R>,
) -> Done {
    // SAFETY: the contract of the header.
    let ((blocks, samples), options, start) = unsafe { (blocks_of(scan)?, options_at(options)?, output(start)?) };
    start.write(with_model!(
        options,
        candidate_of::<R>(blocks, samples, &options, index)
    )?);
    Ok(())
}

// Each set of terms has a stack frame of its own, or that of the caller would hold those of all.
#[inline(never)]
fn candidate_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(
    blocks: &[Block<R>],
    samples: usize,
    options: &brdfit_options<R>,
    index: u64,
) -> Result<brdfit_params<R>, brdfit_error> {
    enough::<P>(samples)?;
    let scan = Of::<R, D, TERMS, P>::new(blocks);
    let x = scan
        .candidate(&bounds::<R, TERMS, P>(options), options.seed, index, Region::Everywhere)
        .x;
    Ok(Scan::<R, TERMS, P>::params(&x).into())
}

pub unsafe fn fit_begin<R: Real>(
    fit: *mut brdfit_fit<R>,
    scan: *const brdfit_scan<R>,
    start: *const brdfit_params<R>,
    options: *const brdfit_options<R>,
) -> Done {
    // SAFETY: the contract of the header; a `State` is no larger than a `brdfit_fit`.
    let (state, (blocks, samples), start, options) = unsafe {
        (
            output(fit.cast::<State<R>>())?,
            blocks_of(scan)?,
            input(start)?,
            options_at(options)?,
        )
    };
    if !Params::from(*start).to_array().iter().all(|value| value.is_finite()) {
        return Err(brdfit_error::NotFinite);
    }
    with_model!(options, fit_begin_of::<R>(state, blocks, samples, start, &options))
}

#[inline(never)]
fn fit_begin_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(
    state: &mut MaybeUninit<State<R>>,
    blocks: &[Block<R>],
    samples: usize,
    start: &brdfit_params<R>,
    options: &brdfit_options<R>,
) -> Done {
    enough::<P>(samples)?;
    let scan = Of::<R, D, TERMS, P>::new(blocks);
    let start = Scan::<R, TERMS, P>::coordinates(&(*start).into());
    let bounds = bounds::<R, TERMS, P>(options);
    let fit = Fit::begin(&scan, &bounds, start, &lm_options(options));
    let state = state.write(State {
        begun: begun::<R>(),
        options: *options,
        fit: MaybeUninit::uninit(),
    });
    // SAFETY: there is room for it, aligned as its largest sibling is.
    unsafe { state.fit_mut::<P>().write(fit) };
    Ok(())
}

/// The place of the state of a fit that was begun.
///
/// # Safety
/// As for `memory::input`.
unsafe fn state_of<R>(fit: *const brdfit_fit<R>) -> Result<*const State<R>, brdfit_error> {
    // SAFETY: as asked of the caller; a number of 32 bits is there, whatever else.
    let first = *unsafe { input(fit.cast::<u32>()) }?;
    if first == begun::<R>() {
        Ok(fit.cast())
    } else {
        Err(brdfit_error::NotBegun)
    }
}

pub unsafe fn fit_run<R: Real>(fit: *mut brdfit_fit<R>, scan: *const brdfit_scan<R>, passes: u32) -> Done {
    // SAFETY: the contract of the header.
    let (state, (blocks, samples)) = unsafe { (changed(state_of(fit)?.cast_mut())?, blocks_of(scan)?) };
    with_model!(state.options, fit_run_of::<R>(state, blocks, samples, passes))
}

#[inline(never)]
fn fit_run_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(
    state: &mut State<R>,
    blocks: &[Block<R>],
    samples: usize,
    passes: u32,
) -> Done {
    enough::<P>(samples)?;
    let scan = Of::<R, D, TERMS, P>::new(blocks);
    // SAFETY: `fit_begin_of` wrote one of this P there, for the terms are the same.
    let fit = unsafe { &mut *state.fit_mut::<P>() };
    let passes = fit.passes.saturating_add(passes);
    fit.run(
        &scan,
        &bounds::<R, TERMS, P>(&state.options),
        &lm_options(&state.options),
        passes,
    );
    Ok(())
}

pub unsafe fn fit_result<R: Real>(fit: *const brdfit_fit<R>, result: *mut brdfit_result<R>) -> Done {
    // SAFETY: the contract of the header.
    let (state, result) = unsafe { (input(state_of(fit)?)?, output(result)?) };
    result.write(with_model!(state.options, fit_result_of::<R>(state))?);
    Ok(())
}

#[expect(
    clippy::extra_unused_type_parameters,
    reason = "the macro gives the distribution to all"
)]
fn fit_result_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(
    state: &State<R>,
) -> Result<brdfit_result<R>, brdfit_error> {
    // SAFETY: as in `fit_run_of`.
    Ok(result::<R, TERMS, P>(unsafe { &*state.fit::<P>() }))
}

pub fn result<R: Real, const TERMS: u8, const P: usize>(fit: &Fit<R, P>) -> brdfit_result<R> {
    brdfit_result {
        params: Scan::<R, TERMS, P>::params(&fit.x).into(),
        cost: fit.at.cost,
        passes: fit.passes,
        stop: fit.stop.into(),
    }
}

pub unsafe fn search<R: Real>(
    scan: *const brdfit_scan<R>,
    options: *const brdfit_options<R>,
    minima: *mut brdfit_minimum<R>,
    capacity: usize,
    found: *mut brdfit_found<R>,
) -> Done {
    // SAFETY: the contract of the header.
    let ((blocks, samples), options, found) = unsafe { (blocks_of(scan)?, options_at(options)?, output(found)?) };
    // SAFETY: the contract of the header.
    let minima = unsafe { minima_of(minima, capacity) }?;
    found.write(with_model!(options, search_of::<R>(blocks, samples, &options, minima))?);
    Ok(())
}

#[inline(never)]
fn search_of<R: Real, D: Distribution, const TERMS: u8, const P: usize>(
    blocks: &[Block<R>],
    samples: usize,
    options: &brdfit_options<R>,
    minima: &mut [MaybeUninit<brdfit_minimum<R>>],
) -> Result<brdfit_found<R>, brdfit_error> {
    enough::<P>(samples)?;
    let scan = Of::<R, D, TERMS, P>::new(blocks);
    let found = brdfit_core::search::search(
        &scan,
        &bounds::<R, TERMS, P>(options),
        options.seed,
        options.candidates,
        &lm_options(options),
    );
    if !found.best.at.cost.is_finite() {
        return Err(brdfit_error::NoFit);
    }
    Ok(write_found::<R, TERMS, P>(
        &found.best,
        found.minima.as_slice(),
        found.evaluations,
        minima,
    ))
}

/// Room for minima; none if the caller has no interest in them.
///
/// # Safety
/// As for `memory::outputs`.
pub unsafe fn minima_of<'a, R>(
    minima: *mut brdfit_minimum<R>,
    capacity: usize,
) -> Result<&'a mut [MaybeUninit<brdfit_minimum<R>>], brdfit_error> {
    if minima.is_null() && capacity == 0 {
        return Ok(&mut []);
    }
    // SAFETY: as asked of the caller.
    unsafe { outputs(minima, capacity) }
}

/// What a search found, and as many of its minima as there is room for.
pub fn write_found<R: Real, const TERMS: u8, const P: usize>(
    best: &Fit<R, P>,
    list: &[Minimum<R, P>],
    evaluations: Evaluations,
    minima: &mut [MaybeUninit<brdfit_minimum<R>>],
) -> brdfit_found<R> {
    for (place, minimum) in minima.iter_mut().zip(list) {
        place.write(brdfit_minimum {
            params: Scan::<R, TERMS, P>::params(&minimum.x).into(),
            cost: minimum.cost,
            hits: minimum.hits,
        });
    }
    brdfit_found {
        best: result::<R, TERMS, P>(best),
        minima: minima.len().min(list.len()),
        cost_passes: evaluations.cost,
        linearize_passes: evaluations.linearize,
    }
}
