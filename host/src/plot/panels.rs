//! Measured scans with the lines of models over them, one panel an incident angle.

use std::fmt::Write;

use super::axis::Axis;
use super::curve::{self, LnF, curve};
use super::frame::{Grid, LEFT, WIDTH, frame, labels};
use super::marks::{Data, Marks, Panel, thinned};
use super::svg;

/// How far a line may be from the model, pixels.
pub const TRUE_TO: f64 = 0.1;

/// A model's line over the data.
pub struct Line<'a> {
    /// The model.
    pub ln_f: LnF<'a>,
    /// Its colour and width, as attributes of SVG.
    pub style: String,
    /// How far it may be from the model, pixels.
    pub true_to: f64,
}

/// Panels with the lines, the first on top, and the data; `legend` writes into the `top` pixels above.
///
/// What lies out of the plane of incidence is drawn below, in panels of its own.
pub fn draw(title: &str, data: &Data, lines: &[Line], top: f64, legend: impl FnOnce(&mut String)) -> String {
    let marks = Marks::of(data);
    let total: usize = marks.blocks().map(|block| block.samples()).sum();
    let shown = marks.blocks().flat_map(|block| block.shown());
    let heights: Vec<f64> = shown.flat_map(|panel| &panel.measured).map(|point| point.1).collect();
    let mut drawn = 0;
    let mut body = String::new();
    let mut bottom = top;
    for block in marks.blocks() {
        let panels: Vec<&Panel> = block.shown().collect();
        let grid = Grid::new(panels.len(), [400.0, 270.0, 210.0]);
        let x = block.axis(grid.width);
        let best = lines.first().filter(|_| block.in_plane);
        let y = vertical_axis(&heights, &panels, best, &x, grid.height);
        let id = if block.in_plane { "a" } else { "b" };
        let _ = write!(
            body,
            "<clipPath id=\"{id}\"><rect width=\"{:.1}\" height=\"{:.1}\"/></clipPath>",
            grid.width, grid.height
        );
        for (place, panel) in panels.iter().enumerate() {
            let (left, upper) = grid.place(place, bottom);
            let _ = write!(body, "\n<g transform=\"translate({left:.1} {upper:.1})\">");
            frame(&mut body, &x, &y, grid.is_left(place), grid.is_low(place));
            svg::text(&mut body, 0.0, -7.0, "", &block.caption(panel));
            let _ = write!(
                body,
                "<g clip-path=\"url(#{id})\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">"
            );
            for line in lines.iter().rev().filter(|_| block.in_plane) {
                let points = curve(&line.ln_f, panel.theta_i, &x, &y, line.true_to);
                svg::path(&mut body, &line.style, &points);
            }
            let pixels = |points: &[(f64, f64)]| -> Vec<(f64, f64)> {
                let all = points.iter().map(|p| (x.pixel(p.0), y.pixel(p.1)));
                thinned(all.collect(), block.limit())
            };
            svg::crosses(&mut body, pixels(&panel.left_out).into_iter());
            let dots = pixels(&panel.measured);
            drawn += dots.len();
            svg::dots(&mut body, dots.into_iter());
            if let Some(best) = lines.first().filter(|_| !block.in_plane) {
                let model = panel.model(&best.ln_f);
                svg::rings(&mut body, &best.style, pixels(&model).into_iter());
            }
            body.push_str("</g></g>");
        }
        let label = format!("BRDF (sr{})", svg::sup("−1"));
        bottom = labels(&mut body, &grid, bottom, &block.label(), &label);
    }
    let mut out = String::new();
    svg::open(&mut out, WIDTH, bottom);
    svg::text(
        &mut out,
        LEFT,
        26.0,
        "font-size=\"17\" font-weight=\"bold\"",
        &svg::escape(title),
    );
    legend(&mut out);
    marks.note(&mut out, drawn, total);
    out + &body + "\n</svg>\n"
}

/// The range of the data, with the best curve's peak.
fn vertical_axis(data: &[f64], panels: &[&Panel], best: Option<&Line>, x: &Axis, height: f64) -> Axis {
    let highest = data.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let peaks = best.into_iter().flat_map(|best| {
        let peak = |p: &&Panel| curve::peak(&best.ln_f, p.theta_i, x).min(highest + 1.0).max(highest);
        panels.iter().map(peak).collect::<Vec<_>>()
    });
    Axis::logarithm(data.iter().copied().chain(peaks), height)
}
