//! Residuals of ln f over the scattering angle, with the band of the noise.

use std::fmt::Write;

use brdfit_core::geometry::Sample;

use super::axis::Axis;
use super::frame::{Grid, WIDTH, frame, labels};
use super::marks::{Data, Marks, Panel, thinned};
use super::svg;
use crate::engine::View;

const TOP: f64 = 10.0;

/// Model less measurement in ln f, times the weight of the sample, over signed theta_s (degrees, positive forward), one panel an incident angle; what lies out of plane is drawn below, over its angle from the specular direction.
///
/// `scale` is the standard deviation of a residual: the bands are one and two of them wide on each side.
/// All panels share the vertical range; of very many angles and samples only some are drawn, as in [`super::scan_svg`].
pub fn residuals_svg(samples: &[Sample<f64>], view: &View, scale: f64) -> String {
    let marks = Marks::of(&Data {
        samples,
        left_out: &[],
        left_out_count: 0,
    });
    let band = if scale.is_finite() { 2.2 * scale } else { 0.0 };
    let residuals = samples.iter().filter_map(|sample| view.residual(sample));
    let far = residuals.map(f64::abs).fold(band, f64::max);
    let mut body = String::new();
    let mut bottom = TOP;
    for block in marks.blocks() {
        let panels: Vec<&Panel> = block.shown().collect();
        let grid = Grid::new(panels.len(), [200.0, 160.0, 130.0]);
        let x = block.axis(grid.width);
        let y = Axis::linear([-far, far].into_iter(), grid.height).upwards();
        for (place, panel) in panels.iter().enumerate() {
            let (left, upper) = grid.place(place, bottom);
            let _ = write!(body, "\n<g transform=\"translate({left:.1} {upper:.1})\">");
            bands(&mut body, &y, grid.width, scale);
            frame(&mut body, &x, &y, grid.is_left(place), grid.is_low(place));
            svg::text(&mut body, 0.0, -7.0, "", &block.caption(panel));
            body.push_str("<g fill=\"none\" stroke-linecap=\"round\">");
            let zero = y.pixel(0.0);
            svg::path(
                &mut body,
                "stroke=\"#f08a24\" stroke-width=\"2\"",
                &[(0.0, zero), (grid.width, zero)],
            );
            let each = panel.samples().iter().zip(&panel.measured);
            let points = each.filter_map(|(sample, point)| Some((x.pixel(point.0), y.pixel(view.residual(sample)?))));
            svg::dots(&mut body, thinned(points.collect(), block.limit()).into_iter());
            body.push_str("</g></g>");
        }
        let label = format!("residual of ln {}", svg::italic("f"));
        bottom = labels(&mut body, &grid, bottom, &block.label(), &label);
    }
    let mut out = String::new();
    svg::open(&mut out, WIDTH, bottom);
    out + &body + "\n</svg>\n"
}

/// One and two standard deviations on each side.
fn bands(out: &mut String, y: &Axis, width: f64, scale: f64) {
    for (scales, opacity) in [(2.0, 0.12), (1.0, 0.2)] {
        if scale.is_finite() {
            let (above, below) = (y.pixel(scales * scale), y.pixel(-scales * scale));
            let _ = write!(
                out,
                "<rect y=\"{above:.1}\" width=\"{width:.1}\" height=\"{:.1}\" fill=\"#f08a24\" fill-opacity=\"{opacity}\"/>",
                below - above
            );
        }
    }
}
