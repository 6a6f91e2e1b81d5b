//! Excess cost over run time, both logarithmic: a line for the median of each method and a band from 10 to 90 %.

use std::fmt::Write;

use super::axis::Axis;
use super::frame::frame;
use super::svg;
use super::svg::log10;
use crate::analysis::converge::{Band, MethodStudy, Point, ScanStudy};

/// Least excess that is drawn; less is drawn here.
const FLOOR: f64 = 1e-10;
/// Largest excess that is drawn: before that the fit is no fit.
const CEILING: f64 = 1e4;

/// Sizes in pixels.
const WIDTH: f64 = 900.0;
const LEFT: f64 = 70.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 86.0;
const BOTTOM: f64 = 50.0;
const GAP: f64 = 16.0;
const HEIGHT: f64 = 330.0;

/// Colour and dashes of a method.
fn style(method: &MethodStudy) -> (&'static str, &'static str) {
    let colour = if method.method == "paper" { "#3b78b8" } else { "#f08a24" };
    let dashes = if method.precision == "f32" {
        "stroke-dasharray=\"7 4\""
    } else {
        ""
    };
    (colour, dashes)
}

/// One panel a scan, side by side: relative excess of the cost over the best known, over wall time in seconds.
pub fn converge_svg(scans: &[ScanStudy], seeds: u32) -> String {
    let columns = scans.len().max(1);
    let width = (WIDTH - LEFT - RIGHT - GAP * (columns - 1) as f64) / columns as f64;
    let points = || {
        scans
            .iter()
            .flat_map(|scan| &scan.methods)
            .flat_map(|method| &method.by_time)
    };
    let x = Axis::logarithm(points().map(|point| log10(point.at)), width).rightwards();
    let bands = points().flat_map(|point| [point.excess.p10, point.excess.median, point.excess.p90]);
    let y = Axis::logarithm(bands.filter(|excess| excess.is_finite()).map(height), HEIGHT);

    let mut out = String::new();
    svg::open(&mut out, WIDTH, TOP + HEIGHT + BOTTOM);
    let title = "Excess cost against run time";
    svg::text(&mut out, LEFT, 26.0, "font-size=\"17\" font-weight=\"bold\"", title);
    let methods = scans.first().map_or(&[][..], |scan| &scan.methods);
    legend(&mut out, methods, seeds);
    let _ = write!(
        out,
        "<clipPath id=\"a\"><rect width=\"{width:.1}\" height=\"{HEIGHT:.1}\"/></clipPath>"
    );
    for (place, scan) in scans.iter().enumerate() {
        let left = LEFT + place as f64 * (width + GAP);
        let _ = write!(out, "\n<g transform=\"translate({left:.1} {TOP:.1})\">");
        frame(&mut out, &x, &y, place == 0, true);
        svg::text(&mut out, 0.0, -8.0, "", &svg::escape(&scan.name));
        out.push_str("<g clip-path=\"url(#a)\" fill=\"none\" stroke-linejoin=\"round\">");
        for method in scan.methods.iter().rev() {
            draw(&mut out, method, &x, &y);
        }
        out.push_str("</g></g>");
    }
    let middle = LEFT + 0.5 * (WIDTH - LEFT - RIGHT);
    let below = TOP + HEIGHT + BOTTOM - 12.0;
    svg::text(
        &mut out,
        middle,
        below,
        "text-anchor=\"middle\"",
        "run time (s, one thread)",
    );
    let centre = TOP + 0.5 * HEIGHT;
    let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 18 {centre:.1})\"");
    svg::text(&mut out, 18.0, centre, &turned, "(cost − best) / best");
    out.push_str("\n</svg>\n");
    out
}

/// log10 of an excess within what is drawn.
fn height(excess: f64) -> f64 {
    log10(excess.clamp(FLOOR, CEILING))
}

fn draw(out: &mut String, method: &MethodStudy, x: &Axis, y: &Axis) {
    let (colour, dashes) = style(method);
    let line = |value: fn(&Band) -> f64| -> Vec<(f64, f64)> {
        let begun = method.by_time.iter().filter(|point| point.excess.p90.is_finite());
        let pixel = |point: &Point| (x.pixel(log10(point.at)), y.pixel(height(value(&point.excess))));
        begun.map(pixel).collect()
    };
    let mut outline = line(|band| band.p10);
    outline.extend(line(|band| band.p90).into_iter().rev());
    svg::path(out, &format!("fill=\"{colour}\" fill-opacity=\"0.18\""), &outline);
    let stroke = format!("stroke=\"{colour}\" stroke-width=\"2.2\" {dashes}");
    svg::path(out, &stroke, &line(|band| band.median));
}

fn legend(out: &mut String, methods: &[MethodStudy], seeds: u32) {
    let (mut at, y) = (LEFT, 51.0);
    let _ = write!(out, "<g fill=\"none\">");
    for method in methods {
        let (colour, dashes) = style(method);
        let stroke = format!("stroke=\"{colour}\" stroke-width=\"2.2\" {dashes}");
        svg::path(out, &stroke, &[(at, y - 4.0), (at + 30.0, y - 4.0)]);
        let text = format!("{} {}", method.method, method.precision);
        svg::text(out, at + 36.0, y, svg::INK, &text);
        at += 36.0 + 7.7 * svg::letters(&text) as f64 + 20.0;
    }
    let note = format!("median and 10–90 % of {seeds} seeds");
    svg::text(out, at, y, svg::INK, &note);
    out.push_str("</g>");
}
