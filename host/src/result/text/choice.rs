//! How the model or its terms were chosen, for the page of a fit.

use crate::analysis::choose::{Candidate, Choice};
use crate::number::two;
use crate::result::words;

/// The table for pages.
pub fn lines(choice: &Choice) -> Vec<String> {
    let (aicc, bic) = (
        choice.least(|one| one.criteria.aicc),
        choice.least(|one| one.criteria.bic),
    );
    let names = choice.candidates.iter().map(|one| words::candidate(choice, one));
    let names: Vec<String> = names.collect();
    let width = names.iter().map(String::len).max().unwrap_or(0).max(22);
    let several = choice.models().len() > 1;
    let tested = choice.candidates.iter().any(|one| one.p_value.is_some());
    let head = if several { "model" } else { "terms" };
    let test = if tested { "  F test" } else { "" };
    let mut lines = vec![
        format!("  choice     {}", words::choice(choice)),
        format!("    {head:<width$}  P  rms ln f    AICc     BIC{test}"),
    ];
    let rows = choice.candidates.iter().zip(names).enumerate();
    lines.extend(rows.map(|(place, (one, name))| {
        let Candidate { outcome, criteria, .. } = one;
        let test = one.p_value.map_or_else(String::new, |p| format!("p = {}", two(p)));
        let (aicc, bic) = (criteria.aicc - aicc, criteria.bic - bic);
        let mark = if place == choice.place { '*' } else { ' ' };
        let line = format!(
            "  {mark} {name:<width$} {:>2}  {:>8.5} {aicc:>7.1} {bic:>7.1}  {test}",
            criteria.parameters, outcome.rms_ln,
        );
        line.trim_end().to_string()
    }));
    let test = if tested {
        "; F test against the set without the last term"
    } else {
        ""
    };
    let among = words::among(choice);
    lines.push(format!(
        "    AICc and BIC above their least; * has the least BIC{among}{test}"
    ));
    if let Some(inflation) = choice.inflation {
        lines.push(format!("    {}", words::judged(&inflation)));
    }
    lines
}
