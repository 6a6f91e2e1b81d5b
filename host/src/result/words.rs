//! Sentences on a fit.

use crate::analysis::choose::{Candidate, Choice};
use crate::analysis::derived::{Derived, Value};
use crate::analysis::deviations::Verdict;
use crate::analysis::misfit::Inflation;
use crate::analysis::proof::Proof;
use crate::analysis::undetermined::Undetermined;
use crate::engine::uncertainty::Misfit;
use crate::number::{four, percent, percent_up, six, two};
use crate::terms::term_names;

/// One line, such as "rho_s, n and kappa only through rho_s F(theta_d); their product is known to 0.4 %".
pub fn sentence(what: &Undetermined) -> String {
    let names = listed(&what.parameters);
    let verb = if what.parameters.len() == 1 { "is" } else { "are" };
    match &what.through[..] {
        [] => format!("{names} {verb} not determined"),
        [(product, error)] => format!(
            "{names} only through {product}; their product is known to {}",
            percent(*error)
        ),
        several => {
            let products: Vec<&str> = several.iter().map(|&(product, _)| product).collect();
            let errors: Vec<String> = several.iter().map(|&(_, error)| percent(error)).collect();
            let errors: Vec<&str> = errors.iter().map(String::as_str).collect();
            format!(
                "{names} only through {}; these products are known to {}",
                listed(&products),
                listed(&errors)
            )
        }
    }
}

/// What is said of lobes that no sample sees.
pub fn unseen(names: &[&str]) -> String {
    let verb = if names.len() == 1 { "is" } else { "are" };
    format!(
        "{} {verb} not seen by this scan, and left out of all that follows",
        listed(names)
    )
}

/// What became of the standard deviations of a file, behind its chi^2.
pub fn deviations(verdict: Verdict) -> String {
    match verdict {
        Verdict::Used => ": errors are those of the file's standard deviations".into(),
        Verdict::Absolute(ratio) => format!(
            ": errors are those of the file's standard deviations, as asked; residuals are {} times these",
            two(ratio)
        ),
        Verdict::Exact => ": the residuals are rounding, which tells nothing of the file's standard deviations".into(),
        Verdict::Refuted(ratio) => format!(
            ": that refutes the file's standard deviations, and errors are {} times theirs",
            two(ratio)
        ),
    }
}

/// What is said of a fit without residuals.
pub const EXACT: &str = "the fit is exact: no residual tells of errors, and so nothing has a standard error";

/// How far residuals are correlated and what it does to errors, such as "residuals are correlated over 14 deg: errors are 2.0 to 4.1 times those of independent ones"; they are called so where independence is refuted, which is wrong of one in twenty scans with independent errors at most.
pub fn correlated(misfit: &Misfit) -> String {
    let (least, most) = misfit.factor;
    let times = match (factor(least), factor(most)) {
        (least, most) if least == most => most,
        (least, most) => format!("{least} to {most}"),
    };
    let over = two(misfit.length.to_degrees());
    match misfit.sure {
        true => format!("residuals are correlated over {over} deg: errors are {times} times those of independent ones"),
        false => format!(
            "residuals may be independent, or correlated over {over} deg: errors count both, and are {times} times those of independent ones"
        ),
    }
}

/// By how much the lobe that the samples show differs from that of the model, such as "read from the data, the lobe is 12 % wider at 45 deg, and its peak 8.1 % lower at 60 deg: that is in the errors of both", each at the angle of incidence where it is largest; none where it adds little to the errors.
pub fn from_data(derived: &[Derived]) -> Option<String> {
    /// A difference that makes less than this part of an error is not told.
    const PART: f64 = 0.5;
    let largest = |of: fn(&Derived) -> Option<(Value, Value)>, more: &str, less: &str| {
        let one = |at: &Derived| {
            let (model, read) = of(at)?;
            let part = read.value / model.value - 1.0;
            (read.stderr >= PART * model.stderr).then_some((at.theta_i, part))
        };
        let most = derived
            .iter()
            .filter_map(one)
            .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        most.map(|(theta_i, part)| {
            let than = if part > 0.0 { more } else { less };
            format!("{} {than} at {} deg", percent(part.abs()), six(theta_i.to_degrees()))
        })
    };
    let width = |at: &Derived| {
        let peak = at.peak?;
        peak.width.zip(peak.from_data?.width)
    };
    let peak = |at: &Derived| Some((at.peak?.f, at.peak?.from_data?.f));
    let (width, peak) = (largest(width, "wider", "narrower"), largest(peak, "higher", "lower"));
    let what = match (width, peak) {
        (None, None) => return None,
        (Some(width), None) => format!("lobe is {width}: that is in the error of its width"),
        (None, Some(peak)) => format!("lobe's peak is {peak}: that is in its error"),
        (Some(width), Some(peak)) => format!("lobe is {width}, and its peak {peak}: that is in the errors of both"),
    };
    Some(format!("read from the data, the {what}"))
}

