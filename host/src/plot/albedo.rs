//! Directional-hemispherical reflectance over the angle of incidence.

use std::fmt::Write;

use super::axis::Axis;
use super::frame::frame;
use super::svg;

/// Sizes in pixels.
const WIDTH: f64 = 900.0;
const LEFT: f64 = 66.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 14.0;
const BOTTOM: f64 = 50.0;
const HEIGHT: f64 = 240.0;

/// The reflectance at one angle of incidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Albedo {
    /// The angle, degrees.
    pub theta_i: f64,
    /// Dimensionless.
    pub value: f64,
    /// One standard error of it.
    pub stderr: f64,
}

/// A line with a band of one standard error on each side over theta_i (degrees); dots at the angles that were measured.
///
/// The dashed line is 1: above it the model makes energy.
pub fn albedo_svg(curve: &[Albedo], measured: &[Albedo]) -> String {
    let width = WIDTH - LEFT - RIGHT;
    let x = Axis::angles([0.0, 90.0].into_iter(), width);
    let values = curve.iter().chain(measured).map(|albedo| albedo.value);
    let y = Axis::linear(values.chain([0.0]), HEIGHT).upwards();
    let pixels = |theta_i: f64, value: f64| (x.pixel(theta_i), y.pixel(value).clamp(-5.0, HEIGHT + 5.0));

    let mut out = String::new();
    svg::open(&mut out, WIDTH, TOP + HEIGHT + BOTTOM);
    let _ = write!(
        out,
        "<clipPath id=\"a\"><rect width=\"{width:.1}\" height=\"{HEIGHT:.1}\"/></clipPath><g transform=\"translate({LEFT:.1} {TOP:.1})\">"
    );
    frame(&mut out, &x, &y, true, true);
    out.push_str("<g clip-path=\"url(#a)\" fill=\"none\" stroke-linecap=\"round\">");
    let known = || curve.iter().filter(|albedo| albedo.stderr.is_finite());
    let above = known().map(|albedo| pixels(albedo.theta_i, albedo.value + albedo.stderr));
    let below = known()
        .rev()
        .map(|albedo| pixels(albedo.theta_i, albedo.value - albedo.stderr));
    let band: Vec<_> = above.chain(below).collect();
    svg::path(
        &mut out,
        "fill=\"#f08a24\" fill-opacity=\"0.25\" stroke=\"none\"",
        &band,
    );
    let (low, high) = y.range();
    if low < 1.0 && 1.0 < high {
        svg::path(
            &mut out,
            "stroke=\"#333\" stroke-dasharray=\"6 4\"",
            &[(0.0, y.pixel(1.0)), (width, y.pixel(1.0))],
        );
    }
    let line: Vec<_> = curve
        .iter()
        .map(|albedo| pixels(albedo.theta_i, albedo.value))
        .collect();
    svg::path(&mut out, "stroke=\"#f08a24\" stroke-width=\"2.5\"", &line);
    let measured = measured.iter().map(|albedo| pixels(albedo.theta_i, albedo.value));
    svg::dots(&mut out, measured);
    out.push_str("</g></g>");
    let middle = LEFT + 0.5 * width;
    let label = format!("angle of incidence {} (degrees)", svg::sub("θ", "i"));
    svg::text(&mut out, middle, TOP + HEIGHT + 38.0, "text-anchor=\"middle\"", &label);
    let centre = TOP + 0.5 * HEIGHT;
    let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 18 {centre:.1})\"");
    svg::text(&mut out, 18.0, centre, &turned, "reflectance");
    out.push_str("\n</svg>\n");
    out
}
