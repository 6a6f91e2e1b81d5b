//! What panels have in common: sizes, grid, ticks and labels.

use std::fmt::Write;

use super::axis::{self, Axis};
use super::svg;

/// Panels at most; of more incident angles an even choice is drawn.
pub const PANELS: usize = 12;
/// Points at most, over all panels.
pub const POINTS: usize = 3000;
/// Width of a picture, pixels.
pub const WIDTH: f64 = 900.0;
/// Left margin, for the labels, pixels.
pub const LEFT: f64 = 66.0;
/// Right margin, pixels.
pub const RIGHT: f64 = 16.0;
/// Bottom margin, for the labels, pixels.
pub const BOTTOM: f64 = 50.0;
/// Between two panels, pixels.
pub const GAP: f64 = 14.0;
/// Height of the caption of a panel, pixels.
pub const CAPTION: f64 = 27.0;

/// Grid, ticks, labels and border of one panel.
pub fn frame(out: &mut String, x: &Axis, y: &Axis, left: bool, bottom: bool) {
    let (width, height) = (x.pixels(), y.pixels());
    let mut grid = String::new();
    let mut ticks = String::new();
    for tick in x.ticks() {
        let at = x.pixel(tick.at);
        let _ = write!(
            ticks,
            "M{at:.1} {height}v{}",
            if tick.label.is_some() { -6 } else { -3 }
        );
        let Some(label) = &tick.label else { continue };
        let _ = write!(grid, "M{at:.1} 0v{height}");
        if bottom {
            svg::text(out, at, height + 18.0, "text-anchor=\"middle\"", label);
        }
    }
    for tick in y.ticks() {
        let at = y.pixel(tick.at);
        let _ = write!(ticks, "M0 {at:.1}h{}", if tick.label.is_some() { 6 } else { 3 });
        let Some(label) = &tick.label else { continue };
        let _ = write!(grid, "M0 {at:.1}h{width:.1}");
        if left {
            svg::text(out, -7.0, at + 4.5, "text-anchor=\"end\"", label);
        }
    }
    let _ = write!(
        out,
        "<path d=\"{grid}\" stroke=\"#e6e6e6\"/><path d=\"{ticks}\" stroke=\"#333\"/>"
    );
    let _ = write!(
        out,
        "<rect width=\"{width:.1}\" height=\"{height:.1}\" fill=\"none\" stroke=\"#333\"/>"
    );
}

/// Degrees with as many decimals as needed, at most three.
pub fn degrees(radians: f64) -> String {
    axis::plain((radians.to_degrees() * 1000.0).round() / 1000.0)
}
