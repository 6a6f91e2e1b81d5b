//! What a fit found, as text, JSON or CSV.

use std::fmt::Write;
use std::time::Duration;

use brdfit_core::brdf::{NAMES, Params, has};
use brdfit_core::geometry::{Geometry, Sample};
use brdfit_core::lm::Stop;
use serde::Serialize;

use crate::choose::{self, Choice};
use crate::derived::{self, Derived};
use crate::engine::{self, FitOptions, Method, Minimum, Outcome, Precision};
use crate::input::{LeftOut, Measurement, ReadAs, left_out};
use crate::options::term_names;
use crate::output::shortest;
use crate::uncertainty::{json as known_json, text as known_text};

/// One fitted scan.
#[derive(Clone, Debug)]
pub struct Report {
    /// The scan's file.
    pub file: String,
    /// Which scan of the file it is, if that has a name.
    pub scan: Option<String>,
    /// What the numbers of the file were taken for.
    pub read_as: ReadAs,
    /// What was left out of the scan.
    pub left_out: Vec<LeftOut>,
    /// The part of each angle of incidence, in order of that angle.
    pub angles: Vec<AngleOfIncidence>,
    /// What was asked for.
    pub options: FitOptions,
    /// What came out.
    pub outcome: Outcome,
    /// Sum of squared residuals of ln f over their variances, if the file gives standard deviations; that of a right model is near the degrees of freedom.
    pub chi2: Option<f64>,
    /// Why these terms, if the scan chose them.
    pub choice: Option<Choice>,
    /// What follows from it at each angle of incidence.
    pub derived: Vec<Derived>,
    /// Time of the search, without reading the file; none where every run is to give the same bits.
    pub elapsed: Option<Duration>,
}

/// How well the samples of one angle of incidence are fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleOfIncidence {
    /// The angle in radians.
    pub theta_i: f64,
    /// Number of its samples.
    pub samples: usize,
    /// Root of the mean squared residual of ln f, dimensionless.
    pub rms_ln: f64,
}

impl Report {
    /// Puts a report together.
    pub fn new(measurement: &Measurement, options: &FitOptions, outcome: Outcome, elapsed: Duration) -> Self {
        let (samples, left_out) = without_outliers(measurement, &outcome);
        Report {
            file: measurement.file.clone(),
            scan: measurement.name.clone(),
            read_as: measurement.read_as,
            left_out,
            angles: by_angle(&samples, &outcome.params),
            derived: derived::at_each_angle(&samples, &outcome.params, &outcome.uncertainty),
            options: *options,
            chi2: measurement.sigma_ln.map(|sigma| outcome.cost / (sigma * sigma)),
            outcome,
            choice: None,
            elapsed: Some(elapsed),
        }
    }
}

/// The samples that were fitted, and all that was left out.
fn without_outliers(measurement: &Measurement, outcome: &Outcome) -> (Vec<Sample<f64>>, Vec<LeftOut>) {
    let (mut samples, mut left_out) = (measurement.samples.clone(), measurement.left_out.clone());
    if let Some(robust) = &outcome.robust {
        let mut counts = left_out::Counts::default();
        for &outlier in robust.outliers.iter().rev() {
            // Degrees as they stand in the file have few decimals.
            let theta_i = samples.remove(outlier).theta_i.to_degrees();
            counts.add(left_out::Reason::Outlier, (theta_i * 1e9).round() / 1e9);
        }
        left_out.extend(counts.list());
    }
    (samples, left_out)
}

fn by_angle(samples: &[Sample<f64>], params: &Params<f64>) -> Vec<AngleOfIncidence> {
    let mut order: Vec<&Sample<f64>> = samples.iter().collect();
    order.sort_by(|a, b| a.theta_i.total_cmp(&b.theta_i));
    let groups = order.chunk_by(|a, b| a.theta_i == b.theta_i);
    let one = |group: &[&Sample<f64>]| {
        let squares = group.iter().filter_map(|sample| {
            let geometry = Geometry::new(sample.theta_i, sample.theta_s, sample.delta_phi).ok()?;
            let residual = sample.weight * (engine::ln_f(params, &geometry) - brdfit_core::real::Real::ln(sample.brdf));
            Some(residual * residual)
        });
        AngleOfIncidence {
            theta_i: group[0].theta_i,
            samples: group.len(),
            rms_ln: (squares.sum::<f64>() / group.len() as f64).sqrt(),
        }
    };
    groups.map(one).collect()
}

/// `default` or `paper`.
pub fn method_name(method: Method) -> &'static str {
    match method {
        Method::Default => "default",
        Method::Paper => "paper",
    }
}

