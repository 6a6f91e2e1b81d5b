//! The lobes in the plane of incidence as a polar picture with a logarithmic radius.

use std::fmt::Write;

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::axis::plain;
use super::frame::{POINTS, degrees};
use super::marks::thinned;
use super::svg;
use super::svg::log10;
use crate::engine::Material;
use crate::input::plane::{by_angle, signed_theta_s};

/// Okabe and Ito's colours, which the colour-blind tell apart too.
const COLOURS: [&str; 6] = ["#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
/// Decades at most; what is darker is drawn at the centre.
const DECADES: f64 = 8.0;

/// Sizes in pixels.
const WIDTH: f64 = 900.0;
const HEIGHT: f64 = 470.0;
const RADIUS: f64 = 370.0;
const CENTRE: (f64, f64) = (450.0, 430.0);

/// Data as crosses and the best fit as lines, BRDF (sr^-1) over signed theta_s, which is 0 upwards and positive to the right.
///
/// Of more than six incident angles an even choice is drawn; the dashed ray is that of incidence.
/// Samples out of the plane of incidence are not drawn.
pub fn polar_svg(samples: &[Sample<f64>], material: &Material) -> String {
    let all = by_angle(samples);
    let shown: Vec<_> = all.iter().step_by(all.len().div_ceil(COLOURS.len()).max(1)).collect();
    let lines: Vec<Vec<(f64, f64)>> = shown.iter().map(|(theta_i, _)| line(*theta_i, material)).collect();
    let data = || {
        shown
            .iter()
            .flat_map(|(_, samples)| samples)
            .map(|sample| log10(sample.brdf))
    };
    let highest = data().fold(f64::NEG_INFINITY, f64::max);
    let peak = lines.iter().flatten().map(|p| p.1).fold(highest, f64::max);
    let outer = peak.min(highest + 1.0).ceil();
    let inner = data().fold(f64::INFINITY, f64::min).floor().max(outer - DECADES);
    // Less than a decade is drawn as one.
    let inner = inner.min(outer - 1.0);
    let radius = |log10: f64| RADIUS * ((log10 - inner) / (outer - inner)).clamp(0.0, 1.02);
    let place = |(theta_s, log10): (f64, f64)| {
        let (sin, cos) = Real::portable_sin_cos(theta_s.to_radians());
        (CENTRE.0 + radius(log10) * sin, CENTRE.1 - radius(log10) * cos)
    };

    let mut out = String::new();
    svg::open(&mut out, WIDTH, HEIGHT);
    grid(&mut out, inner, outer);
    out.push_str("<g fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\">");
    for (((theta_i, samples), line), colour) in shown.iter().zip(&lines).zip(COLOURS) {
        let ray = [place((-theta_i.to_degrees(), outer)), CENTRE];
        svg::path(&mut out, &format!("stroke=\"{colour}\" stroke-dasharray=\"5 5\""), &ray);
        let line: Vec<_> = line.iter().map(|&point| place(point)).collect();
        svg::path(&mut out, &format!("stroke=\"{colour}\" stroke-width=\"2.2\""), &line);
        let measured = samples
            .iter()
            .filter_map(|sample| Some((signed_theta_s(sample)?, log10(sample.brdf))));
        // Thinned over the angle, so that peaks stay.
        let upright = thinned(
            measured.map(|(angle, log10)| (angle, -log10)).collect(),
            POINTS / shown.len(),
        );
        let crossed = upright.into_iter().map(|(angle, log10)| place((angle, -log10)));
        crosses(&mut out, colour, crossed);
    }
    for (row, ((theta_i, _), colour)) in shown.iter().zip(COLOURS).enumerate() {
        let y = 24.0 + 20.0 * row as f64;
        svg::path(
            &mut out,
            &format!("stroke=\"{colour}\" stroke-width=\"2.2\""),
            &[(14.0, y - 4.0), (40.0, y - 4.0)],
        );
        crosses(&mut out, colour, [(27.0, y - 4.0)].into_iter());
        let label = format!("{} = {}°", svg::sub("θ", "i"), degrees(*theta_i));
        svg::text(&mut out, 48.0, y, svg::INK, &label);
    }
    out.push_str("</g>\n</svg>\n");
    out
}

/// Signed theta_s in degrees and log10 of the model, dense around the specular and the retro direction.
fn line(theta_i: f64, material: &Material) -> Vec<(f64, f64)> {
    let mut angles: Vec<f64> = (-179..=179).map(|half| 0.5 * f64::from(half)).collect();
    for peak in [theta_i.to_degrees(), -theta_i.to_degrees()] {
        let mut offset = 1e-4;
        angles.push(peak);
        while offset < 5.0 {
            angles.extend([peak - offset, peak + offset]);
            offset *= 1.3;
        }
    }
    angles.retain(|angle| angle.abs() <= 89.5);
    angles.sort_by(f64::total_cmp);
    let value = |theta_s: f64| {
        let sample = Sample::in_plane(theta_i, theta_s.to_radians(), 1.0);
        Some((theta_s, material.ln_f(&sample)? * std::f64::consts::LOG10_E))
    };
    angles.into_iter().filter_map(value).collect()
}

/// A ring a decade and a ray every 15 degrees.
fn grid(out: &mut String, inner: f64, outer: f64) {
    let (x, y) = CENTRE;
    let decades = (outer - inner) as i32;
    for decade in 0..=decades {
        let radius = RADIUS * f64::from(decade) / f64::from(decades);
        let colour = if decade == decades { "#333" } else { "#ddd" };
        let _ = write!(
            out,
            "<path d=\"M{:.1} {y}a{radius:.1} {radius:.1} 0 0 1 {:.1} 0\" fill=\"none\" stroke=\"{colour}\"/>",
            x - radius,
            2.0 * radius
        );
        let label = format!("10{}", svg::sup(&plain(inner + f64::from(decade))));
        if decades == 1 && decade == 1 {
            // Two labels are no scale.
            let half = RADIUS * log10(3.0);
            svg::text(
                out,
                x + half,
                y + 20.0,
                "text-anchor=\"middle\" font-size=\"12\"",
                &svg::number(3.0 * Real::portable_exp(inner * std::f64::consts::LN_10)),
            );
        }
        for side in [-1.0, 1.0].iter().take(if decade == 0 { 1 } else { 2 }) {
            let at = x + side * radius;
            svg::text(out, at, y + 20.0, "text-anchor=\"middle\" font-size=\"12\"", &label);
        }
    }
    let _ = write!(
        out,
        "<path d=\"M{:.1} {y}h{:.1}\" stroke=\"#333\"/>",
        x - RADIUS,
        2.0 * RADIUS
    );
    for ray in -5..=5 {
        let angle = 15.0 * f64::from(ray);
        let (sin, cos) = Real::portable_sin_cos(angle.to_radians());
        let end = |radius: f64| (x + radius * sin, y - radius * cos);
        svg::path(out, "stroke=\"#ddd\"", &[CENTRE, end(RADIUS)]);
        let (label_x, label_y) = end(RADIUS + 20.0);
        svg::text(
            out,
            label_x,
            label_y + 4.0,
            "text-anchor=\"middle\" font-size=\"12\"",
            &format!("{}°", plain(angle)),
        );
    }
    let label = format!("BRDF (sr{})", svg::sup("−1"));
    svg::text(out, x, y + 38.0, "text-anchor=\"middle\" font-size=\"12\"", &label);
}

/// Small crosses.
fn crosses(out: &mut String, colour: &str, points: impl Iterator<Item = (f64, f64)>) {
    let _ = write!(out, "<path stroke=\"{colour}\" stroke-width=\"1\" d=\"");
    for (x, y) in points {
        let _ = write!(out, "M{:.1} {:.1}l5 5m-5 0l5-5", x - 2.5, y - 2.5);
    }
    out.push_str("\"/>");
}
