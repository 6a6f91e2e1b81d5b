//! Sentences on a fit.

use crate::analysis::choose::Choice;
use crate::analysis::derived::Value;
use crate::analysis::undetermined::Undetermined;
use crate::number::{four, percent, two};
use crate::terms::term_names;

use brdfit_core::brdf::ALL;

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

/// One sentence on what the scene needs.
pub fn choice(choice: &Choice) -> String {
    let left_out = term_names(ALL & !choice.terms);
    let needs = format!("the scene needs {}", term_names(choice.terms).join(", "));
    match left_out.is_empty() {
        true => needs + ": every term pays",
        false => format!("{needs}; the scan gives no evidence for {}", left_out.join(", ")),
    }
}

/// A value with its standard error, as "0.5123 +- 0.0021".
pub fn shown(value: Value) -> String {
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
