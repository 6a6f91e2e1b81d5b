//! How the terms were chosen, for the page of a fit.

use crate::analysis::choose::{Candidate, Choice};
use crate::number::two;
use crate::result::words;
use crate::terms::term_names;

/// The table for the page of a fit.
pub fn lines(choice: &Choice) -> Vec<String> {
    let least = |of: fn(&Candidate) -> f64| choice.candidates.iter().map(of).fold(f64::INFINITY, f64::min);
    let (aicc, bic) = (least(|one| one.aicc), least(|one| one.bic));
    let mut lines = vec![
        format!("  choice     {}", words::choice(choice)),
        "    terms                                   P  sum of squares   AICc    BIC  F test".into(),
    ];
    lines.extend(choice.candidates.iter().map(|one| {
        let names = term_names(one.terms).join(", ");
        let test = one.p_value.map_or_else(String::new, |p| format!("p = {}", two(p)));
        let (aicc, bic) = (one.aicc - aicc, one.bic - bic);
        let mark = if one.terms == choice.terms { '*' } else { ' ' };
        let cost = format!("{:.4e}", one.cost);
        format!(
            "  {mark} {names:<38} {:>2} {cost:>15} {aicc:>6.1} {bic:>6.1}  {test}",
            one.parameters
        )
        .trim_end()
        .to_string()
    }));
    lines.push(
        "    AICc and BIC above their least; * has the least BIC; F test against the set without the last term".into(),
    );
    lines
}
