//! The page itself.

use brdfit_core::uncertainty::Place;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::provenance;
use super::section::{Section, Table};
use crate::analysis::choose::Choice;
use crate::analysis::derived::{Value, determined};
use crate::analysis::misfit::coverage_factor;
use crate::analysis::undetermined::undetermined;
use crate::analysis::unseen;
use crate::engine::{Model, Outcome};
use crate::input::left_out;
use crate::names;
use crate::number::{self, percent, shortest, two};
use crate::plain::plain;
use crate::result::beside;
use crate::result::columns::{Json, of_fits};
use crate::result::words::{self, shown};

const STYLE: &str = include_str!("style.css");

/// Rows of the table of minima at most.
const MINIMA: usize = 12;
/// Rows of the table of angles at most.
const ANGLES: usize = 24;

/// One file that needs no other; `command` is the line that made it.
///
/// ```
/// use brdfit::analysis::choose::Wanted;
/// use brdfit::engine::FitOptions;
/// use brdfit::input::{ReadOptions, parse};
/// use brdfit::page::html::page;
/// use brdfit::page::section::Section;
///
/// let table = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/testdata3_sym_seed1.csv"));
/// let scan = &parse("paint.csv", table, &ReadOptions::default())?[0];
/// let section = Section::new(scan, &Wanted::One(FitOptions::default()), None)?;
/// assert!(page(&[section], "brdfit report paint.csv").starts_with("<!DOCTYPE html>"));
/// # Ok::<(), brdfit::error::Error>(())
/// ```
pub fn page(sections: &[Section], command: &str) -> String {
    let title = match sections {
        [one] => format!("BRDF fit of {}", one.label),
        several => format!("BRDF fits of {} scans", several.len()),
    };
    let lead = html! { (models(sections)) ", fitted to ln BRDF by brdfit " (env!("CARGO_PKG_VERSION")) "." };
    let body = html! {
        @if sections.len() > 1 { (overview(sections)) }
        @for (place, section) in sections.iter().enumerate() { (scan(place, section, sections.len() > 1, command)) }
    };
    document(&title, &lead, &body)
}

/// A whole file of this title, what stands below it, and all else.
pub(super) fn document(title: &str, lead: &Markup, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    h1 { (title) }
                    p { (lead) }
                }
                (body)
            }
        }
    };
    page.into_string() + "\n"
}

/// One row a scan.
fn overview(sections: &[Section]) -> Markup {
    html! {
        table {
            caption { "Best fits." }
            thead { tr {
                th.text { "scan" } th { "samples" }
                @for name in names(sections) { th { (symbol(name)) } }
                th { "rms of ln " i { "f" } }
            } }
            tbody {
                @for (place, section) in sections.iter().enumerate() { tr {
                    @let outcome = &section.fit.outcome;
                    td.text { a href={ "#scan" (place + 1) } { (section.label) } }
                    td { (outcome.samples) }
                    @for name in names(sections) {
                        td { @if let Some(value) = fitted(outcome, name) { (number(value)) } @else { "–" } }
                    }
                    td { (percent(outcome.rms_ln)) }
                } }
            }
        }
    }
}

fn scan(place: usize, section: &Section, heading: bool, command: &str) -> Markup {
    html! {
        section id={ "scan" (place + 1) } {
            @if heading { h2 { (section.label) } }
            (summary(section))
            (parameters(section))
            @if let Some(choice) = &section.fit.choice { (candidates(choice)) }
            @for (number, figure) in section.figures.iter().enumerate() {
                figure {
                    (PreEscaped(inline(&figure.svg, &format!("{}-{}", place + 1, number + 1))))
                    figcaption { b { "Figure " (number + 1) ". " } (figure.caption) }
                }
                @match figure.table {
                    Some(Table::Minima) => (minima(section)),
                    Some(Table::Angles) => (angles(section)),
                    None => {},
                }
            }
            (provenance(section, command))
        }
    }
}

