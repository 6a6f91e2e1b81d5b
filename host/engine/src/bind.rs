//! The searches over the passes of one model, compiled: where the types of a model end and its values at run time begin.
//!
//! Only the passes are compiled for each model; a search sees them through one dynamic call a pass, and is compiled once for each number of parameters.

use brdfit_core::geometry::Sample;
use brdfit_core::model::Model;

use crate::averaged::Averaged;
use crate::compiled::{Compiled, Searches};
use crate::error::FitError;
use crate::options::{FitOptions, Precision};
use crate::outcome::Outcome;
use crate::passes::{Both, Kernel, blocks_of, scene, with};
use crate::search::joint::{self, JointFit};
use crate::search::setup::Setup;
use crate::search::watched::{self, Trace};
use crate::search::{self, enough};
use crate::values::Values;

/// A cost and the parameters where it is.
type Found = Option<(f64, Values)>;
/// A joint fit, or the place of the scan that cannot be fitted, and why.
type Joint = Result<JointFit, (usize, FitError)>;

/// The searches of model `M`; `VECTORS` says for which instructions, as in [`FastScan`].
pub(crate) const fn set<M: Both<P, C>, const P: usize, const C: usize, const VECTORS: u8>(terms: u8) -> Compiled {
    Compiled {
        terms,
        fit: fit::<M, P, C, VECTORS>,
        descend: descend::<M, P, C, VECTORS>,
        trace: trace::<M, P, C, VECTORS>,
    }
}

/// All of model `M`, with `sets` of its terms on their own.
pub(crate) const fn searches<M: Both<P, C>, const P: usize, const C: usize, const VECTORS: u8>(
    terms: u8,
    sets: &'static [Compiled],
) -> Searches {
    Searches {
        whole: set::<M, P, C, VECTORS>(terms),
        through: through::<M, P, C, VECTORS>,
        through_from: through_from::<M, P, C, VECTORS>,
        joint: joint::<M, P, C, VECTORS>,
        sets,
    }
}

/// The same through the aperture.
fn with_aperture<M: Both<P, C>, T, const P: usize, const C: usize, const VECTORS: u8>(
    samples: &[Sample<f64>],
    options: &FitOptions,
    then: impl FnOnce(&Kernel<f64, P>) -> Result<T, FitError>,
) -> Result<T, FitError> {
    with::<f64, M, T, P, C, VECTORS>(samples, options.simd, |point| {
        then(&Averaged::<M, P, C>::new(point, samples, options.instrument.aperture)?)
    })
}

fn fit<M: Both<P, C>, const P: usize, const C: usize, const VECTORS: u8>(
    samples: &[Sample<f64>],
    options: &FitOptions,
    setup: &Setup,
    known: &[Values],
) -> Result<Outcome, FitError> {
    enough(samples, options)?;
    let own = &<M as Model<f64, P, C>>::PARAMETERS;
    with::<f64, M, _, P, C, VECTORS>(samples, options.simd, |exact| match options.precision {
        Precision::F64 => search::run(exact, exact, own, samples, options, setup, known),
        Precision::F32 => with::<f32, M, _, P, C, VECTORS>(samples, options.simd, |scene| {
            search::run(scene, exact, own, samples, options, setup, known)
        }),
    })
}

fn descend<M: Both<P, C>, const P: usize, const C: usize, const VECTORS: u8>(
    samples: &[Sample<f64>],
    options: &FitOptions,
    setup: &Setup,
    starts: &[Values],
) -> Result<Found, FitError> {
    let own = &<M as Model<f64, P, C>>::PARAMETERS;
    with::<f64, M, _, P, C, VECTORS>(samples, options.simd, |scene| {
        search::descend_from(scene, own, samples, options, setup, starts)
    })
}

fn through<M: Both<P, C>, const P: usize, const C: usize, const VECTORS: u8>(
    samples: &[Sample<f64>],
    options: &FitOptions,
    setup: &Setup,
    known: &[Values],
) -> Result<Outcome, FitError> {
    enough(samples, options)?;
    let own = &<M as Model<f64, P, C>>::PARAMETERS;
    with_aperture::<M, _, P, C, VECTORS>(samples, options, |seen| {
        search::run(seen, seen, own, samples, options, setup, known)
    })
}

fn through_from<M: Both<P, C>, const P: usize, const C: usize, const VECTORS: u8>(
    samples: &[Sample<f64>],
    options: &FitOptions,
    setup: &Setup,
    starts: &[Values],
) -> Result<Found, FitError> {
    let own = &<M as Model<f64, P, C>>::PARAMETERS;
    with_aperture::<M, _, P, C, VECTORS>(samples, options, |seen| {
        search::descend_from(seen, own, samples, options, setup, starts)
    })
}

fn trace<M: Both<P, C>, const P: usize, const C: usize, const VECTORS: u8>(
    samples: &[Sample<f64>],
    options: &FitOptions,
) -> Result<Trace, FitError> {
    enough(samples, options)?;
    let own = &<M as Model<f64, P, C>>::PARAMETERS;
    with::<f64, M, _, P, C, VECTORS>(samples, options.simd, |exact| match options.precision {
        Precision::F64 => Ok(watched::watch(exact, exact, own, options)),
        Precision::F32 => with::<f32, M, _, P, C, VECTORS>(samples, options.simd, |scene| {
            Ok(watched::watch(scene, exact, own, options))
        }),
    })
}

fn joint<M: Both<P, C>, const P: usize, const C: usize, const VECTORS: u8>(
    all: &[&[Sample<f64>]],
    shared: &[bool],
    options: &FitOptions,
) -> Joint {
    let each = all.iter().enumerate();
    let each = each.map(|(place, samples)| blocks_of::<f64, M, P, C>(samples).map_err(|error| (place, error)));
    let blocks: Vec<_> = each.collect::<Result<_, _>>()?;
    let scans: Vec<_> = blocks
        .iter()
        .map(|blocks| scene::<f64, M, P, C, VECTORS>(blocks, options.simd))
        .collect();
    let points: Vec<&Kernel<f64, P>> = scans.iter().map(|scan| scan as &Kernel<f64, P>).collect();
    let aperture = options.instrument.aperture;
    let each = points.iter().zip(all).enumerate();
    let seen = each.map(|(place, (point, samples))| {
        Averaged::<M, P, C>::new(*point, samples, aperture).map_err(|error| (place, error))
    });
    let seen: Vec<_> = if aperture > 0.0 {
        seen.collect::<Result<_, _>>()?
    } else {
        Vec::new()
    };
    let scans: Vec<&Kernel<f64, P>> = match seen.is_empty() {
        true => points,
        false => seen.iter().map(|scan| scan as &Kernel<f64, P>).collect(),
    };
    let own = &<M as Model<f64, P, C>>::PARAMETERS;
    joint::run::<P>(&scans, own, shared, options, all)
}
