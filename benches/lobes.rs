//! Which lobes the measured scans need: `cargo run --release --example lobes > benches/results/lobes.md`.

use std::path::Path;

use brdfit::analysis::choose::{Criteria, criteria};
use brdfit::engine::models::MODELS;
use brdfit::engine::{FitOptions, Outcome, fit};
use brdfit::input::{ReadOptions, read_file};

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
    println!("# Which lobes the measured scans need\n");
    println!(
        "Root mean square of the residuals of ln f at each model's best fit, and the model of least AICc; the last column is by how much it falls from Eq. 14 to that model."
    );
    println!("Printed by `cargo run --release --example lobes`.\n");
    for model in &MODELS {
        println!(
            "- `{}`: {} ({} parameters)",
            model.name,
            model.what,
            model.parameters.len()
        );
    }
    let names: Vec<_> = MODELS.iter().map(|model| model.name).collect();
    println!("\n| scan | samples | {} | least AICc | fall |", names.join(" | "));
    println!("|---|--:|{}---|--:|", "--:|".repeat(MODELS.len()));
    for file in files {
        let name = file.file_stem().map(|name| name.to_string_lossy().into_owned());
        let scan = read_file(&file, &ReadOptions::default(), &mut std::io::empty()).and_then(|scans| {
            let scan = scans.into_iter().next();
            scan.ok_or_else(|| brdfit::error::Error::new("there is no scan"))
        });
        let scan = scan.unwrap_or_else(|error| panic!("{error}"));
        let fits = MODELS.iter().map(|model| {
            let options = FitOptions::of(model);
            let outcome = fit(&scan.samples, &options).unwrap_or_else(|error| panic!("{error}"));
            let criteria = criteria(&scan.samples, &options, outcome.cost);
            (outcome, criteria)
        });
        let fits: Vec<(Outcome, Criteria)> = fits.collect();
        let rms: Vec<_> = fits.iter().map(|(fit, _)| format!("{:.3}", fit.rms_ln)).collect();
        let best = fits.iter().min_by(|a, b| a.1.aicc.total_cmp(&b.1.aicc));
        let best = &best.expect("there are models").0;
        println!(
            "| {} | {} | {} | {} | {:.0} % |",
            name.unwrap_or_default(),
            scan.samples.len(),
            rms.join(" | "),
            best.model.name,
            100.0 * (1.0 - best.rms_ln / fits[0].0.rms_ln)
        );
    }
}
