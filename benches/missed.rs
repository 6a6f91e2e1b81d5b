//! How often the default search misses the optimum, by kind of scan, and what more candidates buy.
//!
//! `cargo bench --bench missed -- --write` writes `benches/results/search.md`.
//! `--scans N` takes N scans of each kind, in place of 1667.
//! The least costs that thorough methods find are kept in `target/missed`; making them takes an hour on two cores.
//! `--first N` begins with scan N: scans on which no design was chosen. The optimum is then what these searches and one with many candidates find, and `--write` writes `benches/results/search_unseen.md`.
//! Without cargo's own `--bench`, as in `cargo test --benches`, only a small part is done.

use std::fmt::Write;
use std::ops::Range;
use std::path::PathBuf;

use brdfit_core::search::CANDIDATES;
use brdfit_suite::hard_scenes::{KINDS, Kind};
use brdfit_suite::missed::{Ended, Known, Row, ended, line, many, row, thorough};
use rayon::prelude::*;

/// Most candidates of the searches that show what more work buys.
const EFFORTS: [u32; 4] = [64, CANDIDATES, 1000, 2000];
/// Scans of a kind for them.
const EFFORT_SCANS: u64 = 100;

fn main() {
    let asked = |name: &str| std::env::args().any(|argument| argument == name);
    let number = |name: &str| {
        let number = std::env::args().skip_while(|argument| argument != name).nth(1);
        number.map(|number| number.parse::<u64>().expect("a number behind the option"))
    };
    let (count, seeds) = match asked("--bench") {
        true => (number("--scans").unwrap_or(1667), 3),
        false => (1, 1),
    };
    let first = number("--first").unwrap_or(0);
    let scans = first..first + count;
    let root: PathBuf = env!("CARGO_MANIFEST_DIR").into();
    let (least, page): (fn(Kind, u64) -> f64, _) = match first {
        0 => (thorough, "search.md"),
        _ => (many, "search_unseen.md"),
    };
    let mut known = KINDS.map(|kind| match first {
        0 => Known::read(&root.join("target/missed"), kind),
        _ => Known::from(first),
    });
    for (kind, known) in KINDS.iter().zip(&mut known) {
        let more: Vec<f64> = (known.end()..scans.end)
            .into_par_iter()
            .map(|k| least(*kind, k))
            .collect();
        more.into_iter().for_each(|cost| known.push(cost));
    }
    let table = text(&mut known, scans, seeds);
    known.iter().for_each(Known::write);
    print!("{table}");
    if asked("--write") {
        std::fs::write(root.join("benches/results").join(page), table).expect("benches/results is writable");
    }
}

fn text(known: &mut [Known], scans: Range<u64>, seeds: u64) -> String {
    let (first, count, last) = (scans.start, scans.end - scans.start, seeds - 1);
    let mut out = String::from("# What the default search misses\n\n");
    match first {
        0 => {
            let _ = writeln!(
                out,
                "{count} random scans of each kind (`tests/common/hard_scenes.rs`), each with seeds 0 to {last}.\nMissed: the cost is more than 1e-4 above the least that any method found: these searches, one with 2000 candidates and another seed, and mixed starts.\nThe search was designed on these scans; of others: `search_unseen.md`.",
            );
        }
        _ => {
            let _ = writeln!(
                out,
                "On scans on which no design was chosen: {count} of each kind (`tests/common/hard_scenes.rs`), from number {first} on, each with seeds 0 to {last}.\nMissed: the cost is more than 1e-4 above the least of these searches and of one with 2000 candidates and another seed; what all of them miss is not seen here.",
            );
        }
    }
    out.push_str("A pass without derivatives counts half; until 1 %: the median of the passes until the cost is within 1 % of the least.\n");
    out.push_str("Single: any of the other kinds in single precision; its end is judged after a fit in double precision from there.\n");
    out.push_str("What other designs missed: `search_designs.md`.\n");
    let from = if first > 0 {
        format!(" --first {first}")
    } else {
        String::new()
    };
    let _ = writeln!(
        out,
        "Regenerate: `cargo bench --bench missed -- --write{from} --scans {count}`.\n"
    );
    out.push_str("| kind | searches | missed | passes, mean | passes, most | until 1 % |\n|---|--:|--:|--:|--:|--:|\n");
    let rows: Vec<Row> = KINDS
        .iter()
        .zip(known.iter_mut())
        .map(|(kind, known)| judge(*kind, known, scans.clone(), seeds, CANDIDATES))
        .collect();
    for (kind, row) in KINDS.iter().zip(&rows) {
        line(&mut out, &format!("{kind:?}"), row);
    }
    let all: usize = rows.iter().map(|row| row.fits).sum();
    let missed: usize = rows.iter().map(|row| row.missed.len()).sum();
    let _ = writeln!(out, "| all | {all} | {missed} | | | |");
    let list: Vec<String> = KINDS
        .iter()
        .zip(&rows)
        .flat_map(|(kind, row)| {
            row.missed
                .iter()
                .map(move |(k, excess)| format!("{kind:?} {k} (+{excess:.1e})"))
        })
        .collect();
    if !list.is_empty() {
        let _ = writeln!(out, "\nMissed, with the excess: {}.", list.join(", "));
    }
    if first == 0 {
        efforts(&mut out, known, count.min(EFFORT_SCANS));
    }
    out
}

/// What more candidates than the default buy, and cost.
fn efforts(out: &mut String, known: &mut [Known], scans: u64) {
    let _ = writeln!(out, "\n## More work\n");
    let _ = writeln!(
        out,
        "The first {scans} scans of each kind, seed 0; with more than {CANDIDATES} candidates (`--starts`) the search does not end before all are made.\n"
    );
    out.push_str("| candidates | searches | missed | passes, mean |\n|--:|--:|--:|--:|\n");
    for candidates in EFFORTS {
        let rows: Vec<Row> = KINDS
            .iter()
            .zip(known.iter_mut())
            .map(|(kind, known)| judge(*kind, known, 0..scans, 1, candidates))
            .collect();
        let fits: usize = rows.iter().map(|row| row.fits).sum();
        let missed: usize = rows.iter().map(|row| row.missed.len()).sum();
        let passes: f64 = rows.iter().map(|row| row.mean * row.fits as f64).sum();
        let _ = writeln!(
            out,
            "| {candidates} | {fits} | {missed} | {:.0} |",
            passes / fits as f64
        );
    }
}

/// The searches of the scans of a kind, which may lower what is known of them.
fn judge(kind: Kind, known: &mut Known, scans: Range<u64>, seeds: u64, candidates: u32) -> Row {
    let least = &*known;
    let of = |k: u64| (0..seeds).map(move |seed| (k, ended(kind, k, seed, candidates, least.cost(k))));
    let all: Vec<(u64, Ended)> = scans.into_par_iter().flat_map_iter(of).collect();
    all.iter().for_each(|(k, ended)| known.lower(*k, ended.cost));
    row(known, &all)
}
