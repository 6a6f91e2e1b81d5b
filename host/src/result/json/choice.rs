//! How the model or its terms were chosen, as a part of the JSON contract.

use serde::Serialize;

use super::by_name::ByName;
use crate::analysis::choose::{Candidate, Choice};
use crate::result::words;
use crate::terms::term_names;

/// How the model or its terms were chosen, for the JSON contract.
#[derive(Serialize)]
pub struct Selection {
    criterion: &'static str,
    /// The angle over which residuals are correlated, by which all are judged; null where they are not.
    correlated_over_deg: Option<f64>,
    /// By how much that raises the variance of parameters, so that so many samples count as one; null where they are not.
    variance_inflation: Option<f64>,
    sentence: String,
    candidates: Vec<JsonCandidate>,
}

#[derive(Serialize)]
struct JsonCandidate {
    model: &'static str,
    terms: Vec<&'static str>,
    /// How many are free.
    parameters: usize,
    values: ByName<f64>,
    cost: f64,
    rms_ln: f64,
    aicc: f64,
    bic: f64,
    f_test_p: Option<f64>,
}

/// For the JSON contract.
pub fn selection(choice: &Choice) -> Selection {
    let candidate = |one: &Candidate| JsonCandidate {
        model: one.options.model.name,
        terms: term_names(one.outcome.terms),
        parameters: one.criteria.parameters,
        values: ByName::new(one.options.model, |place| one.outcome.params[place]),
        cost: one.outcome.cost,
        rms_ln: one.outcome.rms_ln,
        aicc: one.criteria.aicc,
        bic: one.criteria.bic,
        f_test_p: one.p_value,
    };
    Selection {
        criterion: "bic",
        correlated_over_deg: choice.inflation.map(|inflation| inflation.process.length.to_degrees()),
        variance_inflation: choice.inflation.map(|inflation| inflation.factor),
        sentence: words::choice(choice),
        candidates: choice.candidates.iter().map(candidate).collect(),
    }
}
