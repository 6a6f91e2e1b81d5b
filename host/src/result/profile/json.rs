//! Profiles as JSON.

use serde::Serialize;

use crate::analysis::bootstrap::quantile;
use crate::analysis::profile::calibrate::LEVELS;
use crate::analysis::profile::findings::Findings;
use crate::analysis::profile::{self, Interval, Profile};
use crate::analysis::unseen;
use crate::document;
use crate::engine::Outcome;
use crate::result::json::provenance::{Provenance, provenance};
use crate::result::json::{Selection, selection};

#[derive(Serialize)]
struct Document<'a> {
    file: &'a str,
    model: &'static str,
    samples: usize,
    /// Standard deviation of a residual of ln f.
    residual_scale: f64,
    degrees_of_freedom: usize,
    /// Without residuals there are neither errors nor intervals.
    exact: bool,
    /// Sum of squared residuals of the best fit.
    cost: f64,
    /// That of the search, if a profile met a better fit; else null.
    improved_from: Option<f64>,
    selection: Option<Selection>,
    parameters: Vec<Parameter>,
    bootstrap: Option<Bootstrap>,
    /// Copies at each end of an interval whose thresholds are measured; null for those of the F test.
    calibrated: Option<u32>,
    provenance: Provenance<'a>,
}

#[derive(Serialize)]
struct Parameter {
    name: &'static str,
    best: f64,
    /// Null where it is on a bound or not seen.
    stderr: Option<f64>,
    intervals: [Ends; 2],
    points: Vec<At>,
}

#[derive(Serialize)]
struct Ends {
    level: f64,
    /// Null where the fit is exact, as nothing tells an interval.
    low: Option<f64>,
    low_at_bound: bool,
    high: Option<f64>,
    high_at_bound: bool,
}

#[derive(Serialize)]
struct At {
    value: f64,
    /// Sum of squared residuals.
    cost: f64,
    /// Above the best, over the variance of a residual.
    rise: f64,
    /// In the order of the model: rho_d, rho_s, rho_v, m, n, kappa for that of the paper.
    parameters: Vec<f64>,
}

#[derive(Serialize)]
struct Bootstrap {
    copies: usize,
    seed: u64,
    parameters: Vec<Percentiles>,
}

#[derive(Serialize)]
struct Percentiles {
    name: &'static str,
    median: f64,
    intervals: [[f64; 2]; 2],
}

/// One object.
pub fn json(findings: &Findings) -> String {
    let known = &findings.outcome.uncertainty;
    let document = Document {
        file: &findings.name,
        model: findings.outcome.model.name,
        samples: findings.outcome.samples,
        residual_scale: known.scale,
        degrees_of_freedom: known.degrees_of_freedom,
        exact: unseen::without_errors(known),
        cost: findings.outcome.cost,
        improved_from: findings.improved_from,
        selection: findings.choice.as_ref().map(selection),
        parameters: findings
            .profiles
            .iter()
            .map(|profile| parameter(profile, &findings.outcome))
            .collect(),
        provenance: provenance(&findings.about, Some(&findings.options)),
        calibrated: Some(findings.calibrated).filter(|&copies| copies > 0),
        bootstrap: (!findings.copies.is_empty()).then(|| Bootstrap {
            copies: findings.copies.len(),
            seed: findings.options.seed,
            parameters: findings
                .profiles
                .iter()
                .map(|profile| percentiles(findings, profile.index))
                .collect(),
        }),
    };
    document::json(&document)
}

fn parameter(profile: &Profile, outcome: &Outcome) -> Parameter {
    let exact = unseen::without_errors(&outcome.uncertainty);
    let told = |value: f64| (!exact).then_some(value);
    let ends = |interval: Interval| Ends {
        level: interval.level,
        low: told(interval.low.value),
        low_at_bound: interval.low.at_bound,
        high: told(interval.high.value),
        high_at_bound: interval.high.at_bound,
    };
    let points = profile.points.iter().map(|point| At {
        value: point.value,
        cost: point.cost,
        rise: profile.rise(point),
        parameters: point.params.to_vec(),
    });
    Parameter {
        name: outcome.model.parameters[profile.index].name,
        best: profile.best.value,
        stderr: profile::stderr(profile.index, &outcome.uncertainty),
        intervals: profile.intervals.map(ends),
        points: points.collect(),
    }
}

fn percentiles(findings: &Findings, index: usize) -> Percentiles {
    let values: Vec<f64> = findings.copies.iter().map(|params| params[index]).collect();
    Percentiles {
        name: findings.outcome.model.parameters[index].name,
        median: quantile(&values, 0.5),
        intervals: LEVELS.map(|level| [0.5 - 0.5 * level, 0.5 + 0.5 * level].map(|share| quantile(&values, share))),
    }
}
