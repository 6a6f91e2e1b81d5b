//! Who is first within 1 % of the optimum: the share of scenes over the number of passes.

use std::fmt::Write;

use brdfit::analysis::paper_sets::paper_scans;
use brdfit::engine::trace::{passes, trace};
use brdfit::engine::{FitOptions, Method};
use brdfit_core::brdf::{ALL, Params};
use brdfit_core::geometry::Block;
use brdfit_core::lm::Bounds;
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::search::{Region, Scene};
use brdfit_core::start;
use brdfit_suite::hard_scenes::{Kind, Task, task};

use crate::course::Course;
use crate::fits::{self, Local};
use crate::globals::{self, box_of};
use crate::profile;

/// Passes at which the table is read; the last is the end of the race.
const MARKS: [f64; 4] = [100.0, 300.0, 1000.0, 3000.0];
/// Searches of each of the paper's sets, by as many seeds.
const SEEDS: u64 = 20;
/// Scenes of each kind, ordinary ones and hard ones together.
const ORDINARY: u64 = 240;
const HARD: [Kind; 6] = [
    Kind::Mirror,
    Kind::Narrow,
    Kind::Rough,
    Kind::Misfit,
    Kind::Walk,
    Kind::Needle,
];
const HARD_EACH: u64 = 10;

/// How a racer goes about it; the number is the seed.
type Racer = fn(&Course, u64);

/// A racer's name, and whether it is ours.
const RACERS: &[(&str, Racer)] = &[
    ("**brdfit**, default search", ours),
    ("brdfit, the paper's method", papers),
    ("`rmpfit` 2.0, multistart", |course, seed| {
        multistart(course, seed, fits::rmpfit)
    }),
    ("`rmpfit` 2.0 from our candidates", |course, seed| {
        candidates(course, seed, fits::rmpfit)
    }),
    ("`basin` 3.2 BoundedLevenbergMarquardt, multistart", |course, seed| {
        multistart(course, seed, fits::basin)
    }),
    ("`basin` 3.2 from our candidates", |course, seed| {
        candidates(course, seed, fits::basin)
    }),
    ("`levenberg-marquardt` 0.15, multistart", |course, seed| {
        multistart(course, seed, fits::levenberg_marquardt)
    }),
    ("`levenberg-marquardt` 0.15 from our candidates", |course, seed| {
        candidates(course, seed, fits::levenberg_marquardt)
    }),
    #[cfg(ceres)]
    ("Ceres, multistart", |course, seed| {
        multistart(course, seed, crate::ceres::ceres)
    }),
    #[cfg(ceres)]
    ("Ceres from our candidates", |course, seed| {
        candidates(course, seed, crate::ceres::ceres)
    }),
    ("NLopt 2.9 MLSL_LDS with L-BFGS", globals::mlsl_lbfgs),
    ("NLopt 2.9 MLSL_LDS with SLSQP", globals::mlsl_slsqp),
    ("`basin` 3.2 differential evolution", globals::differential_evolution),
    ("`basin` 3.2 CMA-ES, restarted", globals::cma_es),
];

/// The searches one after the other, by further seeds, to the end of the race.
fn searches(course: &Course, seed: u64, method: Method) {
    for further in 0.. {
        let options = FitOptions {
            method,
            seed: seed + (further << 32),
            lower: course.lower.into(),
            upper: course.upper.into(),
            ..FitOptions::default()
        };
        let before = course.passes();
        let trace = trace(&course.samples, &options).expect("a valid scene");
        for record in &trace.records {
            course.note_at(before + passes(record.evaluations), record.cost);
        }
        course.spend(passes(trace.evaluations));
        if course.is_over() {
            return;
        }
    }
}

fn ours(course: &Course, seed: u64) {
    searches(course, seed, Method::Default);
}

fn papers(course: &Course, seed: u64) {
    searches(course, seed, Method::Paper);
}

/// Start `k`, uniform in the logarithm of each parameter.
pub fn log_uniform(course: &Course, seed: u64, k: u64) -> [f64; 6] {
    let [lower, upper] = box_of(course).map(|side| std::array::from_fn(|k| side[k]));
    start::uniform::<f64, 6>(seed, k, &Bounds { lower, upper }).map(Real::portable_exp)
}

fn multistart(course: &Course, seed: u64, local: Local) {
    (0..)
        .take_while(|_| !course.is_over())
        .for_each(|k| local(course, &log_uniform(course, seed, k)));
}

/// From the candidates of the default search, one after the other; what they cost counts too.
fn candidates(course: &Course, seed: u64, local: Local) {
    let mut blocks = vec![Block::EMPTY; course.rows().div_ceil(16)];
    for (row, sample) in course.samples.iter().enumerate() {
        let observation = brdfit_core::geometry::Observation::new(sample).expect("a valid scene");
        blocks[row / 16].set(row % 16, &observation);
    }
    let scan = Scan::<f64, ALL, 6>::new(&blocks);
    let bounds = Scan::<f64, ALL, 6>::bounds(&Params::from_array(course.lower), &Params::from_array(course.upper));
    for k in 0.. {
        if course.is_over() {
            return;
        }
        let candidate = scan.candidate(&bounds, seed, k, Region::Everywhere);
        course.spend(0.5 * f64::from(candidate.passes));
        local(course, &Scan::<f64, ALL, 6>::params(&candidate.x).to_array());
    }
}

