//! What a fit gives.

use brdfit_core::lm::Stop;
use brdfit_core::search::Evaluations;

use crate::instrument::{Offset, View};
use crate::material::Material;
use crate::model::Model;
use crate::options::FitOptions;
use crate::uncertainty::Uncertainty;
use crate::values::Values;

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

/// What a robust fit left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Robust {
    /// Standard deviation of the residuals of ln f, from the median size of those that were kept; dimensionless.
    pub scale: f64,
    /// The indices of the outliers, in order: their residuals are beyond 6 scales, or more where samples are few.
    pub outliers: Vec<usize>,
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

impl FitOptions {
    /// For further fits of the samples that `outcome` is of: without outliers to look for, with priors that weigh as they did there, and with offsets near the one that was found.
    pub fn settled(&self, outcome: &Outcome) -> Self {
        /// Radians (1.15 degrees).
        const NEAR: f64 = 0.02;
        let mut options = FitOptions { robust: false, ..*self };
        options.instrument.sigma = outcome.sigma.or(self.instrument.sigma);
        if let (Some((least, most)), Some(offset)) = (self.instrument.offsets, outcome.offset) {
            let near = (offset.value - NEAR, offset.value + NEAR);
            options.instrument.offsets = Some((least.max(near.0), most.min(near.1)));
        }
        options
    }
}
