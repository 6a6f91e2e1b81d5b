//! A comparison of models as text, JSON and SVG.

use serde_json::json;

use crate::analysis::choose::{Candidate, Choice};
use crate::document;
use crate::engine::Outcome;
use crate::input::Measurement;
use crate::number::four;
use crate::plot;
use crate::result::json::ByName;
use crate::result::json::provenance::provenance;
use crate::result::words;

/// A table for people.
pub fn text(measurement: &Measurement, choice: &Choice) -> String {
    let (least_aicc, least_bic) = (
        choice.least(|one| one.criteria.aicc),
        choice.least(|one| one.criteria.bic),
    );
    let mut lines = vec![
        format!("{}: {} samples", measurement.label(), measurement.samples.len()),
        "  model                   P        MSE^2  rms ln    AICc     BIC  minima  parameters".to_string(),
    ];
    for (place, Candidate { outcome, criteria, .. }) in choice.candidates.iter().enumerate() {
        let values = outcome.model.named(&outcome.params);
        let values: Vec<_> = values.map(|(name, value)| format!("{name} {}", four(value))).collect();
        let mark = if place == choice.place { '*' } else { ' ' };
        lines.push(format!(
            "{mark} {:<22} {:>2} {:>12.4e} {:>7.4} {:>7.1} {:>7.1} {:>7}  {}",
            outcome.model.name,
            criteria.parameters,
            outcome.mse2,
            outcome.rms_ln,
            criteria.aicc - least_aicc,
            criteria.bic - least_bic,
            outcome.minima.len(),
            values.join(", "),
        ));
    }
    lines.push(format!(
        "  AICc and BIC are above their least; * has the least BIC{}; a difference of 10 leaves no doubt.",
        words::among(choice)
    ));
    lines.join("\n") + "\n"
}

/// One object.
pub fn json(measurement: &Measurement, choice: &Choice) -> String {
    let candidates = choice.candidates.iter();
    let models: Vec<_> = candidates
        .map(|one| {
            let (outcome, criteria) = (&one.outcome, &one.criteria);
            let bounds = |place: usize| [one.options.lower[place], one.options.upper[place]];
            json!({
                "model": outcome.model.name,
                "mse2": outcome.mse2,
                "rms_ln": outcome.rms_ln,
                "aicc": criteria.aicc,
                "bic": criteria.bic,
                "minima": outcome.minima.len(),
                "parameters": ByName::new(outcome.model, |place| outcome.params[place]),
                "bounds": ByName::new(outcome.model, bounds),
            })
        })
        .collect();
    let value = json!({
        "scan": measurement.label(),
        "samples": measurement.samples.len(),
        "model": choice.chosen().outcome.model.name,
        "criterion": "bic",
        "seed": choice.chosen().options.seed,
        "starts": choice.chosen().options.starts(),
        "models": models,
        "provenance": provenance(&measurement.about, None),
    });
    document::json(&value)
}

/// The best fit of every model over the data.
pub fn svg(measurement: &Measurement, choice: &Choice) -> String {
    let mut best_first: Vec<&Outcome> = choice.candidates.iter().map(|one| &one.outcome).collect();
    best_first.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let lines: Vec<_> = best_first
        .into_iter()
        .map(|outcome| plot::Overlay {
            label: format!("{}, rms {:.3}", outcome.model.name, outcome.rms_ln),
            ln_f: plot::of(&outcome.material()),
        })
        .collect();
    plot::overlay_svg(&measurement.label(), &plot::Drawn::of_scan(measurement).data(), &lines)
}
