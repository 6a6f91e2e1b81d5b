//! A scan with its fits as a picture: points, the distinct minima as thin lines, the best as a thick one.

mod albedo;
mod axis;
mod converge;
mod curve;
mod overlay;
pub mod picture;
mod polar;
mod profile;
mod residuals;
mod svg;
mod waterfall;

use std::fmt::Write;

use brdfit_core::brdf::Params;
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

pub use albedo::albedo_svg;
pub use converge::converge_svg;
pub use overlay::{Overlay, overlay_svg};
pub use polar::polar_svg;
pub use profile::profile_svg;
pub use residuals::residuals_svg;
pub use waterfall::waterfall_svg;

use axis::Axis;
use curve::{LnF, curve, eq_14, mse2};

/// Panels at most; of more incident angles an even choice is drawn.
const PANELS: usize = 12;
/// Thin lines at most.
const OTHERS: usize = 24;
/// How far a line may be from the model, pixels.
const TRUE_TO: f64 = 0.1;
/// The same of thin lines.
const OTHERS_TRUE_TO: f64 = 0.25;
/// Points at most, over all panels.
const POINTS: usize = 3000;

/// Sizes in pixels.
const WIDTH: f64 = 900.0;
const LEFT: f64 = 66.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 80.0;
const BOTTOM: f64 = 50.0;
const GAP: f64 = 14.0;
const CAPTION: f64 = 27.0;

/// The samples of one incident angle.
struct Panel {
    /// Radians.
    theta_i: f64,
    /// Signed theta_s in degrees and log10 of the BRDF.
    points: Vec<(f64, f64)>,
}

/// A scan and its fits as SVG: log BRDF (sr^-1) over signed theta_s (degrees, positive forward), one panel an incident angle.
///
/// `curves` are the distinct minima, best first: the best is a thick line, the others are thin ones; it may be empty.
/// Samples out of plane are projected: theta_s counts as forward where cos(delta_phi) < 0, while the curves are those in plane.
/// All panels share both ranges: the horizontal one is that of the data, the vertical one that of the data and of the best curve's peak, up to a decade above the data; lines that leave it are cut.
/// Of very many only some are drawn (every k-th angle, every k-th sample, the best minima), and the picture says so; so the file stays below 100 kB.
pub fn scan_svg(title: &str, samples: &[Sample<f64>], curves: &[Params<f64>]) -> String {
    let drawn = &curves[..curves.len().min(1 + OTHERS)];
    let lines: Vec<Line> = drawn
        .iter()
        .enumerate()
        .map(|(place, params)| Line {
            ln_f: eq_14(params),
            style: if place == 0 { svg::THICK } else { svg::THIN }.to_string(),
            true_to: if place == 0 { TRUE_TO } else { OTHERS_TRUE_TO },
        })
        .collect();
    draw(title, samples, &lines, TOP, |out| legend(out, samples, curves))
}

/// A model's line over the data.
struct Line<'a> {
    ln_f: LnF<'a>,
    style: String,
    /// How far it may be from the model, pixels.
    true_to: f64,
}

