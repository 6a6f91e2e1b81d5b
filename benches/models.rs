//! Which model each measured scan needs, as `brdfit fit --model auto` tells: `cargo run --release --example models > benches/results/models.md`.

use std::path::Path;

use brdfit::analysis::choose::{Choice, choose};
use brdfit::engine::FitOptions;
use brdfit::engine::models::MODELS;
use brdfit::input::{Measurement, ReadOptions, read_file};
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

fn main() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/real");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("left out: the measured scans are not at {}", folder.display());
        return;
    };
    let mut files: Vec<_> = entries
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .filter(|path| path.extension().is_some_and(|ending| ending == "csv"))
        .collect();
    files.sort();
    let scans: Vec<(String, Measurement, Choice)> = files.iter().map(|file| chosen(file)).collect();
    println!("# Which model the measured scans need\n");
    println!(
        "The choice of `brdfit fit --model auto`: the least BIC of all {} models. Where the residuals of the best of them wander with the angle, so many samples count as one, for all models alike (\"independent\" has their number): of equally many parameters the least residual is chosen, and a further parameter must buy more than wandering gives.",
        MODELS.len()
    );
    println!(
        "Residuals are root mean squares of ln f, so 0.05 is 5 %; noise is what neighbouring samples scatter about the line between their neighbours, by the median, so that peaks do not count."
    );
    println!(
        "A residual near the noise leaves nothing to explain; one far above it says that no model of the list is right."
    );
    println!("Printed by `cargo run --release --example models > benches/results/models.md`.\n");
    println!(
        "| scan | samples | independent | Eq. 14 | best | falls by | noise | model | its parameters | BIC to the next | on a bound |"
    );
    println!("|---|--:|--:|--:|--:|--:|--:|---|--:|--:|---|");
    for (name, measurement, choice) in &scans {
        let best = choice.chosen();
        let paper = choice.candidates[0].outcome.rms_ln;
        let others = choice.candidates.iter().filter(|one| one.options != best.options);
        let next = others.map(|one| one.criteria.bic).fold(f64::INFINITY, f64::min);
        println!(
            "| {name} | {} | {:.0} | {paper:.3} | {:.3} | {:.0} % | {:.3} | {} | {} | {:.0} | {} |",
            measurement.samples.len(),
            best.criteria.samples,
            best.outcome.rms_ln,
            100.0 * (1.0 - best.outcome.rms_ln / paper),
            noise(&measurement.samples),
            best.options.model.name,
            best.criteria.parameters,
            next - best.criteria.bic,
            best.outcome.at_bound.join(", "),
        );
    }
    println!("\nResiduals of every model, and by how much its BIC is above the least:\n");
    println!("| model | parameters | {} |", names(&scans, |name, _| name.to_string()));
    println!("|---|--:|{}", "--:|".repeat(scans.len()));
    for (place, model) in MODELS.iter().enumerate() {
        let cell = |choice: &Choice| {
            let one = &choice.candidates[place];
            let above = one.criteria.bic - choice.chosen().criteria.bic;
            format!("{:.3}, {above:.0}", one.outcome.rms_ln)
        };
        println!(
            "| `{}`: {} | {} | {} |",
            model.name,
            model.what,
            model.parameters.len(),
            names(&scans, |_, choice| cell(choice))
        );
    }
}

fn names(scans: &[(String, Measurement, Choice)], cell: impl Fn(&str, &Choice) -> String) -> String {
    let cells: Vec<String> = scans.iter().map(|(name, _, choice)| cell(name, choice)).collect();
    cells.join(" | ")
}

/// The name of a scan, the scan, and the choice of its model.
fn chosen(file: &Path) -> (String, Measurement, Choice) {
    let name = file.file_stem().map(|name| name.to_string_lossy().into_owned());
    let scan = read_file(file, &ReadOptions::default(), &mut std::io::empty())
        .unwrap_or_else(|error| panic!("{error}"))
        .into_iter()
        .next()
        .expect("a scan");
    let candidates: Vec<FitOptions> = MODELS.iter().map(FitOptions::of).collect();
    let choice = choose(&scan.samples, &candidates).unwrap_or_else(|error| panic!("{error}"));
    (name.unwrap_or_default(), scan, choice)
}

/// Standard deviation of the noise of ln f, from how far samples lie off the line between their neighbours.
fn noise(samples: &[Sample<f64>]) -> f64 {
    let mut sorted: Vec<&Sample<f64>> = samples.iter().collect();
    sorted.sort_by(|a, b| a.theta_i.total_cmp(&b.theta_i).then(a.theta_s.total_cmp(&b.theta_s)));
    let mut off: Vec<f64> = Vec::new();
    for three in sorted.windows(3) {
        let [a, b, c] = [three[0], three[1], three[2]];
        let span = c.theta_s - a.theta_s;
        if a.theta_i == c.theta_i && a.delta_phi == c.delta_phi && span > 0.0 {
            let t = (b.theta_s - a.theta_s) / span;
            let [y_a, y_b, y_c] = [a, b, c].map(|sample| Real::portable_ln(sample.brdf));
            let deviation = y_b - (y_a + (y_c - y_a) * t);
            // The line has the noise of its ends.
            off.push(deviation.abs() / (1.0 + t * t + (1.0 - t) * (1.0 - t)).sqrt());
        }
    }
    off.sort_by(f64::total_cmp);
    off.get(off.len() / 2).map_or(f64::NAN, |median| median * 1.4826)
}
