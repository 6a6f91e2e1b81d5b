//! The solver's coordinates of a compiled set of terms, and the parameters of the whole model.

use brdfit_core::lm::Bounds;
use brdfit_core::model::Parameter;
use brdfit_core::real::Real;

use crate::model::Model;
use crate::options::FitOptions;
use crate::values::Values;

/// Where the `P` coordinates of what is compiled stand among the parameters of the model.
pub(crate) struct Layout<'a, const P: usize> {
    own: &'a [Parameter; P],
    model: &'static Model,
    /// Place among the model's parameters.
    pub places: [usize; P],
}

impl<'a, const P: usize> Layout<'a, P> {
    pub fn new(own: &'a [Parameter; P], model: &'static Model) -> Self {
        let place = |k: usize| {
            let place = model.place(own[k].name);
            place.expect("a set of terms has parameters of its model")
        };
        Layout {
            own,
            model,
            places: std::array::from_fn(place),
        }
    }

    /// The coordinate of the model's parameter in this place, if it has one.
    pub fn coordinate(&self, place: usize) -> Option<usize> {
        self.places.iter().position(|&own| own == place)
    }

    pub fn coordinates<R: Real>(&self, values: &[f64]) -> [R; P] {
        std::array::from_fn(|k| {
            let value = R::of(values[self.places[k]]);
            if self.own[k].is_squared() { value * value } else { value }
        })
    }

    pub fn bounds<R: Real>(&self, options: &FitOptions) -> Bounds<R, P> {
        Bounds {
            lower: self.coordinates(&options.lower),
            upper: self.coordinates(&options.upper),
        }
    }

    /// The parameters at these coordinates; what is not compiled has its value of absence.
    pub fn values<R: Real>(&self, x: &[R; P]) -> Values {
        Values::from_fn(self.model.parameters.len(), |place| match self.coordinate(place) {
            Some(k) if self.own[k].is_squared() => x[k].sqrt().f64(),
            Some(k) => x[k].f64(),
            None => self.model.absent(place),
        })
    }

    /// Derivatives of the parameters by the coordinates at `x`; 0 at kappa = 0, where there is none.
    pub fn slopes(&self, x: &[f64; P]) -> [f64; P] {
        std::array::from_fn(|k| self.own[k].slope(x[k]))
    }

    /// The coordinate that is the square of a parameter.
    pub fn squared(&self) -> Option<usize> {
        self.own.iter().position(Parameter::is_squared)
    }
}