/// What matters most, in sentences.
fn summary(section: &Section) -> Markup {
    let (fit, outcome) = (&section.fit, &section.fit.outcome);
    let known = &outcome.uncertainty;
    html! {
        ul.summary {
            li {
                "The best fit leaves an rms residual of ln " i { "f" } " of " b { (percent(outcome.rms_ln)) }
                " over " (outcome.samples) " samples at " (fit.angles.len())
                @if fit.angles.len() == 1 { " angle" } @else { " angles" } " of incidence (MSE" sup { "2" } " = " (number(outcome.mse2)) "); it " (names::stop_meaning(outcome.stop)) "."
                @if let Some(chi2) = fit.chi2 {
                    " With the standard deviations of the file, χ" sup { "2" } " is " (number(chi2)) " of " (known.degrees_of_freedom) " degrees of freedom."
                }
            }
            @if unseen::without_errors(known) { li.flag { (capital(words::EXACT)) "." } }
            @let unseen = unseen::names(outcome);
            @if !unseen.is_empty() { li.flag { (words::unseen(&unseen)) "." } }
            @if let Some(misfit) = &known.misfit {
                li { (capital(&words::correlated(misfit))) "." }
            }
            @if let Some(sentence) = words::from_data(&fit.derived) { li { (capital(&sentence)) "." } }
            @for open in undetermined(&outcome.material(), known, &fit.derived) {
                li.flag { @if !open.through.is_empty() { "The scan tells of " } (words::sentence(&open)) "." }
            }
            @if fit.derived.iter().any(|at| at.conserves_energy(known) == Some(false)) {
                li.flag { "The reflectance is above 1 at some angle of incidence: there the fitted model does not conserve energy." }
            }
            @if section.missed() {
                li.flag { "A start of the paper's method" @if fit.proof.is_some() { ", or the proof," } " ended below what the search had found; this is the better fit. A larger --starts makes the search more thorough." }
            }
            @if let Some(proof) = &fit.proof { li { "Proved: " (words::proved(proof)) "." } }
            @if let Some(left_out) = left_out::summary(&fit.left_out) {
                li { "Left out: " (left_out) "." }
            }
        }
    }
}

fn parameters(section: &Section) -> Markup {
    let (options, outcome) = (&section.fit.options, &section.fit.outcome);
    let known = &outcome.uncertainty;
    html! {
        table {
            caption {
                "Parameters of the best fit, dimensionless where no unit is given; ± is one standard error"
                @let factor = coverage_factor(known);
                @if factor.is_finite() { ", and a 95 % interval ± " (format!("{factor:.1}")) " of them" }
                "."
            }
            thead { tr { th.text { "parameter" } th.text { "meaning" } th { "value" } th { "±" } th { "bounds" } th.text { "remark" } } }
            tbody {
                @for index in outcome.present() {
                    @let parameter = &outcome.model.parameters[index];
                    tr {
                        td.text { (symbol(parameter.name)) }
                        td.text { (parameter.what) @if !parameter.unit.is_empty() { ", " (parameter.unit) } }
                        td { (number(outcome.params[index])) }
                        td { @if known.places[index] == Some(Place::Inside) && known.stderr[index].is_finite() { (two(known.stderr[index])) } @else { "–" } }
                        td { (shortest(options.lower[index])) " – " (shortest(options.upper[index])) }
                        td.text { (remark(section, index)) }
                    }
                }
            }
        }
        @let strong = correlated(section);
        @if !strong.is_empty() { p.note { "Strongly correlated: " (strong.join("; ")) ". The condition number of J'J is " (two(known.condition)) "." } }
    }
}

