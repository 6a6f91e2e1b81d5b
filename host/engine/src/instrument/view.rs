//! What an instrument sees of a material.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::aperture::directions;
use super::moved::moved;
use crate::material::Material;
use crate::values::Values;

/// A material as an instrument with an aperture and an offset sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The material.
    pub material: Material,
    /// Half-angle of the aperture, radians; 0 for a point.
    pub aperture: f64,
    /// What the instrument reads for theta_s = 0, radians.
    pub offset: f64,
}

impl From<&Material> for View {
    /// What is seen without an aperture and an offset.
    fn from(material: &Material) -> Self {
        View {
            material: *material,
            aperture: 0.0,
            offset: 0.0,
        }
    }
}

impl View {
    /// ln of the BRDF that is measured where the instrument reads the directions of `sample`, sr^-1; none beyond the horizon.
    pub fn ln_f(&self, sample: &Sample<f64>) -> Option<f64> {
        let sample = moved(sample, self.offset)?;
        if self.aperture == 0.0 {
            return self.material.ln_f(&sample);
        }
        let parts = directions(&sample, self.aperture);
        let parts = parts
            .iter()
            .filter_map(|(at, share)| Some((self.material.ln_f(at)?, *share)));
        let parts: Vec<(f64, f64)> = parts.collect();
        let top = parts.iter().map(|part| part.0).fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = parts
            .iter()
            .map(|(ln_f, share)| share * Real::portable_exp(ln_f - top))
            .sum();
        (sum > 0.0).then(|| top + Real::portable_ln(sum))
    }

    /// The same, and its derivatives by the parameters.
    pub fn gradient(&self, sample: &Sample<f64>) -> Option<(f64, Values)> {
        if self.aperture == 0.0 {
            return self.material.gradient(&moved(sample, self.offset)?);
        }
        let ln_f = self.ln_f(sample)?;
        let sample = moved(sample, self.offset)?;
        let mut sum = Values::from_fn(self.material.values.len(), |_| 0.0);
        for (at, share) in directions(&sample, self.aperture) {
            if let Some((part, gradient)) = self.material.gradient(&at) {
                let share = share * Real::portable_exp(part - ln_f);
                sum.iter_mut()
                    .zip(gradient.iter())
                    .for_each(|(sum, slope)| *sum += share * slope);
            }
        }
        Some((ln_f, sum))
    }

    /// Model less measurement in ln f, times the sample's weight; none beyond the horizon.
    pub fn residual(&self, sample: &Sample<f64>) -> Option<f64> {
        Some(sample.weight * (self.ln_f(sample)? - Real::portable_ln(sample.brdf)))
    }
}
