//! Reports as a table.

use brdfit_core::brdf::{NAMES, Params};

use crate::analysis::fit::FittedScan;
use crate::names;
use crate::output::shortest;
use crate::terms::term_names;

/// One row a scan, or with `minima` one row a distinct minimum.
pub fn csv(reports: &[FittedScan], minima: bool) -> String {
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
                names::method(report.options.method).to_string(),
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
            let _ = writer.write_record(&row);
        }
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}
