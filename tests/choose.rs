//! Choice of terms: right on scenes of known terms, its criteria against their formulas, and the command's contract.
#![allow(
    clippy::disallowed_methods,
    reason = "oracles may use std's functions; the code under test may not"
)]

use brdfit::analysis::bootstrap::{Noise, copy};
use brdfit::analysis::choose::{self, SETS, Wanted, sets};
use brdfit::analysis::joint;
use brdfit::analysis::profile::calibrate::threshold;
use brdfit::engine::{self, FitOptions, Material, Model};
use brdfit::result::words;
use brdfit::terms::term_names;
use brdfit_core::brdf::{ALL, DIFFUSE, NAMES, SURFACE, VOLUME, has, parameters};
use brdfit_core::geometry::Sample;
use brdfit_suite::program;
use brdfit_suite::scan::{data, scan, six};
use brdfit_suite::tolerance::{self, check};
use serde_json::Value;

fn auto() -> Wanted {
    Wanted::Best(sets(&FitOptions::default()))
}

/// Three angles of a scene with the terms that the set has, each plain to see with 0.5 % noise.
fn scene(terms: u8, seed: u64) -> Vec<Sample<f64>> {
    let all = [0.1, 1.0, 0.05, 0.3, 1.1, 1.0];
    let absent = [0.0, 0.0, 0.0, 0.3, 1.5, 0.0];
    let mut params = std::array::from_fn(|k| if has(terms, k) { all[k] } else { absent[k] });
    if !has(terms, 5) {
        params[4] = absent[4];
    }
    let directions = [20.0f64, 60.0, 80.0].into_iter().flat_map(|theta_i| {
        (-84..=84)
            .step_by(2)
            .map(move |theta_s| Sample::in_plane(theta_i.to_radians(), f64::from(theta_s).to_radians(), 1.0))
    });
    let samples: Vec<_> = directions.collect();
    copy(&samples, &Material::paper(params), 0.005, &mut Noise::new(5, seed))
}

#[test]
fn finds_the_terms_of_a_scene() {
    let (mut right, mut all) = (0, 0);
    for (terms, _) in SETS {
        for seed in 0..12 {
            let samples = scene(terms, seed);
            let (options, outcome, choice) = choose::fit(&samples, &auto()).unwrap();
            let chosen = choice.unwrap().chosen().options;
            all += 1;
            right += u32::from(chosen.terms == terms);
            // The compiled set of the chosen terms is the one that ran.
            assert_eq!(options, chosen);
            let alone = FitOptions {
                terms: chosen.terms,
                ..FitOptions::default()
            };
            let alone = engine::fit(&samples, &alone).unwrap();
            assert!(outcome.cost <= alone.cost * (1.0 + 1e-9));
            let free = outcome.uncertainty.places.iter().flatten().count();
            assert_eq!(free, parameters(chosen.terms));
        }
    }
    // 19 of 20 are asked for.
    assert!(right * 20 >= all * 19, "{right} of {all}");
}

/// Two angles of a scene whose errors of ln f are an AR process of 8 degrees.
fn wandering(truth: &Material, copy: u64) -> Vec<Sample<f64>> {
    let mut noise = Noise::new(21, copy);
    let mut samples = Vec::new();
    for theta_i in [20.0f64, 60.0] {
        let (kept, mut own) = ((-2.0f64 / 8.0).exp(), noise.normal());
        for theta_s in (-84..=84).step_by(2) {
            own = kept * own + (1.0 - kept * kept).sqrt() * noise.normal();
            let sample = Sample::in_plane(theta_i.to_radians(), f64::from(theta_s).to_radians(), 1.0);
            let ln_f = truth.ln_f(&sample).unwrap() + 0.05 * own;
            samples.push(Sample {
                brdf: ln_f.exp(),
                ..sample
            });
        }
    }
    samples
}

