//! A study of convergence as text, JSON, CSV and SVG.

use std::fmt::Write;

use serde::Serialize;

use crate::analysis::converge::{Band, METHODS, MethodStudy, Point, REPEATS, Reached, ScanStudy, WITHIN};
use crate::document::{self, write_row};
use crate::engine::{Method, Precision};
use crate::number::shortest;
use crate::plot;
use crate::result::json::provenance::Provenance;

#[derive(Serialize)]
struct Document<'a> {
    seeds: u32,
    scans: &'a [ScanStudy],
    #[serde(skip_serializing_if = "Option::is_none")]
    provenance: Option<Provenance<'a>>,
}

/// One object with everything, and where the scan is from if it was read.
pub fn json(scans: &[ScanStudy], seeds: u32, provenance: Option<Provenance>) -> String {
    document::json(&Document {
        seeds,
        scans,
        provenance,
    })
}

/// One row a point of the grid and quantity; a cell is empty where too few runs have begun.
pub fn csv(scans: &[ScanStudy]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut row = |cells: [&str; 9]| {
        // A Vec takes all.
        let _ = write_row(&mut writer, &cells);
    };
    row([
        "scan",
        "method",
        "precision",
        "axis",
        "at",
        "quantity",
        "p10",
        "median",
        "p90",
    ]);
    for scan in scans {
        for method in &scan.methods {
            for (axis, points) in [("passes", &method.by_passes), ("seconds", &method.by_time)] {
                for point in points {
                    for (quantity, band) in quantities(point) {
                        let [p10, median, p90] = [band.p10, band.median, band.p90].map(cell);
                        let at = shortest(point.at);
                        let (name, precision) = (scan.name.as_str(), method.precision);
                        row([name, method.method, precision, axis, &at, quantity, &p10, &median, &p90]);
                    }
                }
            }
        }
    }
    let bytes = writer.into_inner().unwrap_or_default();
    String::from_utf8_lossy(&bytes).into_owned()
}

fn quantities(point: &Point) -> impl Iterator<Item = (&'static str, Band)> {
    let known = [("rho_d", point.rho_d), ("m", point.m), ("curve", point.curve)];
    let known = known
        .into_iter()
        .filter_map(|(name, band)| band.map(|band| (name, band)));
    std::iter::once(("excess", point.excess)).chain(known)
}

fn cell(value: f64) -> String {
    if value.is_finite() {
        shortest(value)
    } else {
        String::new()
    }
}

/// A table for each scan: when each method was how near.
pub fn text(scans: &[ScanStudy], seeds: u32) -> String {
    let mut out = String::new();
    for (place, scan) in scans.iter().enumerate() {
        if place > 0 {
            out.push('\n');
        }
        // Writing to a String cannot fail.
        let _ = writeln!(
            out,
            "{}: {} samples, least MSE^2 {:.6e}; medians of {seeds} {}, one thread, fastest of {REPEATS} runs",
            scan.name,
            scan.samples,
            scan.best_mse2,
            if seeds == 1 { "seed" } else { "seeds" }
        );
        let _ = write!(out, "{:12} {:>18}", "", "whole search");
        for within in WITHIN {
            let _ = write!(out, "  {:>22}", format!("excess {}", shortest(within)));
        }
        let _ = write!(out, "\n{:12} {:>8} {:>9}", "", "passes", "ms");
        for _ in WITHIN {
            let _ = write!(out, "  {:>5} {:>7} {:>8}", "seeds", "passes", "ms");
        }
        out.push('\n');
        for method in &scan.methods {
            line(&mut out, method);
        }
        if scan.truth.is_some() {
            errors(&mut out, &scan.methods);
        }
    }
    out
}

fn line(out: &mut String, method: &MethodStudy) {
    let all = method.linearize + 0.5 * method.cost;
    let name = format!("{} {}", method.method, method.precision);
    let _ = write!(out, "{name:12} {all:>8.0} {:>9.3}", 1e3 * method.elapsed_s);
    for &Reached {
        share,
        passes,
        elapsed_s,
        ..
    } in &method.reached
    {
        let _ = write!(out, "  {:>4.0}%", 100.0 * share);
        if passes.is_finite() {
            let _ = write!(out, " {passes:>7.1} {:>8.3}", 1e3 * elapsed_s);
        } else {
            let _ = write!(out, " {:>7} {:>8}", "-", "-");
        }
    }
    out.push('\n');
}

/// The errors at the end of the search.
fn errors(out: &mut String, methods: &[MethodStudy]) {
    let _ = writeln!(
        out,
        "{:12} {:>18}  {:>22}  {:>22}",
        "at the end", "rho_d (relative)", "m (relative)", "curve (rms of ln f)"
    );
    for method in methods {
        let name = format!("{} {}", method.method, method.precision);
        let last = method.by_passes.last();
        let of = |band: Option<Band>| band.map_or_else(String::new, |band| format!("{:.2e}", band.median));
        let [rho_d, m, curve] = [
            of(last.and_then(|p| p.rho_d)),
            of(last.and_then(|p| p.m)),
            of(last.and_then(|p| p.curve)),
        ];
        let _ = writeln!(out, "{name:12} {rho_d:>18}  {m:>22}  {curve:>22}");
    }
}

/// Excess cost over run time.
pub fn svg(studies: &[ScanStudy], seeds: u32) -> String {
    plot::converge_svg(&panels(studies), seeds)
}

/// One panel a scan: colours are those of the methods, and single precision has dashes.
fn panels(studies: &[ScanStudy]) -> Vec<plot::ConvergePanel> {
    let line = |method: &MethodStudy, &(by, precision): &(Method, Precision)| plot::ConvergeLine {
        label: format!("{} {}", method.method, method.precision),
        colour: usize::from(by == Method::Paper),
        dashed: precision == Precision::F32,
        points: method
            .by_time
            .iter()
            .map(|point| (point.at, [point.excess.p10, point.excess.median, point.excess.p90]))
            .collect(),
    };
    let panel = |scan: &ScanStudy| plot::ConvergePanel {
        title: scan.name.clone(),
        lines: scan
            .methods
            .iter()
            .zip(&METHODS)
            .map(|(study, method)| line(study, method))
            .collect(),
    };
    studies.iter().map(panel).collect()
}
