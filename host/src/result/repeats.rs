//! What `brdfit joint --repeats` writes: runs of one sample and their budget of uncertainty.

use serde::Serialize;

use crate::analysis::fit::FittedScan;
use crate::analysis::repeats::{Budget, LEVEL, Quantity};
use crate::analysis::unseen;
use crate::document;
use crate::engine::FitOptions;
use crate::input::Measurement;
use crate::number::{four, percent, six, two};
use crate::result::beside;
use crate::result::json::provenance::{Provenance, provenance};
use crate::terms::term_names;

/// What came out.
pub struct Found<'a> {
    /// How every run was fitted.
    pub options: &'a FitOptions,
    /// The runs as they were read.
    pub measurements: &'a [Measurement],
    /// Their fits.
    pub fits: &'a [FittedScan],
    /// The relative standard uncertainty of the calibration.
    pub calibration: f64,
    /// What follows from them.
    pub quantities: Vec<Quantity>,
}

/// For people.
pub fn text(found: &Found) -> String {
    let terms = term_names(found.options.terms & found.options.model.terms).join(", ");
    let mut lines = vec![format!(
        "{} runs, each fitted alone with {} {terms}",
        found.fits.len(),
        found.options.model.name
    )];
    for (place, (measurement, fit)) in found.measurements.iter().zip(found.fits).enumerate() {
        lines.push(format!(
            "  run {}  {}: {} samples, rms ln residual {:.4}",
            place + 1,
            measurement.label(),
            fit.outcome.samples,
            fit.outcome.rms_ln
        ));
        let beside = beside::lines(fit).into_iter().chain(beside::robust(&fit.outcome));
        lines.extend(beside.map(|(about, what)| format!("    {about:<8} {what}")));
    }
    lines.push(row([
        "quantity", "mean", "between", "within", "type A", "type B", "combined", "dof", "k", "expanded",
    ]
    .map(String::from)));
    for quantity in &found.quantities {
        lines.push(match &quantity.budget {
            Some(budget) => budgeted(&name(quantity), budget),
            None => format!("  {:<26} not determined in {}", name(quantity), missing(quantity)),
        });
    }
    lines.extend(verdict(found).iter().map(|sentence| format!("  {sentence}")));
    lines.join("\n").trim_end().to_string() + "\n"
}

fn row(cells: [String; 10]) -> String {
    let [quantity, mean, rest @ ..] = cells;
    let rest: String = rest.iter().map(|cell| format!(" {cell:>9}")).collect();
    format!("  {quantity:<26} {mean:>11}{rest}")
}

fn budgeted(name: &str, budget: &Budget) -> String {
    row([
        name.to_string(),
        six(budget.mean),
        two(budget.between),
        match budget.within.is_finite() {
            true => two(budget.within),
            false => "-".into(),
        },
        two(budget.type_a),
        two(budget.type_b),
        two(budget.combined),
        four(budget.degrees_of_freedom),
        four(budget.coverage),
        two(budget.expanded),
    ])
}

/// A quantity with its angle of incidence and unit.
pub fn name(quantity: &Quantity) -> String {
    let unit = if quantity.unit.is_empty() {
        String::new()
    } else {
        format!(", {}", quantity.unit)
    };
    match quantity.theta_i {
        Some(theta_i) => format!("{} at {} deg{unit}", quantity.name, six(theta_i)),
        None => format!("{}{unit}", quantity.name),
    }
}

/// The runs that do not tell a quantity.
pub fn missing(quantity: &Quantity) -> String {
    let all = quantity.runs.iter().enumerate().filter(|(_, run)| run.is_none());
    let all: Vec<String> = all.map(|(place, _)| format!("run {}", place + 1)).collect();
    all.join(", ")
}

