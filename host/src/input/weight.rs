//! Weights of samples: factors of the residuals of ln f, whose squares have a mean of 1.

use brdfit_core::geometry::Sample;

/// Where the weight of a sample is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A factor without a unit.
    Unit,
    /// One over the standard deviation of ln f.
    Sigma,
}

/// The standard deviation of a value in parts: `absolute` in the unit of the BRDF, `relative` of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// In sr^-1.
    pub absolute: f64,
    /// Dimensionless.
    pub relative: f64,
}

/// The square of a relative deviation of a half, beyond which noise counts as that.
const HALF: f64 = 0.25;

impl Deviation {
    /// The whole over a BRDF, which is that of its logarithm to first order.
    pub fn over(&self, brdf: f64) -> f64 {
        libm::hypot(self.absolute / brdf, self.relative)
    }

    /// This part of it.
    pub fn times(&self, part: f64) -> Self {
        Deviation {
            absolute: self.absolute * part,
            relative: self.relative * part,
        }
    }

    /// The relative one that leaves residuals of this standard deviation in the logarithm, the inverse of [`Deviation::of_ln`].
    pub fn of_residual(residual: f64) -> Self {
        let mut relative = residual;
        for _ in 0..30 {
            let square = (relative * relative).min(HALF);
            relative = residual / libm::sqrt(1.0 + 2.5 * square);
        }
        Deviation {
            absolute: 0.0,
            relative,
        }
    }

    /// The standard deviation of the logarithm of a value around `brdf` with normal noise, and how far its mean is low: to fourth order in the noise, and no more for one that is half noise.
    pub fn of_ln(&self, brdf: f64) -> (f64, f64) {
        let sigma = self.over(brdf);
        let square = (sigma * sigma).min(HALF);
        (sigma * libm::sqrt(1.0 + 2.5 * square), square * (0.5 + 0.75 * square))
    }
}

/// What is asked where standard deviations are given, and where not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OnDeviations {
    /// Errors are those of the standard deviations whatever chi^2 says.
    pub absolute: bool,
    /// Without any, ln f is raised by what noise of the size of the residuals takes from it.
    pub correct_ln_bias: bool,
}

/// Normalises weights that are one over standard deviations of ln f; returns that of a weight of 1.
pub fn normalised(samples: &mut [Sample<f64>]) -> f64 {
    let count = Count { sigmas: 1, others: 0 };
    count.normalise(samples).unwrap_or(1.0)
}

/// Where the weights of a scan are from.
#[derive(Debug, Default)]
pub struct Count {
    sigmas: usize,
    others: usize,
}

impl Count {
    /// One more sample.
    pub fn add(&mut self, source: Source) {
        match source {
            Source::Unit => self.others += 1,
            Source::Sigma => self.sigmas += 1,
        }
    }

    /// Makes the mean of the squared weights 1, so that MSE^2 (Eq. 17) stays an error of ln f; where all are 1 they stay so.
    ///
    /// Returns the standard deviation of ln f that a weight of 1 stands for, if all weights are of standard deviations.
    pub fn normalise(&self, samples: &mut [Sample<f64>]) -> Option<f64> {
        // Weights that were normalised keep their bits, so that a scan that the program wrote is the same when it is read.
        let mean_square =
            samples.iter().map(|sample| sample.weight * sample.weight).sum::<f64>() / samples.len() as f64;
        if self.sigmas == 0 && (mean_square - 1.0).abs() < 1e-12 {
            return None;
        }
        // A power of two changes no digit, and keeps the squares of weights of any size in range.
        let largest = samples
            .iter()
            .fold(0.0f64, |largest, sample| largest.max(sample.weight));
        let exponent = libm::frexp(largest).1;
        let mut squares = 0.0;
        for sample in &mut *samples {
            sample.weight = libm::ldexp(sample.weight, -exponent);
            squares += sample.weight * sample.weight;
        }
        let root_mean_square = (squares / samples.len() as f64).sqrt();
        for sample in samples {
            sample.weight /= root_mean_square;
        }
        (self.sigmas > 0 && self.others == 0).then(|| libm::ldexp(1.0 / root_mean_square, -exponent))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_size_of_weights_does_not_matter() {
        let normalised = |scale: f64| {
            let mut samples = [0.5, 1.0, 3.0].map(|weight| Sample {
                weight: weight * scale,
                ..Sample::in_plane(0.5, 0.5, 1.0)
            });
            let mut count = Count::default();
            count.add(Source::Sigma);
            let sigma = count.normalise(&mut samples).unwrap();
            (samples.map(|sample| sample.weight), sigma * scale)
        };
        let (weights, sigma) = normalised(1.0);
        let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
        assert!((squares / 3.0 - 1.0).abs() < 1e-15);
        // Powers of two, so that the scaled weights are exact.
        for exponent in [-1000, -600, -1, 1, 600, 1000] {
            let (scaled, scaled_sigma) = normalised(libm::ldexp(1.0, exponent));
            assert_eq!(scaled, weights, "{exponent}");
            assert_eq!(scaled_sigma, sigma, "{exponent}");
        }
    }
}
