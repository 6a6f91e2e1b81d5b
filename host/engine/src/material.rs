//! A model with values: something that has a BRDF.

use brdfit_core::brdf::Params;
use brdfit_core::geometry::Sample;
use brdfit_core::model::Role;
use brdfit_core::real::Real;

use crate::model::Model;
use crate::values::Values;

/// Where kappa is 0 there is no derivative by it: gradients are taken here, and displacements are told for there, so that their products are right.
pub const NEAR_ZERO: f64 = 1e-4;

/// A model with the values of its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// The model.
    pub model: &'static Model,
    /// Its parameters.
    pub values: Values,
}

impl Material {
    /// The parameters of Eq. 14; `None` of another model.
    pub fn eq_14(&self) -> Option<Params<f64>> {
        let values = <[f64; 6]>::try_from(&self.values[..]).ok()?;
        self.model.is_paper().then(|| Params::from_array(values))
    }

    /// The value of the parameter of this name, if the model has it.
    pub fn get(&self, name: &str) -> Option<f64> {
        self.model.value(&self.values, name)
    }

    /// The same with another value of a parameter; a name that the model has not changes nothing.
    pub fn with(mut self, name: &str, value: f64) -> Self {
        if let Some(place) = self.model.place(name) {
            self.values[place] = value;
        }
        self
    }

    /// The same, with kappa a little above 0 where it is 0, for gradients: see [`crate::uncertainty::NEAR_ZERO`].
    pub fn off_zero(mut self) -> Self {
        for (value, parameter) in self.values.iter_mut().zip(self.model.parameters) {
            if parameter.is_squared() && *value == 0.0 {
                *value = NEAR_ZERO;
            }
        }
        self
    }

    /// The width of its narrowest peak, in slopes of facets or direction cosines, dimensionless; 1 at most.
    pub fn width(&self) -> f64 {
        let get = |name: &str| self.get(name);
        let parameters = self.model.parameters.iter().zip(self.values.iter());
        let slopes = parameters.filter(|(parameter, _)| parameter.role == Role::Slope);
        // Of ABg the shoulder is where B is |beta - beta_0|^g, and of K-correlation where b |beta - beta_0| is 1.
        let abg = get("B").zip(get("g")).filter(|(_, g)| *g > 0.0);
        let abg = abg.map(|(b, g)| Real::portable_exp(Real::portable_ln(b) / g));
        let lengths = [get("b"), get("b_2")].into_iter().flatten().map(|b| 1.0 / b);
        let all = slopes.map(|(_, &slope)| slope).chain(abg).chain(lengths);
        all.fold(1.0, f64::min).max(1e-7)
    }

    /// ln f in the directions of `sample`, f in sr^-1; none beyond the horizon.
    pub fn ln_f(&self, sample: &Sample<f64>) -> Option<f64> {
        self.model.ln_f(&self.values, sample)
    }

    /// The same, and its derivatives by the parameters.
    pub fn gradient(&self, sample: &Sample<f64>) -> Option<(f64, Values)> {
        self.model.gradient(&self.values, sample)
    }

    /// Model less measurement in ln f, times the sample's weight; none beyond the horizon.
    pub fn residual(&self, sample: &Sample<f64>) -> Option<f64> {
        Some(sample.weight * (self.ln_f(sample)? - Real::portable_ln(sample.brdf)))
    }
}