/// Panels with the lines, the first on top, and the data; `legend` writes into the `top` pixels above.
fn draw(title: &str, samples: &[Sample<f64>], lines: &[Line], top: f64, legend: impl FnOnce(&mut String)) -> String {
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

/// Grid, ticks, labels and border of one panel.
fn frame(out: &mut String, x: &Axis, y: &Axis, left: bool, bottom: bool) {
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

/// What the marks mean, how well the curves fit, and the best parameters.
fn legend(out: &mut String, samples: &[Sample<f64>], curves: &[Params<f64>]) {
    let y = 50.0;
    let measured = format!("measured ({})", samples.len());
    let _ = write!(out, "<g fill=\"none\" stroke-linecap=\"round\">");
    svg::dots(out, [0.0, 9.0, 18.0].map(|dx| (LEFT + 5.0 + dx, y - 4.0)).into_iter());
    let mut at = LEFT + 32.0;
    let mut entries = vec![(measured, 0)];
    if let Some((best, others)) = curves.split_first() {
        let mse = format!("MSE{}", svg::sup("2"));
        let error = svg::number(mse2(&eq_14(best), samples));
        entries.push((format!("best fit, {mse} = {error}"), 1));
        if let Some(worst) = others.last() {
            let error = svg::number(mse2(&eq_14(worst), samples));
            let kind = if others.len() == 1 { "minimum" } else { "minima" };
            let range = if others.len() == 1 { "=" } else { "up to" };
            let drawn = match others.len() {
                count if count > OTHERS => format!("{OTHERS} of {count}"),
                count => count.to_string(),
            };
            let text = format!("{drawn} other {kind}, {mse} {range} {error}");
            entries.push((text, 2));
        }
    }
    for (text, kind) in entries {
        if kind > 0 {
            let style = [svg::THICK, svg::THIN][kind - 1];
            svg::path(out, style, &[(at, y - 4.0), (at + 26.0, y - 4.0)]);
            at += 34.0;
        }
        svg::text(out, at, y, svg::INK, &text);
        at += 7.7 * svg::letters(&text) as f64 + 22.0;
    }
    out.push_str("</g>");
    if let Some(best) = curves.first() {
        let symbols = ["d", "s", "v"]
            .map(|index| svg::sub("ρ", index))
            .into_iter()
            .chain(["m", "n", "κ"].map(svg::italic));
        let values = best
            .to_array()
            .into_iter()
            .zip(symbols)
            .map(|(value, symbol)| format!("{symbol} = {}", svg::number(value)));
        let text = values.collect::<Vec<_>>().join(",  ");
        svg::text(out, LEFT, y + 22.0, svg::INK, &text);
    }
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

/// Degrees with as many decimals as needed, at most three.
fn degrees(radians: f64) -> String {
    axis::plain((radians.to_degrees() * 1000.0).round() / 1000.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn params(m: f64) -> Params<f64> {
        Params::from_array([0.15, 1.0, 0.001, m, 1.1, 0.86])
    }

    fn scan(angles: u32) -> Vec<Sample<f64>> {
        let sample = |theta_i: f64, theta_s: f64| Sample::in_plane(theta_i.to_radians(), theta_s.to_radians(), 0.05);
        let of = |k| (-85..=85).map(move |theta_s| sample(f64::from(k) * 2.0, f64::from(theta_s)));
        (0..angles).flat_map(of).collect()
    }

    #[test]
    fn is_small_however_much_there_is_to_draw() {
        let curves: Vec<_> = (0..64).map(|k| params(0.005 + 0.01 * f64::from(k))).collect();
        let svg = scan_svg("<&>", &scan(40), &curves);
        assert!(svg.len() < 100_000, "{} bytes", svg.len());
        assert_eq!(svg.matches("translate(").count(), 10);
        assert!(
            svg.contains("shown: 10 of 40 incident angles, one in 3 samples")
                && svg.contains("24 of 63 other minima")
                && svg.contains("&lt;&amp;&gt;")
                && !svg.contains("NaN")
        );
    }

    #[test]
    fn resolves_a_narrow_peak() {
        let x = Axis::angles([-85.0, 85.0].into_iter(), 800.0);
        let y = Axis::logarithm([-2.0, 4.0].into_iter(), 400.0);
        for m in [1e-5, 0.005] {
            let peak = curve::peak(&eq_14(&params(m)), 30f64.to_radians(), &x);
            let at = |theta_s: f64| curve::peak(&eq_14(&params(m)), theta_s.to_radians(), &x);
            assert!(peak > 2.0 && (peak - at(30.0)).abs() < 1e-12);
            let line = curve(&eq_14(&params(0.005)), 30f64.to_radians(), &x, &y, TRUE_TO);
            let top = line.iter().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
            assert!((top.0 - x.pixel(30.0)).abs() < 0.5);
        }
    }

    #[test]
    fn draws_nothing_where_there_is_nothing() {
        assert!(scan_svg("", &[], &[]).ends_with("</svg>\n"));
        assert!(!scan_svg("", &scan(1)[..1], &[]).contains("NaN"));
    }
}
