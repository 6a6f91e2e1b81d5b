//! Uncertainty and derived quantities as parts of the JSON contract; what is infinite or not there is null.

use brdfit_core::uncertainty::Place;
use serde::Serialize;

use super::by_name::ByName;
use crate::analysis::derived::{Derived, Value, determined};
use crate::analysis::misfit::coverage_factor;
use crate::analysis::undetermined::undetermined;
use crate::analysis::unseen;
use crate::engine::Outcome;
use crate::engine::uncertainty::{Misfit, Uncertainty};
use crate::result::words::{correlated, from_data, sentence};

/// What is known of the parameters.
#[derive(Serialize)]
pub struct Known {
    /// Standard deviation of a residual of ln f.
    residual_scale: f64,
    degrees_of_freedom: usize,
    /// For Student's t: fewer where residuals are correlated, null where errors are those of the file.
    effective_degrees_of_freedom: f64,
    /// So many standard errors are the half of a 95 % interval.
    coverage_factor_95: f64,
    /// Null where residuals are independent.
    correlated: Option<Correlated>,
    /// What the lobe that the samples show adds to the errors of peak and width; null where that is little.
    lobe_from_data: Option<String>,
    /// Of J'J, columns scaled, over the parameters inside their bounds.
    condition: f64,
    /// Null where a parameter has none.
    stderr: ByName<Option<f64>>,
    /// As if no bound held another parameter.
    stderr_without_bounds: ByName<Option<f64>>,
    correlation: ByName<ByName<f64>>,
    on_bound: Vec<OnBound>,
    /// Weights of lobes that no sample sees.
    not_seen: Vec<&'static str>,
    /// Without residuals nothing has a standard error.
    exact: bool,
    undetermined: Vec<Open>,
}

/// The correlation of the residuals along the angle.
#[derive(Serialize)]
pub struct Correlated {
    /// Where it falls to 1/e.
    over_deg: f64,
    /// Part of the variance of a residual.
    part: f64,
    /// Is independence refuted, at a level of 5 %?
    sure: bool,
    /// Errors over those of independent residuals, least and largest.
    factor: [f64; 2],
    sentence: String,
}

impl From<&Misfit> for Correlated {
    fn from(misfit: &Misfit) -> Self {
        Correlated {
            over_deg: misfit.length.to_degrees(),
            part: misfit.part,
            sure: misfit.sure,
            factor: misfit.factor.into(),
            sentence: correlated(misfit),
        }
    }
}

#[derive(Serialize)]
struct OnBound {
    parameter: &'static str,
    bound: &'static str,
    /// In standard errors, positive towards larger values.
    push: f64,
}

#[derive(Serialize)]
struct Open {
    parameters: Vec<&'static str>,
    through: Vec<&'static str>,
    sentence: String,
}

/// At one angle of incidence; angles in degrees.
#[derive(Serialize)]
pub struct AtAngle {
    theta_i_deg: f64,
    rho_s_f: Option<Number>,
    rho_v_f: Option<Number>,
    /// Null where the peak is not determined, as its value.
    peak_theta_s_deg: Option<f64>,
    peak_brdf_per_sr: Option<Number>,
    width_deg: Option<Number>,
    /// Peak and width as the samples show them where residuals are correlated; each stderr is the part of the error above that their difference makes.
    from_data: Option<FromData>,
    reflectance: Number,
    /// Null where the reflectance is not determined.
    energy_conserved: Option<bool>,
}

#[derive(Serialize)]
struct FromData {
    peak_brdf_per_sr: Number,
    width_deg: Option<Number>,
}

#[derive(Serialize)]
struct Number {
    /// Null where it is not determined.
    value: Option<f64>,
    stderr: f64,
}

/// The uncertainty of one fit.
pub fn known(outcome: &Outcome, derived: &[Derived]) -> Known {
    let (material, known) = (&outcome.material(), &outcome.uncertainty);
    let model = material.model;
    let on_bound = (0..model.parameters.len()).filter_map(|k| {
        let bound = match known.places[k]? {
            Place::Lower => "lower",
            Place::Upper => "upper",
            _ => return None,
        };
        let (parameter, push) = (model.parameters[k].name, known.push[k]);
        Some(OnBound { parameter, bound, push })
    });
    let open = undetermined(material, known, derived).into_iter().map(|what| Open {
        sentence: sentence(&what),
        through: what.through.iter().map(|&(product, _)| product).collect(),
        parameters: what.parameters,
    });
    let has = |k: usize, place: Place| known.places[k] == Some(place);
    Known {
        residual_scale: known.scale,
        degrees_of_freedom: known.degrees_of_freedom,
        effective_degrees_of_freedom: known.effective,
        coverage_factor_95: coverage_factor(known),
        correlated: known.misfit.as_ref().map(Correlated::from),
        lobe_from_data: from_data(derived),
        condition: known.condition,
        stderr: ByName::new(model, |k| {
            (has(k, Place::Inside) && known.stderr[k].is_finite()).then_some(known.stderr[k])
        }),
        stderr_without_bounds: ByName::new(model, |k| {
            let free = has(k, Place::Inside) || has(k, Place::Lower) || has(k, Place::Upper);
            free.then_some(known.stderr_lifted[k])
        }),
        correlation: ByName::new(model, |i| ByName::new(model, |j| known.correlation[i][j])),
        on_bound: on_bound.collect(),
        not_seen: unseen::names(outcome),
        exact: unseen::without_errors(known),
        undetermined: open.collect(),
    }
}

/// The derived quantities of one angle of incidence.
pub fn at_angle(at: &Derived, known: &Uncertainty) -> AtAngle {
    let number = |value: Value| Number {
        value: determined(value, known),
        stderr: value.stderr,
    };
    let degrees = |width: Value| Number {
        value: determined(width, known).map(f64::to_degrees),
        stderr: width.stderr.to_degrees(),
    };
    AtAngle {
        theta_i_deg: at.theta_i.to_degrees(),
        rho_s_f: at.rho_s_f.map(number),
        rho_v_f: at.rho_v_f.map(number),
        peak_theta_s_deg: at.peak.and_then(|peak| {
            determined(peak.f, known)?;
            Some(peak.theta_s.to_degrees())
        }),
        peak_brdf_per_sr: at.peak.map(|peak| number(peak.f)),
        width_deg: at.peak.and_then(|peak| peak.width).map(degrees),
        from_data: at.peak.and_then(|peak| peak.from_data).map(|read| FromData {
            peak_brdf_per_sr: number(read.f),
            width_deg: read.width.map(degrees),
        }),
        reflectance: number(at.reflectance),
        energy_conserved: at.conserves_energy(known),
    }
}
