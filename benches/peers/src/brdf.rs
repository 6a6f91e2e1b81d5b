//! The paper's three sets: what it costs each solver to be within 1 % of the global optimum with 99 % probability.

use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use brdfit::engine::trace::{Trace, passes, trace};
use brdfit::analysis::paper_sets::{Subject, paper_scans};
use brdfit::engine::FitOptions;
use brdfit_core::lm::Bounds;
use brdfit_core::real::Real;
use brdfit_core::start;

use crate::fits::{PEERS, Scan};
use crate::outside;

/// Searches of brdfit, by as many seeds.
const SEARCHES: u64 = 200;
/// Each is timed this often, and the fastest counts.
const REPEATS: usize = 3;
/// Least of those parameters that may be 0, for a uniform logarithm.
const SMALLEST: [f64; 6] = [1e-3, 1e-3, 1e-3, 1e-3, 1.0, 1e-3];

/// What one solver made of one set.
struct Measured {
    /// Time of one start, or of brdfit until it was there in 99 % of its searches; s.
    seconds: f64,
    /// Passes over the scan, likewise.
    evaluations: f64,
    /// Share of the starts that end within 1 % of the optimum.
    share: f64,
}

impl Measured {
    /// From starts that each took some time, made some evaluations and ended at some cost.
    fn of_starts(starts: &[(f64, f64, f64)], best: f64) -> Measured {
        let count = starts.len() as f64;
        Measured {
            seconds: starts.iter().map(|s| s.0).sum::<f64>() / count,
            evaluations: starts.iter().map(|s| s.1).sum::<f64>() / count,
            share: starts.iter().filter(|s| s.2 <= 1.01 * best).count() as f64 / count,
        }
    }

    /// Starts that reach the optimum at least once with 99 % probability.
    fn starts(&self) -> f64 {
        (0.01f64.ln() / (1.0 - self.share).ln()).max(1.0)
    }
}

/// The whole of benches/results/peers.md.
pub fn print(starts: u64) {
    let scans: Vec<Subject> = paper_scans();
    let limits = FitOptions::default();
    let (lower, upper) = (limits.lower.to_array(), limits.upper.to_array());
    let problems: Vec<Scan> = scans.iter().map(|s| Scan::new(&s.samples, lower, upper)).collect();
    let starts = log_uniform(starts, upper);
    let ours: Vec<(Measured, f64)> = scans.iter().map(searched).collect();
    let best = |set: usize| ours[set].1;

    let mut table: Vec<(String, Vec<Measured>)> = Vec::new();
    for (name, peer) in PEERS {
        let of_set = |set: usize| {
            let problem = &problems[set];
            let one = |x: &[f64; 6]| {
                problem.evaluations.set(0);
                let begun = Instant::now();
                let cost = peer(problem, x);
                (
                    begun.elapsed().as_secs_f64(),
                    f64::from(problem.evaluations.get()),
                    cost,
                )
            };
            Measured::of_starts(&starts.iter().map(one).collect::<Vec<_>>(), best(set))
        };
        table.push((name.to_string(), (0..scans.len()).map(of_set).collect()));
    }
    let folder = outside::beside("target");
    hand_over(&folder, &problems, &starts);
    let tiny = outside::rows(&folder.join("tiny_solver").display().to_string(), &[&folder]);
    let scipy = outside::rows(&outside::python(), &[&outside::beside("least_squares.py"), &folder]);
    for (name, rows) in [("Ceres TinySolver (C++)", tiny), ("SciPy `least_squares`", scipy)] {
        if !rows.is_empty() {
            table.push((
                name.to_string(),
                (0..scans.len()).map(|set| of_rows(&rows, set, best(set))).collect(),
            ));
        }
    }
    print!("{}", text(&table, &ours, starts.len()));
}

/// brdfit's own searches: when 99 % of them were within 1 %, and the optimum.
fn searched(scan: &Subject) -> (Measured, f64) {
    let run = |seed| {
        let options = FitOptions {
            seed,
            ..FitOptions::default()
        };
        let runs = (0..REPEATS).map(|_| trace(&scan.samples, &options).expect("the set is valid"));
        runs.min_by(|a, b| a.elapsed_s.total_cmp(&b.elapsed_s)).expect("a run")
    };
    let traces: Vec<Trace> = (0..SEARCHES).map(run).collect();
    let costs = traces.iter().flat_map(|t| &t.records).map(|r| r.cost);
    let best = costs.fold(f64::INFINITY, f64::min);
    let there = |t: &Trace| t.records.iter().find(|r| r.cost <= 1.01 * best).copied();
    let firsts: Vec<_> = traces.iter().filter_map(there).collect();
    let quantile = |mut values: Vec<f64>| {
        values.resize(traces.len(), f64::INFINITY);
        values.sort_by(f64::total_cmp);
        values[(0.99 * traces.len() as f64).ceil() as usize - 1]
    };
    let measured = Measured {
        seconds: quantile(firsts.iter().map(|r| r.elapsed_s).collect()),
        evaluations: quantile(firsts.iter().map(|r| passes(r.evaluations)).collect()),
        share: firsts.len() as f64 / traces.len() as f64,
    };
    (measured, best)
}

