//! What to fit, and how.

use brdfit_core::brdf::{ABSORBING, ALL, DIFFUSE, SURFACE, VOLUME};
use brdfit_core::search::{CANDIDATES, PAPER_STARTS};

use crate::error::FitError;
use crate::instrument::{Instrument, View};
use crate::material::Material;
use crate::model::Model;
use crate::simd::Simd;
use crate::until::Until;
use crate::values::Values;

/// How the global optimum is searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Candidates, short fits, convergence of the best.
    Default,
    /// Uniform starts over the bounds, each fitted to convergence (section 3 of the paper).
    Paper,
}

/// The number type of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Double.
    F64,
    /// Single, as firmware does.
    F32,
}

/// What to fit and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitOptions {
    /// How to search.
    pub method: Method,
    /// Seed of the starts.
    pub seed: u64,
    /// Number of starts (`paper`), or of candidates at most (`default`; beyond its own number all are made); `None` for the method's own.
    pub starts: Option<u32>,
    /// The model.
    pub model: &'static Model,
    /// The terms of it that the scene needs, one of [`TERM_SETS`]; others are left out. Without meaning for a model that has none.
    pub terms: u8,
    /// Least values of the model's parameters; those of its description by default, for Eq. 14 Table 1.
    pub lower: Values,
    /// Largest values.
    pub upper: Values,
    /// The number type.
    pub precision: Precision,
    /// Leave out samples far from the fit ([`crate::robust`]).
    pub robust: bool,
    /// What is known beside the samples; the aperture takes double precision, whatever the number type.
    pub instrument: Instrument,
    /// The vector instructions; they change speed and no bit.
    pub simd: Simd,
    /// Until when the search is wanted; this changes no bit either.
    pub until: Until,
}

impl FitOptions {
    /// To fit `model` within the bounds of its description, whole.
    pub fn of(model: &'static Model) -> Self {
        FitOptions {
            method: Method::Default,
            seed: 0,
            starts: None,
            model,
            terms: ALL,
            lower: model.lower(),
            upper: model.upper(),
            precision: Precision::F64,
            robust: false,
            instrument: Instrument::default(),
            simd: Simd::best(),
            until: Until::default(),
        }
    }

    /// The same for the whole model: what the terms leave out is held at its value of absence.
    pub(crate) fn held(&self) -> Result<FitOptions, FitError> {
        let (model, mut options) = (self.model, *self);
        options.terms = self.terms & model.terms;
        if model.terms != 0 && options.terms & (DIFFUSE | SURFACE | VOLUME) == 0 {
            return Err(FitError::Terms(self.terms));
        }
        for place in (0..model.parameters.len()).filter(|&place| model.left_out(options.terms, place)) {
            options.lower[place] = model.absent(place);
            options.upper[place] = model.absent(place);
        }
        Ok(options)
    }

    /// Places of the parameters that are part of the terms.
    pub fn present(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.model.parameters.len()).filter(|&place| !self.model.left_out(self.terms, place))
    }

    /// Those of them that equal bounds do not hold.
    pub fn free(&self) -> impl Iterator<Item = usize> + '_ {
        self.present().filter(|&place| self.lower[place] < self.upper[place])
    }

    /// Places of the parameters that are part of the terms and have a prior; that of a held one counts too, so that the points of its profile have the costs of one sum.
    pub fn with_prior(&self) -> impl Iterator<Item = usize> + '_ {
        self.present().filter(|&place| self.instrument.priors[place].is_some())
    }

    /// Number of priors that count.
    pub(crate) fn prior_count(&self) -> usize {
        self.with_prior().count()
    }

    /// The model with these values, as the aperture sees it.
    pub fn view(&self, values: Values) -> View {
        View {
            material: Material {
                model: self.model,
                values,
            },
            aperture: self.instrument.aperture,
            offset: 0.0,
        }
    }

    /// The number of starts or candidates that will be used.
    pub fn starts(&self) -> u32 {
        self.starts.unwrap_or(match self.method {
            Method::Default => CANDIDATES,
            Method::Paper => PAPER_STARTS,
        })
    }
}

/// The sets of terms that are compiled in.
pub const TERM_SETS: [u8; 8] = [
    DIFFUSE,
    DIFFUSE | SURFACE,
    DIFFUSE | SURFACE | ABSORBING,
    DIFFUSE | SURFACE | VOLUME,
    ALL,
    SURFACE,
    SURFACE | ABSORBING,
    SURFACE | VOLUME | ABSORBING,
];
