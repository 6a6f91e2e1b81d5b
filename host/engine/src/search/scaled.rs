//! Scans of any size through a fit: their scale out of samples and options, and back into what was found.

use brdfit_core::geometry::Sample;
use brdfit_core::model::Parameter;

use super::joint::JointFit;
use super::watched::Trace;
use crate::error::FitError;
use crate::options::{FitOptions, Precision};
use crate::outcome::{Minimum, Outcome};
use crate::scale::{LARGEST, ORDINARY, Scale};
use crate::uncertainty::Uncertainty;

/// In `f32` the squares of what is below 2^-14, 6e-5, and so is its darkest sample, lose digits.
const SINGLE: i32 = 14;
/// Binary digits over which samples may spread before their middle counts, in place of the largest.
const SPREAD: i32 = 60;
/// Bounds beyond 2^60 bind nothing, and their squares are numbers of `f32`.
const UNBOUND: f64 = (1u64 << 60) as f64;

impl Scale {
    /// What has to be taken out of these scans for a fit with these options; none of ordinary ones.
    ///
    /// A model without weights cannot be scaled, and its scans keep their size.
    pub fn of(scans: &[&[Sample<f64>]], options: &FitOptions) -> Option<Scale> {
        let least = match options.precision {
            Precision::F64 => -ORDINARY,
            Precision::F32 => -SINGLE,
        };
        let all = || scans.iter().flat_map(|samples| samples.iter());
        let brdf = match options.model.parameters.iter().any(Parameter::is_weight) {
            true => exponent(all().map(|sample| sample.brdf), least).map_or(0, |size| size - LARGEST),
            false => 0,
        };
        let weight = exponent(all().map(|sample| sample.weight.abs()), -ORDINARY).unwrap_or(0);
        (brdf != 0 || weight != 0).then_some(Scale { brdf, weight })
    }

    /// The options for these samples.
    ///
    /// The bounds of a model's description are those of a BRDF per steradian; what is of no such size has another unit, and bounds that nobody changed are taken in that.
    ///
    /// # Errors
    /// [`FitError::Limit`] where a reflectance is to be limited that is far above 1; far below 1 there is nothing to limit.
    pub fn options(self, options: &FitOptions) -> Result<FitOptions, FitError> {
        let mut inside = *options;
        if self.is_of_another_unit() && self.brdf > 0 && options.instrument.limit.is_some() {
            return Err(FitError::Limit);
        }
        if self.brdf != 0 {
            inside.instrument.limit = None;
        }
        inside.instrument.sigma = options.instrument.sigma.map(|sigma| libm::ldexp(sigma, -self.weight));
        for (place, parameter) in options.model.parameters.iter().enumerate() {
            if !parameter.is_weight() || self.brdf == 0 {
                continue;
            }
            let taken = |value: f64| libm::ldexp(value, -self.brdf);
            if !self.is_of_another_unit() || (options.lower[place], options.upper[place]) != parameter.bounds {
                inside.lower[place] = taken(options.lower[place]).min(UNBOUND);
                inside.upper[place] = taken(options.upper[place]).min(UNBOUND);
            }
            if let Some(prior) = &mut inside.instrument.priors[place] {
                (prior.mean, prior.sigma) = (taken(prior.mean), taken(prior.sigma));
            }
        }
        Ok(inside)
    }

    /// What was found, in the unit of the scan.
    pub fn outcome(self, mut found: Outcome) -> Outcome {
        let parameters = found.model.parameters;
        found.params = self.given(parameters, &found.params);
        for minimum in &mut found.minima {
            *minimum = Minimum {
                params: self.given(parameters, &minimum.params),
                mse2: self.cost(minimum.mse2),
                ..*minimum
            };
        }
        found.cost = self.cost(found.cost);
        found.mse2 = self.cost(found.mse2);
        found.prior_cost = self.cost(found.prior_cost);
        found.rms_ln = self.residual(found.rms_ln);
        found.sigma = found.sigma.map(|sigma| self.residual(sigma));
        if let Some(robust) = &mut found.robust {
            robust.scale = self.residual(robust.scale);
        }
        found.uncertainty = self.uncertainty(parameters, found.uncertainty);
        found
    }

    fn uncertainty(self, parameters: &[Parameter], mut known: Uncertainty) -> Uncertainty {
        known.scale = self.residual(known.scale);
        known.stderr = self.given(parameters, &known.stderr);
        known.stderr_lifted = self.given(parameters, &known.stderr_lifted);
        for axis in known.axes.iter_mut().chain(&mut known.axes_lifted) {
            *axis = self.given(parameters, axis);
        }
        for (i, row) in known.cov.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                // At once, since a half of it may be no number.
                *entry = libm::ldexp(*entry, self.exponent(parameters, i) + self.exponent(parameters, j));
            }
        }
        known
    }

    /// The course of a search, in the unit of the scan.
    pub fn trace(self, parameters: &[Parameter], mut trace: Trace) -> Trace {
        for record in &mut trace.records {
            record.params = self.given(parameters, &record.params);
            record.cost = self.cost(record.cost);
        }
        trace
    }

    /// A joint fit, in the unit of the scans.
    pub fn joint(self, parameters: &[Parameter], fitted: JointFit) -> JointFit {
        let given = |all: &[Vec<Option<f64>>]| -> Vec<Vec<Option<f64>>> {
            let one = |(place, error): (usize, &Option<f64>)| {
                error.map(|error| libm::ldexp(error, self.exponent(parameters, place)))
            };
            all.iter()
                .map(|of_scan| of_scan.iter().enumerate().map(one).collect())
                .collect()
        };
        JointFit {
            errors: given(&fitted.errors),
            lifted: given(&fitted.lifted),
            scale: self.residual(fitted.scale),
            sigma: fitted.sigma.map(|sigma| self.residual(sigma)),
            scans: fitted
                .scans
                .iter()
                .map(|values| self.given(parameters, values))
                .collect(),
            cost: self.cost(fitted.cost),
            of_samples: self.cost(fitted.of_samples),
            separate: self.cost(fitted.separate),
            ..fitted
        }
    }
}

/// The exponent of the largest of some numbers if it is not of an ordinary size, of which the least is 2^`least_ordinary`; where they spread far, that of their middle.
fn exponent(numbers: impl Iterator<Item = f64>, least_ordinary: i32) -> Option<i32> {
    let ordinary = least_ordinary..=ORDINARY;
    let counted = numbers.filter(|x| x.is_finite() && *x > 0.0);
    let (least, largest) = counted.fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), x| (a.min(x), b.max(x)));
    if largest == 0.0 {
        return None;
    }
    let (low, high) = (libm::frexp(least).1, libm::frexp(largest).1);
    let size = if high - low > SPREAD {
        low + (high - low) / 2
    } else {
        high
    };
    (!ordinary.contains(&high) && !ordinary.contains(&size)).then_some(size)
}
