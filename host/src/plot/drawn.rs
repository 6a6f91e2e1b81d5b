//! The samples of a scan as they are drawn.

use brdfit_core::geometry::Sample;

use super::marks::Data;
use crate::engine::Outcome;
use crate::engine::instrument::moved;
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

    /// Those that were fitted, and those that were left out before and in the fit, each where it is: an offset of theta_s is taken off.
    pub fn of_fit(measurement: &Measurement, outcome: &Outcome) -> Drawn {
        let outliers = outcome.robust.as_ref().map_or(&[][..], |robust| &robust.outliers);
        Drawn::without(measurement, outliers).moved(outcome.offset.map_or(0.0, |offset| offset.value))
    }

    /// The same where they are if the instrument reads this much too much for theta_s, radians.
    pub fn moved(mut self, offset: f64) -> Drawn {
        for sample in self.samples.iter_mut().chain(&mut self.left_out) {
            *sample = moved(sample, offset).unwrap_or(*sample);
        }
        self
    }

    /// Those of a scan, of which the ones in these places are shown as left out.
    pub fn without(measurement: &Measurement, outliers: &[usize]) -> Drawn {
        let mut drawn = Drawn::of_scan(measurement);
        let samples = measurement.samples.iter().enumerate();
        let (out, kept): (Vec<_>, Vec<_>) = samples.partition(|(place, _)| outliers.contains(place));
        drawn.left_out.extend(out.iter().map(|&(_, sample)| *sample));
        drawn.left_out_count += out.len();
        drawn.samples = kept.iter().map(|&(_, sample)| *sample).collect();
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
