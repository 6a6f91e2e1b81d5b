//! Several scans of one material fitted together, of which chosen parameters are the same.

use brdfit_core::geometry::Sample;

use crate::error::FitError;
use crate::options::FitOptions;
use crate::scale::Scale;
pub use crate::search::joint::{JointFit, SCANS};
use crate::search::joint::{counted, prior_rows};
use crate::{compiled, with_instrument};

/// Fits each scan on its own, then all together.
///
/// With the shared parameters held, the scans have nothing to do with each other: so each of them is searched with these held where a minimum of any scan has them, and where the best joint fit so far has them, until that leads no lower.
/// `shared` tells of each of the model's parameters whether it is the same in all scans.
/// Priors of shared parameters count once, those of others for each scan; offsets are not fitted.
///
/// # Errors
/// The place of the scan that cannot be fitted, and why; [`FitError::TooFew`] and [`FitError::Limit`] of all scans together come with the number of scans.
pub fn fit(all: &[&[Sample<f64>]], shared: &[bool], options: &FitOptions) -> Result<JointFit, (usize, FitError)> {
    let Some(scale) = Scale::of(all, options) else {
        return fit_ordinary(all, shared, options);
    };
    let inside: Vec<_> = all.iter().map(|samples| scale.samples(samples)).collect();
    let inside: Vec<_> = inside.iter().map(|samples| &samples[..]).collect();
    let options = scale.options(options).map_err(|error| (all.len(), error))?;
    Ok(scale.joint(options.model.parameters, fit_ordinary(&inside, shared, &options)?))
}

/// The same of samples of an ordinary size.
fn fit_ordinary(all: &[&[Sample<f64>]], shared: &[bool], options: &FitOptions) -> Result<JointFit, (usize, FitError)> {
    let together = |error| (all.len(), error);
    let mut options = options.held().map_err(together)?;
    options.instrument.offsets = None;
    let (options, _) = with_instrument::aimed(&options).map_err(together)?;
    let (both, own): (Vec<usize>, Vec<usize>) = options.free().partition(|&place| shared[place]);
    let parameters = both.len() + all.len() * own.len();
    let known = counted(all) + prior_rows(all.len(), shared, &options);
    if known < parameters {
        return Err(together(FitError::TooFew(known, parameters)));
    }
    compiled::whole(options.model).joint(all, shared, &options)
}
