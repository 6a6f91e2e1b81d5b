//! What a fit gives, or why it failed.

use brdfit_core::geometry::SampleError;
use brdfit_core::lm::Stop;
use brdfit_core::search::Evaluations;

use crate::robust::Robust;
use crate::uncertainty::Uncertainty;
use crate::{Material, Model, Offset, Values, View};

/// One distinct minimum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Minimum {
    /// Sum of squared ln residuals over samples squared (Eq. 17).
    pub mse2: f64,
    /// Its parameters.
    pub params: Values,
    /// How many fits ended here.
    pub hits: u32,
    /// The least index of a start that led here.
    pub first_start: u64,
}

/// The result of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The model.
    pub model: &'static Model,
    /// Its terms that were fitted.
    pub terms: u8,
    /// Number of samples.
    pub samples: usize,
    /// Sum of squared residuals: of ln f over the samples, and of priors.
    pub cost: f64,
    /// Eq. 17.
    pub mse2: f64,
    /// Root of the mean squared residual of ln f over the samples.
    pub rms_ln: f64,
    /// The best parameters.
    pub params: Values,
    /// Names of the parameters that ended on a bound.
    pub at_bound: Vec<&'static str>,
    /// How the best fit ended.
    pub stop: Stop,
    /// Distinct minima, best first.
    pub minima: Vec<Minimum>,
    /// (high - low) / high over them (Table 3).
    pub improvement_potential: f64,
    /// How many passes were made.
    pub evaluations: Evaluations,
    /// What a robust fit left out; all else here is of the other samples.
    pub robust: Option<Robust>,
    /// The part of the cost that is that of priors.
    pub prior_cost: f64,
    /// The standard deviation of ln f by which priors were weighed, if there are any.
    pub sigma: Option<f64>,
    /// Half-angle of the aperture that the model was seen through, radians.
    pub aperture: f64,
    /// The offset of theta_s that was fitted.
    pub offset: Option<Offset>,
    /// What the scan tells about the parameters; computed in `f64` whatever the number type of the fit.
    pub uncertainty: Uncertainty,
}

/// Why no fit was made.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum FitError {
    /// The sample of this index is not valid.
    Sample(usize, SampleError),
    /// Fewer samples than parameters: how many of each.
    TooFew(usize, usize),
    /// The sample of this index is out of the plane of incidence, or so near to the horizon that an offset moves it below.
    OutOfPlane(usize),
    /// No parameters within the bounds keep what is limited at 1 or below.
    Limit,
    /// No compiled set has these terms.
    Terms(u8),
    /// There is no proof of the optimum for the model of this name.
    NoProof(&'static str),
    /// The fit was no longer wanted: see [`crate::Until`].
    Interrupted,
}

impl Outcome {
    /// Places of the parameters that are part of the terms.
    pub fn present(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.params.len()).filter(|&place| !self.model.left_out(self.terms, place))
    }

    /// The best fit.
    pub fn material(&self) -> Material {
        Material {
            model: self.model,
            values: self.params,
        }
    }

    /// The best fit as the instrument sees it.
    pub fn view(&self) -> View {
        View {
            material: self.material(),
            aperture: self.aperture,
            offset: self.offset.map_or(0.0, |offset| offset.value),
        }
    }

    /// The value of the parameter of this name, if the model has it.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.model.value(&self.params, name)
    }
}

impl std::fmt::Display for FitError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            FitError::Sample(index, error) => write!(f, "sample {}: {error}", index + 1),
            FitError::TooFew(samples, parameters) => {
                write!(f, "{samples} samples cannot determine {parameters} parameters")
            }
            FitError::OutOfPlane(index) => write!(
                f,
                "sample {} is out of the plane of incidence, where there is no offset of theta_s to fit",
                index + 1
            ),
            FitError::Limit => f.write_str("no parameters within the bounds reflect less light than arrives"),
            FitError::NoProof(model) => write!(f, "there is no proof of the optimum for the model {model}"),
            FitError::Terms(terms) => write!(f, "no compiled model has the set of terms {terms:#b}"),
            FitError::Interrupted => f.write_str("interrupted"),
        }
    }
}
impl std::error::Error for FitError {}
