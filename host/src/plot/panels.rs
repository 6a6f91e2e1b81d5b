//! Measured scans with the lines of models over them, one panel an incident angle.

use std::fmt::Write;

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::axis::Axis;
use super::curve::{self, LnF, curve};
use super::frame::{BOTTOM, CAPTION, GAP, LEFT, PANELS, POINTS, RIGHT, WIDTH, degrees, frame};
use super::svg;

/// How far a line may be from the model, pixels.
pub const TRUE_TO: f64 = 0.1;

/// The samples of one incident angle.
struct Panel {
    /// Radians.
    theta_i: f64,
    /// Signed theta_s in degrees and log10 of the BRDF.
    points: Vec<(f64, f64)>,
}

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
pub fn draw(
    title: &str,
    samples: &[Sample<f64>],
    lines: &[Line],
    top: f64,
    legend: impl FnOnce(&mut String),
) -> String {
    let all = panels(samples);
    let panels: Vec<&Panel> = all.iter().step_by(all.len().div_ceil(PANELS).max(1)).collect();
    let columns = match panels.len() {
        0 | 1 => 1,
        2 | 4 => 2,
        _ => 3,
    };
    let rows = panels.len().max(1).div_ceil(columns);
    let width = (WIDTH - LEFT - RIGHT - GAP * (columns - 1) as f64) / columns as f64;
    let height = [400.0, 270.0, 210.0][columns - 1];
    let x = Axis::angles(panels.iter().flat_map(|p| &p.points).map(|p| p.0), width);
    let y = vertical_axis(&panels, lines.first(), &x, height);

    let total = top + rows as f64 * (height + CAPTION) + BOTTOM;
    let mut out = String::new();
    svg::open(&mut out, WIDTH, total);
    svg::text(
        &mut out,
        LEFT,
        26.0,
        "font-size=\"17\" font-weight=\"bold\"",
        &svg::escape(title),
    );
    legend(&mut out);
    let _ = write!(
        out,
        "<clipPath id=\"a\"><rect width=\"{width:.1}\" height=\"{height:.1}\"/></clipPath>"
    );
    let stride = samples.len().div_ceil(POINTS).max(1);
    left_out(&mut out, panels.len(), all.len(), stride);
    for (place, panel) in panels.iter().enumerate() {
        let left = LEFT + (place % columns) as f64 * (width + GAP);
        let top = top + (place / columns) as f64 * (height + CAPTION) + CAPTION;
        let _ = write!(out, "\n<g transform=\"translate({left:.1} {top:.1})\">");
        frame(&mut out, &x, &y, place % columns == 0, place + columns >= panels.len());
        let caption = format!("{} = {}°", svg::sub("θ", "i"), degrees(panel.theta_i));
        svg::text(&mut out, 0.0, -7.0, "", &caption);
        out.push_str("<g clip-path=\"url(#a)\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">");
        for line in lines.iter().rev() {
            let points = curve(&line.ln_f, panel.theta_i, &x, &y, line.true_to);
            svg::path(&mut out, &line.style, &points);
        }
        let points = panel.points.iter().step_by(stride);
        svg::dots(&mut out, points.map(|p| (x.pixel(p.0), y.pixel(p.1))));
        out.push_str("</g></g>");
    }
    let middle = LEFT + 0.5 * (WIDTH - LEFT - RIGHT);
    let label = format!("scattering angle {} (degrees, positive forward)", svg::sub("θ", "s"));
    svg::text(&mut out, middle, total - 12.0, "text-anchor=\"middle\"", &label);
    let centre = 0.5 * (top + CAPTION + total - BOTTOM);
    let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 18 {centre:.1})\"");
    svg::text(&mut out, 18.0, centre, &turned, &format!("BRDF (sr{})", svg::sup("−1")));
    out.push_str("\n</svg>\n");
    out
}

/// The samples by incident angle, equal to a hundredth of a degree; ascending.
fn panels(samples: &[Sample<f64>]) -> Vec<Panel> {
    let mut groups = std::collections::BTreeMap::new();
    for sample in samples {
        let key = (sample.theta_i.to_degrees() * 100.0).round() as i64;
        let panel = groups.entry(key).or_insert_with(|| Panel {
            theta_i: sample.theta_i,
            points: Vec::new(),
        });
        let forward = Real::sin_cos(sample.delta_phi).1 < 0.0;
        let theta_s = if forward { sample.theta_s } else { -sample.theta_s };
        panel.points.push((theta_s.to_degrees(), svg::log10(sample.brdf)));
    }
    groups.into_values().collect()
}

/// The range of the data, with the best curve's peak.
fn vertical_axis(panels: &[&Panel], best: Option<&Line>, x: &Axis, height: f64) -> Axis {
    let data = panels.iter().flat_map(|p| &p.points).map(|p| p.1);
    let highest = data.clone().fold(f64::NEG_INFINITY, f64::max);
    let peaks = best.into_iter().flat_map(|best| {
        let peak = |p: &&Panel| curve::peak(&best.ln_f, p.theta_i, x).min(highest + 1.0).max(highest);
        panels.iter().map(peak).collect::<Vec<_>>()
    });
    Axis::logarithm(data.chain(peaks), height)
}

/// Says in the upper right corner what is not drawn.
fn left_out(out: &mut String, drawn: usize, angles: usize, stride: usize) {
    let mut notes = Vec::new();
    if drawn < angles {
        notes.push(format!("{drawn} of {angles} incident angles"));
    }
    if stride > 1 {
        notes.push(format!("one in {stride} samples"));
    }
    if !notes.is_empty() {
        let note = format!("shown: {}", notes.join(", "));
        svg::text(out, WIDTH - RIGHT, 26.0, "text-anchor=\"end\"", &note);
    }
}
