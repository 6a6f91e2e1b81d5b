//! What is known of instrument and sample beside the samples, and takes part in the fit.
//!
//! Every part of it stands around the same search: priors and the limit on energy are further residuals (`search/beside.rs`), the aperture is a scan of averages (`averaged.rs`), and the offset is a search over shifted samples (`search/offset.rs`).
//! A fit without any of it is not touched.

pub(crate) mod aperture;
pub(crate) mod moved;
mod view;

use std::fmt;

use crate::material::Material;
use crate::values::{MOST, Values};
pub use moved::{Offset, moved, signed};
pub use view::View;

/// What a parameter is known to be from another measurement: a normal distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Its value, in the unit of the parameter.
    pub mean: f64,
    /// Its standard uncertainty, above 0.
    pub sigma: f64,
}

/// Something that must not be above 1, such as reflectance, at an angle of incidence in radians, with its derivatives by the parameters.
#[derive(Clone, Copy)]
pub struct Limit(pub fn(&Material, f64) -> (f64, Values));

impl fmt::Debug for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The address of a function is another one in each process.
        f.write_str("Limit")
    }
}

/// A program has one.
impl PartialEq for Limit {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// What takes part in a fit beside the samples; nothing by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Instrument {
    /// For the parameter in each place of the model.
    pub priors: [Option<Prior>; MOST],
    /// Half-angle of the cone that the detector sees from the sample, radians; 0 for a point.
    pub aperture: f64,
    /// Least and largest offset of the zero of theta_s that may be fitted, radians; none for no offset.
    pub offsets: Option<(f64, f64)>,
    /// Relative standard uncertainty of the calibration, one factor of all samples: it adds to errors and changes no value.
    pub scale_uncertainty: f64,
    /// What is held to at most 1 at the angles of incidence of the samples.
    pub limit: Option<Limit>,
    /// Standard deviation of ln f of a sample of weight 1, by which priors weigh against samples; none to take it from the residuals.
    pub sigma: Option<f64>,
}

impl Instrument {
    /// Does nothing of it change the values of a fit?
    pub fn is_plain(&self) -> bool {
        self.priors.iter().all(Option::is_none)
            && self.aperture == 0.0
            && self.offsets.is_none()
            && self.limit.is_none()
    }
}
