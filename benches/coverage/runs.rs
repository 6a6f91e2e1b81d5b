//! Repeats with an effect of the run, and their budget.

use brdfit::analysis::bootstrap::{Noise as Random, copy};
use brdfit::analysis::choose::Wanted;
use brdfit::analysis::fit::{FittedScan, fit};
use brdfit::analysis::repeats::{Quantity, quantities};
use brdfit::engine::Material;
use brdfit::input::Measurement;
use brdfit_core::geometry::Sample;
use rayon::prelude::*;

use crate::case::NAMES;
use crate::scene::few;
use crate::share::Share;

const ACTUAL: [f64; 6] = [0.2, 0.8, 0.0, 0.15, 1.5, 0.0];
const THETA_I: f64 = 30.0;

/// Of each quantity the share of budgets of so many runs that hold its value without an effect of the run.
pub fn held(runs: u64, effect: f64, experiments: u64) -> Vec<Share> {
    let truth = budgets(&[exact(), exact()]);
    let all: Vec<Vec<Quantity>> = (0..experiments)
        .into_par_iter()
        .map(|experiment| {
            let first = 1000 * runs + experiment * runs;
            let all: Vec<Measurement> = (first..first + runs).map(|seed| run(seed, effect)).collect();
            budgets(&all)
        })
        .collect();
    let of = |name: &&str| {
        let place = truth.iter().position(|quantity| quantity.name == *name);
        let actual = place.and_then(|place| Some((place, truth[place].runs[0]?.value)));
        actual.map_or_else(Share::default, |(place, actual)| {
            let budgets = all.iter().filter_map(|one| one[place].budget);
            Share::of(budgets.map(|budget| (budget.mean - actual).abs() <= budget.expanded))
        })
    };
    NAMES.iter().map(of).collect()
}

/// Without anything that all runs have in common.
fn budgets(runs: &[Measurement]) -> Vec<Quantity> {
    let fitted = |run| fit(run, &Wanted::One(few())).expect("a fit");
    let fits: Vec<FittedScan> = runs.iter().map(fitted).collect();
    quantities(runs, &fits, 0.0)
}

/// A run: the spot changes rho_d by 5 %, rho_s by 3 % and m by 2 %, and the noise of a sample is 3 %.
fn run(seed: u64, effect: f64) -> Measurement {
    let mut noise = Random::new(21, seed);
    let [rho_d, rho_s, rho_v, m, n, kappa] = ACTUAL;
    let mut changed = |value: f64, part: f64| value * (1.0 + effect * part * noise.normal());
    let (rho_d, rho_s, m) = (changed(rho_d, 0.05), changed(rho_s, 0.03), changed(m, 0.02));
    let material = Material::paper([rho_d, rho_s, rho_v, m, n, kappa]);
    measured(&material, 0.03, &mut noise)
}

fn exact() -> Measurement {
    measured(&Material::paper(ACTUAL), 1e-6, &mut Random::new(0, 0))
}

fn measured(material: &Material, noise: f64, random: &mut Random) -> Measurement {
    let grid: Vec<Sample<f64>> = (-80..=80)
        .step_by(5)
        .map(|theta_s| Sample::in_plane(THETA_I.to_radians(), f64::from(theta_s).to_radians(), 1.0))
        .collect();
    let samples = copy(&grid, material, noise, random);
    Measurement::of_samples("run", samples, None)
}
