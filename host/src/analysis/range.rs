//! What is known no better than to the whole range that it can have is not determined.
//!
//! The range of a parameter is that of its bounds, and that of a weight ends where it reflects more than arrives; what is derived has its range in [`super::derived`].

use brdfit_core::geometry::Sample;
use brdfit_core::uncertainty::Place;

use super::copies::directions;
use super::misfit::coverage_factor;
use super::reflectance::slope_by_weight;
use super::unseen::forget;
use crate::engine::scale::Scale;
use crate::engine::uncertainty::{NEAR_ZERO, UNKNOWN};
use crate::engine::{FitOptions, Outcome, Values};

/// The fit with errors that say no more than bounds and energy allow.
///
/// A parameter on a bound lies no farther inside than the other bound.
/// A weight on its lower bound that may, within its 95 % interval, reflect more than arrives is not limited by the scan: it is [`Place::Unseen`], and stays out of the errors of all else.
/// The standard error of a parameter whose 95 % interval is all that its bounds allow is infinite; so is that of an offset of theta_s, and all where there are fewer directions than free parameters.
pub fn settled(samples: &[Sample<f64>], options: &FitOptions, mut outcome: Outcome) -> Outcome {
    let model = outcome.model;
    let count = model.parameters.len();
    let factor = coverage_factor(&outcome.uncertainty);
    if !factor.is_finite() {
        return outcome;
    }
    if too_few_directions(samples, options) {
        return nothing_known(outcome);
    }
    let scale = Scale::of(&[samples], options);
    let (lower, upper) = bounds(scale, options);
    // What is of another unit may be larger than 1.
    let in_sr = !scale.is_some_and(Scale::is_of_another_unit);
    let mut axes = outcome.uncertainty.axes.clone();
    let mut capped = false;
    for place in 0..count {
        if !matches!(outcome.uncertainty.places[place], Some(Place::Lower | Place::Upper)) {
            continue;
        }
        let (lower, upper) = (lower[place], upper[place]);
        // Displacements from kappa = 0 are of kappa^2, told at NEAR_ZERO.
        let most = match model.parameters[place].name == "kappa" && outcome.params[place] == 0.0 {
            true => 0.5 * upper * upper / NEAR_ZERO,
            false => upper - lower,
        };
        let size = axes[place][place].abs();
        if size > most {
            axes[place] = axes[place].iter().map(|part| part * (most / size)).collect();
            capped = true;
        }
    }
    if capped {
        outcome.uncertainty = outcome.uncertainty.clone().with_axes(axes);
    }
    for place in 0..count {
        let parameter = &model.parameters[place];
        let lobe = parameter.is_weight() && parameter.name != "rho_d";
        let inside = outcome.uncertainty.axes[place][place].abs();
        if lobe
            && in_sr
            && outcome.uncertainty.places[place] == Some(Place::Lower)
            && makes_energy(samples, &outcome, place, factor * inside)
        {
            outcome.at_bound.retain(|&name| name != parameter.name);
            forget(&mut outcome.uncertainty, place);
        }
    }
    let known = &mut outcome.uncertainty;
    known.stderr = Values::from_fn(count, |place| {
        let error = known.stderr[place];
        let range = upper[place] - lower[place];
        match known.places[place] == Some(Place::Inside) && factor * error >= range {
            true => f64::INFINITY,
            false => error,
        }
    });
    if let (Some(offset), Some((least, most))) = (&mut outcome.offset, options.instrument.offsets)
        && !(factor * offset.stderr < most - least)
    {
        offset.stderr = f64::INFINITY;
    }
    outcome
}

/// Are there fewer different directions, with priors, than free parameters? Then whole curves of parameters fit as well, however often each direction was measured.
fn too_few_directions(samples: &[Sample<f64>], options: &FitOptions) -> bool {
    let free = options.free().count();
    let known = options.with_prior().count();
    free > known && directions(samples, free - known) + known < free
}

/// The fit without any certainty.
fn nothing_known(mut outcome: Outcome) -> Outcome {
    let known = &mut outcome.uncertainty;
    let count = known.places.len();
    let mut axes = known.axes.clone();
    for place in known.inside().collect::<Vec<_>>() {
        let unknown = Values::from_fn(count, |k| if k == place { UNKNOWN } else { 0.0 });
        axes[place] = unknown;
        known.axes_lifted[place] = unknown;
        known.stderr_lifted[place] = f64::INFINITY;
    }
    *known = known.clone().with_axes(axes);
    known.stderr = Values::from_fn(count, |place| match known.places[place] {
        Some(Place::Inside | Place::Unseen) => f64::INFINITY,
        _ => known.stderr[place],
    });
    if let Some(offset) = &mut outcome.offset {
        offset.stderr = f64::INFINITY;
    }
    outcome
}

/// The bounds in the unit of the scan.
fn bounds(scale: Option<Scale>, options: &FitOptions) -> (Values, Values) {
    let inside = scale.and_then(|scale| Some((scale, scale.options(options).ok()?)));
    inside.map_or((options.lower, options.upper), |(scale, inside)| {
        let given = |values: &Values| scale.given(options.model.parameters, values);
        (given(&inside.lower), given(&inside.upper))
    })
}

/// Would a weight that is larger by this reflect more than arrives, at the least or the largest angle of incidence?
fn makes_energy(samples: &[Sample<f64>], outcome: &Outcome, place: usize, more: f64) -> bool {
    /// A lobe of weight 1 reflects less than this.
    const MOST: f64 = 100.0;
    if !(more * MOST > 1.0) {
        return false;
    }
    let angles = || samples.iter().map(|sample| sample.theta_i);
    let (least, most) = (angles().fold(f64::INFINITY, f64::min), angles().fold(0.0, f64::max));
    // Most files of a batch have one.
    let ends = if least < most { &[least, most][..] } else { &[least] };
    let slope = |theta_i: f64| slope_by_weight(&outcome.material(), theta_i, place);
    ends.iter().any(|&theta_i| more * slope(theta_i) > 1.0)
}
