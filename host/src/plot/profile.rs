//! Profiles of parameters: the rise of the cost over each, with the levels of the F test of 68 and 95 %, and the ends of the intervals.

use std::fmt::Write;

use super::axis::Axis;
use super::frame::frame;
use super::svg;
use super::svg::log10;

/// Sizes in pixels.
const WIDTH: f64 = 900.0;
const LEFT: f64 = 66.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 60.0;
const BOTTOM: f64 = 50.0;
const GAP: f64 = 24.0;
const CAPTION: f64 = 44.0;
const HEIGHT: f64 = 240.0;
/// The largest rise that is drawn.
const HIGHEST: f64 = 9.0;
/// A panel whose ends have this ratio is logarithmic.
const WIDE: f64 = 30.0;

/// The profile of one parameter.
pub struct Panel {
    /// The parameter.
    pub name: &'static str,
    /// Its best value.
    pub best: f64,
    /// Values in ascending order, and the rise of the cost above the best over the variance of a residual.
    pub points: Vec<(f64, f64)>,
    /// Levels of confidence, 0 to 1, and the rise that ends an interval of each.
    pub levels: [(f64, f64); 2],
    /// The ends of the interval of each level; `None` where the bound of the parameter ends it.
    pub ends: [[Option<f64>; 2]; 2],
}

/// One panel a profile: the rise of the cost over the variance of a residual, over the parameter.
pub fn profile_svg(title: &str, profiles: &[Panel]) -> String {
    let columns = profiles.len().clamp(1, 3);
    let rows = profiles.len().max(1).div_ceil(columns);
    let width = (WIDTH - LEFT - RIGHT - GAP * (columns - 1) as f64) / columns as f64;
    let total = TOP + rows as f64 * (HEIGHT + CAPTION) + BOTTOM;
    let mut out = String::new();
    svg::open(&mut out, WIDTH, total);
    let style = "font-size=\"17\" font-weight=\"bold\"";
    svg::text(&mut out, LEFT, 26.0, style, &svg::escape(title));
    let _ = write!(
        out,
        "<clipPath id=\"a\"><rect width=\"{width:.1}\" height=\"{HEIGHT:.1}\"/></clipPath>"
    );
    let y = Axis::linear([0.0, HIGHEST].into_iter(), HEIGHT).upwards();
    for (place, profile) in profiles.iter().enumerate() {
        let left = LEFT + (place % columns) as f64 * (width + GAP);
        let top = TOP + (place / columns) as f64 * (HEIGHT + CAPTION);
        let _ = write!(out, "\n<g transform=\"translate({left:.1} {top:.1})\">");
        panel(&mut out, profile, &y, width, place % columns == 0);
        out.push_str("</g>");
    }
    let centre = 0.5 * (TOP + total - BOTTOM);
    let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 18 {centre:.1})\"");
    svg::text(
        &mut out,
        18.0,
        centre,
        &turned,
        "rise of the cost, variances of a residual",
    );
    out.push_str("\n</svg>\n");
    out
}

fn panel(out: &mut String, profile: &Panel, y: &Axis, width: f64, first: bool) {
    let near = profile.points.iter().filter(|(_, rise)| *rise <= 1.5 * HIGHEST);
    let values = || near.clone().map(|(value, _)| *value);
    let (least, most) = values().fold((f64::MAX, f64::MIN), |(a, b), value| (a.min(value), b.max(value)));
    let logarithmic = least > 0.0 && most > WIDE * least;
    let scale = |value: f64| if logarithmic { log10(value) } else { value };
    let x = if logarithmic {
        Axis::logarithm(values().map(log10), width).rightwards()
    } else {
        Axis::linear(values(), width)
    };
    frame(out, &x, y, first, true);
    let caption = format!("{} = {}", profile.name, svg::number(profile.best));
    svg::text(out, 0.0, -8.0, "", &caption);
    out.push_str("<g clip-path=\"url(#a)\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">");
    for ((level, rise), dashes) in profile.levels.into_iter().zip(["2 4", "7 4"]) {
        let at = y.pixel(rise);
        let style = format!("stroke=\"#888\" stroke-dasharray=\"{dashes}\"");
        svg::path(out, &style, &[(0.0, at), (width, at)]);
        let grey = "text-anchor=\"end\" fill=\"#666\" font-size=\"11\"";
        svg::text(out, width - 3.0, at - 3.0, grey, &format!("{:.0} %", 100.0 * level));
    }
    for (ends, dashes) in profile.ends.iter().zip(["2 4", "7 4"]) {
        let style = format!("stroke=\"#888\" stroke-dasharray=\"{dashes}\"");
        for end in ends.iter().flatten() {
            let at = x.pixel(scale(*end));
            if at.is_finite() {
                svg::path(out, &style, &[(at, 0.0), (at, HEIGHT)]);
            }
        }
    }
    let pixels = |(value, rise): &(f64, f64)| (x.pixel(scale(*value)), y.pixel(rise.min(3.0 * HIGHEST)));
    let line: Vec<(f64, f64)> = profile
        .points
        .iter()
        .map(pixels)
        .filter(|point| point.0.is_finite() && point.1.is_finite())
        .collect();
    svg::path(out, svg::THICK, &line);
    svg::dots(out, line.into_iter());
    out.push_str("</g>");
}
