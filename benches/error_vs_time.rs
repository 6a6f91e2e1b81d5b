//! How fast the default search is, and how sure: the paper's sets by instruction set, random scenes against brute force, growth with the samples, and many scans on all cores.
//!
//! `cargo bench --bench error_vs_time -- --write` writes `benches/results/error_vs_time.md`.
//! The best of 2000 starts of each random scene is read from `benches/results/random_scenes.csv`; `--reference` makes that anew, which takes ten minutes on two cores.
//! Without cargo's own `--bench`, as in `cargo test --benches`, only a small part is done.

use std::fmt::Write;
use std::process::Command;
use std::time::Instant;

use brdfit::analysis::paper_sets::{Subject, paper_scans};
use brdfit::engine::simd::{FastEq14, Simd};
use brdfit::engine::trace::{Trace, passes, trace};
use brdfit::engine::{FitOptions, Material, Precision, blocks, fit};
use brdfit_core::brdf::{ALL, Brdf, Params};
use brdfit_core::geometry::{Geometry, Sample};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_suite::random_scenes::{KINDS, brute, scene};
use brdfit_suite::scan;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

/// Each search is timed this often, and the fastest counts.
const REPEATS: usize = 3;

/// Starts of the brute force.
const STARTS: u64 = 2000;

/// Scans that one thread fits before all threads have their turn.
const ROUND: usize = 500;

/// What there is to do.
struct Settings {
    scenes: u64,
    seeds: u64,
    /// The most samples of a scan.
    samples: usize,
    /// Scans on all cores.
    batch: u64,
    reference: bool,
    write: bool,
}

fn main() {
    let asked = |name: &str| std::env::args().any(|argument| argument == name);
    let settings = if asked("--bench") {
        Settings {
            scenes: 1000,
            seeds: 20,
            samples: 171_000,
            batch: 10_000,
            reference: asked("--reference"),
            write: asked("--write"),
        }
    } else {
        Settings {
            scenes: 5,
            seeds: 1,
            samples: 171,
            batch: 4,
            reference: false,
            write: false,
        }
    };
    if settings.reference {
        write_reference(settings.scenes);
    }
    let mut out = String::from("# Error against run time of the default search\n\n");
    let _ = writeln!(out, "Processor: {}, commit {}.", processor(), commit());
    let _ = writeln!(out, "Regenerate: `cargo bench --bench error_vs_time -- --write`.");
    paper_sets(&mut out, &settings);
    random_scenes(&mut out, &settings);
    growth(&mut out, &settings);
    batch(&mut out, &settings);
    print!("{out}");
    if settings.write {
        std::fs::write(results("error_vs_time.md"), out).expect("benches/results is writable");
    }
}

fn results(name: &str) -> std::path::PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "benches/results", name].iter().collect()
}