/// What wanders is no lobe: with the criteria of independent residuals half of such scans of Lambert's law have one, and the F test finds one in more than half.
#[test]
fn residuals_that_wander_buy_no_terms() {
    let copies = 24;
    for (params, terms, more) in [
        ([0.2, 0.0, 0.0, 0.2, 1.5, 0.0], DIFFUSE, Some(DIFFUSE | SURFACE)),
        (
            [0.05, 1.0, 0.0, 0.2, 1.5, 0.0],
            DIFFUSE | SURFACE,
            Some(DIFFUSE | SURFACE | VOLUME),
        ),
        // All terms are tested against those without the volume lobe.
        ([0.1, 1.0, 1.0, 0.15, 1.5, 0.0], DIFFUSE | SURFACE | VOLUME, None),
    ] {
        let (mut right, mut plain, mut correlated, mut rejected) = (0, 0, 0, 0);
        for copy in 0..copies {
            let samples = wandering(&Material::paper(params), copy);
            let count = samples.len() as f64;
            let choice = choose::choose(&samples, &sets(&FitOptions::default())).unwrap();
            let independent = |one: &&choose::Candidate| {
                count * (one.outcome.cost / count).ln() + (one.criteria.parameters as f64 + 1.0) * count.ln()
            };
            let least = choice
                .candidates
                .iter()
                .min_by(|a, b| independent(a).total_cmp(&independent(b)));
            plain += u64::from(least.unwrap().options.terms == terms);
            right += u64::from(choice.chosen().options.terms == terms);
            correlated += u64::from(
                choice
                    .inflation
                    .is_some_and(|inflation| inflation.process.length > 0.05),
            );
            let larger = choice.candidates.iter().find(|one| Some(one.options.terms) == more);
            rejected += u64::from(larger.is_some_and(|larger| larger.p_value.unwrap() < 0.05));
        }
        println!(
            "{terms}: {right} of {copies} right, {plain} by independent residuals; {correlated} correlated; F rejects the truth in {rejected}"
        );
        assert!(10 * right >= 8 * copies && right > plain, "{terms}: {right}, {plain}");
        assert!(correlated + 1 >= copies, "{correlated}");
        assert!(rejected <= 5, "{rejected}");
    }
}

/// All candidates are judged by one correlation, so that of equally many parameters the least cost is the best; misfit that wanders is what measured scans have.
#[test]
fn of_equally_many_parameters_the_least_cost_is_the_best() {
    let truth = Material::paper([0.1, 2.0, 0.3, 0.2, 1.5, 0.5]);
    let models = [
        "beckmann",
        "beckmann-smith",
        "ggx",
        "ggx-smith",
        "beckmann-own-slope",
        "hyper-cauchy",
    ];
    let list: Vec<FitOptions> = models.into_iter().filter_map(Model::find).map(FitOptions::of).collect();
    for copy in 0..4 {
        let choice = choose::choose(&wandering(&truth, copy), &list).unwrap();
        let inflation = choice.inflation.expect("a correlation");
        assert!(inflation.factor > 2.0, "{inflation:?}");
        for one in &choice.candidates {
            let count = one.outcome.samples as f64 / inflation.factor;
            assert!(tolerance::CRITERION.admits((one.criteria.samples / count - 1.0).abs()));
            let k = one.criteria.parameters as f64 + 1.0;
            let bic = count * (one.outcome.cost / one.outcome.samples as f64).ln() + k * count.ln();
            assert!(tolerance::CRITERION.admits((one.criteria.bic / bic - 1.0).abs()));
            for other in &choice.candidates {
                let alike = one.criteria.parameters == other.criteria.parameters;
                if alike && one.outcome.cost < other.outcome.cost {
                    assert!(one.criteria.bic < other.criteria.bic && one.criteria.aicc < other.criteria.aicc);
                }
            }
        }
    }
}

/// Scans fitted together are judged as one is: their terms, and the errors of what they share.
#[test]
fn joint_fits_count_what_wanders() {
    let truths = [[0.05, 1.0, 0.0, 0.2, 1.5, 0.0], [0.1, 2.0, 0.0, 0.2, 1.5, 0.0]];
    let terms = DIFFUSE | SURFACE;
    let shared: Vec<bool> = NAMES.iter().map(|&name| name == "m").collect();
    let candidates: Vec<_> = sets(&FitOptions::default())
        .into_iter()
        .map(|options| (options, shared.clone()))
        .collect();
    let copies = 24;
    let (mut right, mut covered, mut independent, mut told) = (0, 0, 0, 0);
    for copy in 0..copies {
        let scans = [0, 1].map(|scan| wandering(&Material::paper(truths[scan]), 2 * copy + scan as u64));
        let scans = scans.each_ref().map(|samples| &samples[..]);
        let fits = joint::fit(&scans, &candidates, None).unwrap();
        right += u64::from(fits.best().options.terms == terms);
        let place = candidates
            .iter()
            .position(|(options, _)| options.terms == terms)
            .unwrap();
        let one = &fits.candidates[place];
        let plain = engine::joint::fit(&scans, &shared, &one.options).unwrap();
        assert_eq!(one.fitted.scans, plain.scans);
        let within = |errors: &[Vec<Option<f64>>]| (one.fitted.scans[0][3] - 0.2).abs() < 2.0 * errors[0][3].unwrap();
        covered += u64::from(within(&one.known.errors));
        independent += u64::from(within(&plain.errors));
        told += u64::from(one.known.misfit.is_some_and(|misfit| misfit.factor.1 > 1.5));
    }
    println!("{right} of {copies} right; m within 2 errors in {covered}, {independent} by independent residuals");
    assert!(10 * right >= 9 * copies, "{right}");
    assert!(
        covered + 2 >= copies && independent < covered,
        "{covered}, {independent}"
    );
    assert!(told + 1 >= copies, "{told}");
}

