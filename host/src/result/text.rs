//! Reports as pages for people.

pub mod choice;
mod uncertainty;

use std::fmt::Write;

use super::beside;
use crate::analysis::fit::{AngleOfIncidence, FittedScan};
use crate::engine::{Minimum, Outcome};
use crate::input::{label, left_out};
use crate::names;
use crate::number::six;
use crate::result::words;
use crate::terms::term_names;

/// A page for people.
pub fn text(reports: &[FittedScan], minima: bool) -> String {
    let pages: Vec<String> = reports.iter().map(|fit| page(fit, minima)).collect();
    pages.join("\n")
}

fn page(fit: &FittedScan, minima: bool) -> String {
    let (outcome, options) = (&fit.outcome, &fit.options);
    let mut page = String::new();
    let mut line = |text: String| page.push_str(&(text + "\n"));
    line(label(&fit.file, fit.scan.as_deref()));
    line(format!("  read as    {}", fit.read_as));
    for note in &fit.about.notes {
        line(format!("  note       {note}"));
    }
    if !fit.about.unused.is_empty() {
        line(format!("  not used   {}", fit.about.unused()));
    }
    line(format!("  samples    {}{}", outcome.samples, angles(&fit.angles)));
    if let Some(summary) = left_out::summary(&fit.left_out) {
        line(format!("  left out   {summary}"));
    }
    line(format!(
        "  search     {} of {} starts, seed {}, {}",
        names::method(options.method),
        options.starts(),
        options.seed,
        names::precision(options.precision),
    ));
    if !outcome.model.is_paper() {
        line(format!("  model      {} ({})", outcome.model.name, outcome.model.what));
    }
    line(match outcome.terms {
        0 => "  parameters".into(),
        terms => format!("  terms      {}", term_names(terms).join(", ")),
    });
    for index in outcome.present() {
        let remark = uncertainty::remark(index, &outcome.uncertainty);
        let parameter = &outcome.model.parameters[index];
        let unit = if parameter.unit.is_empty() {
            String::new()
        } else {
            format!(" {}", parameter.unit)
        };
        let value = six(outcome.params[index]);
        line(format!("    {:<8} {value:>13}{unit}{remark}", parameter.name));
    }
    for (about, what) in beside::lines(fit) {
        line(format!("  {about:<9}  {what}"));
    }
    line(format!("  MSE^2      {}", six(outcome.mse2)));
    line(format!(
        "  rms ln f   {} ({:.2} %)",
        six(outcome.rms_ln),
        outcome.rms_ln * 100.0
    ));
    if let Some(proof) = &fit.proof {
        line(format!("  proved     {}", words::proved(proof)));
    }
    if let Some(chi2) = fit.chi2 {
        let degrees = outcome.uncertainty.degrees_of_freedom;
        let verdict = fit.deviations.map_or_else(String::new, words::deviations);
        line(format!(
            "  chi^2      {} of {degrees} degrees of freedom{verdict}",
            six(chi2)
        ));
    }
    if let Some((about, what)) = beside::robust(outcome) {
        line(format!("  {about:<9}  {what}"));
    }
    line(format!(
        "  minima     {} distinct, improvement potential {:.1} %",
        outcome.minima.len(),
        outcome.improvement_potential * 100.0
    ));
    line(format!(
        "  stop       {} ({})",
        names::stop(outcome.stop),
        names::stop_meaning(outcome.stop)
    ));
    line(format!(
        "  passes     {} with derivatives, {} without",
        outcome.evaluations.linearize, outcome.evaluations.cost
    ));
    if let Some(elapsed) = fit.elapsed {
        line(format!("  time       {:.4} s", elapsed.as_secs_f64()));
    }
    for choice in fit.choice.iter().flat_map(choice::lines) {
        line(choice);
    }
    let weighted = fit.read_as.weighted;
    for known in uncertainty::lines(outcome, &fit.derived, weighted) {
        line(known);
    }
    if fit.left_out_by_auto != 0 {
        let terms = term_names(fit.left_out_by_auto).join(", ");
        line(format!(
            "  evidence   there is none for {terms}: --terms auto leaves that out"
        ));
    }
    for hint in &fit.hints {
        line(format!("  hint       {}", hint.text));
    }
    if minima {
        page += &minima_table(outcome, &outcome.minima);
    }
    page
}

/// The angles of incidence, with their rms where there are several.
fn angles(angles: &[AngleOfIncidence]) -> String {
    const LISTED: usize = 12;
    let degrees = |angle: &AngleOfIncidence| six(angle.theta_i.to_degrees());
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
                six(angle.rms_ln)
            );
            list
        }),
    }
}

fn minima_table(outcome: &Outcome, minima: &[Minimum]) -> String {
    let mut table = format!("\n  {:>3} {:>12}", "#", "MSE^2");
    for parameter in outcome.model.parameters {
        let _ = write!(table, " {:>12}", parameter.name);
    }
    table += "  hits  first start\n";
    for (place, minimum) in minima.iter().enumerate() {
        let _ = write!(table, "  {:>3} {:>12}", place + 1, six(minimum.mse2));
        for &value in minimum.params.iter() {
            let _ = write!(table, " {:>12}", six(value));
        }
        let _ = writeln!(table, " {:>5} {:>12}", minimum.hits, minimum.first_start);
    }
    table
}
