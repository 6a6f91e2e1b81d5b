//! The computations of one model, compiled: where the types of a model end and its values at run time begin.
//!
//! Only the passes are compiled for each model; a search sees them through one dynamic call a pass, and is compiled once for each number of parameters.

use brdfit_core::brdf::ALL;
use brdfit_core::geometry::{Block, LANES, Sample};
use brdfit_core::microfacet::Microfacet;
use brdfit_core::model::{Model, Parameter};
use brdfit_core::real::Real;
use brdfit_core::residuals::{Residuals, ln_f, observe};
use brdfit_core::search::Scene;

use crate::instrument::averaged::Averaged;
use crate::instrument::setup::Setup;
use crate::options::Precision;
use crate::simd::{FastScan, Simd};
use crate::trace::{self, Trace};
use crate::{FitError, FitOptions, Outcome, Values, joint, search};

/// A cost and the parameters where it is.
type Found = Option<(f64, Values)>;
/// A joint fit, or the place of the scan that cannot be fitted, and why.
type Joint = Result<joint::Fitted, (usize, FitError)>;

/// The computations of one model, or of one set of its terms.
#[allow(clippy::type_complexity, reason = "a signature says more than names for its parts")]
#[derive(Clone, Copy, Debug)]
pub struct Compiled {
    pub(crate) terms: u8,
    pub(crate) fit: fn(&[Sample<f64>], &FitOptions, &Setup, &[Values]) -> Result<Outcome, FitError>,
    pub(crate) descend: fn(&[Sample<f64>], &FitOptions, &Setup, &[Values]) -> Result<Found, FitError>,
    pub(crate) trace: fn(&[Sample<f64>], &FitOptions) -> Result<Trace, FitError>,
}

/// What a model has only once, whatever terms are left out.
#[allow(clippy::type_complexity, reason = "a signature says more than names for its parts")]
#[derive(Clone, Copy, Debug)]
pub struct Whole {
    pub(crate) compiled: Compiled,
    /// A fit, and one from given values, through an aperture.
    pub(crate) through: fn(&[Sample<f64>], &FitOptions, &Setup, &[Values]) -> Result<Outcome, FitError>,
    pub(crate) through_from: fn(&[Sample<f64>], &FitOptions, &Setup, &[Values]) -> Result<Found, FitError>,
    pub(crate) joint: fn(&[&[Sample<f64>]], &[bool], &FitOptions) -> Joint,
    pub(crate) ln_f: fn(&[f64], &Sample<f64>) -> Option<f64>,
    pub(crate) gradient: fn(&[f64], &Sample<f64>) -> Found,
}

/// A scan of some model, as a search sees it.
pub type Kernel<'a, R, const P: usize> = dyn Scene<R, P> + Sync + 'a;

/// A model in both precisions, as all of [`brdfit_core`] are.
pub trait Both<const P: usize, const C: usize>: Model<f64, P, C> + Model<f32, P, C> + Send + Sync {}
impl<M: Model<f64, P, C> + Model<f32, P, C> + Send + Sync, const P: usize, const C: usize> Both<P, C> for M {}

/// The parameters of a model.
pub(crate) const fn parameters_of<M: Both<P, C>, const P: usize, const C: usize>() -> &'static [Parameter] {
    const { &<M as Model<f64, P, C>>::PARAMETERS }
}

/// The computations of model `M`; `VECTORS` says for which instructions, as in [`FastScan`].
pub(crate) const fn compile<M: Both<P, C>, const P: usize, const C: usize, const VECTORS: u8>(terms: u8) -> Compiled {
    Compiled {
        terms,
        fit: fit::<M, P, C, VECTORS>,
        descend: descend::<M, P, C, VECTORS>,
        trace: trace::<M, P, C, VECTORS>,
    }
}

/// All of model `M`.
pub(crate) const fn whole<M: Both<P, C>, const P: usize, const C: usize, const VECTORS: u8>(terms: u8) -> Whole {
    Whole {
        compiled: compile::<M, P, C, VECTORS>(terms),
        through: through::<M, P, C, VECTORS>,
        through_from: through_from::<M, P, C, VECTORS>,
        joint: joint::<M, P, C, VECTORS>,
        ln_f: value::<M, P, C>,
        gradient: gradient::<M, P, C>,
    }
}

/// The samples of a scan in the number type of the fit, as blocks for Eq. 14.
///
/// # Errors
/// [`FitError::Sample`].
pub fn blocks<R: Real>(samples: &[Sample<f64>]) -> Result<Vec<Block<R>>, FitError> {
    blocks_of::<R, Microfacet<ALL>, 6, 6>(samples)
}

