//! What was read, for people.

use super::{Angle, Inspected};
use crate::input::left_out;
use crate::number::six;
use crate::plain::plain;

/// Columns and angles of incidence that are listed at most.
const LISTED: usize = 24;

/// A page for people.
pub fn text(scans: &[Inspected]) -> String {
    let pages: Vec<String> = scans.iter().map(page).collect();
    pages.join("\n")
}

fn page(scan: &Inspected) -> String {
    let (measurement, about) = (scan.measurement, &scan.measurement.about);
    let mut lines = vec![measurement.label(), format!("  read as    {}", measurement.read_as)];
    for (place, column) in about.columns.iter().take(LISTED).enumerate() {
        let head = if place == 0 { "columns" } else { "" };
        let name = plain(&column.name);
        lines.push(format!("  {head:<10} {:>3} {name:<20} {}", column.number, column.holds));
    }
    if about.columns.len() > LISTED {
        lines.push(format!("  {:<10}     and {} more", "", about.columns.len() - LISTED));
    }
    if !about.unused.is_empty() {
        lines.push(format!("  not used   {}", about.unused()));
    }
    lines.extend(about.notes.iter().map(|note| format!("  note       {note}")));
    lines.push(format!("  samples    {}", measurement.samples.len()));
    lines.extend(scan.angles.iter().take(LISTED).map(angle));
    if scan.angles.len() > LISTED {
        lines.push(format!(
            "    and {} more angles of incidence, in --format json",
            scan.angles.len() - LISTED
        ));
    }
    if let Some(sigma) = measurement.sigma_ln {
        lines.push(format!(
            "  weights    of standard deviations, {:.2} % at a weight of 1",
            100.0 * sigma
        ));
    }
    if let Some(summary) = left_out::summary(&measurement.left_out) {
        lines.push(format!("  left out   {summary}"));
    }
    lines.extend(scan.hints.iter().map(|hint| format!("  hint       {}", hint.text)));
    lines.join("\n") + "\n"
}

fn angle(angle: &Angle) -> String {
    let plane = match angle.delta_phi {
        None => "in plane".to_string(),
        Some((low, high)) => format!(
            "{} in plane, azimuths {} to {} deg",
            angle.in_plane,
            six(low),
            six(high)
        ),
    };
    let brightest = angle
        .brightest
        .map_or(String::new(), |degrees| format!(", brightest at {} deg", six(degrees)));
    format!(
        "    theta_i {:>8} deg: {:>4} samples, {plane}, theta_s {} to {} deg, BRDF {} to {} /sr{brightest}",
        six(angle.theta_i),
        angle.samples,
        six(angle.theta_s.0),
        six(angle.theta_s.1),
        six(angle.brdf.0),
        six(angle.brdf.1),
    )
}
