//! Prints how often `--terms auto` finds the terms that a scene was made with, as a Markdown table: `cargo run --release --example selection > benches/results/selection.md`.

use brdfit::analysis::bootstrap::{Noise, copy};
use brdfit::analysis::choose::{Candidate, Choice, SETS, choose, sets};
use brdfit::engine::{self, FitOptions, Material};
use brdfit::terms::term_names;
use brdfit_core::brdf::{ABSORBING, ALL, DIFFUSE, Params, SURFACE, VOLUME};
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use rayon::prelude::*;

const SCENES: u64 = 1000;
/// A term contributes more than the noise if leaving it out costs the scene without noise this many variances of the noise, over all samples and with the other parameters fitted anew.
const CONTRIBUTES: f64 = 25.0;
/// Where the columns of the second table begin.
const BANDS: [f64; 5] = [0.0, 5.0, CONTRIBUTES, 100.0, 1000.0];

struct Scene {
    /// Place of its terms in [`SETS`].
    set: usize,
    /// The least contribution of its terms, variances of the noise; infinite for Lambert's law, which has none to lose.
    contribution: f64,
    /// The sets of the least BIC and of the least AICc.
    chosen: [u8; 2],
}

fn main() {
    let scenes: Vec<Scene> = (0..SCENES).into_par_iter().map(scene).collect();
    println!("# Choice of terms\n");
    println!(
        "{SCENES} random scenes: 1 to 3 incident angles of 0 to 80 deg, theta_s every 1 or 2 deg, normal noise of ln f of 0.5 to 20 %, the five sets of terms in turn."
    );
    println!(
        "A term contributes what the best fit without it costs on the scene without noise, over the variance of the noise."
    );
    println!(
        "It contributes more than the noise if that is at least {CONTRIBUTES}: 5 standard deviations in all, or 0.4 of the noise at each of 171 samples."
    );
    println!("Regenerate: `cargo run --release --example selection > benches/results/selection.md`.\n");
    println!("| terms | scenes | of which each term contributes more than the noise | right by BIC | right by AICc |");
    println!("|---|--:|--:|--:|--:|");
    let row = |name: String, of: Vec<&Scene>| {
        let counted: Vec<&&Scene> = of.iter().filter(|scene| scene.contribution >= CONTRIBUTES).collect();
        let right = |k: usize| {
            share(
                counted
                    .iter()
                    .filter(|scene| scene.chosen[k] == SETS[scene.set].0)
                    .count(),
                counted.len(),
            )
        };
        println!(
            "| {name} | {} | {} | {} | {} |",
            of.len(),
            counted.len(),
            right(0),
            right(1)
        );
    };
    for (set, (terms, _)) in SETS.into_iter().enumerate() {
        row(
            term_names(terms).join(", "),
            scenes.iter().filter(|scene| scene.set == set).collect(),
        );
    }
    row("all".into(), scenes.iter().collect());
    println!("\nBIC, by the contribution of the term that contributes least, scenes with a lobe:\n");
    println!("| contribution from | scenes | right | a term too few | a term too many | another set |");
    println!("|--:|--:|--:|--:|--:|--:|");
    for (k, from) in BANDS.into_iter().enumerate() {
        let to = BANDS.get(k + 1).copied().unwrap_or(f64::INFINITY);
        let of: Vec<&Scene> = scenes
            .iter()
            .filter(|scene| scene.set > 0 && (from..to).contains(&scene.contribution))
            .collect();
        let count = |what: fn(u8, u8) -> bool| {
            share(
                of.iter()
                    .filter(|scene| what(scene.chosen[0], SETS[scene.set].0))
                    .count(),
                of.len(),
            )
        };
        println!(
            "| {from} | {} | {} | {} | {} | {} |",
            of.len(),
            count(|chosen, truth| chosen == truth),
            count(|chosen, truth| chosen != truth && chosen & truth == chosen),
            count(|chosen, truth| chosen != truth && chosen & truth == truth),
            count(|chosen, truth| chosen & truth != chosen && chosen & truth != truth),
        );
    }
}

fn share(part: usize, of: usize) -> String {
    if of == 0 {
        "-".into()
    } else {
        format!("{:.1} %", 100.0 * part as f64 / of as f64)
    }
}

fn scene(k: u64) -> Scene {
    let random = &mut Noise::new(1, k);
    let set = (k % SETS.len() as u64) as usize;
    let terms = SETS[set].0;
    let (samples, actual, noise) = draw(terms, random);
    let clean = copy(&samples, &actual, 0.0, random);
    let lost = [SURFACE | VOLUME | ABSORBING, ABSORBING, VOLUME].map(|term| terms & !term);
    let smaller = lost
        .into_iter()
        .filter(|&left| left != terms && SETS.iter().any(|(set, _)| *set == left));
    // What has no lobe is the smallest set only for a scene with a plain surface.
    let smaller = smaller.filter(|&left| left != DIFFUSE || terms == DIFFUSE | SURFACE);
    let costs = smaller.map(|terms| {
        let options = FitOptions {
            terms,
            ..FitOptions::default()
        };
        engine::fit(&clean, &options).expect("simulated scans are valid").cost
    });
    let contribution = costs.fold(f64::INFINITY, f64::min) / (noise * noise);
    let noisy = copy(&samples, &actual, noise, random);
    let choice = choose(&noisy, &sets(&FitOptions::default())).expect("simulated scans are valid");
    Scene {
        set,
        contribution,
        chosen: [choice.chosen().options.terms, least_aicc(&choice)],
    }
}

fn least_aicc(choice: &Choice) -> u8 {
    let order = |a: &&Candidate, b: &&Candidate| a.criteria.aicc.total_cmp(&b.criteria.aicc);
    choice
        .candidates
        .iter()
        .min_by(order)
        .map_or(ALL, |one| one.options.terms)
}

/// Angles, parameters and noise of a scene with these terms.
fn draw(terms: u8, random: &mut Noise) -> (Vec<Sample<f64>>, Material, f64) {
    let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
    let angles = 1 + between(0.0, 3.0) as usize;
    let theta_i: Vec<f64> = (0..angles).map(|_| between(0.0, 80.0).round()).collect();
    let step = if between(0.0, 1.0) < 0.5 { 1 } else { 2 };
    let mut log_between =
        |low: f64, high: f64| Real::portable_exp(between(Real::portable_ln(low), Real::portable_ln(high)));
    let mut params = Params {
        rho_d: log_between(1e-3, 0.9),
        rho_s: log_between(0.01, 20.0),
        rho_v: log_between(1e-4, 1.0),
        m: log_between(0.005, 0.6),
        n: log_between(1.05, 4.0),
        kappa: log_between(0.05, 8.0),
    };
    let noise = log_between(0.005, 0.2);
    let has = |term: u8| if terms & term != 0 { 1.0 } else { 0.0 };
    params.rho_s *= has(SURFACE);
    params.rho_v *= has(VOLUME);
    params.kappa *= has(ABSORBING);
    let directions = theta_i.iter().flat_map(|&theta_i| {
        (-85..=85)
            .step_by(step)
            .map(move |theta_s| (theta_i, f64::from(theta_s)))
    });
    let samples =
        directions.map(|(theta_i, theta_s)| Sample::in_plane(theta_i.to_radians(), theta_s.to_radians(), 1.0));
    (samples.collect(), Material::paper(params.to_array()), noise)
}
