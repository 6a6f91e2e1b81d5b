//! A model as the program knows it: what it is called, its parameters, and its computations, compiled.

use std::f64::consts::LN_2;

use brdfit_core::brdf::{ABSORBING, DIFFUSE, SURFACE, VOLUME};
use brdfit_core::geometry::Sample;
use brdfit_core::model::{Parameter, Role};

use crate::compiled::{Both, Compiled, Whole, parameters_of, whole};
use crate::models::MODELS;
use crate::scale::{self, Scale};
use crate::simd::SCALAR;
use crate::{FitError, FitOptions, Values};

/// A model that scans can be fitted with, one of [`MODELS`].
pub struct Model {
    /// What options and results call it.
    pub name: &'static str,
    /// What it is made of.
    pub what: &'static str,
    /// Where its formulas come from.
    pub source: &'static str,
    /// Its parameters.
    pub parameters: &'static [Parameter],
    /// The terms that can be left out of it; 0 if it is not a microfacet model.
    pub terms: u8,
    pub(crate) whole: Whole,
    /// Sets of its terms that are compiled on their own.
    pub(crate) sets: &'static [Compiled],
}

/// The name, which is the same in every process, as the addresses of the computations are not.
impl std::fmt::Debug for Model {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

impl PartialEq for Model {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Model {
    /// The paper's model, Eq. 14.
    pub const fn paper() -> &'static Model {
        &MODELS[0]
    }

    /// A model of one's own, from [`brdfit_core::formula::Own`] of a formula or from another [`brdfit_core::model::Model`].
    ///
    /// Everything of the engine takes it: searches, minima, uncertainty, `f32`, joint and robust fits; `examples/own_model.rs` fits one.
    /// `P` is the number of its parameters and `C` that of its numbers a pair of directions, which is 8 for a formula.
    /// Its passes go lane by lane.
    ///
    /// ```
    /// use brdfit_core::formula::Own;
    /// use brdfit_core::models::Abg;
    /// use brdfit_engine::{FitOptions, Model};
    ///
    /// static MINE: Model = Model::own::<Own<Abg>, 4, 8>("mine", "what it is", "where it is from");
    /// assert_eq!(FitOptions::of(&MINE).lower.len(), 4);
    /// ```
    pub const fn own<M: Both<P, C>, const P: usize, const C: usize>(
        name: &'static str,
        what: &'static str,
        source: &'static str,
    ) -> Model {
        Model {
            name,
            what,
            source,
            parameters: parameters_of::<M, P, C>(),
            terms: 0,
            whole: whole::<M, P, C, SCALAR>(0),
            sets: &[],
        }
    }

    /// The model of this name.
    pub fn find(name: &str) -> Option<&'static Model> {
        MODELS.iter().find(|model| model.name == name)
    }

    /// Place of the parameter of this name.
    pub fn place(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|parameter| parameter.name == name)
    }

    /// The value of the parameter of this name.
    pub fn value(&self, values: &[f64], name: &str) -> Option<f64> {
        values.get(self.place(name)?).copied()
    }

    /// Names and values of the parameters.
    pub fn named<'a>(&self, values: &'a [f64]) -> impl Iterator<Item = (&'static str, f64)> + use<'a> {
        let parameters = self.parameters.iter().map(|parameter| parameter.name);
        parameters.zip(values.iter().copied())
    }

    /// The least values of a fit, unless something else is asked for.
    pub fn lower(&self) -> Values {
        self.parameters.iter().map(|parameter| parameter.bounds.0).collect()
    }

    /// The largest.
    pub fn upper(&self) -> Values {
        self.parameters.iter().map(|parameter| parameter.bounds.1).collect()
    }

    /// Is it the model of Eq. 14?
    pub fn is_paper(&self) -> bool {
        self == Model::paper()
    }

    /// Does `terms` leave out the parameter in this place?
    pub fn left_out(&self, terms: u8, place: usize) -> bool {
        let missing = self.terms & !terms;
        let no_lobes = self.terms != 0 && terms & (SURFACE | VOLUME) == 0;
        match self.parameters[place].name {
            "rho_d" => missing & DIFFUSE != 0,
            "rho_s" | "rho_2" | "m_2" => missing & SURFACE != 0,
            "rho_v" | "m_v" => missing & VOLUME != 0,
            "kappa" => missing & ABSORBING != 0 || no_lobes,
            _ => no_lobes,
        }
    }

    /// The value of a parameter that is left out: a weight and kappa are 0, what has then no effect is 1.
    pub fn absent(&self, place: usize) -> f64 {
        let parameter = &self.parameters[place];
        if parameter.is_weight() || parameter.is_squared() {
            0.0
        } else {
            1.0
        }
    }

    /// The values of this model that come nearest to those of another: the same ones if this model contains the other.
    ///
    /// Parameters are the same by name; a slope that the other does not have is its m, another weight is 0, and the tail is that of GGX.
    pub fn translated(&self, from: &Model, values: &[f64]) -> Values {
        let value = |place: usize| {
            let parameter = &self.parameters[place];
            from.value(values, parameter.name).or(match parameter.role {
                Role::Slope => from.value(values, "m"),
                Role::Shape if parameter.name == "q" => Some(2.0),
                _ => None,
            })
        };
        Values::from_fn(self.parameters.len(), |place| {
            value(place).unwrap_or_else(|| self.absent(place))
        })
    }

    /// ln f in the directions of `sample`, f in sr^-1, and its derivatives by the parameters; none beyond the horizon.
    pub fn gradient(&self, values: &[f64], sample: &Sample<f64>) -> Option<(f64, Values)> {
        let (inside, exponent) = scale::ordinary(self, values);
        let (ln_f, mut gradient) = (self.whole.gradient)(&inside, sample)?;
        if exponent != 0 {
            gradient = Scale {
                brdf: -exponent,
                weight: 0,
            }
            .given(self, &gradient);
        }
        Some((ln_f + f64::from(exponent) * LN_2, gradient))
    }

    /// ln f in the directions of `sample`, f in sr^-1; none beyond the horizon.
    pub fn ln_f(&self, values: &[f64], sample: &Sample<f64>) -> Option<f64> {
        let (inside, exponent) = scale::ordinary(self, values);
        Some((self.whole.ln_f)(&inside, sample)? + f64::from(exponent) * LN_2)
    }

    /// What is compiled of the terms of `options`, and the options for it: what no compiled set leaves out is held.
    pub(crate) fn compiled(&self, options: &FitOptions) -> Result<(&Compiled, FitOptions), FitError> {
        let whole = self.whole_of(options)?;
        if let Some(set) = self.sets.iter().find(|set| set.terms == whole.terms) {
            let terms = whole.terms;
            return Ok((set, FitOptions { terms, ..*options }));
        }
        Ok((&self.whole.compiled, whole))
    }

    /// The options for the whole model: what their terms leave out is held.
    pub(crate) fn whole_of(&self, options: &FitOptions) -> Result<FitOptions, FitError> {
        let (terms, mut options) = (options.terms & self.terms, *options);
        if self.terms != 0 && terms & (DIFFUSE | SURFACE | VOLUME) == 0 {
            return Err(FitError::Terms(options.terms));
        }
        options.terms = terms;
        self.hold(&mut options);
        Ok(options)
    }

    /// Holds what the terms of `options` leave out at its value of absence.
    pub(crate) fn hold(&self, options: &mut FitOptions) {
        for place in 0..self.parameters.len() {
            if self.left_out(options.terms, place) {
                options.lower[place] = self.absent(place);
                options.upper[place] = self.absent(place);
            }
        }
    }
}