/// Some scenes with a name.
struct Group {
    name: &'static str,
    /// Each with the seed of its searches.
    tasks: Vec<(Task, u64)>,
}

fn groups() -> Vec<Group> {
    let limits = FitOptions::default();
    let params = |values: &[f64]| Params::from_array(std::array::from_fn(|k| values[k]));
    let paper = paper_scans().into_iter().flat_map(|subject| {
        let task = Task {
            samples: subject.samples,
            lower: params(&limits.lower),
            upper: params(&limits.upper),
        };
        (0..SEEDS).map(move |seed| (task.clone(), seed))
    });
    let hard = HARD
        .into_iter()
        .flat_map(|kind| (0..HARD_EACH).map(move |k| (task(kind, k), k)));
    vec![
        Group {
            name: "the paper's three sets, 20 seeds each",
            tasks: paper.collect(),
        },
        Group {
            name: "240 random scenes",
            tasks: (0..ORDINARY).map(|k| (task(Kind::Ordinary, k), k)).collect(),
        },
        Group {
            name: "60 hard scenes",
            tasks: hard.collect(),
        },
    ]
}

/// Passes until each racer was within 1 % of the best that any met, for each scene; infinite where it was not.
fn raced(group: &Group) -> Vec<Vec<f64>> {
    let cap = MARKS[MARKS.len() - 1];
    let mut firsts = vec![Vec::new(); RACERS.len()];
    for (place, (task, seed)) in group.tasks.iter().enumerate() {
        let runs = RACERS.iter().map(|(_, racer)| {
            let course = Course::new(task, cap);
            racer(&course, *seed);
            course.improvements()
        });
        let runs: Vec<Vec<(f64, f64)>> = runs.collect();
        let best = runs
            .iter()
            .filter_map(|run| run.last())
            .map(|last| last.1)
            .fold(f64::INFINITY, f64::min);
        for (firsts, run) in firsts.iter_mut().zip(&runs) {
            let first = run.iter().find(|(_, cost)| *cost <= 1.01 * best);
            firsts.push(first.map_or(f64::INFINITY, |(passes, _)| *passes));
        }
        eprint!("\r{}: {} of {}", group.name, place + 1, group.tasks.len());
    }
    eprintln!();
    firsts
}

/// Writes the table and the picture into `folder`.
pub fn write(folder: &std::path::Path) {
    let mut text = String::from("# A race: who is first within 1 % of the optimum\n\n");
    text += "Each racer has 3000 passes for each scene: a pass with derivatives is one, without them a half, whoever makes it.\n";
    text += "So it is as if each had brdfit's vector kernel; what a solver does between the passes is not counted.\n";
    text += "Multistart begins uniformly in the logarithms (from 1e-3 where the bound is 0 or less than that), as NLopt and the evolutions of `basin` search in these.\n";
    text += "Solvers without bounds (`levenberg-marquardt`, Ceres) search in x = lower + (upper - lower) sin^2 u. brdfit searches on by further seeds when it is done.\n";
    text += "A racer is there at the first pass within 1 % of the least cost that any racer meets; the tables have the share of scenes where it is there after so many passes.\n";
    text += "Regenerate: `benches/peers/run race`; the counts do not depend on the machine.\n";
    let mut panels = Vec::new();
    for group in groups() {
        let firsts = raced(&group);
        let _ = write!(text, "\n## {}\n\n| racer |", sentence(group.name));
        MARKS.iter().for_each(|mark| text += &format!(" {mark} passes |"));
        text += " passes in the median |\n|---|";
        MARKS.iter().for_each(|_| text += "--:|");
        text += "--:|\n";
        for ((name, _), firsts) in RACERS.iter().zip(&firsts) {
            let _ = write!(text, "| {name} |");
            for mark in MARKS {
                let share = firsts.iter().filter(|&&first| first <= mark).count() as f64 / firsts.len() as f64;
                let _ = write!(text, " {:.1} % |", 100.0 * share);
            }
            let mut sorted = firsts.clone();
            sorted.sort_by(f64::total_cmp);
            let median = sorted[sorted.len() / 2];
            let shown = if median.is_finite() {
                format!("{median:.0}")
            } else {
                "-".into()
            };
            let _ = writeln!(text, " {shown} |");
        }
        panels.push((sentence(group.name), firsts));
    }
    text += "\n![Share of scenes over passes](peers.svg)\n";
    let names: Vec<String> = RACERS.iter().map(|(name, _)| name.replace(['*', '`'], "")).collect();
    std::fs::write(folder.join("peers.svg"), profile::svg(&names, &panels, MARKS[3])).expect("a writable folder");
    std::fs::write(folder.join("peers.md"), text).expect("a writable folder");
}

fn sentence(name: &str) -> String {
    let mut letters = name.chars();
    letters
        .next()
        .map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
