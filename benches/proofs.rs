//! Prints what `brdfit certify` proves, at what expense, as a Markdown table: `cargo run --release --example proofs > benches/results/certify.md`; other limits of a proof may follow, such as `-- --proof-boxes 100000`.

use std::iter;
use std::path::{Path, PathBuf};

use brdfit_suite::program::brdfit;
use brdfit_suite::scan::{data, shared};
use serde_json::Value;

/// The limit of one proof, if no other is given.
const LIMIT: [&str; 2] = ["--proof-seconds", "600"];

/// Cases that are about a fit with options.
const OWN: [(&str, &[&str]); 1] = [("bound036", &["--fix", "m=0.08212434656627657"])];

fn main() {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let limit = if given.is_empty() {
        LIMIT.map(String::from).to_vec()
    } else {
        given.clone()
    };
    let command = if given.is_empty() {
        String::new()
    } else {
        format!(" -- {}", given.join(" "))
    };
    println!("# Proofs of the optimum\n");
    println!(
        "What `brdfit certify {}` proves of the fit: eps means that no parameters within the bounds have an MSE^2 below (1 - eps) of that of the fit.",
        limit.join(" ")
    );
    println!(
        "Seconds are processor time of all threads, which share the work evenly, of a build {} optimisation; a proof that is complete has the same boxes in each run.",
        if cfg!(debug_assertions) {
            "for tests, with little"
        } else {
            "with full"
        }
    );
    println!("Regenerate: `cargo run --release --example proofs{command} > benches/results/certify.md`.\n");
    let sets: Vec<PathBuf> = (1..=3)
        .flat_map(|set| (1..=3).map(move |seed| data(&format!("testdata{set}_sym_seed{seed}.csv"))))
        .collect();
    table("The paper's sets with 10 % noise", &sets, &["5%", "1%"], &limit);
    for (title, folder) in [("Measured scans", "real"), ("Difficult cases", "cases/fit")] {
        let folder = shared(folder);
        match files(&folder) {
            Some(files) => table(title, &files, &["10%"], &limit),
            None => println!("Left out: {title}, which are not at ../shared.\n"),
        }
    }
}

/// The scans in a folder, in order of their names.
fn files(folder: &Path) -> Option<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder).ok()?;
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let mut files: Vec<PathBuf> = paths
        .filter(|path| path.extension().is_some_and(|ending| ending == "csv"))
        .collect();
    files.sort();
    Some(files)
}

fn table(title: &str, files: &[PathBuf], parts: &[&str], limit: &[String]) {
    println!("## {title}\n");
    println!("| scan | samples | asked | proved eps | boxes | CPU s | MSE^2 | |");
    println!("|---|--:|--:|--:|--:|--:|--:|---|");
    for file in files {
        for part in parts {
            println!("{}", row(file, part, limit));
        }
    }
    println!();
}

fn row(file: &Path, part: &str, limit: &[String]) -> String {
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    let path = file.display().to_string();
    let fixed = ["certify", &path, "--within", part, "--format", "json"];
    let limit = limit.iter().map(String::as_str);
    let own = OWN.iter().find(|(case, _)| *case == name);
    let own = own.map_or(&[][..], |(_, options)| options).iter().copied();
    let arguments: Vec<&str> = fixed.into_iter().chain(own.clone()).chain(limit).collect();
    let before = processor_time();
    let ran = brdfit(&arguments, b"");
    let time = processor_time() - before;
    let Ok(result) = serde_json::from_str::<Value>(&ran.output) else {
        let why = ran.errors.replace(&path, &name);
        return format!("| {name} | | {part} | | | | | {} |", why.trim().replace('|', "/"));
    };
    let certificate = &result["certificate"];
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let mark = |flag: bool, text: &'static str| if flag { text } else { "" };
    format!(
        "| {} | {} | {part} | {} | {} | {time:.1} | {:.4e} | {}{} |",
        iter::once(&*name).chain(own).collect::<Vec<_>>().join(" "),
        result["samples"],
        certificate["eps"]
            .as_f64()
            .map_or("-".into(), |eps| format!("{:.1} %", 100.0 * eps)),
        certificate["boxes"]
            .as_u64()
            .map_or("-".into(), |boxes| boxes.to_string()),
        number(&result["mse2"]),
        mark(certificate["complete"] == true, "proved"),
        mark(certificate["better"] == true, ", better than the search"),
    )
}

/// Of this process so far, s; NaN where the system does not tell it as Linux does.
fn processor_time() -> f64 {
    /// Of the fields behind the name: user and system time, in hundredths of a second.
    const FIELDS: [usize; 2] = [11, 12];
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = text.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    let number = |k: usize| fields.get(k).and_then(|field| field.parse::<f64>().ok());
    FIELDS.map(|k| number(k).unwrap_or(f64::NAN)).iter().sum::<f64>() / 100.0
}