/// Sentences on what the table means, and whether the runs agree.
pub fn verdict(found: &Found) -> Vec<String> {
    let budgets = || {
        found
            .quantities
            .iter()
            .filter_map(|one| Some((one, one.budget.as_ref()?)))
    };
    let level = match found.quantities.len() {
        1 => "5 %".to_string(),
        several => format!("5 % for all {several} quantities together"),
    };
    let mut lines = vec![format!(
        "Mean +- expanded holds the value with {:.0} %: k is Student's t for the effective degrees of freedom. Between: standard deviation of the runs; within: of one run by its own residuals.",
        100.0 * LEVEL
    )];
    if found.calibration > 0.0 {
        lines.push(format!(
            "Type B is the calibration, known to {}.",
            percent(found.calibration)
        ));
    }
    let priors = beside::priors(found.options);
    if !priors.is_empty() {
        lines.push(format!(
            "Type B holds what the uncertainty of the priors, which are the same in all runs, makes of each quantity: {priors}."
        ));
    }
    let lobe = found.quantities.iter().find(|one| one.name == "width");
    if lobe
        .and_then(|one| one.budget.as_ref())
        .is_some_and(|budget| budget.type_b > 0.0)
        && found.fits.iter().any(from_data)
    {
        lines.push("Type B of peak and width holds what the lobe that the samples show has of another shape than the model's, which is alike in all runs.".into());
    }
    let more: Vec<String> = budgets()
        .filter(|(_, budget)| budget.differs())
        .map(|(one, budget)| format!("{} ({} times)", name(one), two(budget.between / budget.within)))
        .collect();
    let exact: Vec<String> = (1..)
        .zip(found.fits)
        .filter(|(_, fit)| unseen::without_errors(&fit.outcome.uncertainty))
        .map(|(number, _)| number.to_string())
        .collect();
    if !exact.is_empty() {
        let (runs, have) = match &exact[..] {
            [one] => (format!("The fit of run {one} is exact"), "it has"),
            several => (
                format!("The fits of runs {} are exact", several.join(" and ")),
                "they have",
            ),
        };
        lines.push(format!("{runs}: no residual tells of errors, so that {have} none from within, and nothing tells whether the runs differ by more than that."));
    } else {
        lines.push(if more.is_empty() {
            format!("The runs differ by no more than their own errors (F test, {level}).")
        } else {
            format!(
                "The runs differ by more than their own errors (F test, {level}): {}.",
                more.join(", ")
            )
        });
        lines.extend(disagreement(found));
    }
    let apart: Vec<String> = budgets()
        .filter_map(|(one, budget)| Some(format!("run {} in {}", budget.apart? + 1, name(one))))
        .collect();
    lines.push(match found.fits.len() {
        2 => "Of two runs no test tells which is off.".into(),
        _ if apart.is_empty() => format!("No run stands apart from the others (Grubbs's test, {level})."),
        _ => format!(
            "Stands apart from the others (Grubbs's test, {level}): {}.",
            apart.join(", ")
        ),
    });
    lines
}

/// Does a run count what its samples show of a lobe?
fn from_data(fit: &FittedScan) -> bool {
    let peaks = fit.derived.iter().filter_map(|at| at.peak.as_ref());
    peaks.into_iter().any(|peak| peak.from_data.is_some())
}

/// Which runs do not agree within their expanded errors, and in what: one sentence for each set of runs.
fn disagreement(found: &Found) -> Vec<String> {
    let mut sets: Vec<(&[usize], Vec<String>)> = Vec::new();
    for quantity in found.quantities.iter().filter(|one| !one.disagree.is_empty()) {
        match sets.iter_mut().find(|(runs, _)| *runs == quantity.disagree) {
            Some((_, names)) => names.push(name(quantity)),
            None => sets.push((&quantity.disagree, vec![name(quantity)])),
        }
    }
    if sets.is_empty() {
        return vec!["All runs agree within their own expanded errors.".into()];
    }
    let sentence = |(runs, names): &(&[usize], Vec<String>)| {
        let numbers: Vec<String> = runs.iter().map(|place| (place + 1).to_string()).collect();
        let (who, with) = match runs {
            [_] => ("Run", "the others"),
            _ if runs.len() == found.fits.len() => ("Runs", "each other"),
            _ => ("Runs", "most others"),
        };
        let does = if runs.len() == 1 { "does" } else { "do" };
        format!(
            "{who} {} {does} not agree with {with} within their own expanded errors in {}.",
            numbers.join(" and "),
            names.join(", ")
        )
    };
    sets.iter().map(sentence).collect()
}