/// The way a fit ended, as a word of the JSON contract.
pub fn stop_name(stop: Stop) -> &'static str {
    match stop {
        Stop::Cost => "cost",
        Stop::Step => "step",
        Stop::Passes => "passes",
        Stop::NotFinite => "not_finite",
    }
}

pub(crate) fn stop_meaning(stop: Stop) -> &'static str {
    match stop {
        Stop::Cost => "converged: no step promises less",
        Stop::Step => "converged as far as rounding allows",
        Stop::Passes => "NOT converged: all passes were used",
        Stop::NotFinite => "FAILED: the model is not finite at the start",
    }
}

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
    selection: Option<choose::Selection>,
    uncertainty: known_json::Known,
    derived: Vec<known_json::AtAngle>,
    stop: &'a str,
    minima: Vec<JsonMinimum>,
    evaluations: JsonEvaluations,
    #[serde(skip_serializing_if = "Option::is_none")]
    elapsed_s: Option<f64>,
}

#[derive(Serialize)]
struct JsonParameters {
    rho_d: f64,
    rho_s: f64,
    rho_v: f64,
    m: f64,
    n: f64,
    kappa: f64,
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

fn json_report(report: &Report) -> JsonReport<'_> {
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
        method: method_name(report.options.method),
        seed: report.options.seed,
        starts: report.options.starts(),
        terms: term_names(report.options.terms),
        mse2: outcome.mse2,
        rms_ln: outcome.rms_ln,
        chi2: report.chi2,
        robust_scale: outcome.robust.as_ref().map(|robust| robust.scale),
        parameters: json_parameters(&outcome.params),
        at_bound: &outcome.at_bound,
        selection: report.choice.as_ref().map(Choice::selection),
        uncertainty: known_json::known(&outcome.params, &outcome.uncertainty, &report.derived),
        derived: report.derived.iter().map(known_json::at_angle).collect(),
        stop: stop_name(outcome.stop),
        minima: outcome.minima.iter().map(minimum).collect(),
        evaluations: JsonEvaluations {
            cost: outcome.evaluations.cost,
            linearize: outcome.evaluations.linearize,
        },
        elapsed_s: report.elapsed.map(|elapsed| elapsed.as_secs_f64()),
    }
}

/// One object for one scan, an array for several.
pub fn json(reports: &[Report]) -> String {
    let objects: Vec<_> = reports.iter().map(json_report).collect();
    let written = match objects.as_slice() {
        [one] => serde_json::to_string_pretty(one),
        several => serde_json::to_string_pretty(several),
    };
    // Only maps with other keys than strings, and failing writers, can make this fail.
    written.unwrap_or_default() + "\n"
}

