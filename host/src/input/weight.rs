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

/// The squares of the weights of a scan.
#[derive(Debug, Default)]
pub struct Sum {
    squares: f64,
    sigmas: usize,
    others: usize,
}

impl Sum {
    /// One more sample.
    pub fn add(&mut self, weight: f64, source: Source) {
        self.squares += weight * weight;
        match source {
            Source::Unit => self.others += 1,
            Source::Sigma => self.sigmas += 1,
        }
    }

    /// Makes the mean of the squared weights 1, so that MSE^2 (Eq. 17) stays an error of ln f; where all are 1 they stay so.
    ///
    /// Returns the standard deviation of ln f that a weight of 1 stands for, if all weights are of standard deviations.
    pub fn normalise(&self, samples: &mut [Sample<f64>]) -> Option<f64> {
        let root_mean_square = (self.squares / samples.len() as f64).sqrt();
        // Weights that were normalised keep their bits, so that a scan that the program wrote is the same when it is read.
        let normalised = (root_mean_square - 1.0).abs() < 1e-12;
        if !normalised || self.sigmas > 0 {
            for sample in samples {
                sample.weight /= root_mean_square;
            }
        }
        (self.sigmas > 0 && self.others == 0).then(|| 1.0 / root_mean_square)
    }
}
