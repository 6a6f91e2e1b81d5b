//! The samples of a scan as they are drawn.

use brdfit_core::geometry::Sample;

use super::marks::Data;
use crate::engine::{Outcome, robust};
use crate::input::Measurement;

/// The samples of a picture.
pub struct Drawn {
    samples: Vec<Sample<f64>>,
    left_out: Vec<Sample<f64>>,
    left_out_count: usize,
}

impl Drawn {
    /// Those of a scan without a fit.
    pub fn of_scan(measurement: &Measurement) -> Drawn {
        Drawn {
            samples: measurement.samples.clone(),
            left_out: measurement.masked.iter().map(|(_, sample)| *sample).collect(),
            left_out_count: measurement.left_out.iter().map(|one| one.samples).sum(),
        }
    }

    /// Those that were fitted, and those that were left out before and in the fit.
    pub fn of_fit(measurement: &Measurement, outcome: &Outcome) -> Drawn {
        let mut drawn = Drawn::of_scan(measurement);
        if let Some(robust) = &outcome.robust {
            let outliers = robust.outliers.iter().map(|&place| measurement.samples[place]);
            drawn.left_out.extend(outliers);
            drawn.left_out_count += robust.outliers.len();
            drawn.samples = robust::kept(&measurement.samples, outcome);
        }
        drawn
    }

    /// The same for a figure.
    pub fn data(&self) -> Data<'_> {
        Data {
            samples: &self.samples,
            left_out: &self.left_out,
            left_out_count: self.left_out_count,
        }
    }
}
