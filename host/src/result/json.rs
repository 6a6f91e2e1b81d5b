//! Reports for programs: one object a scan.

mod by_name;
mod choice;
mod uncertainty;

use serde::Serialize;

use crate::analysis::fit::FittedScan;
use crate::engine::{Minimum, Values};
use crate::input::{LeftOut, ReadAs};
use crate::names;
use crate::output;
use crate::terms::term_names;
pub use by_name::ByName;
use choice::{Selection, selection};
use uncertainty::{AtAngle, Known, at_angle, known};

#[derive(Serialize)]
struct JsonReport<'a> {
    file: &'a str,
    scan: Option<&'a str>,
    input: ReadAs,
    left_out: &'a [LeftOut],
    samples: usize,
    method: &'a str,
    seed: u64,
    starts: u32,
    model: &'a str,
    terms: Vec<&'a str>,
    mse2: f64,
    rms_ln: f64,
    /// Of the standard deviations in the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    chi2: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    robust_scale: Option<f64>,
    parameters: ByName<f64>,
    at_bound: &'a [&'a str],
    selection: Option<Selection>,
    uncertainty: Known,
    derived: Vec<AtAngle>,
    stop: &'a str,
    minima: Vec<JsonMinimum>,
    evaluations: JsonEvaluations,
    #[serde(skip_serializing_if = "Option::is_none")]
    elapsed_s: Option<f64>,
}

#[derive(Serialize)]
struct JsonMinimum {
    mse2: f64,
    parameters: ByName<f64>,
    hits: u32,
    first_start: u64,
}

#[derive(Serialize)]
struct JsonEvaluations {
    cost: u32,
    linearize: u32,
}

fn json_report(report: &FittedScan) -> JsonReport<'_> {
    let outcome = &report.outcome;
    let parameters = |values: &Values| ByName::new(outcome.model, |place| values[place]);
    let minimum = |minimum: &Minimum| JsonMinimum {
        mse2: minimum.mse2,
        parameters: parameters(&minimum.params),
        hits: minimum.hits,
        first_start: minimum.first_start,
    };
    JsonReport {
        file: &report.file,
        scan: report.scan.as_deref(),
        input: report.read_as,
        left_out: &report.left_out,
        samples: outcome.samples,
        method: names::method(report.options.method),
        seed: report.options.seed,
        starts: report.options.starts(),
        model: outcome.model.name,
        terms: term_names(outcome.terms),
        mse2: outcome.mse2,
        rms_ln: outcome.rms_ln,
        chi2: report.chi2,
        robust_scale: outcome.robust.as_ref().map(|robust| robust.scale),
        parameters: parameters(&outcome.params),
        at_bound: &outcome.at_bound,
        selection: report.choice.as_ref().map(selection),
        uncertainty: known(&outcome.material(), &outcome.uncertainty, &report.derived),
        derived: report.derived.iter().map(at_angle).collect(),
        stop: names::stop(outcome.stop),
        minima: outcome.minima.iter().map(minimum).collect(),
        evaluations: JsonEvaluations {
            cost: outcome.evaluations.cost,
            linearize: outcome.evaluations.linearize,
        },
        elapsed_s: report.elapsed.map(|elapsed| elapsed.as_secs_f64()),
    }
}

/// One object for one scan, an array for several.
pub fn json(reports: &[FittedScan]) -> String {
    let objects: Vec<_> = reports.iter().map(json_report).collect();
    match objects.as_slice() {
        [one] => output::json(one),
        several => output::json(&several),
    }
}
