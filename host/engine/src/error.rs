//! Why no fit was made.

use std::fmt;

use brdfit_core::geometry::SampleError;

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
    /// The course of a search with an instrument is not traced.
    Trace,
    /// No compiled set has these terms.
    Terms(u8),
    /// There is no proof of the optimum for the model of this name.
    NoProof(&'static str),
    /// The fit was no longer wanted: see [`crate::Until`].
    Interrupted,
}

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
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
            FitError::Trace => {
                f.write_str("the course of a search is traced without priors, aperture, offset and limit")
            }
            FitError::Terms(terms) => write!(f, "no compiled model has the set of terms {terms:#b}"),
            FitError::Interrupted => f.write_str("interrupted"),
        }
    }
}
impl std::error::Error for FitError {}
