//! How fast the default search is, and how sure: the paper's sets by instruction set, and random scenes against brute force.
//!
//! `cargo bench --bench error_vs_time -- --scenes 1000 --starts 200 --seeds 20 --write`; the last writes `benches/results/error_vs_time.md`.
//! Without cargo's own `--bench`, as in `cargo test --benches`, only a small part is done.

use std::fmt::Write;
use std::process::Command;

use brdfit::converge::trace::{Trace, passes, trace};
use brdfit::converge::{Subject, paper_scans};
use brdfit::engine::{FitOptions, blocks, fit};
use brdfit::simd::{FastScan, Simd};
use brdfit_core::brdf::ALL;
use brdfit_core::residuals::Scan;
use brdfit_suite::random_scenes::{KINDS, brute, scene};
use rayon::prelude::*;

/// Each search is timed this often, and the fastest counts.
const REPEATS: usize = 3;

struct Settings {
    scenes: u64,
    starts: u64,
    seeds: u64,
    write: bool,
}

fn main() {
    let settings = settings();
    let mut out = String::from("# Error against run time of the default search\n\n");
    let _ = writeln!(out, "Processor: {}, commit {}.", processor(), commit());
    let _ = writeln!(
        out,
        "Regenerate: `cargo bench --bench error_vs_time -- --scenes {} --starts {} --seeds {} --write`.",
        settings.scenes, settings.starts, settings.seeds
    );
    paper_sets(&mut out, &settings);
    random_scenes(&mut out, &settings);
    print!("{out}");
    if settings.write {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/results/error_vs_time.md");
        std::fs::write(path, out).expect("benches/results is writable");
    }
}

fn settings() -> Settings {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let whole = arguments.iter().any(|argument| argument == "--bench");
    let number = |name: &str, usual: u64, small: u64| {
        let place = arguments.iter().position(|argument| argument == name);
        let given = place.map(|place| {
            let value = arguments.get(place + 1).and_then(|value| value.parse().ok());
            value.unwrap_or_else(|| panic!("{name} takes a number"))
        });
        given.unwrap_or(if whole { usual } else { small })
    };
    Settings {
        scenes: number("--scenes", 1000, 5),
        starts: number("--starts", 200, 5),
        seeds: number("--seeds", 20, 1),
        write: arguments.iter().any(|argument| argument == "--write"),
    }
}

