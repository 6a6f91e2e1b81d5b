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
pub type Found = Option<(f64, Values)>;
/// A joint fit, or the place of the scan that cannot be fitted, and why.
pub type Joint = Result<JointFit, (usize, FitError)>;

/// The searches of one model, or of one set of its terms.
pub trait Searches: Send + Sync {
    fn fit(
        &self,
        samples: &[Sample<f64>],
        options: &FitOptions,
        setup: &Setup,
        known: &[Values],
    ) -> Result<Outcome, FitError>;

    /// The best end of fits from `starts`.
    fn descend(
        &self,
        samples: &[Sample<f64>],
        options: &FitOptions,
        setup: &Setup,
        starts: &[Values],
    ) -> Result<Found, FitError>;

    fn trace(&self, samples: &[Sample<f64>], options: &FitOptions) -> Result<Trace, FitError>;

    fn joint(&self, all: &[&[Sample<f64>]], shared: &[bool], options: &FitOptions) -> Joint;
}

/// A set of terms with its searches.
#[derive(Clone, Copy)]
pub struct Compiled {
    pub terms: u8,
    pub searches: &'static dyn Searches,
}

/// All that is compiled of one model.
pub struct Sets {
    /// The model with all its terms, also as an aperture sees it.
    pub whole: &'static dyn Searches,
    /// Sets of its terms that are compiled on their own.
    pub sets: &'static [Compiled],
}

fn of(model: &Model) -> &'static Sets {
    let sets = model.searches.downcast_ref();
    sets.expect("whoever makes a model gives it these")
}

/// The searches of a model with all its terms.
pub fn whole(model: &Model) -> &'static dyn Searches {
    of(model).whole
}

/// The searches of the terms of `options`, and the options for them: what no compiled set leaves out is held.
pub fn set_of(options: &FitOptions) -> Result<(&'static dyn Searches, FitOptions), FitError> {
    let sets = of(options.model);
    let held = options.held()?;
    Ok(match sets.sets.iter().find(|set| set.terms == held.terms) {
        Some(set) => {
            let terms = held.terms;
            (set.searches, FitOptions { terms, ..*options })
        }
        None => (sets.whole, held),
    })
}
