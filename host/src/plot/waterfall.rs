//! Where all starts of a search ended, and how soon the best of them came.

use std::fmt::Write;

use super::axis::Axis;
use super::frame::frame;
use super::svg;
use super::svg::log10;

/// Sizes in pixels.
const WIDTH: f64 = 900.0;
const LEFT: f64 = 104.0;
const RIGHT: f64 = 16.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 50.0;
const GAP: f64 = 34.0;
const HEIGHT: f64 = 240.0;

/// A distinct minimum as the starts met it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// Its MSE^2 (Eq. 17).
    pub mse2: f64,
    /// How many starts ended in it.
    pub hits: u32,
    /// The first of these.
    pub first_start: u64,
}

/// Left, the final MSE^2 (Eq. 17) of each start in ascending order; right, the least of the first k of them over k.
///
/// Each start counts with the distinct minimum that it ended in, whose MSE^2 is its own to 1 %.
pub fn waterfall_svg(minima: &[Met], starts: u32) -> String {
    let width = (WIDTH - LEFT - RIGHT - GAP) / 2.0;
    // An exact fit has no logarithm.
    let height = |minimum: &Met| log10(minimum.mse2.max(1e-40));
    let y = Axis::logarithm(minima.iter().map(height), HEIGHT);
    let rank = Axis::linear([0.0, f64::from(starts)].into_iter(), width);
    let count = Axis::logarithm([0.0, log10(f64::from(starts))].into_iter(), width).rightwards();

    let ends = minima
        .iter()
        .flat_map(|minimum| (0..minimum.hits).map(|_| height(minimum)));
    let sorted = ends.enumerate().map(|(rank, height)| (1.0 + rank as f64, height));
    let mut by_start: Vec<&Met> = minima.iter().collect();
    by_start.sort_by_key(|minimum| minimum.first_start);
    let mut best: Vec<(f64, f64)> = Vec::new();
    for minimum in by_start {
        let here = log10(1.0 + minimum.first_start as f64);
        match best.last().copied() {
            Some((_, least)) if height(minimum) >= least => continue,
            Some((_, least)) => best.extend([(here, least), (here, height(minimum))]),
            None => best.push((here, height(minimum))),
        }
    }
    best.extend(best.last().copied().map(|(_, least)| (log10(f64::from(starts)), least)));

    let mut out = String::new();
    svg::open(&mut out, WIDTH, TOP + HEIGHT + BOTTOM);
    let panels = [
        (LEFT, &rank, "start, in order of its end", "final error of every start"),
        (
            LEFT + width + GAP,
            &count,
            "number of starts",
            "least error of the first starts",
        ),
    ];
    for (place, (left, x, label, title)) in panels.into_iter().enumerate() {
        let _ = write!(out, "\n<g transform=\"translate({left:.1} {TOP:.1})\">");
        frame(&mut out, x, &y, place == 0, true);
        svg::text(&mut out, 0.0, -9.0, "", title);
        svg::text(&mut out, 0.5 * width, HEIGHT + 38.0, "text-anchor=\"middle\"", label);
        out.push_str("<g fill=\"none\" stroke-linecap=\"round\">");
        if place == 0 {
            svg::dots(&mut out, sorted.clone().map(|p| (rank.pixel(p.0), y.pixel(p.1))));
        } else {
            let line: Vec<_> = best.iter().map(|p| (count.pixel(p.0), y.pixel(p.1))).collect();
            svg::path(&mut out, svg::THICK, &line);
        }
        out.push_str("</g></g>");
    }
    let centre = TOP + 0.5 * HEIGHT;
    let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 18 {centre:.1})\"");
    svg::text(&mut out, 18.0, centre, &turned, &format!("MSE{}", svg::sup("2")));
    out.push_str("\n</svg>\n");
    out
}