#[derive(Serialize)]
struct Document<'a> {
    model: &'static str,
    terms: Vec<&'static str>,
    level: f64,
    calibration: f64,
    runs: Vec<Run<'a>>,
    quantities: Vec<JsonQuantity<'a>>,
}

#[derive(Serialize)]
struct Run<'a> {
    scan: String,
    samples: usize,
    rms_ln: f64,
    /// What theta_s in the file reads too much, degrees, with its standard error; null where none is fitted, or it is not determined.
    offset_deg: Option<f64>,
    offset_stderr_deg: Option<f64>,
    provenance: Provenance<'a>,
}

#[derive(Serialize)]
struct JsonQuantity<'a> {
    name: &'a str,
    unit: &'static str,
    theta_i_deg: Option<f64>,
    /// Null where a run does not tell it.
    values: Vec<Option<f64>>,
    /// From within each run.
    stderr: Vec<Option<f64>>,
    /// Null if a run does not tell it.
    budget: Option<JsonBudget>,
    /// Those that do not agree with most others within their own expanded errors, from 1.
    runs_that_disagree: Vec<usize>,
}

#[derive(Serialize)]
struct JsonBudget {
    mean: f64,
    between: f64,
    within: f64,
    /// Probability of such a spread of this quantity if nothing changed between runs; null where a run is exact and has no errors.
    by_chance: Option<f64>,
    type_a: f64,
    type_b: f64,
    combined: f64,
    effective_degrees_of_freedom: f64,
    coverage_factor: f64,
    expanded: f64,
    /// From 1.
    run_apart: Option<usize>,
}

/// For programs.
pub fn json(found: &Found) -> String {
    let pairs = found.measurements.iter().zip(found.fits);
    let offset = |fit: &FittedScan| {
        let offset = fit.outcome.offset.filter(|offset| offset.stderr.is_finite())?;
        let value = fit.about.counts.of_file(offset.value.to_degrees());
        Some((value, offset.stderr.to_degrees()))
    };
    let runs = pairs.map(|(measurement, fit)| Run {
        offset_deg: offset(fit).map(|offset| offset.0),
        offset_stderr_deg: offset(fit).map(|offset| offset.1),
        scan: measurement.label(),
        samples: fit.outcome.samples,
        rms_ln: fit.outcome.rms_ln,
        provenance: provenance(&measurement.about, Some(found.options)),
    });
    let budget = |budget: &Budget| JsonBudget {
        mean: budget.mean,
        between: budget.between,
        within: budget.within,
        by_chance: budget.within.is_finite().then_some(budget.by_chance),
        type_a: budget.type_a,
        type_b: budget.type_b,
        combined: budget.combined,
        effective_degrees_of_freedom: budget.degrees_of_freedom,
        coverage_factor: budget.coverage,
        expanded: budget.expanded,
        run_apart: budget.apart.map(|place| place + 1),
    };
    let quantities = found.quantities.iter().map(|one| JsonQuantity {
        name: &one.name,
        unit: one.unit,
        theta_i_deg: one.theta_i,
        values: one.runs.iter().map(|run| run.map(|run| run.value)).collect(),
        stderr: one.runs.iter().map(|run| run.map(|run| run.stderr)).collect(),
        budget: one.budget.as_ref().map(budget),
        runs_that_disagree: one.disagree.iter().map(|place| place + 1).collect(),
    });
    document::json(&Document {
        model: found.options.model.name,
        terms: term_names(found.options.terms & found.options.model.terms),
        level: LEVEL,
        calibration: found.calibration,
        runs: runs.collect(),
        quantities: quantities.collect(),
    })
}