/// AICc and BIC as in Burnham and Anderson (2002), and the F test.
#[test]
fn criteria() {
    let samples = scene(ALL, 1);
    let count = samples.len() as f64;
    let choice = choose::fit(&samples, &auto()).unwrap().2.unwrap();
    assert_eq!(choice.candidates.len(), SETS.len());
    for (candidate, (terms, _)) in choice.candidates.iter().zip(SETS) {
        let criteria = candidate.criteria;
        assert_eq!(
            (candidate.options.terms, criteria.parameters),
            (terms, parameters(terms))
        );
        let k = criteria.parameters as f64 + 1.0;
        let likelihood = -0.5 * count * (candidate.outcome.cost / count).ln();
        let aicc = 2.0 * k * count / (count - k - 1.0) - 2.0 * likelihood;
        let bic = k * count.ln() - 2.0 * likelihood;
        for (criterion, expected) in [(criteria.aicc, aicc), (criteria.bic, bic)] {
            assert!(tolerance::CRITERION.admits((criterion / expected - 1.0).abs()));
        }
    }
    assert_eq!(choice.candidates[0].p_value, None);
    assert!(choice.candidates[1].p_value.unwrap() < 1e-10);
    // One parameter more: the F test is the two-sided t test, of which `threshold` has the quantiles.
    let (mut largest, mut falls) = (0.0f64, 0);
    for seed in 1..=6 {
        let samples = scene(DIFFUSE | SURFACE, seed);
        let choice = choose::fit(&samples, &auto()).unwrap().2.unwrap();
        let plain = &choice.candidates[1];
        for more in &choice.candidates[2..4] {
            let left = samples.len() - more.criteria.parameters;
            let f = (plain.outcome.cost / more.outcome.cost - 1.0) * left as f64;
            let limit = threshold(1.0 - more.p_value.unwrap(), left as f64);
            largest = largest.max((f - limit).abs());
            falls += u32::from(f > 1e-3);
        }
    }
    assert!(falls > 0, "the cost never falls");
    check(largest, tolerance::F_TEST);
}

#[test]
fn bounds_that_need_a_term_keep_it() {
    let samples = scene(DIFFUSE | SURFACE, 3);
    let mut options = FitOptions::default();
    (options.lower[5], options.upper[5]) = (1.0, 1.0);
    let choice = choose::fit(&samples, &Wanted::Best(sets(&options))).unwrap().2.unwrap();
    assert!(
        choice
            .candidates
            .iter()
            .all(|one| has(one.options.terms, 5) || one.options.terms == DIFFUSE)
    );
    assert_ne!(choice.chosen().options.terms, DIFFUSE);
    // A held parameter is not counted.
    let absorbing = choice.candidates.iter().find(|one| has(one.options.terms, 5)).unwrap();
    assert_eq!(absorbing.criteria.parameters, parameters(absorbing.options.terms) - 1);
    // Without noise the smallest set that is exact is chosen, not the one with the luckiest rounding.
    let material = Material::paper([0.1, 1.0, 0.0, 0.2, 1.5, 0.0]);
    let exact = copy(&samples, &material, 0.0, &mut Noise::new(0, 0));
    assert_eq!(choose::fit(&exact, &auto()).unwrap().0.terms, DIFFUSE | SURFACE);
    // Too few samples for the larger sets: those are no candidates.
    let few = choose::fit(&samples[..5], &auto()).unwrap().2.unwrap();
    assert!(few.candidates.iter().all(|one| one.criteria.parameters <= 5) && few.candidates.len() < SETS.len());
}

#[test]
fn command() {
    let file = data("testdata3_sym_seed1.csv");
    let file = file.to_str().unwrap();
    let ran = program::brdfit(&["fit", file, "--terms", "auto"], b"");
    assert_eq!((ran.code, ran.errors.as_str()), (0, ""));
    let samples = scan(&data("testdata3_sym_seed1.csv"));
    let (options, outcome, choice) = choose::fit(&samples, &auto()).unwrap();
    assert!(ran.output.contains(&words::choice(&choice.unwrap())), "{}", ran.output);
    assert_eq!(ran.output.matches("p = ").count(), 4);
    let ran = program::brdfit(&["fit", file, "--terms", "auto", "--format", "json"], b"");
    let json: Value = serde_json::from_str(&ran.output).unwrap();
    assert_eq!(json["terms"], serde_json::json!(term_names(options.terms)));
    let selection = &json["selection"];
    assert_eq!(selection["criterion"], "bic");
    assert_eq!(selection["candidates"].as_array().unwrap().len(), SETS.len());
    assert!(selection["candidates"][0]["f_test_p"].is_null() && selection["candidates"][1]["f_test_p"].is_f64());
    for (k, name) in NAMES.iter().enumerate() {
        assert_eq!(json["parameters"][name].as_f64(), Some(six(&outcome.params)[k]));
    }
    let ran = program::brdfit(&["profile", file, "--terms", "auto", "--parameter", "rho_d"], b"");
    assert_eq!(ran.code, 0);
}
