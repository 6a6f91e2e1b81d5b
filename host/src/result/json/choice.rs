//! How the terms were chosen, as a part of the JSON contract.

use serde::Serialize;

use crate::analysis::choose::{Candidate, Choice};
use crate::result::words;
use crate::terms::term_names;

/// How the terms were chosen, for the JSON contract.
#[derive(Serialize)]
pub struct Selection {
    criterion: &'static str,
    sentence: String,
    candidates: Vec<JsonCandidate>,
}

#[derive(Serialize)]
struct JsonCandidate {
    terms: Vec<&'static str>,
    parameters: usize,
    cost: f64,
    aicc: f64,
    bic: f64,
    f_test_p: Option<f64>,
}

/// For the JSON contract.
pub fn selection(choice: &Choice) -> Selection {
    let candidate = |one: &Candidate| JsonCandidate {
        terms: term_names(one.terms),
        parameters: one.parameters,
        cost: one.cost,
        aicc: one.aicc,
        bic: one.bic,
        f_test_p: one.p_value,
    };
    Selection {
        criterion: "bic",
        sentence: words::choice(choice),
        candidates: choice.candidates.iter().map(candidate).collect(),
    }
}