/// A sentence with a capital letter.
fn capital(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// What the model or its terms were chosen from.
fn candidates(choice: &Choice) -> Markup {
    let (aicc, bic) = (
        choice.least(|one| one.criteria.aicc),
        choice.least(|one| one.criteria.bic),
    );
    let above = |criterion: f64, least: f64| minus(&format!("{:.1}", criterion - least));
    html! {
        table {
            caption { "What was compared: the fit is that of least BIC" (words::among(choice)) ". AICc and BIC are given above their least; a difference of 10 leaves no doubt." @if let Some(inflation) = choice.inflation { " " (capital(&words::judged(&inflation))) "." } }
            thead { tr { th.text { "candidate" } th { "parameters" } th { "rms of ln " i { "f" } } th { "AICc" } th { "BIC" } } }
            tbody {
                @for (place, one) in choice.candidates.iter().enumerate() { tr {
                    @let name = words::candidate(choice, one);
                    td.text { @if place == choice.place { b { (name) } } @else { (name) } }
                    td { (one.criteria.parameters) } td { (percent(one.outcome.rms_ln)) }
                    td { (above(one.criteria.aicc, aicc)) } td { (above(one.criteria.bic, bic)) }
                } }
            }
        }
    }
}

/// Where a parameter ended, if not inside its bounds, or how well it is known.
fn remark(section: &Section, index: usize) -> String {
    let outcome = &section.fit.outcome;
    let known = &outcome.uncertainty;
    let on = |bound: &str, push: f64| {
        if push.abs() < 0.05 {
            format!("on its {bound} bound, where the data want it")
        } else {
            format!(
                "on its {bound} bound; the data push beyond by {:.1} standard errors",
                push.abs()
            )
        }
    };
    match known.places[index] {
        Some(Place::Lower) => on("lower", known.push[index]),
        Some(Place::Upper) => on("upper", known.push[index]),
        Some(Place::Fixed) => "fixed".into(),
        Some(Place::Unseen) => "not seen by this scan".into(),
        _ => {
            let open = undetermined(&outcome.material(), known, &section.fit.derived);
            let name = outcome.model.parameters[index].name;
            let not = open.iter().any(|open| open.parameters.contains(&name));
            if not { "not determined".into() } else { String::new() }
        }
    }
}

/// Pairs with a correlation of 0.9 and more.
fn correlated(section: &Section) -> Vec<String> {
    let outcome = &section.fit.outcome;
    let (known, count) = (&outcome.uncertainty, outcome.params.len());
    let name = |index: usize| outcome.model.parameters[index].name;
    let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
    pairs
        .map(|(i, j)| (i, j, known.correlation[i][j]))
        .filter(|(.., correlation)| correlation.abs() >= 0.9)
        .map(|(i, j, correlation)| format!("{} and {} {}", name(i), name(j), minus(&format!("{correlation:.3}"))))
        .collect()
}

fn minima(section: &Section) -> Markup {
    let minima = &section.survey.minima;
    let outcome = &section.fit.outcome;
    html! {
        table {
            caption {
                "Distinct minima of " (section.starts) " fits from uniform starts: " (minima.len()) ", improvement potential "
                (format!("{:.2} %", 100.0 * section.survey.improvement_potential)) "."
                @if minima.len() > MINIMA { " The best " (MINIMA) " are listed." }
            }
            thead { tr {
                th { "#" } th { "MSE" sup { "2" } }
                @for index in outcome.present() { th { (symbol(outcome.model.parameters[index].name)) } }
                th { "hits" } th { "first start" }
            } }
            tbody {
                @for (place, minimum) in minima.iter().take(MINIMA).enumerate() { tr {
                    td { (place + 1) } td { (number(minimum.mse2)) }
                    @for index in outcome.present() { td { (number(minimum.params[index])) } }
                    td { (minimum.hits) } td { (minimum.first_start) }
                } }
            }
        }
    }
}

fn angles(section: &Section) -> Markup {
    let fit = &section.fit;
    let known = &fit.outcome.uncertainty;
    let without = unseen::without_errors(known) || known.degrees_of_freedom == 0;
    let with_error = |value| minus(&shown(value, without).replace("+-", "±"));
    html! {
        table {
            caption {
                "At each angle of incidence, with standard errors; peak and width are those of the surface lobe in plane."
                @if fit.derived.len() > ANGLES { " The first " (ANGLES) " of " (fit.derived.len()) " angles are listed." }
            }
            thead { tr {
                th { (symbol("theta_i")) ", deg" } th { (symbol("rho_s")) " F" } th { (symbol("rho_v")) " F" }
                th { "peak, sr" sup { "−1" } } th { "at, deg" } th { "width, deg" } th { "reflectance" }
            } }
            tbody {
                @for at in fit.derived.iter().take(ANGLES) { tr {
                    td { (number(at.theta_i.to_degrees())) }
                    td { (at.rho_s_f.map_or_else(|| "–".into(), with_error)) }
                    td { (at.rho_v_f.map_or_else(|| "–".into(), with_error)) }
                    td { (at.peak.map_or_else(|| "–".into(), |peak| with_error(peak.f))) }
                    td { (at.peak.filter(|peak| determined(peak.f, known).is_some()).map_or_else(|| "–".into(), |peak| format!("{:.2}", peak.theta_s.to_degrees()))) }
                    td { (at.peak.and_then(|peak| peak.width).map_or_else(|| "–".into(), |width| with_error(Value { value: width.value.to_degrees(), stderr: width.stderr.to_degrees() }))) }
                    td { (with_error(at.reflectance)) @if at.conserves_energy(known) == Some(false) { " (above 1)" } }
                } }
            }
        }
    }
}

/// What it takes to make this again, and what came out: every column of the tables of results but the time, which is another each time.
fn provenance(section: &Section, command: &str) -> Markup {
    let (fit, options) = (&section.fit, &section.fit.options);
    let columns = of_fits(&[fit.outcome.model])
        .into_iter()
        .filter(|column| column.json != Json::Time);
    let cells = columns.map(|column| (column.cell(&fit.into()), column));
    let numbers = cells.filter(|(cell, _)| !cell.is_empty());
    html! {
        table.provenance {
            caption { "Provenance and results by their names in CSV and JSON, with all digits. The command gives this page again, to the byte." }
            tbody {
                (provenance::origin(command))
                (provenance::sources(&fit.about.sources))
                tr { th.text { "read as" } td.text { (fit.read_as) } }
                tr { th.text { "left out" } td.text { (left_out::summary(&fit.left_out).unwrap_or_else(|| "nothing".into())) } }
                (provenance::search(options))
                @for (about, what) in beside::lines(fit) { tr { th.text { (about) } td.text { (what) } } }
                @if let Some(choice) = &fit.choice { tr { th.text { "choice" } td.text { (words::choice(choice)) } } }
            }
            tbody {
                @for (cell, column) in numbers { tr {
                    th.text { code { (column.name) } }
                    td.text { code { (plain(&cell.text())) } @if !matches!(column.unit, "" | "1") { " " (column.unit) } ", " (column.about) }
                } }
            }
        }
    }
}

/// The models of the fits, as a clause.
fn models(sections: &[Section]) -> String {
    let mut models: Vec<_> = sections.iter().map(|section| section.fit.outcome.model).collect();
    models.dedup();
    match &models[..] {
        [one] => model(one),
        _ => "Models as each scan needs them".into(),
    }
}

/// A model, as a clause.
pub(super) fn model(model: &Model) -> String {
    match model {
        one if one.is_paper() => {
            "Modified Cook-Torrance model of Bishop, Butler and Marciniak, Opt. Eng. 60(9), 094103 (2021)".into()
        }
        one => format!("Model {} ({}; {})", one.name, one.what, one.source),
    }
}

/// The names of the parameters of all fits, each once.
fn names(sections: &[Section]) -> Vec<&'static str> {
    let models = sections.iter().flat_map(|section| section.fit.outcome.model.parameters);
    let mut names: Vec<&'static str> = Vec::new();
    for parameter in models {
        if !names.contains(&parameter.name) {
            names.push(parameter.name);
        }
    }
    names
}

