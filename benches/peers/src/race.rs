//! Who is first within 1 % of the optimum: the share of scenes over the number of passes.

use std::fmt::Write;

use brdfit::analysis::paper_sets::paper_scans;
use brdfit::engine::FitOptions;
use brdfit_core::brdf::Params;
use brdfit_suite::hard_scenes::{Kind, Task, task};

use crate::course::Course;
use crate::octave::Octave;
use crate::profile;
use crate::racers::{self, Racer};

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
fn raced(racers: &[Racer], group: &Group) -> Vec<Vec<f64>> {
    let cap = MARKS[MARKS.len() - 1];
    let mut firsts = vec![Vec::new(); racers.len()];
    for (place, (task, seed)) in group.tasks.iter().enumerate() {
        let runs = racers.iter().map(|racer| {
            let course = Course::new(task, cap);
            (racer.run)(&course, *seed);
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
    let octave = Octave::begin();
    let (racers, left_out) = racers::all(octave.as_ref());
    let mut text = String::from("# A race: who is first within 1 % of the optimum\n\n");
    text += "Each racer has 3000 passes for each scene: a pass with derivatives is one, without them a half, whoever makes it.\n";
    text += "So it is as if each had brdfit's vector kernel; what a solver does between the passes is not counted.\n";
    text += "Multistart begins uniformly in the logarithms (from 1e-3 where the bound is 0 or less than that), as NLopt and the evolutions of `basin` search in these.\n";
    text += "Solvers without bounds (`levenberg-marquardt`, Ceres) search in x = lower + (upper - lower) sin^2 u. brdfit searches on by further seeds when it is done.\n";
    text += "Octave's lsqnonlin, with its default tolerances and the same derivatives, stands in for MATLAB's MultiStart, but is not the same: MATLAB's lsqnonlin takes other steps (trust-region-reflective), and its MultiStart begins uniformly in the parameters themselves.\n";
    text += "A racer is there at the first pass within 1 % of the least cost that any racer meets; the tables have the share of scenes where it is there after so many passes.\n";
    text += "Regenerate: `benches/peers/run race`; the counts do not depend on the machine, except for Octave's and Ceres's, which are those of the linear algebra installed there.\n";
    if !left_out.is_empty() {
        let _ = writeln!(text, "Left out, as not installed: {}.", left_out.join(", "));
    }
    let mut panels = Vec::new();
    for group in groups() {
        let firsts = raced(&racers, &group);
        let _ = write!(text, "\n## {}\n\n| racer |", sentence(group.name));
        MARKS.iter().for_each(|mark| text += &format!(" {mark} passes |"));
        text += " passes in the median |\n|---|";
        MARKS.iter().for_each(|_| text += "--:|");
        text += "--:|\n";
        for (Racer { name, .. }, firsts) in racers.iter().zip(&firsts) {
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
    let names: Vec<String> = racers.iter().map(|racer| racer.name.replace(['*', '`'], "")).collect();
    std::fs::write(folder.join("peers.svg"), profile::svg(&names, &panels, MARKS[3])).expect("a writable folder");
    std::fs::write(folder.join("peers.md"), text).expect("a writable folder");
}

fn sentence(name: &str) -> String {
    let mut letters = name.chars();
    letters
        .next()
        .map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
