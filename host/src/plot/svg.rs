//! The few marks that the picture needs, as SVG text; paths go in relative steps of a tenth of a pixel to stay short.

use std::f64::consts::LOG10_E;
use std::fmt::Write;

use brdfit_core::real::Real;

use crate::number;

/// The best curve.
pub const THICK: &str = "stroke=\"#f08a24\" stroke-width=\"3.5\"";
/// Any other minimum.
pub const THIN: &str = "stroke=\"#3b78b8\" stroke-width=\"1\"";
/// Text within a group of lines.
pub const INK: &str = "fill=\"#111\" stroke=\"none\"";

/// The head of the file, with a light background.
pub fn open(out: &mut String, width: f64, height: f64) {
    let _ = write!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"Helvetica,Arial,'DejaVu Sans',sans-serif\" font-size=\"14\" fill=\"#111\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
    );
}

/// Text whose `content` is already SVG.
pub fn text(out: &mut String, x: f64, y: f64, attributes: &str, content: &str) {
    let _ = write!(
        out,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" xml:space=\"preserve\" {attributes}>{content}</text>"
    );
}

/// A polyline.
pub fn path(out: &mut String, style: &str, points: &[(f64, f64)]) {
    let _ = write!(out, "<path {style} d=\"");
    let mut last = (0, 0);
    for (place, &point) in points.iter().enumerate() {
        let step = relative(&mut last, point);
        let separator = if step.starts_with('-') { "" } else { " " };
        let _ = write!(out, "{}{step}", ["m", "l", separator][place.min(2)]);
    }
    out.push_str("\"/>");
}

/// Round dots: lines of no length with round ends.
pub fn dots(out: &mut String, points: impl Iterator<Item = (f64, f64)>) {
    out.push_str("<path stroke=\"#111\" stroke-width=\"2.8\" d=\"");
    let mut last = (0, 0);
    for point in points {
        let _ = write!(out, "m{}h0", relative(&mut last, point));
    }
    out.push_str("\"/>");
}

/// Grey crosses, for what was left out.
pub fn crosses(out: &mut String, points: impl Iterator<Item = (f64, f64)>) {
    let mut points = points.peekable();
    if points.peek().is_none() {
        return;
    }
    out.push_str("<path stroke=\"#999\" stroke-width=\"1.1\" d=\"");
    for (x, y) in points {
        let _ = write!(out, "M{:.1} {:.1}l5 5m-5 0l5-5", x - 2.5, y - 2.5);
    }
    out.push_str("\"/>");
}

/// Small rings, for a model where a line cannot go.
pub fn rings(out: &mut String, style: &str, points: impl Iterator<Item = (f64, f64)>) {
    let _ = write!(out, "<path {style} style=\"stroke-width:1\" d=\"");
    for (x, y) in points {
        let _ = write!(out, "M{:.1} {y:.1}a2 2 0 1 0 4 0a2 2 0 1 0-4 0", x - 2.0);
    }
    out.push_str("\"/>");
}

/// The step from the last point, in tenths of a pixel, to `point`.
fn relative(last: &mut (i64, i64), point: (f64, f64)) -> String {
    let tenths = |v: f64| (v * 10.0).round() as i64;
    let next = (tenths(point.0), tenths(point.1));
    let (dx, dy) = (next.0 - last.0, next.1 - last.1);
    *last = next;
    let show = |v: i64| format!("{}", v as f64 / 10.0);
    format!("{}{}{}", show(dx), if dy < 0 { "" } else { " " }, show(dy))
}

/// A symbol.
pub fn italic(symbol: &str) -> String {
    format!("<tspan font-style=\"italic\">{symbol}</tspan>")
}

/// A symbol with an index; an empty letter brings the line back to its height.
pub fn sub(symbol: &str, index: &str) -> String {
    let symbol = italic(symbol);
    format!("{symbol}<tspan dy=\"3\" font-size=\"10\">{index}</tspan><tspan dy=\"-3\">\u{200b}</tspan>")
}

/// An exponent.
pub fn sup(exponent: &str) -> String {
    format!("<tspan dy=\"-5\" font-size=\"10\">{exponent}</tspan><tspan dy=\"5\">\u{200b}</tspan>")
}

/// A number with four digits, as a power of ten where that is shorter.
pub fn number(value: f64) -> String {
    match number::set(&number::four(value)) {
        (mantissa, Some(exponent)) => format!("{mantissa} × 10{}", sup(&exponent)),
        (plain, None) => plain,
    }
}

/// How many letters are seen.
pub fn letters(text: &str) -> usize {
    let mut inside = false;
    let seen = text.chars().filter(|&c| {
        inside = (inside || c == '<') && c != '>';
        !inside && c != '>' && c != '\u{200b}'
    });
    seen.count()
}

/// Plain text as SVG.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// The logarithm to the base of 10.
pub fn log10(value: f64) -> f64 {
    Real::portable_ln(value) * LOG10_E
}
