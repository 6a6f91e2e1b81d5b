//! What a scan cannot see is not told: lobes that no sample meets, and errors of fits that leave no residual.

use brdfit_core::geometry::Sample;
use brdfit_core::uncertainty::Place;

use crate::engine::uncertainty::{UNKNOWN, Uncertainty};
use crate::engine::{FitOptions, Outcome, Values};

/// A lobe whose part of f is below this at every sample changes no digit of the cost that counts.
const SHARE: f64 = 1e-6;

/// The fit with the weights of lobes that no sample sees at their lower bounds: of fits that cost the same, the one with the smaller weights.
///
/// Such a weight is [`Place::Unseen`], has no standard error, and takes no part in the errors of anything else.
pub fn settled(samples: &[Sample<f64>], options: &FitOptions, mut outcome: Outcome) -> Outcome {
    let model = outcome.model;
    let lobes = (0..model.parameters.len()).filter(|&place| {
        let parameter = &model.parameters[place];
        parameter.is_weight() && parameter.name != "rho_d" && outcome.params[place] > options.lower[place]
    });
    for place in lobes.collect::<Vec<_>>() {
        let mut without = outcome.params;
        without[place] = options.lower[place];
        let unseen = |sample: &Sample<f64>| {
            let with = model.ln_f(&outcome.params, sample);
            let without = model.ln_f(&without, sample);
            with.zip(without)
                .is_some_and(|(with, without)| (with - without).abs() < SHARE)
        };
        if samples.iter().filter(|sample| sample.weight != 0.0).all(unseen) {
            outcome.params = without;
            if let Some(best) = outcome.minima.first_mut() {
                best.params[place] = without[place];
            }
            outcome.at_bound.retain(|&name| name != model.parameters[place].name);
            forget(&mut outcome.uncertainty, place);
        }
    }
    outcome
}

/// Takes a parameter out of all that is known.
pub(super) fn forget(known: &mut Uncertainty, place: usize) {
    known.places[place] = Some(Place::Unseen);
    known.push[place] = 0.0;
    let mut axes = known.axes.clone();
    for axis in axes.iter_mut().chain(&mut known.axes_lifted) {
        axis[place] = 0.0;
    }
    axes[place] = Values::from_fn(known.places.len(), |_| 0.0);
    known.stderr_lifted[place] = f64::INFINITY;
    *known = known.clone().with_axes(axes);
    known.stderr[place] = f64::INFINITY;
}

/// Names of the weights that no sample sees.
pub fn names(outcome: &Outcome) -> Vec<&'static str> {
    let parameters = outcome.model.parameters.iter().zip(&outcome.uncertainty.places);
    let unseen = parameters.filter(|(parameter, place)| parameter.is_weight() && **place == Some(Place::Unseen));
    unseen.map(|(parameter, _)| parameter.name).collect()
}

/// Why a fit knows none of its errors: it leaves no residuals, so that nothing tells of noise.
pub fn is_exact(known: &Uncertainty) -> bool {
    known.degrees_of_freedom > 0 && known.scale < known.rounding
}

/// Has nothing a standard error, since the fit is exact and no standard deviations of the file are taken for them?
pub fn without_errors(known: &Uncertainty) -> bool {
    is_exact(known) && known.effective.is_finite()
}

/// Without any certainty if the fit is exact.
pub fn doubted(known: &Uncertainty) -> Uncertainty {
    if !is_exact(known) {
        return known.clone();
    }
    let mut axes = known.axes.clone();
    for place in known.inside() {
        axes[place] = Values::from_fn(known.places.len(), |k| if k == place { UNKNOWN } else { 0.0 });
    }
    known.clone().with_axes(axes)
}
