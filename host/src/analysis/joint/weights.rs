//! How scans count against each other in a joint fit: by the standard deviations that their files state, or alike.

use crate::analysis::deviations::Stated;
use crate::input::Measurement;

/// By what the scans of a joint fit count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum By {
    /// By their standard deviations, of which a weight of 1 stands for one that all have in common.
    Deviations(Stated),
    /// No file states any: the weights of each scan have a mean square of 1.
    Alike,
    /// So many of the scans have some, and the others none: weights are as without any.
    Some(usize),
}

impl By {
    /// What all files state.
    pub fn stated(self) -> Option<Stated> {
        match self {
            By::Deviations(stated) => Some(stated),
            By::Alike | By::Some(_) => None,
        }
    }
}

/// The scans with weights that follow their standard deviations, where all files state some.
///
/// The weights of each scan alone have a mean square of 1, so that one with large deviations would count like one with small ones; here those of all samples together have.
pub fn weighed(mut measurements: Vec<Measurement>) -> (Vec<Measurement>, By) {
    let stated: Vec<Stated> = measurements.iter().filter_map(Stated::of).collect();
    let Some(first) = stated.first().filter(|_| stated.len() == measurements.len()) else {
        let by = if stated.is_empty() {
            By::Alike
        } else {
            By::Some(stated.len())
        };
        return (measurements, by);
    };
    let sigma = common(&measurements, &stated);
    for (measurement, own) in measurements.iter_mut().zip(&stated) {
        let factor = sigma / own.sigma;
        if factor != 1.0 {
            measurement
                .samples
                .iter_mut()
                .for_each(|sample| sample.weight *= factor);
        }
        measurement.sigma_ln = Some(sigma);
    }
    let by = By::Deviations(Stated { sigma, ..*first });
    (measurements, by)
}

/// The deviation over which those of the scans give weights with a mean square of 1; that of all scans where it is the same, to the bit.
fn common(measurements: &[Measurement], stated: &[Stated]) -> f64 {
    let least = stated.iter().map(|one| one.sigma).fold(f64::INFINITY, f64::min);
    if stated.iter().all(|one| one.sigma == least) {
        return least;
    }
    let pairs = measurements.iter().zip(stated);
    let (mut samples, mut squares) = (0.0, 0.0);
    for (measurement, one) in pairs {
        // Over the least, so that no square is out of range.
        let part = least / one.sigma;
        samples += measurement.samples.len() as f64;
        squares += measurement.samples.len() as f64 * part * part;
    }
    least * libm::sqrt(samples / squares)
}
