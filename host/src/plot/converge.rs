//! Excess cost over run time, both logarithmic: a line for the median of each method and a band from 10 to 90 %.

use std::fmt::Write;

use super::axis::Axis;
use super::frame::frame;
use super::svg;
use super::svg::log10;

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

/// One panel.
pub struct Panel {
    /// What stands above it.
    pub title: String,
    /// Its lines, the first on top; all panels have the same.
    pub lines: Vec<Line>,
}

/// The excess of one method over the run time.
pub struct Line {
    /// For the legend.
    pub label: String,
    /// Its colour: 0 for orange, 1 for blue.
    pub colour: usize,
    /// Drawn in dashes.
    pub dashed: bool,
    /// Run time in seconds, and of the relative excess the tenth percentile, the median and the ninetieth.
    pub points: Vec<(f64, [f64; 3])>,
}

/// Orange and blue.
const COLOURS: [&str; 2] = ["#f08a24", "#3b78b8"];

fn style(line: &Line) -> (&'static str, &'static str) {
    let dashes = if line.dashed { "stroke-dasharray=\"7 4\"" } else { "" };
    (COLOURS[line.colour % COLOURS.len()], dashes)
}

/// One panel a scan, side by side: relative excess of the cost over the best known, over wall time in seconds.
pub fn converge_svg(panels: &[Panel], seeds: u32) -> String {
    let columns = panels.len().max(1);
    let width = (WIDTH - LEFT - RIGHT - GAP * (columns - 1) as f64) / columns as f64;
    let points = || {
        panels
            .iter()
            .flat_map(|panel| &panel.lines)
            .flat_map(|line| &line.points)
    };
    let x = Axis::logarithm(points().map(|(at, _)| log10(*at)), width).rightwards();
    let bands = points().flat_map(|(_, excess)| *excess);
    let y = Axis::logarithm(bands.filter(|excess| excess.is_finite()).map(height), HEIGHT);

    let mut out = String::new();
    svg::open(&mut out, WIDTH, TOP + HEIGHT + BOTTOM);
    let title = "Excess cost against run time";
    svg::text(&mut out, LEFT, 26.0, "font-size=\"17\" font-weight=\"bold\"", title);
    let lines = panels.first().map_or(&[][..], |panel| &panel.lines);
    legend(&mut out, lines, seeds);
    let _ = write!(
        out,
        "<clipPath id=\"a\"><rect width=\"{width:.1}\" height=\"{HEIGHT:.1}\"/></clipPath>"
    );
    for (place, panel) in panels.iter().enumerate() {
        let left = LEFT + place as f64 * (width + GAP);
        let _ = write!(out, "\n<g transform=\"translate({left:.1} {TOP:.1})\">");
        frame(&mut out, &x, &y, place == 0, true);
        svg::text(&mut out, 0.0, -8.0, "", &svg::escape(&panel.title));
        out.push_str("<g clip-path=\"url(#a)\" fill=\"none\" stroke-linejoin=\"round\">");
        for line in panel.lines.iter().rev() {
            draw(&mut out, line, &x, &y);
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

fn draw(out: &mut String, line: &Line, x: &Axis, y: &Axis) {
    let (colour, dashes) = style(line);
    let quantile = |k: usize| -> Vec<(f64, f64)> {
        let begun = line.points.iter().filter(|(_, excess)| excess[2].is_finite());
        begun
            .map(|(at, excess)| (x.pixel(log10(*at)), y.pixel(height(excess[k]))))
            .collect()
    };
    let mut outline = quantile(0);
    outline.extend(quantile(2).into_iter().rev());
    svg::path(out, &format!("fill=\"{colour}\" fill-opacity=\"0.18\""), &outline);
    let stroke = format!("stroke=\"{colour}\" stroke-width=\"2.2\" {dashes}");
    svg::path(out, &stroke, &quantile(1));
}

fn legend(out: &mut String, lines: &[Line], seeds: u32) {
    let (mut at, y) = (LEFT, 51.0);
    let _ = write!(out, "<g fill=\"none\">");
    for line in lines {
        let (colour, dashes) = style(line);
        let stroke = format!("stroke=\"{colour}\" stroke-width=\"2.2\" {dashes}");
        svg::path(out, &stroke, &[(at, y - 4.0), (at + 30.0, y - 4.0)]);
        svg::text(out, at + 36.0, y, svg::INK, &svg::escape(&line.label));
        at += 36.0 + 7.7 * svg::letters(&line.label) as f64 + 20.0;
    }
    let note = format!("median and 10–90 % of {seeds} seeds");
    svg::text(out, at, y, svg::INK, &note);
    out.push_str("</g>");
}