/// By what correlation the candidates of a choice are judged.
pub fn judged(inflation: &Inflation) -> String {
    format!(
        "residuals are correlated over {} deg: the criteria count {} samples as one",
        two(inflation.process.length.to_degrees()),
        factor(inflation.factor)
    )
}

fn factor(factor: f64) -> String {
    format!("{factor:.1}")
}

/// Of which candidates the chosen one has the least BIC, if not of all; to be put behind "the least BIC".
pub fn among(choice: &Choice) -> &'static str {
    let saturated = choice.candidates.iter().any(|one| one.criteria.saturated);
    if saturated && !choice.chosen().criteria.saturated {
        " of those with at least three samples more than parameters"
    } else {
        ""
    }
}

/// One sentence on what the scene needs.
pub fn choice(choice: &Choice) -> String {
    let (model, terms) = (choice.chosen().options.model, choice.chosen().options.terms);
    let mut parts = Vec::new();
    let models = choice.models().len();
    if models > 1 {
        let others = choice.candidates.iter().filter(|one| one.options.model != model);
        let next = others.filter(|other| !other.criteria.saturated);
        let next = next.min_by(|a, b| a.criteria.order(&b.criteria));
        let next = next.map_or_else(String::new, |next| {
            let above = next.criteria.bic - choice.chosen().criteria.bic;
            format!("; that of {}, the next, is {above:.1} above", next.options.model.name)
        });
        let among = among(choice);
        parts.push(format!(
            "of {models} models {} has the least BIC{among}{next}",
            model.name
        ));
    }
    if choice.chose_terms(model) || models == 1 {
        let left_out = term_names(model.terms & !terms);
        let needs = format!("the scene needs {}", term_names(terms).join(", "));
        parts.push(match left_out.is_empty() {
            true => needs + ": every term pays",
            false => {
                let (they, are) = if left_out.len() == 1 {
                    ("it", "is")
                } else {
                    ("they", "are")
                };
                let names = left_out.join(", ");
                format!(
                    "{needs}; the scan gives no evidence for {names}, and values and errors hold if {they} {are} absent"
                )
            }
        });
    }
    parts.join("; ")
}

/// What is proved of the fit, and with how much work.
pub fn proved(proof: &Proof) -> String {
    let time = proof.elapsed.map(|time| format!(", {:.1} s", time.as_secs_f64()));
    let work = format!("{} boxes{}", proof.boxes, time.unwrap_or_default());
    let better = match proof.better {
        true => "; the search had missed this better minimum",
        false => "",
    };
    match proof.within() {
        Some(eps) => {
            let eps = percent_up(eps);
            let so_far = match proof.complete {
                true => String::new(),
                false => format!(" so far, of {} asked for", percent(proof.asked)),
            };
            format!(
                "within {eps}{so_far}: no parameters within the bounds have an MSE^2 that is lower by more than {eps} ({work}){better}"
            )
        }
        None if proof.exact => format!("nothing: the fit is exact, its MSE^2 is rounding ({work}){better}"),
        None => format!("nothing so far ({work}){better}"),
    }
}

/// What a candidate is called among the others: its model, its terms, or both.
pub fn candidate(choice: &Choice, one: &Candidate) -> String {
    let (model, terms) = (one.options.model, term_names(one.options.terms).join(", "));
    match (choice.models().len() > 1, choice.chose_terms(model)) {
        (false, _) => terms,
        (true, false) => model.name.to_string(),
        (true, true) => format!("{}: {terms}", model.name),
    }
}

/// What is said of a value whose 95 % interval is the whole range that it can have.
pub const NOT_DETERMINED: &str = "not determined";

/// A value with its standard error, as "0.5123 +- 0.0021"; of an exact fit, which has no errors, the value.
pub fn shown(value: Value, exact: bool) -> String {
    if !value.stderr.is_finite() {
        return if exact {
            four(value.value)
        } else {
            NOT_DETERMINED.into()
        };
    }
    format!("{} +- {}", four(value.value), two(value.stderr))
}

/// "a", "a and b", "a, b and c".
pub fn listed(words: &[&str]) -> String {
    match words {
        [] => String::new(),
        [one] => (*one).to_string(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
