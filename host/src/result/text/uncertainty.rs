//! Uncertainty and derived quantities for the page of a fit.

use brdfit_core::uncertainty::Place;

use crate::analysis::derived::{Derived, Value, determined};
use crate::analysis::misfit::coverage_factor;
use crate::analysis::undetermined::undetermined;
use crate::analysis::unseen;
use crate::engine::Outcome;
use crate::engine::uncertainty::Uncertainty;
use crate::number::{percent, six, two};
use crate::result::words::{self, EXACT, NOT_DETERMINED, correlated, sentence};

/// Correlations from this on are listed.
const STRONG: f64 = 0.9;
/// Angles of incidence at most.
const LISTED: usize = 12;

/// What stands behind the value of parameter `index`.
pub fn remark(index: usize, known: &Uncertainty) -> String {
    match known.places[index] {
        Some(Place::Inside) if known.stderr[index].is_finite() => format!("  +- {}", two(known.stderr[index])),
        Some(Place::Inside) if !unseen::without_errors(known) && known.degrees_of_freedom > 0 => {
            format!("  {NOT_DETERMINED}")
        }
        Some(Place::Inside) | None => String::new(),
        Some(Place::Lower | Place::Upper) => "  at its bound".into(),
        Some(Place::Fixed) => "  fixed".into(),
        Some(Place::Unseen) => "  not seen by this scan".into(),
    }
}

/// Lines on what is known, what is not, and what follows.
///
/// With weights, the residual is in their unit and no part of f.
pub fn lines(outcome: &Outcome, derived: &[Derived], weighted: bool) -> Vec<String> {
    let (material, known) = (&outcome.material(), &outcome.uncertainty);
    let names: Vec<&str> = material
        .model
        .parameters
        .iter()
        .map(|parameter| parameter.name)
        .collect();
    let mut lines = Vec::new();
    if known.degrees_of_freedom == 0 {
        lines.push("  known      no standard errors: as many parameters as samples".into());
        return lines;
    }
    lines.push(format!(
        "  known      residual {}, {} degrees of freedom, condition {}",
        if weighted {
            two(known.scale) + " of the weights' unit"
        } else {
            percent(known.scale)
        },
        known.degrees_of_freedom,
        two(known.condition)
    ));
    if unseen::without_errors(known) {
        lines.push(format!("    {EXACT}"));
    }
    let unseen = unseen::names(outcome);
    if !unseen.is_empty() {
        lines.push(format!("    {}", words::unseen(&unseen)));
    }
    if let Some(misfit) = &known.misfit {
        lines.push(format!("    {}", correlated(misfit)));
    }
    lines.extend(words::from_data(derived).map(|sentence| format!("    {sentence}")));
    let expanded = coverage_factor(known);
    if (expanded - 2.0).abs() > 0.05 {
        lines.push(format!("    95 % intervals are +- {expanded:.1} of these errors"));
    }
    for what in undetermined(material, known, derived) {
        lines.push(format!("    {}", sentence(&what)));
    }
    for index in 0..names.len() {
        let (side, end) = match known.places[index] {
            Some(Place::Lower) => ("below", "lower"),
            Some(Place::Upper) => ("above", "upper"),
            _ => continue,
        };
        let (name, push) = (names[index], known.push[index].abs());
        lines.push(if push < 0.05 {
            format!("    {name} is on its {end} bound, where the data want it")
        } else {
            format!("    {name} is on its {end} bound; the data push {side} it, by {push:.1} standard errors")
        });
    }
    let inside: Vec<usize> = known.inside().collect();
    let pairs = inside.iter().flat_map(|&i| inside.iter().map(move |&j| (i, j)));
    let strong: Vec<String> = pairs
        .filter(|&(i, j)| i < j && known.correlation[i][j].abs() >= STRONG)
        .map(|(i, j)| format!("{} and {} {:.3}", names[i], names[j], known.correlation[i][j]))
        .collect();
    if !strong.is_empty() {
        lines.push(format!("    correlated: {}", strong.join(", ")));
    }
    lines.extend(table(derived, known));
    lines
}

/// One row an angle of incidence; of an exact fit without errors.
fn table(derived: &[Derived], known: &Uncertainty) -> Vec<String> {
    let exact = unseen::without_errors(known);
    let shown = |value: Value| words::shown(value, exact);
    let row = |cells: [String; 6]| {
        let [theta_i, rho_s_f, rho_v_f, peak, width, reflectance] = cells;
        format!("    {theta_i:>7}  {rho_s_f:<19}  {rho_v_f:<19}  {peak:<28}  {width:<15}  {reflectance}")
            .trim_end()
            .to_string()
    };
    let heads = [
        "theta_i",
        "rho_s F",
        "rho_v F",
        "lobe's peak, 1/sr at deg",
        "width, deg",
        "reflectance",
    ];
    let mut lines = vec![row(heads.map(String::from))];
    let none = || "-".to_string();
    for at in derived.iter().take(LISTED) {
        let peak = at.peak.as_ref();
        let width = peak.and_then(|peak| peak.width);
        let degrees = |value: Value| Value {
            value: value.value.to_degrees(),
            stderr: value.stderr.to_degrees(),
        };
        let excess = match at.conserves_energy(known) {
            Some(false) => "  ABOVE 1: energy is not conserved",
            _ => "",
        };
        lines.push(row([
            six(at.theta_i.to_degrees()),
            at.rho_s_f.map_or_else(none, shown),
            at.rho_v_f.map_or_else(none, shown),
            peak.map_or_else(none, |peak| match determined(peak.f, known) {
                Some(_) => format!("{} at {:.2}", shown(peak.f), peak.theta_s.to_degrees()),
                // Where a lobe of unknown height is brightest says nothing.
                None => shown(peak.f),
            }),
            width.map_or_else(none, |width| shown(degrees(width))),
            shown(at.reflectance) + excess,
        ]));
    }
    if derived.len() > LISTED {
        lines.push(format!(
            "    and {} more angles of incidence, in --format json",
            derived.len() - LISTED
        ));
    }
    lines
}
