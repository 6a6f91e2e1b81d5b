//! Instructions of a pass over a scan and of a whole search, counted by `valgrind --tool=callgrind`: they do not depend on what else the machine does.
//!
//! `cargo run --release -p brdfit-instructions > benches/results/instructions.md`; with `--check` it counts again, but for whole searches of Eq. 14, and fails if anything takes 3 % more than that table says, so that a lost vectorisation is seen; with other arguments it does the work that is counted.
//!
//! Valgrind has no AVX-512: of that the functions of this program are counted that compute with its registers.

use std::hint::black_box;
use std::process::Command;

use brdfit::analysis::paper_sets::paper_scans;
use brdfit::engine::models::MODELS;
use brdfit::engine::simd::{FastEq14, Simd};
use brdfit::engine::{FitOptions, Model, Precision, blocks, fit};
use brdfit_core::brdf::{ALL, DIFFUSE, SURFACE};
use brdfit_core::geometry::Sample;
use brdfit_core::lm::Problem;
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::search::{Region, Scene};
use rayon::prelude::*;

/// What is counted, and how often it is repeated.
const WORK: [(&str, u64); 6] = [
    ("cost", 100),
    ("linearize", 100),
    ("candidate", 100),
    ("search1", 2),
    ("search2", 2),
    ("search3", 2),
];
const EQ_14: [&str; 4] = ["all f64", "all f32", "diffuse,surface f64", "diffuse,surface f32"];
/// Valgrind has no AVX-512.
const INSTRUCTIONS: [&str; 2] = ["portable", "avx2"];
/// What is counted of each model by its name: a search divided by its passes, those for candidates and with derivatives among them.
const PASS: &str = "pass of a search";
/// Candidates of that search.
const FEW: u32 = 20;
/// What a count may be above that of the table.
const MORE: f64 = 1.03;
/// The same with another compiler than the table's: a lost vectorisation is more.
const MORE_ELSEWHERE: f64 = 1.3;
/// Operations on registers of AVX-512 that make a function one that is vectorised.
const MANY: usize = 20;
/// The table, as it was committed.
const TABLE: &str = include_str!("results/instructions.md");

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match &arguments[..] {
        [] => table(),
        [check] if check == "--check" => std::process::exit(i32::from(!is_as_before())),
        [work, model, simd, repeats] => {
            let simd = Simd::available().into_iter().find(|one| one.name() == simd);
            let Some(simd) = simd else { std::process::exit(3) };
            let samples = &paper_scans().swap_remove(set_of(work)).samples;
            run(work, model, simd, repeats.parse().expect("a number"), samples);
        }
        _ => panic!("no arguments, or what to do, the model, the instructions and how often"),
    }
}

/// Which of the paper's sets is worked on: all kernels take the first.
fn set_of(work: &str) -> usize {
    work.strip_prefix("search")
        .map_or(0, |set| set.parse::<usize>().expect("1 to 3") - 1)
}

fn run(work: &str, model: &str, simd: Simd, repeats: u64, samples: &[Sample<f64>]) {
    const DS: u8 = DIFFUSE | SURFACE;
    match model {
        "all f64" => repeat::<f64, ALL, 6>(work, simd, repeats, samples, Precision::F64),
        "all f32" => repeat::<f32, ALL, 6>(work, simd, repeats, samples, Precision::F32),
        "diffuse,surface f64" => repeat::<f64, DS, 4>(work, simd, repeats, samples, Precision::F64),
        "diffuse,surface f32" => repeat::<f32, DS, 4>(work, simd, repeats, samples, Precision::F32),
        name => {
            let options = few(name, simd);
            for _ in 0..repeats {
                drop(black_box(fit(black_box(samples), &options)));
            }
        }
    }
}

/// A short search with a model.
fn few(model: &str, simd: Simd) -> FitOptions {
    FitOptions {
        simd,
        starts: Some(FEW),
        ..FitOptions::of(Model::find(model).expect("a known model"))
    }
}

/// How many passes that takes.
fn passes(model: &str) -> u64 {
    let found = fit(&paper_scans()[0].samples, &few(model, Simd::best())).expect("a fit");
    u64::from(found.evaluations.cost) + u64::from(found.evaluations.linearize)
}

fn repeat<R: Real, const TERMS: u8, const P: usize>(
    work: &str,
    simd: Simd,
    repeats: u64,
    samples: &[Sample<f64>],
    precision: Precision,
) {
    let blocks = blocks::<R>(samples).expect("the set is valid");
    let options = FitOptions {
        terms: TERMS,
        precision,
        simd,
        ..FitOptions::default()
    };
    let bounds = Scan::<R, TERMS, P>::usual_bounds();
    let scene = FastEq14 {
        scan: Scan::<R, TERMS, P>::new(&blocks),
        simd,
    };
    let x = scene.candidate(&bounds, 0, 0, Region::Everywhere).x;
    for i in 0..repeats {
        match work {
            "cost" => drop(black_box(scene.cost(black_box(&x)))),
            "linearize" => drop(black_box(scene.linearize(black_box(&x)))),
            "candidate" => drop(black_box(scene.candidate(&bounds, 0, black_box(i), Region::Everywhere))),
            _ => drop(black_box(fit(black_box(samples), &options))),
        }
    }
}

/// Instructions of this program with some arguments, if they can be counted.
fn counted(work: &str, model: &str, simd: &str, repeats: u64) -> Option<u64> {
    let program = std::env::current_exe().expect("this program has a path");
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args([work, model, simd, &repeats.to_string()])
        .output()
        .expect("valgrind is installed");
    let text = String::from_utf8_lossy(&output.stderr);
    let line = text.lines().find_map(|line| line.split_once("Collected :"));
    line.filter(|_| output.status.success())
        .and_then(|(_, count)| count.trim().parse().ok())
}