/// Time and passes until the optimum within 1e-6.
fn paper_sets(out: &mut String, settings: &Settings) {
    let _ = writeln!(out, "\n## The paper's sets\n");
    let _ = writeln!(
        out,
        "171 samples, one thread, medians of {} seeds, each the fastest of {REPEATS} runs.",
        settings.seeds
    );
    let _ = writeln!(
        out,
        "Reached: the cost, computed in f64, is within 1e-6 of the least that any seed found; a pass without derivatives counts half.\n"
    );
    out.push_str(
        "| set | number | instructions | reached by | passes until then | ms until then | passes in all | ms in all |\n",
    );
    out.push_str("|---|---|---|--:|--:|--:|--:|--:|\n");
    for Subject { name, samples, .. } in paper_scans() {
        let run = |simd, precision, seed| {
            let options = FitOptions {
                simd,
                precision,
                seed,
                ..FitOptions::default()
            };
            let runs = (0..REPEATS).map(|_| trace(&samples, &options).expect("the set is valid"));
            runs.min_by(|a, b| a.elapsed_s.total_cmp(&b.elapsed_s)).expect("a run")
        };
        let mut all: Vec<(&str, Simd, Vec<Trace>)> = Vec::new();
        for (name, precision) in [("f64", Precision::F64), ("f32", Precision::F32)] {
            for simd in Simd::available() {
                let traces = (0..settings.seeds).map(|seed| run(simd, precision, seed)).collect();
                all.push((name, simd, traces));
            }
        }
        let traces = || all.iter().flat_map(|(_, _, traces)| traces);
        let best = traces()
            .flat_map(|trace| &trace.records)
            .map(|r| r.cost)
            .fold(f64::INFINITY, f64::min);
        for (number, simd, traces) in &all {
            let there = |trace: &Trace| {
                let first = trace.records.iter().find(|record| record.cost <= best * (1.0 + 1e-6));
                first.map(|record| (passes(record.evaluations), 1e3 * record.elapsed_s))
            };
            let firsts: Vec<_> = traces.iter().map(there).collect();
            let reached = firsts.iter().flatten().count();
            let until = |value: fn((f64, f64)) -> f64| median(firsts.iter().map(|f| f.map_or(f64::INFINITY, value)));
            let _ = writeln!(
                out,
                "| {name} | {number} | {} | {reached} of {} | {:.1} | {:.3} | {:.1} | {:.3} |",
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

/// Changes if the scene does.
fn fingerprint(samples: &[Sample<f64>]) -> f64 {
    samples.iter().map(|sample| Real::portable_ln(sample.brdf)).sum()
}

fn brute_force(k: u64, starts: u64) -> f64 {
    let samples = scene(k);
    let options = FitOptions::default();
    let blocks = blocks::<f64>(&samples).expect("scenes are valid");
    let fast = FastEq14 {
        scan: Scan::<f64, ALL, 6>::new(&blocks),
        simd: options.simd,
    };
    let bounds = Scan::<f64, ALL, 6>::usual_bounds();
    brute(&fast, &bounds, starts, k)
}

fn write_reference(scenes: u64) {
    let row = |k| format!("{k},{:e},{:e}\n", fingerprint(&scene(k)), brute_force(k, STARTS));
    let rows: Vec<String> = (0..scenes).into_par_iter().map(row).collect();
    let head = format!(
        "# The least sum of squares that {STARTS} starts of mixed kinds find in each random scene: `cargo bench --bench error_vs_time -- --reference`.\nscene,sum_of_ln_f,cost\n"
    );
    std::fs::write(results("random_scenes.csv"), head + &rows.concat()).expect("benches/results is writable");
}

/// The share of scenes in which the default search ends at the best that brute force finds.
fn random_scenes(out: &mut String, settings: &Settings) {
    let _ = writeln!(out, "\n## Random scenes\n");
    let reference = results("random_scenes.csv");
    if !reference.exists() {
        let _ = writeln!(out, "Left out: `--reference` makes what they are compared with.");
        return;
    }
    let known = scan::rows(&reference);
    let judge = |k: u64| {
        let samples = scene(k);
        let row = &known[k as usize];
        assert_eq!(
            scan::number(&row[1]),
            fingerprint(&samples),
            "scene {k} has changed: run with --reference"
        );
        let outcome = fit(&samples, &FitOptions::default()).expect("scenes are valid");
        Judged {
            excess: outcome.cost / scan::number(&row[2]) - 1.0,
            passes: passes(outcome.evaluations),
        }
    };
    let judged: Vec<Judged> = (0..settings.scenes).into_par_iter().map(judge).collect();
    let _ = writeln!(
        out,
        "One to five incident angles, noise of 0.5 to 20 %; the default search against the best of {STARTS} mixed starts."
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

/// Test data `set` (0 to 2) at `count` angles from -85 to 85 degrees, with noise of +-10 % from `seed`.
fn noisy(truth: &Params<f64>, theta_i: f64, count: usize, seed: u64) -> Vec<Sample<f64>> {
    let brdf = Brdf::<f64, ALL>::new(truth);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let sample = |k: usize| {
        let theta_s = (-85.0 + 170.0 * k as f64 / (count - 1) as f64).to_radians();
        let geometry = Geometry::new(theta_i, theta_s, f64::PI).expect("angles are above the horizon");
        let factor = 1.0 + 0.1 * (2.0 * f64::unit(random.next_u64()) - 1.0);
        Sample::in_plane(theta_i, theta_s, Real::portable_exp(brdf.ln_f(&geometry)) * factor)
    };
    (0..count).map(sample).collect()
}

/// Time of a search by the number of samples.
fn growth(out: &mut String, settings: &Settings) {
    let _ = writeln!(out, "\n## Growth with the samples\n");
    let _ = writeln!(
        out,
        "Test data 1 at more angles, f64, one thread, fastest of {REPEATS} searches.\n"
    );
    out.push_str("| samples | passes | ms | us of a sample | ns of a sample and pass |\n|--:|--:|--:|--:|--:|\n");
    let Subject { samples, truth, .. } = paper_scans().swap_remove(0);
    let truth = of_eq_14(truth);
    let mut count = 171;
    while count <= settings.samples {
        let scan = noisy(&truth, samples[0].theta_i, count, 1);
        let runs = (0..REPEATS).map(|_| trace(&scan, &FitOptions::default()).expect("the scan is valid"));
        let run = runs.min_by(|a, b| a.elapsed_s.total_cmp(&b.elapsed_s)).expect("a run");
        let (passes, of_a_sample) = (passes(run.evaluations), run.elapsed_s / count as f64);
        let _ = writeln!(
            out,
            "| {count} | {passes:.0} | {:.3} | {:.3} | {:.2} |",
            1e3 * run.elapsed_s,
            1e6 * of_a_sample,
            1e9 * of_a_sample / passes
        );
        count *= 10;
    }
}

/// Many scans of 171 samples on one core and on all; and on all where each thread has its own share from the beginning, which is what the machine itself gives.
fn batch(out: &mut String, settings: &Settings) {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let _ = writeln!(out, "\n## Many scans\n");
    let _ = writeln!(
        out,
        "{} scans of 171 samples, the paper's three sets in turn, each with noise of its own, f64; the rows take turns every {ROUND} scans.\n",
        settings.batch
    );
    let sets = paper_scans();
    let scan = |k: u64| {
        let Subject { samples, truth, .. } = &sets[(k % 3) as usize];
        noisy(&of_eq_14(*truth), samples[0].theta_i, 171, k)
    };
    let scans: Vec<_> = (0..settings.batch).map(scan).collect();
    let one = |scan: &Vec<Sample<f64>>| fit(scan, &FitOptions::default()).expect("the scans are valid").cost;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(cores).build();
    let pool = pool.expect("threads");
    let mut seconds = [0.0; 3];
    for scans in scans.chunks(ROUND) {
        let serial = timed(&mut seconds[0], || scans.iter().map(one).collect::<Vec<_>>());
        let parallel = timed(&mut seconds[1], || {
            pool.install(|| scans.par_iter().map(one).collect::<Vec<_>>())
        });
        assert!(serial == parallel, "the number of threads changed a bit");
        timed(&mut seconds[2], || {
            std::thread::scope(|scope| {
                for share in scans.chunks(scans.len().div_ceil(cores)) {
                    scope.spawn(move || share.iter().map(one).sum::<f64>());
                }
            });
        });
    }
    out.push_str("| threads | s | scans in a second | speed-up of one thread |\n|--:|--:|--:|--:|\n");
    let names = [
        "1".to_string(),
        cores.to_string(),
        format!("{cores}, a fixed share each"),
    ];
    for (name, &spent) in names.iter().zip(&seconds) {
        let rate = settings.batch as f64 / spent;
        let _ = writeln!(out, "| {name} | {spent:.2} | {rate:.0} | {:.2} |", seconds[0] / spent);
    }
}

/// What `work` gives; its time is added to `seconds`.
fn timed<T>(seconds: &mut f64, work: impl FnOnce() -> T) -> T {
    let begun = Instant::now();
    let result = work();
    *seconds += begun.elapsed().as_secs_f64();
    result
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

fn of_eq_14(truth: Option<Material>) -> Params<f64> {
    let truth = truth.and_then(|material| material.eq_14());
    truth.expect("the paper's sets are synthetic")
}