/// The same for model `M`.
///
/// # Errors
/// [`FitError::Sample`].
pub fn blocks_of<R: Real, M: Model<R, P, C>, const P: usize, const C: usize>(
    samples: &[Sample<f64>],
) -> Result<Vec<Block<R, LANES, C>>, FitError> {
    let mut blocks = vec![Block::EMPTY; samples.len().div_ceil(LANES)];
    for (index, sample) in samples.iter().enumerate() {
        let sample = Sample {
            theta_i: R::of(sample.theta_i),
            theta_s: R::of(sample.theta_s),
            delta_phi: R::of(sample.delta_phi),
            brdf: R::of(sample.brdf),
            weight: R::of(sample.weight),
        };
        let observation = observe::<R, M, P, C>(&sample).map_err(|error| FitError::Sample(index, error))?;
        blocks[index / LANES].set(index % LANES, &observation);
    }
    Ok(blocks)
}

/// Blocks as a scene.
fn scene<R: Real, M: Model<R, P, C> + Sync, const P: usize, const C: usize, const VECTORS: u8>(
    blocks: &[Block<R, LANES, C>],
    simd: Simd,
) -> FastScan<'_, R, M, P, C, VECTORS> {
    FastScan::new(Residuals::new(blocks), simd)
}

/// What `then` does with the samples as a scene.
fn with<R: Real, M: Model<R, P, C> + Send + Sync, T, const P: usize, const C: usize, const VECTORS: u8>(
    samples: &[Sample<f64>],
    options: &FitOptions,
    then: impl FnOnce(&Kernel<R, P>) -> Result<T, FitError>,
) -> Result<T, FitError> {
    let blocks = blocks_of::<R, M, P, C>(samples)?;
    then(&scene::<R, M, P, C, VECTORS>(&blocks, options.simd))
}

/// The same through the aperture.
fn with_aperture<M: Both<P, C>, T, const P: usize, const C: usize, const VECTORS: u8>(
    samples: &[Sample<f64>],
    options: &FitOptions,
    then: impl FnOnce(&Kernel<f64, P>) -> Result<T, FitError>,
) -> Result<T, FitError> {
    with::<f64, M, T, P, C, VECTORS>(samples, options, |point| {
        then(&Averaged::<M, P, C>::new(point, samples, options.instrument.aperture)?)
    })
}

fn fit<M: Both<P, C>, const P: usize, const C: usize, const VECTORS: u8>(
    samples: &[Sample<f64>],
    options: &FitOptions,
    setup: &Setup,
    known: &[Values],
) -> Result<Outcome, FitError> {
    search::enough(samples, options)?;
    let own = &<M as Model<f64, P, C>>::PARAMETERS;
    with::<f64, M, _, P, C, VECTORS>(samples, options, |exact| match options.precision {
        Precision::F64 => search::run(exact, exact, own, samples, options, setup, known),
        Precision::F32 => with::<f32, M, _, P, C, VECTORS>(samples, options, |scene| {
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
    with::<f64, M, _, P, C, VECTORS>(samples, options, |scene| {
        search::descend_from(scene, own, samples, options, setup, starts)
    })
}

fn through<M: Both<P, C>, const P: usize, const C: usize, const VECTORS: u8>(
    samples: &[Sample<f64>],
    options: &FitOptions,
    setup: &Setup,
    known: &[Values],
) -> Result<Outcome, FitError> {
    search::enough(samples, options)?;
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
    search::enough(samples, options)?;
    let own = &<M as Model<f64, P, C>>::PARAMETERS;
    with::<f64, M, _, P, C, VECTORS>(samples, options, |exact| match options.precision {
        Precision::F64 => Ok(trace::watch(exact, exact, own, options)),
        Precision::F32 => {
            with::<f32, M, _, P, C, VECTORS>(samples, options, |scene| Ok(trace::watch(scene, exact, own, options)))
        }
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

fn value<M: Both<P, C>, const P: usize, const C: usize>(values: &[f64], sample: &Sample<f64>) -> Option<f64> {
    let geometry = <M as Model<f64, P, C>>::geometry(sample.theta_i, sample.theta_s, sample.delta_phi).ok()?;
    let x = Residuals::<f64, M, P, C>::from_values(values.try_into().ok()?);
    Some(brdfit_core::residuals::value::<f64, M, P, C>(&x, geometry))
}

fn gradient<M: Both<P, C>, const P: usize, const C: usize>(values: &[f64], sample: &Sample<f64>) -> Found {
    let geometry = <M as Model<f64, P, C>>::geometry(sample.theta_i, sample.theta_s, sample.delta_phi).ok()?;
    let x = Residuals::<f64, M, P, C>::from_values(values.try_into().ok()?);
    let (value, gradient) = ln_f::<f64, M, P, C>(&x, geometry);
    let own = &<M as Model<f64, P, C>>::PARAMETERS;
    let by_parameter = gradient.iter().zip(own).zip(values).map(|((slope, parameter), value)| {
        if parameter.is_squared() {
            slope * 2.0 * value
        } else {
            *slope
        }
    });
    Some((value, by_parameter.collect()))
}
