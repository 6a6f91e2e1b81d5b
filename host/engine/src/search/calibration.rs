//! What a calibration that is uncertain by a factor adds to what is known.

use brdfit_core::uncertainty::Place;

use crate::options::FitOptions;
use crate::outcome::Outcome;
use crate::uncertainty::Uncertainty;
use crate::values::Values;

impl Outcome {
    /// With the uncertainty of the calibration: one factor of all samples, which the weights take, all together.
    pub(crate) fn calibrated(mut self, options: &FitOptions) -> Self {
        let relative = options.instrument.scale_uncertainty;
        if relative > 0.0 {
            let moves = |place: usize, held: bool| {
                let free = match self.uncertainty.places[place] {
                    Some(Place::Inside) => true,
                    Some(Place::Lower | Place::Upper) => !held,
                    _ => false,
                };
                if free && self.model.parameters[place].is_weight() {
                    relative * self.params[place]
                } else {
                    0.0
                }
            };
            let axis = |held: bool| Values::from_fn(self.params.len(), |place| moves(place, held));
            let (axis, lifted) = (axis(true), axis(false));
            add(&mut self.uncertainty, axis, lifted);
        }
        self
    }
}

/// The standard error of a sum of two; the first to the bit where the second is 0.
pub(crate) fn beside(stderr: f64, other: f64) -> f64 {
    if other == 0.0 {
        stderr
    } else {
        (stderr * stderr + other * other).sqrt()
    }
}

/// Adds a further axis of one standard error.
fn add(known: &mut Uncertainty, axis: Values, lifted: Values) {
    let count = axis.len();
    for (stderr, part) in known.stderr.iter_mut().zip(axis.iter()) {
        *stderr = beside(*stderr, *part);
    }
    for (stderr, part) in known.stderr_lifted.iter_mut().zip(lifted.iter()) {
        *stderr = beside(*stderr, *part);
    }
    for i in 0..count {
        for j in 0..count {
            known.cov[i][j] += axis[i] * axis[j];
        }
    }
    for i in 0..count {
        for j in 0..count {
            let scale = known.stderr[i] * known.stderr[j];
            if scale > 0.0 && scale.is_finite() {
                known.correlation[i][j] = (known.cov[i][j] / scale).clamp(-1.0, 1.0);
            }
        }
    }
    known.axes.push(axis);
    known.axes_lifted.push(lifted);
}
