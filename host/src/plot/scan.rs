//! A scan with its fits as a picture: points, the distinct minima as thin lines, the best as a thick one.

use std::fmt::Write;

use brdfit_core::geometry::Sample;
use brdfit_core::model::Parameter;

use super::curve::{mse2, of};
use super::frame::LEFT;
use super::panels::{Line, TRUE_TO, draw};
use super::svg;
use crate::engine::Material;

/// Thin lines at most.
const OTHERS: usize = 24;
/// How far a thin line may be from the model, pixels.
const OTHERS_TRUE_TO: f64 = 0.25;
/// Height of the title and the legend, pixels.
const TOP: f64 = 80.0;

/// A scan and its fits as SVG: log BRDF (sr^-1) over signed theta_s (degrees, positive forward), one panel an incident angle.
///
/// `curves` are the distinct minima, best first: the best is a thick line, the others are thin ones; it may be empty.
/// Samples out of plane are projected: theta_s counts as forward where cos(delta_phi) < 0, while the curves are those in plane.
/// All panels share both ranges: the horizontal one is that of the data, the vertical one that of the data and of the best curve's peak, up to a decade above the data; lines that leave it are cut.
/// Of very many only some are drawn (every k-th angle, every k-th sample, the best minima), and the picture says so; so the file stays below 100 kB.
pub fn scan_svg(title: &str, samples: &[Sample<f64>], curves: &[Material]) -> String {
    let drawn = &curves[..curves.len().min(1 + OTHERS)];
    let lines: Vec<Line> = drawn
        .iter()
        .enumerate()
        .map(|(place, material)| Line {
            ln_f: of(material),
            style: if place == 0 { svg::THICK } else { svg::THIN }.to_string(),
            true_to: if place == 0 { TRUE_TO } else { OTHERS_TRUE_TO },
        })
        .collect();
    draw(title, samples, &lines, TOP, |out| legend(out, samples, curves))
}

/// What the marks mean, how well the curves fit, and the best parameters.
fn legend(out: &mut String, samples: &[Sample<f64>], curves: &[Material]) {
    let y = 50.0;
    let measured = format!("measured ({})", samples.len());
    let _ = write!(out, "<g fill=\"none\" stroke-linecap=\"round\">");
    svg::dots(out, [0.0, 9.0, 18.0].map(|dx| (LEFT + 5.0 + dx, y - 4.0)).into_iter());
    let mut at = LEFT + 32.0;
    let mut entries = vec![(measured, 0)];
    if let Some((best, others)) = curves.split_first() {
        let mse = format!("MSE{}", svg::sup("2"));
        let error = svg::number(mse2(&of(best), samples));
        entries.push((format!("best fit, {mse} = {error}"), 1));
        if let Some(worst) = others.last() {
            let error = svg::number(mse2(&of(worst), samples));
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
        let parameters = best.model.parameters.iter().zip(best.values.iter());
        let values = parameters.map(|(parameter, &value)| format!("{} = {}", symbol(parameter), svg::number(value)));
        let text = values.collect::<Vec<_>>().join(",  ");
        svg::text(out, LEFT, y + 22.0, svg::INK, &text);
    }
}

/// The symbol of a parameter as it is set.
fn symbol(parameter: &Parameter) -> String {
    match parameter.symbol.split_once('_') {
        Some((letter, index)) => svg::sub(letter, index),
        None => svg::italic(parameter.symbol),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::axis::Axis;
    use crate::plot::curve::{curve, peak};

    fn params(m: f64) -> Material {
        Material::paper([0.15, 1.0, 0.001, m, 1.1, 0.86])
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
            let highest = peak(&of(&params(m)), 30f64.to_radians(), &x);
            let at = |theta_s: f64| peak(&of(&params(m)), theta_s.to_radians(), &x);
            assert!(highest > 2.0 && (highest - at(30.0)).abs() < 1e-12);
            let line = curve(&of(&params(0.005)), 30f64.to_radians(), &x, &y, TRUE_TO);
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
