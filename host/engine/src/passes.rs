//! The passes over a scan, compiled for a model: all that is, of a search.

use brdfit_core::brdf::ALL;
use brdfit_core::geometry::{Block, LANES, Observation, Sample, SampleError};
use brdfit_core::microfacet::Microfacet;
use brdfit_core::model::{Model, Parameter};
use brdfit_core::real::Real;
use brdfit_core::residuals::{Residuals, ln_f};
use brdfit_core::search::Scene;

use crate::error::FitError;
use crate::simd::{FastScan, Simd};
use crate::values::Values;

/// A scan of some model, as a search sees it.
pub type Kernel<'a, R, const P: usize> = dyn Scene<R, P> + Sync + 'a;

/// A model in both precisions, as all of [`brdfit_core`] are.
pub trait Both<const P: usize, const C: usize>: Model<f64, P, C> + Model<f32, P, C> + Send + Sync {}
impl<M: Model<f64, P, C> + Model<f32, P, C> + Send + Sync, const P: usize, const C: usize> Both<P, C> for M {}

/// The parameters of a model.
pub(crate) const fn parameters_of<M: Both<P, C>, const P: usize, const C: usize>() -> &'static [Parameter] {
    const { &<M as Model<f64, P, C>>::PARAMETERS }
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
    blocks_by(samples, M::geometry)
}

/// [`Model::geometry`] of some model.
type GeometryOf<R, const C: usize> = fn(R, R, R) -> Result<[R; C], SampleError>;

/// The same for all models of as many numbers, so that it is compiled once.
fn blocks_by<R: Real, const C: usize>(
    samples: &[Sample<f64>],
    geometry: GeometryOf<R, C>,
) -> Result<Vec<Block<R, LANES, C>>, FitError> {
    let mut blocks = vec![Block::EMPTY; samples.len().div_ceil(LANES)];
    for (index, sample) in samples.iter().enumerate() {
        let observation = geometry(R::of(sample.theta_i), R::of(sample.theta_s), R::of(sample.delta_phi))
            .and_then(|geometry| Observation::at(geometry, R::of(sample.brdf), R::of(sample.weight)))
            .map_err(|error| FitError::Sample(index, error))?;
        blocks[index / LANES].set(index % LANES, &observation);
    }
    Ok(blocks)
}

/// Blocks as a scene; `VECTORS` says for which instructions, as in [`FastScan`].
pub(crate) fn scene<R: Real, M: Model<R, P, C> + Sync, const P: usize, const C: usize, const VECTORS: u8>(
    blocks: &[Block<R, LANES, C>],
    simd: Simd,
) -> FastScan<'_, R, M, P, C, VECTORS> {
    FastScan::new(Residuals::new(blocks), simd)
}

/// ln f and its derivatives by the parameters; none beyond the horizon.
type Slopes = Option<(f64, Values)>;

/// A model at a single pair of directions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    /// ln f; none beyond the horizon.
    pub ln_f: fn(&[f64], &Sample<f64>) -> Option<f64>,
    pub gradient: fn(&[f64], &Sample<f64>) -> Slopes,
}

/// Model `M` at a single pair of directions.
pub(crate) const fn point<M: Both<P, C>, const P: usize, const C: usize>() -> Point {
    Point {
        ln_f: value::<M, P, C>,
        gradient: gradient::<M, P, C>,
    }
}

fn value<M: Both<P, C>, const P: usize, const C: usize>(values: &[f64], sample: &Sample<f64>) -> Option<f64> {
    let geometry = <M as Model<f64, P, C>>::geometry(sample.theta_i, sample.theta_s, sample.delta_phi).ok()?;
    let x = Residuals::<f64, M, P, C>::from_values(values.try_into().ok()?);
    Some(brdfit_core::residuals::value::<f64, M, P, C>(&x, geometry))
}

fn gradient<M: Both<P, C>, const P: usize, const C: usize>(
    values: &[f64],
    sample: &Sample<f64>,
) -> Option<(f64, Values)> {
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
