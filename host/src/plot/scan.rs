//! A scan with its fits as a picture: points, the distinct minima as thin lines, the best as a thick one.

use std::fmt::Write;

use brdfit_core::model::Parameter;

use super::curve::{mse2, of};
use super::frame::LEFT;
use super::marks::Data;
use super::panels::{Line, TRUE_TO, draw};
use super::svg;
use crate::engine::Material;

/// Thin lines at most.
const OTHERS: usize = 24;
/// How far a thin line may be from the model, pixels.
const OTHERS_TRUE_TO: f64 = 0.25;
/// Width of a letter of the legend, pixels; the fonts that a browser may take are up to 7.9 wide, and the gaps have room for that.
const LETTER: f64 = 7.2;
/// Height of the title and the legend, pixels.
const TOP: f64 = 80.0;

/// A scan and its fits as SVG: log BRDF (sr^-1) over signed theta_s (degrees, positive forward), one panel an incident angle.
///
/// `curves` are the distinct minima, best first: the best is a thick line, the others are thin ones; it may be empty.
/// Samples out of plane are drawn apart, over their angle from the specular direction, with the best model as rings; samples that were left out are grey crosses.
/// All panels share both ranges: the horizontal one is that of the data, the vertical one that of the data and of the best curve's peak, up to a decade above the data; lines that leave it are cut.
/// Of very many only some are drawn (every k-th angle, the highest and lowest of neighbouring samples, the best minima), and the picture says so; so the file stays below 100 kB.
pub fn scan_svg(title: &str, data: &Data, curves: &[Material]) -> String {
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
    draw(title, data, &lines, TOP, |out| legend(out, data, curves))
}

/// What the marks mean, how well the curves fit, and the best parameters.
fn legend(out: &mut String, data: &Data, curves: &[Material]) {
    let (y, samples) = (50.0, data.samples);
    let measured = format!("measured ({})", samples.len());
    let _ = write!(out, "<g fill=\"none\" stroke-linecap=\"round\">");
    svg::dots(out, [0.0, 9.0, 18.0].map(|dx| (LEFT + 5.0 + dx, y - 4.0)).into_iter());
    let mut at = LEFT + 32.0;
    let mut entries = vec![(measured, 0)];
    if data.left_out_count > 0 {
        let drawn = match (data.left_out.len(), data.left_out_count) {
            (drawn, all) if drawn < all => format!("left out ({all}, shown {drawn})"),
            (_, all) => format!("left out ({all})"),
        };
        entries.push((drawn, 3));
    }
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
        if kind == 3 {
            svg::crosses(out, std::iter::once((at + 4.0, y - 4.0)));
            at += 14.0;
        } else if kind > 0 {
            let style = [svg::THICK, svg::THIN][kind - 1];
            svg::path(out, style, &[(at, y - 4.0), (at + 26.0, y - 4.0)]);
            at += 34.0;
        }
        svg::text(out, at, y, svg::INK, &text);
        at += LETTER * svg::letters(&text) as f64 + 18.0;
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
    use brdfit_core::geometry::Sample;

    use super::*;
    use crate::plot::axis::Axis;
    use crate::plot::curve::{curve, peak};

    fn params(m: f64) -> Material {
        Material::paper([0.15, 1.0, 0.001, m, 1.1, 0.86])
    }

    fn all(samples: &[Sample<f64>]) -> Data<'_> {
        Data {
            samples,
            left_out: &[],
            left_out_count: 0,
        }
    }

    fn scan(angles: u32) -> Vec<Sample<f64>> {
        let sample = |theta_i: f64, theta_s: f64| Sample::in_plane(theta_i.to_radians(), theta_s.to_radians(), 0.05);
        let of = |k| (-85..=85).map(move |theta_s| sample(f64::from(k) * 2.0, f64::from(theta_s)));
        (0..angles).flat_map(of).collect()
    }

    #[test]
    fn is_small_however_much_there_is_to_draw() {
        let curves: Vec<_> = (0..64).map(|k| params(0.005 + 0.01 * f64::from(k))).collect();
        let svg = scan_svg("<&>", &all(&scan(40)), &curves);
        assert!(svg.len() < 100_000, "{} bytes", svg.len());
        assert_eq!(svg.matches("translate(").count(), 10);
        assert!(
            svg.contains("shown: 10 of 40 incident angles, 1710 of 6840 samples")
                && svg.contains("24 of 63 other minima")
                && svg.contains("&lt;&amp;&gt;")
                && !svg.contains("NaN")
        );
    }

    #[test]
    fn out_of_plane_and_left_out_samples_look_so() {
        let in_plane = scan(1);
        let out: Vec<Sample<f64>> = in_plane[..20]
            .iter()
            .map(|sample| Sample {
                delta_phi: 1.0,
                ..*sample
            })
            .collect();
        let both = [in_plane.clone(), out].concat();
        let svg = scan_svg("", &all(&both), &[params(0.1)]);
        assert_eq!(svg.matches("translate(").count(), 2);
        assert!(svg.contains("out of the plane of incidence") && svg.contains("measured (191)"));
        // Dots of the plane are those of a scan without the others.
        let dots = |svg: &str| {
            svg.split("stroke-width=\"2.8\" d=\"")
                .nth(2)
                .map(|rest| rest.matches("h0").count())
        };
        assert_eq!(dots(&svg), dots(&scan_svg("", &all(&in_plane), &[params(0.1)])));
        let some = Data {
            samples: &in_plane[3..],
            left_out: &in_plane[..3],
            left_out_count: 5,
        };
        let svg = scan_svg("", &some, &[]);
        assert!(svg.contains("measured (168)") && svg.contains("left out (5, shown 3)"));
        assert_eq!(svg.matches("l5 5m-5 0l5-5").count(), 3 + 1);
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
        assert!(scan_svg("", &all(&[]), &[]).ends_with("</svg>\n"));
        assert!(!scan_svg("", &all(&scan(1)[..1]), &[]).contains("NaN"));
    }
}
