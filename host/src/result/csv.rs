//! Reports as a table.

use crate::analysis::fit::FittedScan;
use crate::engine::Values;
use crate::names;
use crate::output::{shortest, write_row};
use crate::terms::term_names;

/// One row a scan, or with `minima` one row a distinct minimum.
pub fn csv(reports: &[FittedScan], minima: bool) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut head = vec![
        "file", "scan", "samples", "method", "seed", "starts", "model", "terms", "mse2",
    ];
    let names = parameters(reports);
    head.extend(&names);
    head.extend(if minima {
        ["minimum", "hits", "first_start"].as_slice()
    } else {
        &["rms_ln", "at_bound", "stop", "minima", "cost", "linearize"]
    });
    let timed = !minima && reports.iter().any(|report| report.elapsed.is_some());
    head.extend(timed.then_some("elapsed_s"));
    // Writing to memory does not fail.
    let _ = write_row(&mut writer, &head);
    for report in reports {
        let outcome = &report.outcome;
        let row = |mse2: f64, params: &Values| {
            let mut row = vec![
                report.file.clone(),
                report.scan.clone().unwrap_or_default(),
                outcome.samples.to_string(),
                names::method(report.options.method).to_string(),
                report.options.seed.to_string(),
                report.options.starts().to_string(),
                outcome.model.name.to_string(),
                term_names(outcome.terms).join("+"),
                shortest(mse2),
            ];
            row.extend(
                names
                    .iter()
                    .map(|name| outcome.model.value(params, name).map_or(String::new(), shortest)),
            );
            row
        };
        if minima {
            for (place, minimum) in outcome.minima.iter().enumerate() {
                let mut row = row(minimum.mse2, &minimum.params);
                let counts = [place as u64 + 1, u64::from(minimum.hits), minimum.first_start];
                row.extend(counts.map(|count| count.to_string()));
                let _ = write_row(&mut writer, &row);
            }
        } else {
            let mut row = row(outcome.mse2, &outcome.params);
            row.extend([
                shortest(outcome.rms_ln),
                outcome.at_bound.join("+"),
                names::stop(outcome.stop).to_string(),
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
            let _ = write_row(&mut writer, &row);
        }
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// The names of the parameters of all models, each once.
fn parameters(reports: &[FittedScan]) -> Vec<&'static str> {
    let mut names = Vec::new();
    for parameter in reports.iter().flat_map(|report| report.outcome.model.parameters) {
        if !names.contains(&parameter.name) {
            names.push(parameter.name);
        }
    }
    names
}
