//! Several models' best fits over the data.

use super::curve::LnF;
use super::frame::LEFT;
use super::marks::Data;
use super::panels::{Line, TRUE_TO, draw};
use super::svg;

/// A model's line, and what it is called.
pub struct Overlay<'a> {
    /// For the legend.
    pub label: String,
    /// The model.
    pub ln_f: LnF<'a>,
}

/// Okabe and Ito's colours, which the colour-blind tell apart too; then greys.
const COLOURS: [&str; 9] = [
    "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#b3a000", "#555555", "#aaaaaa",
];
/// Entries of a row of the legend, and their size in pixels.
const ENTRIES: usize = 3;
const ENTRY: (f64, f64) = (272.0, 20.0);

/// As [`super::scan_svg`], one line a model, the first on top and setting the vertical range.
pub fn overlay_svg(title: &str, data: &Data, models: &[Overlay]) -> String {
    let style = |place: usize| format!("stroke=\"{}\" stroke-width=\"2\"", COLOURS[place % COLOURS.len()]);
    let lines: Vec<Line> = models
        .iter()
        .enumerate()
        .map(|(place, model)| Line {
            ln_f: Box::new(|sample| (model.ln_f)(sample)),
            style: style(place),
            true_to: TRUE_TO,
        })
        .collect();
    let rows = models.len().div_ceil(ENTRIES);
    draw(title, data, &lines, 46.0 + ENTRY.1 * rows as f64, |out| {
        out.push_str("<g fill=\"none\">");
        for (place, model) in models.iter().enumerate() {
            let (x, y) = (
                LEFT + ENTRY.0 * (place % ENTRIES) as f64,
                50.0 + ENTRY.1 * (place / ENTRIES) as f64,
            );
            svg::path(out, &style(place), &[(x, y - 4.0), (x + 26.0, y - 4.0)]);
            svg::text(out, x + 34.0, y, svg::INK, &svg::escape(&model.label));
        }
        out.push_str("</g>");
    })
}