/// Uniform in the logarithm of each parameter.
fn log_uniform(count: u64, upper: [f64; 6]) -> Vec<[f64; 6]> {
    let bounds = Bounds {
        lower: SMALLEST.map(f64::ln),
        upper: upper.map(f64::ln),
    };
    let point = |i| start::uniform::<f64, 6>(0, i, &bounds).map(Real::exp);
    (0..count).map(point).collect()
}

/// Writes what the other languages need: geometry and ln f of each sample, and the starts.
fn hand_over(folder: &Path, problems: &[Scan], starts: &[[f64; 6]]) {
    let write = |name: String, rows: String| std::fs::write(folder.join(name), rows).expect("target is writable");
    for (set, problem) in problems.iter().enumerate() {
        let mut rows = String::new();
        for (geometry, ln_f) in problem.geometry.iter().zip(&problem.ln_f) {
            let _ = write!(rows, "{ln_f}");
            for lobe in [geometry.surface(), geometry.volume()] {
                let _ = write!(rows, " {} {} {}", lobe.tan2_theta_h, lobe.cos_theta_d, lobe.factor);
            }
            rows.push('\n');
        }
        write(format!("set{set}.txt"), rows);
    }
    let row = |x: &[f64; 6]| x.map(|x| x.to_string()).join(" ") + "\n";
    write("starts.txt".into(), starts.iter().map(row).collect());
}

/// Rows of set, seconds, evaluations, cost.
fn of_rows(rows: &[Vec<String>], set: usize, best: f64) -> Measured {
    let number = |row: &[String], k: usize| row[k].parse().expect("a number");
    let of_set = rows.iter().filter(|row| row[0] == set.to_string());
    Measured::of_starts(
        &of_set
            .map(|row| (number(row, 1), number(row, 2), number(row, 3)))
            .collect::<Vec<_>>(),
        best,
    )
}

fn text(table: &[(String, Vec<Measured>)], ours: &[(Measured, f64)], starts: usize) -> String {
    let mut out = String::from("# What it costs to be within 1 % of the global optimum with 99 % probability\n\n");
    out += "The paper's three sets with noise of +-10 % (seed 1), 171 samples, all six parameters within the bounds of Table 1, one thread.\n";
    let _ = writeln!(
        out,
        "Peers: {starts} starts, uniform in the logarithm (from 1e-3 where the bound is 0 or less than that), each solver with its own default tolerances, or 1e-10; time of a start x ln 0.01 / ln(1 - share), where share is that of the starts that end within 1 %."
    );
    out += "The Rust peers have brdfit's model with its analytic derivatives, one sample after the other; TinySolver its automatic ones, SciPy exact ones by complex steps, all samples at once.\n";
    out +=
        "Solvers without bounds (`levenberg-marquardt`, TinySolver) search in x = lower + (upper - lower) sin^2 u.\n";
    let _ = writeln!(
        out,
        "brdfit: the default search by {SEARCHES} seeds, until 99 % of them were there; share: of the searches."
    );
    let _ = writeln!(
        out,
        "Processor: {}; the shares and evaluations depend on it little, the times do.",
        processor()
    );
    out += "Regenerate, all in one run: `benches/peers/run brdf 100 > benches/results/peers.md`.\n\n";
    out += "| solver | test data | share | time of a start, ms | evaluations of a start | expected time, ms | over brdfit's | expected evaluations | over brdfit's |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for (set, (mine, _)) in ours.iter().enumerate() {
        let _ = writeln!(
            out,
            "| **brdfit** | {} | {:.1} % | | | **{:.3}** | 1 | **{:.0}** | 1 |",
            set + 1,
            100.0 * mine.share,
            1e3 * mine.seconds,
            mine.evaluations
        );
    }
    for (name, measured) in table {
        for (set, one) in measured.iter().enumerate() {
            let (mine, starts) = (&ours[set].0, one.starts());
            let (time, evaluations) = (one.seconds * starts, one.evaluations * starts);
            let _ = writeln!(
                out,
                "| {name} | {} | {:.1} % | {:.3} | {:.0} | {:.2} | {:.0} | {:.0} | {:.0} |",
                set + 1,
                100.0 * one.share,
                1e3 * one.seconds,
                one.evaluations,
                1e3 * time,
                time / mine.seconds,
                evaluations,
                evaluations / mine.evaluations
            );
        }
    }
    out
}

fn processor() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = info.lines().find(|line| line.starts_with("model name"));
    let name = line.and_then(|line| line.split_once(':')).map(|(_, name)| name.trim());
    name.unwrap_or("unknown").to_string()
}
