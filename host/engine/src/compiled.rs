//! The searches that are compiled for a model, and which of them a fit takes.

use brdfit_core::geometry::Sample;

use crate::error::FitError;
use crate::model::Model;
use crate::options::FitOptions;
use crate::outcome::Outcome;
use crate::search::joint::JointFit;
use crate::search::setup::Setup;
use crate::search::watched::Trace;
use crate::values::Values;

/// A cost and the parameters where it is.
type Found = Option<(f64, Values)>;
/// A joint fit, or the place of the scan that cannot be fitted, and why.
type Joint = Result<JointFit, (usize, FitError)>;

/// The searches of one model, or of one set of its terms.
#[allow(clippy::type_complexity, reason = "a signature says more than names for its parts")]
#[derive(Clone, Copy, Debug)]
pub struct Compiled {
    pub terms: u8,
    pub fit: fn(&[Sample<f64>], &FitOptions, &Setup, &[Values]) -> Result<Outcome, FitError>,
    pub descend: fn(&[Sample<f64>], &FitOptions, &Setup, &[Values]) -> Result<Found, FitError>,
    pub trace: fn(&[Sample<f64>], &FitOptions) -> Result<Trace, FitError>,
}

/// The searches of one model.
#[allow(clippy::type_complexity, reason = "a signature says more than names for its parts")]
#[derive(Clone, Copy, Debug)]
pub struct Searches {
    pub whole: Compiled,
    /// A fit, and one from given values, through an aperture.
    pub through: fn(&[Sample<f64>], &FitOptions, &Setup, &[Values]) -> Result<Outcome, FitError>,
    pub through_from: fn(&[Sample<f64>], &FitOptions, &Setup, &[Values]) -> Result<Found, FitError>,
    /// Sets of its terms that are compiled on their own.
    pub sets: &'static [Compiled],
    pub joint: fn(&[&[Sample<f64>]], &[bool], &FitOptions) -> Joint,
}

/// Those of a model.
pub fn of(model: &Model) -> &'static Searches {
    let searches = model.searches.downcast_ref();
    searches.expect("whoever makes a model gives it these")
}

/// What is compiled of the terms of `options`, and the options for it: what no compiled set leaves out is held.
pub fn set_of(options: &FitOptions) -> Result<(&'static Compiled, FitOptions), FitError> {
    let searches = of(options.model);
    let held = options.held()?;
    Ok(match searches.sets.iter().find(|set| set.terms == held.terms) {
        Some(set) => {
            let terms = held.terms;
            (set, FitOptions { terms, ..*options })
        }
        None => (&searches.whole, held),
    })
}