/// Time and passes until the optimum within 1e-6.
fn paper_sets(out: &mut String, settings: &Settings) {
    let _ = writeln!(out, "\n## The paper's sets\n");
    let _ = writeln!(
        out,
        "171 samples, f64, one thread, medians of {} seeds, each the fastest of {REPEATS} runs.",
        settings.seeds
    );
    let _ = writeln!(
        out,
        "Reached: the cost is within 1e-6 of the least that any seed found; a pass without derivatives counts half.\n"
    );
    out.push_str(
        "| set | instructions | reached by | passes until then | ms until then | passes in all | ms in all |\n",
    );
    out.push_str("|---|---|--:|--:|--:|--:|--:|\n");
    for Subject { name, samples, .. } in paper_scans() {
        let run = |simd, seed| {
            let options = FitOptions {
                simd,
                seed,
                ..FitOptions::default()
            };
            let runs = (0..REPEATS).map(|_| trace(&samples, &options).expect("the set is valid"));
            runs.min_by(|a, b| a.elapsed_s.total_cmp(&b.elapsed_s)).expect("a run")
        };
        let all: Vec<(Simd, Vec<Trace>)> = Simd::available()
            .into_iter()
            .map(|simd| (simd, (0..settings.seeds).map(|seed| run(simd, seed)).collect()))
            .collect();
        let traces = || all.iter().flat_map(|(_, traces)| traces);
        let best = traces()
            .flat_map(|trace| &trace.records)
            .map(|r| r.cost)
            .fold(f64::INFINITY, f64::min);
        for (simd, traces) in &all {
            let there = |trace: &Trace| {
                let first = trace.records.iter().find(|record| record.cost <= best * (1.0 + 1e-6));
                first.map(|record| (passes(record.evaluations), 1e3 * record.elapsed_s))
            };
            let firsts: Vec<_> = traces.iter().map(there).collect();
            let reached = firsts.iter().flatten().count();
            let until = |value: fn((f64, f64)) -> f64| median(firsts.iter().map(|f| f.map_or(f64::INFINITY, value)));
            let _ = writeln!(
                out,
                "| {name} | {} | {reached} of {} | {:.1} | {:.3} | {:.1} | {:.3} |",
                simd.name(),
                settings.seeds,
                until(|f| f.0),
                until(|f| f.1),
                median(traces.iter().map(|t| passes(t.evaluations))),
                median(traces.iter().map(|t| 1e3 * t.elapsed_s)),
            );
        }
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[(values.len() - 1) / 2]
}

/// What the default search made of one scene.
struct Judged {
    excess: f64,
    passes: f64,
}

/// The share of scenes in which the default search ends at the best that brute force finds.
fn random_scenes(out: &mut String, settings: &Settings) {
    let judge = |k: u64| {
        let samples = scene(k);
        let options = FitOptions::default();
        let outcome = fit(&samples, &options).expect("scenes are valid");
        let blocks = blocks::<f64>(&samples).expect("scenes are valid");
        let fast = FastScan {
            scan: Scan::<f64, ALL, 6>::new(&blocks),
            simd: options.simd,
        };
        let bounds = Scan::<f64, ALL, 6>::bounds(&options.lower, &options.upper);
        let best = brute(&fast, &bounds, settings.starts, k);
        Judged {
            excess: outcome.cost / best - 1.0,
            passes: passes(outcome.evaluations),
        }
    };
    let judged: Vec<Judged> = (0..settings.scenes).into_par_iter().map(judge).collect();
    let _ = writeln!(out, "\n## Random scenes\n");
    let _ = writeln!(
        out,
        "One to five incident angles, noise of 0.5 to 20 %; the default search against the best of {} mixed starts.",
        settings.starts
    );
    let _ = writeln!(
        out,
        "Missed: its cost is more than 1e-4 above that best; better: more than 1e-4 below it.\n"
    );
    out.push_str("| kind | scenes | missed | within 1e-4 | better | passes, mean | passes, most |\n");
    out.push_str("|---|--:|--:|--:|--:|--:|--:|\n");
    for (place, kind) in KINDS.iter().enumerate() {
        let of_kind = judged.iter().skip(place).step_by(KINDS.len());
        row(out, &format!("{kind:?}"), of_kind);
    }
    row(out, "all", judged.iter());
    let missed = (0..).zip(&judged).filter(|(_, judged)| judged.excess > 1e-4);
    let list: Vec<String> = missed
        .map(|(k, judged)| format!("{k} (+{:.1e})", judged.excess))
        .collect();
    if !list.is_empty() {
        let _ = writeln!(out, "\nMissed scenes, with the excess: {}.", list.join(", "));
    }
}

fn row<'a>(out: &mut String, name: &str, judged: impl Iterator<Item = &'a Judged>) {
    let judged: Vec<&Judged> = judged.collect();
    if judged.is_empty() {
        return;
    }
    let count = |test: fn(f64) -> bool| judged.iter().filter(|judged| test(judged.excess)).count();
    let missed = count(|excess| excess > 1e-4);
    let all = judged.len();
    let _ = writeln!(
        out,
        "| {name} | {all} | {missed} | {:.2} % | {} | {:.0} | {:.0} |",
        100.0 * (all - missed) as f64 / all as f64,
        count(|excess| excess < -1e-4),
        judged.iter().map(|judged| judged.passes).sum::<f64>() / all as f64,
        judged.iter().map(|judged| judged.passes).fold(0.0, f64::max),
    );
}

fn processor() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = info.lines().find(|line| line.starts_with("model name"));
    let name = line.and_then(|line| line.split_once(':')).map(|(_, name)| name.trim());
    name.unwrap_or("unknown").to_string()
}

fn commit() -> String {
    let output = Command::new("git")
        .args(["describe", "--always", "--dirty"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output();
    match output {
        Ok(output) if output.status.success() => String::from_utf8_lossy(&output.stdout).trim().to_string(),
        _ => "unknown".to_string(),
    }
}
