//! Residuals of ln f over the scattering angle, with the band of the noise.

use std::fmt::Write;

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::axis::Axis;
use super::frame::{BOTTOM, CAPTION, GAP, LEFT, PANELS, POINTS, RIGHT, WIDTH, degrees, frame};
use super::svg;
use crate::engine::Material;

const TOP: f64 = 10.0;

/// Model less measurement in ln f, times the weight of the sample, over signed theta_s (degrees, positive forward), one panel an incident angle.
///
/// `scale` is the standard deviation of a residual: the bands are one and two of them wide on each side.
/// All panels share both ranges; of very many angles and samples only some are drawn, as in [`super::scan_svg`].
pub fn residuals_svg(samples: &[Sample<f64>], material: &Material, scale: f64) -> String {
    let all = by_angle(samples);
    let panels: Vec<_> = all.iter().step_by(all.len().div_ceil(PANELS).max(1)).collect();
    let columns = match panels.len() {
        0 | 1 => 1,
        2 | 4 => 2,
        _ => 3,
    };
    let rows = panels.len().max(1).div_ceil(columns);
    let width = (WIDTH - LEFT - RIGHT - GAP * (columns - 1) as f64) / columns as f64;
    let height = [200.0, 160.0, 130.0][columns - 1];
    let points: Vec<Vec<(f64, f64)>> = panels
        .iter()
        .map(|(_, samples)| samples.iter().filter_map(|sample| point(sample, material)).collect())
        .collect();
    let x = Axis::angles(points.iter().flatten().map(|p| p.0), width);
    let band = if scale.is_finite() { 2.2 * scale } else { 0.0 };
    let far = points.iter().flatten().map(|p| p.1.abs()).fold(band, f64::max);
    let y = Axis::linear([-far, far].into_iter(), height).upwards();

    let total = TOP + rows as f64 * (height + CAPTION) + BOTTOM;
    let mut out = String::new();
    svg::open(&mut out, WIDTH, total);
    let stride = samples.len().div_ceil(POINTS).max(1);
    for (place, points) in points.iter().enumerate() {
        let left = LEFT + (place % columns) as f64 * (width + GAP);
        let top = TOP + (place / columns) as f64 * (height + CAPTION) + CAPTION;
        let _ = write!(out, "\n<g transform=\"translate({left:.1} {top:.1})\">");
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
        frame(&mut out, &x, &y, place % columns == 0, place + columns >= panels.len());
        let caption = format!("{} = {}°", svg::sub("θ", "i"), degrees(panels[place].0));
        svg::text(&mut out, 0.0, -7.0, "", &caption);
        out.push_str("<g fill=\"none\" stroke-linecap=\"round\">");
        let zero = y.pixel(0.0);
        svg::path(
            &mut out,
            "stroke=\"#f08a24\" stroke-width=\"2\"",
            &[(0.0, zero), (width, zero)],
        );
        let drawn = points.iter().step_by(stride);
        svg::dots(&mut out, drawn.map(|p| (x.pixel(p.0), y.pixel(p.1))));
        out.push_str("</g></g>");
    }
    let middle = LEFT + 0.5 * (WIDTH - LEFT - RIGHT);
    let label = format!("scattering angle {} (degrees, positive forward)", svg::sub("θ", "s"));
    svg::text(&mut out, middle, total - 12.0, "text-anchor=\"middle\"", &label);
    let centre = 0.5 * (TOP + CAPTION + total - BOTTOM);
    let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 18 {centre:.1})\"");
    svg::text(
        &mut out,
        18.0,
        centre,
        &turned,
        &format!("residual of ln {}", svg::italic("f")),
    );
    out.push_str("\n</svg>\n");
    out
}

/// Signed theta_s in degrees and the residual; none beyond the horizon.
fn point(sample: &Sample<f64>, material: &Material) -> Option<(f64, f64)> {
    Some((signed_theta_s(sample), material.residual(sample)?))
}

/// Degrees, positive forward.
pub fn signed_theta_s(sample: &Sample<f64>) -> f64 {
    let forward = Real::sin_cos(sample.delta_phi).1 < 0.0;
    if forward { sample.theta_s } else { -sample.theta_s }.to_degrees()
}

/// The samples by incident angle, radians, equal to a hundredth of a degree; ascending.
pub fn by_angle(samples: &[Sample<f64>]) -> Vec<(f64, Vec<&Sample<f64>>)> {
    let mut groups = std::collections::BTreeMap::new();
    for sample in samples {
        let key = (sample.theta_i.to_degrees() * 100.0).round() as i64;
        let group = groups.entry(key).or_insert_with(|| (sample.theta_i, Vec::new()));
        group.1.push(sample);
    }
    groups.into_values().collect()
}
