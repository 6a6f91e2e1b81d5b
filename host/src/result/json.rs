//! Reports for programs: one object a scan.

mod choice;
mod uncertainty;

use brdfit_core::brdf::Params;
use serde::{Deserialize, Serialize};

use crate::analysis::fit::FittedScan;
use crate::engine::Minimum;
use crate::input::{LeftOut, ReadAs};
use crate::names;
use crate::terms::term_names;
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
    terms: Vec<&'a str>,
    mse2: f64,
    rms_ln: f64,
    /// Of the standard deviations in the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    chi2: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    robust_scale: Option<f64>,
    parameters: JsonParameters,
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

/// The six parameters by name.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct JsonParameters {
    rho_d: f64,
    rho_s: f64,
    rho_v: f64,
    m: f64,
    n: f64,
    kappa: f64,
}

impl From<JsonParameters> for Params<f64> {
    fn from(p: JsonParameters) -> Self {
        Params::from_array([p.rho_d, p.rho_s, p.rho_v, p.m, p.n, p.kappa])
    }
}

#[derive(Serialize)]
struct JsonMinimum {
    mse2: f64,
    parameters: JsonParameters,
    hits: u32,
    first_start: u64,
}

#[derive(Serialize)]
struct JsonEvaluations {
    cost: u32,
    linearize: u32,
}

fn json_parameters(params: &Params<f64>) -> JsonParameters {
    let [rho_d, rho_s, rho_v, m, n, kappa] = params.to_array();
    JsonParameters {
        rho_d,
        rho_s,
        rho_v,
        m,
        n,
        kappa,
    }
}

fn json_report(report: &FittedScan) -> JsonReport<'_> {
    let outcome = &report.outcome;
    let minimum = |minimum: &Minimum| JsonMinimum {
        mse2: minimum.mse2,
        parameters: json_parameters(&minimum.params),
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
        terms: term_names(report.options.terms),
        mse2: outcome.mse2,
        rms_ln: outcome.rms_ln,
        chi2: report.chi2,
        robust_scale: outcome.robust.as_ref().map(|robust| robust.scale),
        parameters: json_parameters(&outcome.params),
        at_bound: &outcome.at_bound,
        selection: report.choice.as_ref().map(selection),
        uncertainty: known(&outcome.params, &outcome.uncertainty, &report.derived),
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
    let written = match objects.as_slice() {
        [one] => serde_json::to_string_pretty(one),
        several => serde_json::to_string_pretty(several),
    };
    // Only maps with other keys than strings, and failing writers, can make this fail.
    written.unwrap_or_default() + "\n"
}