/// The value of a parameter that was fitted.
fn fitted(outcome: &Outcome, name: &str) -> Option<f64> {
    let place = outcome.model.place(name)?;
    outcome
        .present()
        .any(|index| index == place)
        .then(|| outcome.params[place])
}

/// A name such as rho_s as it is set.
pub(super) fn symbol(name: &str) -> Markup {
    let (letter, index) = name.split_once('_').unwrap_or((name, ""));
    let letter = match letter {
        "rho" => "ρ",
        "theta" => "θ",
        "kappa" => "κ",
        other => other,
    };
    html! { i { (letter) } @if !index.is_empty() { sub { (index) } } }
}

/// Five significant digits, with a power of ten where that is shorter.
pub(super) fn number(value: f64) -> Markup {
    let (mantissa, exponent) = number::set(&number::significant(value, 5));
    html! { (mantissa) @if let Some(exponent) = exponent { " × 10" sup { (exponent) } } }
}

pub(super) fn minus(text: &str) -> String {
    text.replace('-', "−")
}

/// A figure as a part of the page: it needs no name space there, and its clipping has a name of its own.
fn inline(svg: &str, key: &str) -> String {
    svg.replace(" xmlns=\"http://www.w3.org/2000/svg\"", " role=\"img\"")
        .replace("id=\"a\"", &format!("id=\"clip{key}\""))
        .replace("url(#a)", &format!("url(#clip{key})"))
}
