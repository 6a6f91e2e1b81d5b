//! The page on runs of one sample: what each run gives, and the budget of uncertainty over them.

use maud::{Markup, html};

use super::html::{document, minus, model, number, symbol};
use super::provenance;
use crate::analysis::derived::Value;
use crate::analysis::fit::FittedScan;
use crate::analysis::repeats::{Budget, Quantity};
use crate::input::left_out;
use crate::number::{four, percent, two};
use crate::plain::plain;
use crate::result::beside;
use crate::result::repeats::{Found, missing, name, verdict};
use crate::result::words::shown;
use crate::terms::term_names;

/// One file that needs no other; `command` is the line that made it.
pub fn page(found: &Found, command: &str) -> String {
    let title = format!("Budget of uncertainty over {} runs", found.fits.len());
    let lead = html! {
        (model(found.options.model)) ", fitted to ln BRDF of each run alone by brdfit " (env!("CARGO_PKG_VERSION")) "."
    };
    let body = html! {
        ul.summary { @for sentence in verdict(found) { li { (sentence) } } }
        (budgets(found))
        (runs(found))
        (values(found))
        (provenance(found, command))
    };
    document(&title, &lead, &body)
}

/// What a quantity is called.
fn called(quantity: &Quantity) -> Markup {
    match quantity.theta_i {
        None if quantity.unit.is_empty() => symbol(&quantity.name),
        _ => html! { (name(quantity)) },
    }
}

fn budgets(found: &Found) -> Markup {
    let numbers = |budget: &Budget| {
        let steps = [
            budget.between,
            budget.within,
            budget.type_a,
            budget.type_b,
            budget.combined,
        ];
        let rest = [
            four(budget.degrees_of_freedom),
            four(budget.coverage),
            two(budget.expanded),
        ];
        // Runs of exact fits have no errors from within.
        let shown = |x: f64| if x.is_finite() { two(x) } else { "–".into() };
        steps.map(shown).into_iter().chain(rest)
    };
    html! {
        table {
            caption { "The budget (JCGM 100:2008). Between: standard deviation of the runs; within: of one run by its own residuals; type A: standard uncertainty of the mean by the spread of the runs; type B: that of the calibration, of priors, and of what the lobe that the samples show has of another shape than the model's; the expanded uncertainty is k times the combined one, with so many effective degrees of freedom." }
            thead { tr {
                th.text { "quantity" } th { "mean" } th { "between" } th { "within" } th { "type A" } th { "type B" }
                th { "combined" } th { "degrees" } th { i { "k" } } th { "expanded" }
            } }
            tbody {
                @for quantity in &found.quantities { tr {
                    td.text { (called(quantity)) }
                    @match &quantity.budget {
                        Some(budget) => {
                            td { (number(budget.mean)) }
                            @for text in numbers(budget) { td { (text) } }
                        },
                        None => { td.text colspan="9" { "not determined in " (missing(quantity)) } },
                    }
                } }
            }
        }
    }
}

fn runs(found: &Found) -> Markup {
    html! {
        table {
            caption { "The runs." }
            thead { tr { th { "run" } th.text { "scan" } th { "samples" } th { "rms of ln " i { "f" } } th.text { "left out" } th.text { "beside the samples" } } }
            tbody {
                @for (place, (measurement, fit)) in found.measurements.iter().zip(found.fits).enumerate() { tr {
                    td { (place + 1) }
                    td.text { (plain(&measurement.label())) }
                    td { (fit.outcome.samples) }
                    td { (percent(fit.outcome.rms_ln)) }
                    td.text { (left_out::summary(&fit.left_out).unwrap_or_else(|| "–".into())) }
                    td.text { (beside(fit)) }
                } }
            }
        }
    }
}

/// What took part in a run beside its samples.
fn beside(fit: &FittedScan) -> String {
    let lines = beside::lines(fit).into_iter().chain(beside::robust(&fit.outcome));
    let all: Vec<String> = lines
        .map(|(about, what)| minus(&format!("{about}: {what}").replace("+-", "±")))
        .collect();
    if all.is_empty() { "–".into() } else { all.join("; ") }
}

/// What each run gives.
fn values(found: &Found) -> Markup {
    let with_error = |value: Value| minus(&shown(value, false).replace("+-", "±"));
    html! {
        table {
            caption { "What each run gives, with the standard error from within the run." }
            thead { tr {
                th.text { "quantity" }
                @for place in 1..=found.fits.len() { th { "run " (place) } }
            } }
            tbody {
                @for quantity in &found.quantities { tr {
                    td.text { (called(quantity)) }
                    @for run in &quantity.runs { td { (run.map_or_else(|| "–".into(), with_error)) } }
                } }
            }
        }
    }
}

/// What it takes to make this again.
fn provenance(found: &Found, command: &str) -> Markup {
    let options = found.options;
    html! {
        table.provenance {
            caption { "Provenance. The command gives this page again, to the byte." }
            tbody {
                (provenance::origin(command))
                tr { th.text { "terms" } td.text { (term_names(options.terms & options.model.terms).join(", ")) } }
                (provenance::search(options))
            }
            @for measurement in found.measurements { tbody {
                (provenance::sources(&measurement.about.sources))
                tr { th.text { "read as" } td.text { (measurement.read_as) } }
            } }
        }
    }
}
