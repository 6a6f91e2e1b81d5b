//! A model as the program knows it: what it is called, its parameters, and its values.

use std::any::Any;
use std::f64::consts::LN_2;

use brdfit_core::brdf::{ABSORBING, DIFFUSE, SURFACE, VOLUME};
use brdfit_core::geometry::Sample;
use brdfit_core::model::{Parameter, Role};

use crate::passes::Point;
use crate::scale::{self, Scale};
use crate::values::Values;

/// Name of the paper's model, Eq. 14.
pub(crate) const PAPER: &str = "beckmann";

/// A model that scans can be fitted with, one of [`MODELS`](crate::models::MODELS) or one's own.
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
    pub(crate) point: Point,
    /// The searches that are compiled for it, which this description need not know.
    pub(crate) searches: &'static (dyn Any + Send + Sync),
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
        self.name == PAPER
    }

    /// Does `terms` leave out the parameter in this place?
    pub fn left_out(&self, terms: u8, place: usize) -> bool {
        let missing = self.terms & !terms;
        let no_lobes = self.terms != 0 && terms & (SURFACE | VOLUME) == 0;
        match self.parameters[place].name {
            "rho_d" => missing & DIFFUSE != 0,
            "rho_s" | "rho_2" | "m_2" | "rho_m" => missing & SURFACE != 0,
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
        let (inside, exponent) = scale::ordinary(self.parameters, values);
        let (ln_f, mut gradient) = (self.point.gradient)(&inside, sample)?;
        if exponent != 0 {
            gradient = Scale {
                brdf: -exponent,
                weight: 0,
            }
            .given(self.parameters, &gradient);
        }
        Some((ln_f + f64::from(exponent) * LN_2, gradient))
    }

    /// ln f in the directions of `sample`, f in sr^-1; none beyond the horizon.
    pub fn ln_f(&self, values: &[f64], sample: &Sample<f64>) -> Option<f64> {
        let (inside, exponent) = scale::ordinary(self.parameters, values);
        Some((self.point.ln_f)(&inside, sample)? + f64::from(exponent) * LN_2)
    }
}
