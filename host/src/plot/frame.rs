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
const GAP: f64 = 14.0;
/// Height of the caption of a panel, pixels.
pub const CAPTION: f64 = 27.0;

/// Panels of one size in rows.
pub struct Grid {
    columns: usize,
    count: usize,
    /// Of a panel, pixels.
    pub width: f64,
    /// Of a panel, pixels.
    pub height: f64,
}

impl Grid {
    /// Room for so many panels; `heights` are those in one, two and three columns.
    pub fn new(count: usize, heights: [f64; 3]) -> Grid {
        let columns = match count {
            0 | 1 => 1,
            2 | 4 => 2,
            _ => 3,
        };
        Grid {
            columns,
            count,
            width: (WIDTH - LEFT - RIGHT - GAP * (columns - 1) as f64) / columns as f64,
            height: heights[columns - 1],
        }
    }

    /// Left and upper edge of a panel, below `top`.
    pub fn place(&self, panel: usize, top: f64) -> (f64, f64) {
        let left = LEFT + (panel % self.columns) as f64 * (self.width + GAP);
        (
            left,
            top + (panel / self.columns) as f64 * (self.height + CAPTION) + CAPTION,
        )
    }

    /// Is a panel in the first column?
    pub fn is_left(&self, panel: usize) -> bool {
        panel.is_multiple_of(self.columns)
    }

    /// Is there none below a panel?
    pub fn is_low(&self, panel: usize) -> bool {
        panel + self.columns >= self.count
    }

    /// Height of all rows with their captions.
    pub fn total(&self) -> f64 {
        self.count.max(1).div_ceil(self.columns) as f64 * (self.height + CAPTION)
    }
}

/// What stands below a grid whose upper edge is at `top`, and what stands, turned, on its left; the lower edge of both.
pub fn labels(out: &mut String, grid: &Grid, top: f64, below: &str, left: &str) -> f64 {
    let bottom = top + grid.total() + BOTTOM;
    let middle = LEFT + 0.5 * (WIDTH - LEFT - RIGHT);
    svg::text(out, middle, bottom - 12.0, "text-anchor=\"middle\"", below);
    let centre = bottom - BOTTOM - 0.5 * grid.total() + 0.5 * CAPTION;
    let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 18 {centre:.1})\"");
    svg::text(out, 18.0, centre, &turned, left);
    bottom
}

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
