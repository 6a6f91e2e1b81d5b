//! The share of scenes where each racer is there, over the passes: one panel a group of scenes.

use std::fmt::Write;

const WIDTH: f64 = 960.0;
const LEFT: f64 = 50.0;
const GAP: f64 = 24.0;
const TOP: f64 = 30.0;
const HEIGHT: f64 = 280.0;
const LINE: f64 = 17.0;
/// The least number of passes that is drawn.
const FEWEST: f64 = 3.0;
const COLOURS: [&str; 8] = [
    "#d62728", "#1f77b4", "#2ca02c", "#9467bd", "#8c564b", "#e377c2", "#7f7f7f", "#17becf",
];

/// Racers beyond the colours are dashed.
fn style(racer: usize) -> String {
    let dashes = if racer >= COLOURS.len() {
        " stroke-dasharray=\"6 3\""
    } else {
        ""
    };
    let width = if racer == 0 { 3.0 } else { 1.5 };
    format!(
        "stroke=\"{}\" stroke-width=\"{width}\" fill=\"none\"{dashes}",
        COLOURS[racer % COLOURS.len()]
    )
}

/// The picture; `panels` has a title, and for each racer the passes that it needed for each scene.
pub fn svg(names: &[String], panels: &[(String, Vec<Vec<f64>>)], most: f64) -> String {
    let columns = panels.len() as f64;
    let width = (WIDTH - LEFT - GAP * columns) / columns;
    let height = TOP + HEIGHT + 50.0 + LINE * (names.len() as f64 / 2.0).ceil() + 10.0;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{WIDTH}\" height=\"{height}\" fill=\"white\"/>\n"
    );
    for (panel, (title, firsts)) in panels.iter().enumerate() {
        let left = LEFT + panel as f64 * (width + GAP);
        let x = |passes: f64| left + width * (passes.max(FEWEST) / FEWEST).ln() / (most / FEWEST).ln();
        let y = |share: f64| TOP + HEIGHT * (1.0 - share);
        let _ = writeln!(
            svg,
            "<text x=\"{left}\" y=\"{}\" font-weight=\"bold\">{title}</text>",
            TOP - 10.0
        );
        for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
            let _ = writeln!(svg, "<path d=\"M{left} {0}h{width}\" stroke=\"#ddd\"/>", y(share));
            if panel == 0 {
                let _ = writeln!(
                    svg,
                    "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{:.0} %</text>",
                    left - 6.0,
                    y(share) + 4.0,
                    100.0 * share
                );
            }
        }
        for passes in [10.0, 100.0, 1000.0] {
            let _ = writeln!(
                svg,
                "<path d=\"M{0} {TOP}v{HEIGHT}\" stroke=\"#ddd\"/><text x=\"{0}\" y=\"{1}\" text-anchor=\"middle\">{passes}</text>",
                x(passes),
                TOP + HEIGHT + 16.0
            );
        }
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">passes over the scan</text>",
            left + width / 2.0,
            TOP + HEIGHT + 34.0
        );
        for (racer, firsts) in firsts.iter().enumerate().rev() {
            let mut sorted: Vec<f64> = firsts.iter().copied().filter(|first| *first <= most).collect();
            sorted.sort_by(f64::total_cmp);
            let mut path = format!("M{:.1} {:.1}", x(FEWEST), y(0.0));
            for (k, first) in sorted.iter().enumerate() {
                let _ = write!(path, "H{:.1}V{:.1}", x(*first), y((k + 1) as f64 / firsts.len() as f64));
            }
            let _ = writeln!(svg, "<path d=\"{path}H{:.1}\" {}/>", x(most), style(racer));
        }
    }
    for (racer, name) in names.iter().enumerate() {
        let (column, row) = (racer % 2, racer / 2);
        let (x, y) = (
            LEFT + column as f64 * WIDTH / 2.0,
            TOP + HEIGHT + 58.0 + LINE * row as f64,
        );
        let _ = writeln!(
            svg,
            "<path d=\"M{x} {y}h30\" {}/><text x=\"{}\" y=\"{}\">{name}</text>",
            style(racer),
            x + 38.0,
            y + 4.0
        );
    }
    svg + "</svg>\n"
}