/// One row a scan, or with `minima` one row a distinct minimum.
pub fn csv(reports: &[Report], minima: bool) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut head = vec!["file", "scan", "samples", "method", "seed", "starts", "terms"];
    head.extend(["mse2"].iter().chain(&NAMES));
    head.extend(if minima {
        ["minimum", "hits", "first_start"].as_slice()
    } else {
        &["rms_ln", "at_bound", "stop", "minima", "cost", "linearize"]
    });
    let timed = !minima && reports.iter().any(|report| report.elapsed.is_some());
    head.extend(timed.then_some("elapsed_s"));
    // Writing to memory does not fail.
    let _ = writer.write_record(&head);
    for report in reports {
        let outcome = &report.outcome;
        let row = |mse2: f64, params: &Params<f64>| {
            let mut row = vec![
                report.file.clone(),
                report.scan.clone().unwrap_or_default(),
                outcome.samples.to_string(),
                method_name(report.options.method).to_string(),
                report.options.seed.to_string(),
                report.options.starts().to_string(),
                term_names(report.options.terms).join("+"),
                shortest(mse2),
            ];
            row.extend(params.to_array().map(shortest));
            row
        };
        if minima {
            for (place, minimum) in outcome.minima.iter().enumerate() {
                let mut row = row(minimum.mse2, &minimum.params);
                let counts = [place as u64 + 1, u64::from(minimum.hits), minimum.first_start];
                row.extend(counts.map(|count| count.to_string()));
                let _ = writer.write_record(&row);
            }
        } else {
            let mut row = row(outcome.mse2, &outcome.params);
            row.extend([
                shortest(outcome.rms_ln),
                outcome.at_bound.join("+"),
                stop_name(outcome.stop).to_string(),
                outcome.minima.len().to_string(),
                outcome.evaluations.cost.to_string(),
                outcome.evaluations.linearize.to_string(),
            ]);
            if timed {
                row.push(
                    report
                        .elapsed
                        .map_or(String::new(), |elapsed| shortest(elapsed.as_secs_f64())),
                );
            }
            let _ = writer.write_record(&row);
        }
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// A page for people.
pub fn text(reports: &[Report], minima: bool) -> String {
    let pages: Vec<String> = reports.iter().map(|report| page(report, minima)).collect();
    pages.join("\n")
}

fn page(report: &Report, minima: bool) -> String {
    let (outcome, options) = (&report.outcome, &report.options);
    let mut page = String::new();
    let mut line = |text: String| page.push_str(&(text + "\n"));
    line(match &report.scan {
        Some(scan) => format!("{} [{scan}]", report.file),
        None => report.file.clone(),
    });
    line(format!("  read as    {}", report.read_as));
    line(format!("  samples    {}{}", outcome.samples, angles(&report.angles)));
    if let Some(summary) = left_out::summary(&report.left_out) {
        line(format!("  left out   {summary}"));
    }
    line(format!(
        "  search     {} of {} starts, seed {}, {}",
        method_name(options.method),
        options.starts(),
        options.seed,
        match options.precision {
            Precision::F64 => "f64",
            Precision::F32 => "f32",
        },
    ));
    line(format!("  terms      {}", term_names(options.terms).join(", ")));
    for (index, value) in outcome.params.to_array().into_iter().enumerate() {
        if has(options.terms, index) {
            let remark = known_text::remark(index, &outcome.uncertainty);
            line(format!("    {:<8} {:>13}{remark}", NAMES[index], digits(value)));
        }
    }
    line(format!("  MSE^2      {}", digits(outcome.mse2)));
    line(format!(
        "  rms ln f   {} ({:.2} %)",
        digits(outcome.rms_ln),
        outcome.rms_ln * 100.0
    ));
    if let Some(chi2) = report.chi2 {
        let degrees = outcome.uncertainty.degrees_of_freedom;
        line(format!("  chi^2      {} of {degrees} degrees of freedom", digits(chi2)));
    }
    if let Some(robust) = &outcome.robust {
        line(format!(
            "  robust     standard deviation {} of ln f; what is beyond 6 of them is left out",
            digits(robust.scale)
        ));
    }
    line(format!(
        "  minima     {} distinct, improvement potential {:.1} %",
        outcome.minima.len(),
        outcome.improvement_potential * 100.0
    ));
    line(format!(
        "  stop       {} ({})",
        stop_name(outcome.stop),
        stop_meaning(outcome.stop)
    ));
    line(format!(
        "  passes     {} with derivatives, {} without",
        outcome.evaluations.linearize, outcome.evaluations.cost
    ));
    if let Some(elapsed) = report.elapsed {
        line(format!("  time       {:.4} s", elapsed.as_secs_f64()));
    }
    for choice in report.choice.iter().flat_map(Choice::lines) {
        line(choice);
    }
    let weighted = report.read_as.weighted;
    for known in known_text::lines(&outcome.params, &outcome.uncertainty, &report.derived, weighted) {
        line(known);
    }
    if minima {
        page += &minima_table(&outcome.minima);
    }
    page
}

/// The angles of incidence, with their rms where there are several.
fn angles(angles: &[AngleOfIncidence]) -> String {
    const LISTED: usize = 12;
    let degrees = |angle: &AngleOfIncidence| digits(angle.theta_i.to_degrees());
    match angles {
        [] => String::new(),
        [one] => format!(" at theta_i = {} deg", degrees(one)),
        [first, .., last] if angles.len() > LISTED => format!(
            " at {} angles of incidence from {} to {} deg",
            angles.len(),
            degrees(first),
            degrees(last)
        ),
        several => several.iter().fold(String::new(), |mut list, angle| {
            let _ = write!(
                list,
                "\n    theta_i {:>8} deg: {:>4} samples, rms ln f {}",
                degrees(angle),
                angle.samples,
                digits(angle.rms_ln)
            );
            list
        }),
    }
}

fn minima_table(minima: &[Minimum]) -> String {
    let mut table = format!("\n  {:>3} {:>12}", "#", "MSE^2");
    for name in NAMES {
        let _ = write!(table, " {name:>12}");
    }
    table += "  hits  first start\n";
    for (place, minimum) in minima.iter().enumerate() {
        let _ = write!(table, "  {:>3} {:>12}", place + 1, digits(minimum.mse2));
        for value in minimum.params.to_array() {
            let _ = write!(table, " {:>12}", digits(value));
        }
        let _ = writeln!(table, " {:>5} {:>12}", minimum.hits, minimum.first_start);
    }
    table
}

/// Six significant digits, for reading.
pub(crate) fn digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    if rounded == 0.0 || (1e-3..1e6).contains(&rounded.abs()) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}