/// One line of the table: the model, what is counted, and the counts in the order of [`INSTRUCTIONS`].
type Line = (String, &'static str, [Option<u64>; 2]);

/// Every count, on all cores; searches of Eq. 14 only if `all`.
fn lines(all: bool) -> Vec<Line> {
    let eq_14 = EQ_14
        .into_iter()
        .flat_map(|model| WORK.map(|(work, repeats)| (model, work, repeats)))
        .filter(|(_, work, _)| all || !work.starts_with("search"));
    let others = MODELS.iter().map(|model| (model.name, PASS, 1));
    let work: Vec<_> = eq_14.chain(others).collect();
    work.into_par_iter()
        .map(|(model, work, repeats)| {
            let parts = repeats * if work == PASS { passes(model) } else { 1 };
            let counts = INSTRUCTIONS.map(|simd| {
                let more = counted(work, model, simd, 2 * repeats)?;
                Some((more - counted(work, model, simd, repeats)?) / parts)
            });
            (model.to_string(), work, counts)
        })
        .collect()
}

/// How many functions of this program compute with registers of AVX-512.
fn wide_functions() -> usize {
    let program = std::env::current_exe().expect("this program has a path");
    let output = Command::new("objdump")
        .args(["--disassemble", "--no-show-raw-insn"])
        .arg(program)
        .output()
        .expect("objdump is installed");
    let text = String::from_utf8_lossy(&output.stdout);
    let arithmetic = ["add", "sub", "mul", "div", "max", "min"];
    let is_wide = |line: &str| {
        let operation = line
            .split('\t')
            .nth(1)
            .and_then(|text| text.trim_start().strip_prefix('v'));
        let packed = |text: &str| arithmetic.iter().any(|name| text.starts_with(&format!("{name}p")));
        line.contains("%zmm") && operation.is_some_and(packed)
    };
    // A function begins where a line ends in its name.
    let functions = text.split(">:\n");
    functions
        .filter(|body| body.lines().filter(|line| is_wide(line)).count() >= MANY)
        .count()
}

/// The line of the table that says how many these are.
const WIDE: &str = "Functions that compute with registers of AVX-512: ";

/// The line of the table that says which compiler made the program.
fn compiler() -> String {
    let output = Command::new("rustc").arg("-V").output().expect("rustc is installed");
    format!("Compiled by {}.", String::from_utf8_lossy(&output.stdout).trim())
}

fn table() {
    println!("# Instructions\n");
    println!(
        "171 samples; a pass of a kernel over test data 1, and whole default searches of test data 1 to 3 (seed 0, reading the samples included); of each model by its name a search with {FEW} candidates in f64, divided by its passes."
    );
    println!(
        "Counted by valgrind's callgrind, which knows no AVX-512, so the same on every x86-64 processor and with any load; the compiler's version and profile change them."
    );
    println!(
        "Regenerate: `cargo run --release -p brdfit-instructions > benches/results/instructions.md`; `-- --check` fails if a count is 3 % above."
    );
    println!("{}", compiler());
    println!("{WIDE}{}.\n", wide_functions());
    println!("| model | what | portable | of a sample | avx2 | of a sample |\n|---|---|--:|--:|--:|--:|");
    let samples = 171.0;
    for (model, work, counts) in lines(true) {
        let cells = counts.map(|count| {
            count.map_or("- | -".to_string(), |count| {
                format!("{count} | {:.1}", count as f64 / samples)
            })
        });
        println!("| {model} | {work} | {} |", cells.join(" | "));
    }
}

/// The counts of a line of the committed table; none where it has none.
fn before(model: &str, work: &str) -> [Option<u64>; 2] {
    let cells = TABLE
        .lines()
        .map(|line| line.split('|').map(str::trim).collect::<Vec<_>>());
    let mut same = cells.filter(|cells| cells.len() == 8 && (cells[1], cells[2]) == (model, work));
    same.next()
        .map_or([None; 2], |cells| [cells[3].parse().ok(), cells[5].parse().ok()])
}

/// Counts again, and tells what takes more than the table says, or is not in it.
fn is_as_before() -> bool {
    let more = if TABLE.contains(&compiler()) {
        MORE
    } else {
        println!("the table is of another compiler, so that 30 % are allowed");
        MORE_ELSEWHERE
    };
    let mut complaints = Vec::new();
    for (model, work, counts) in lines(false) {
        for ((simd, count), before) in INSTRUCTIONS.into_iter().zip(counts).zip(before(&model, work)) {
            let what = match (count, before) {
                (Some(count), Some(before)) if count as f64 <= more * before as f64 => continue,
                // A processor without AVX2 counts the portable passes alone.
                (None, _) if simd == "avx2" => continue,
                (Some(count), Some(before)) => format!("{count} instructions, {before} before"),
                (Some(count), None) => format!("{count} instructions, and the table has none"),
                (None, _) => "not counted".to_string(),
            };
            complaints.push(format!("{model}, {work}, {simd}: {what}"));
        }
    }
    let wide = wide_functions();
    let before = TABLE.lines().find_map(|line| line.strip_prefix(WIDE));
    let before = before.and_then(|text| text.trim_end_matches('.').parse::<usize>().ok());
    if before.is_none_or(|before| (wide as f64) < before as f64 * (2.0 - more)) {
        complaints.push(format!("{WIDE}{wide}, and before {before:?}"));
    }
    if complaints.is_empty() {
        println!("no count is above the table by more than {:.0} %", 100.0 * (more - 1.0));
    } else {
        println!("{}", complaints.join("\n"));
        println!("regenerate benches/results/instructions.md, and say why");
    }
    complaints.is_empty()
}
