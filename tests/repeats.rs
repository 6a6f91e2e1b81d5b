//! Intervals over runs of one sample hold the actual values, and runs that stand apart are named.

use brdfit::analysis::bootstrap::{Noise, copy};
use brdfit::analysis::choose::Wanted;
use brdfit::analysis::fit::{FittedScan, fit};
use brdfit::analysis::repeats::{Quantity, quantities};
use brdfit::engine::{FitOptions, Material};
use brdfit::input::{self, Measurement, ReadOptions};
use brdfit_core::brdf::{DIFFUSE, SURFACE};
use brdfit_core::geometry::Sample;
use brdfit_suite::program::{brdfit, fail, write};
use brdfit_suite::scan::{left_out, shared};
use rayon::prelude::*;
use serde_json::Value;
use tempfile::TempDir;

const ACTUAL: [f64; 6] = [0.2, 0.8, 0.0, 0.15, 1.5, 0.0];

fn table(samples: &[Sample<f64>]) -> String {
    let row = |sample: &Sample<f64>| {
        let (theta_i, theta_s) = (sample.theta_i.to_degrees(), sample.theta_s.to_degrees());
        format!("{theta_i},{theta_s},{}\n", sample.brdf)
    };
    let rows: String = samples.iter().map(row).collect();
    format!("theta_i_deg,theta_s_deg,brdf_per_sr\n{rows}")
}

fn measurement(name: &str, text: &str) -> Measurement {
    input::parse(name, text.as_bytes(), &ReadOptions::default())
        .expect("a scan")
        .remove(0)
}

/// A run: the spot changes rho_d by 5 %, rho_s by 3 % and m by 2 %, and the noise of a sample is 3 %.
fn run(seed: u64, effect: f64) -> String {
    let mut noise = Noise::new(21, seed);
    let [rho_d, rho_s, rho_v, m, n, kappa] = ACTUAL;
    let mut changed = |value: f64, part: f64| value * (1.0 + effect * part * noise.normal());
    let material = Material::paper([
        changed(rho_d, 0.05),
        changed(rho_s, 0.03),
        rho_v,
        changed(m, 0.02),
        n,
        kappa,
    ]);
    let grid: Vec<Sample<f64>> = (-80..=80)
        .step_by(5)
        .map(|theta_s| Sample::in_plane(30f64.to_radians(), f64::from(theta_s).to_radians(), 1.0))
        .collect();
    table(&copy(&grid, &material, 0.03, &mut noise))
}

fn wanted() -> Wanted {
    let mut options = FitOptions {
        terms: DIFFUSE | SURFACE,
        ..FitOptions::default()
    };
    (options.lower[4], options.upper[4]) = (1.5, 1.5);
    Wanted::One(options)
}

/// The budget over so many runs.
fn experiment(first: u64, runs: u64, effect: f64) -> Vec<Quantity> {
    let all: Vec<Measurement> = (first..first + runs)
        .map(|seed| measurement("run", &run(seed, effect)))
        .collect();
    let fits: Vec<FittedScan> = all.iter().map(|one| fit(one, &wanted()).expect("a fit")).collect();
    quantities(&all, &fits, 0.0)
}

#[test]
fn intervals_over_runs_hold_the_actual_values() {
    const EXPERIMENTS: u64 = 400;
    // Values without an effect of the run, which is even around them.
    let exact = {
        let grid: Vec<Sample<f64>> = (-80..=80)
            .map(|theta_s| Sample::in_plane(30f64.to_radians(), f64::from(theta_s).to_radians(), 1.0))
            .collect();
        let clean = copy(&grid, &Material::paper(ACTUAL), 0.0, &mut Noise::new(0, 0));
        let exact = measurement("exact", &table(&clean));
        let fitted = fit(&exact, &wanted()).expect("a fit");
        quantities(&[exact.clone(), exact], &[fitted.clone(), fitted], 0.0)
    };
    for (runs, effect) in [(3, 1.0), (5, 1.0), (4, 0.0)] {
        let all: Vec<Vec<Quantity>> = (0..EXPERIMENTS)
            .into_par_iter()
            .map(|k| experiment(1000 * runs + k * runs, runs, effect))
            .collect();
        for (place, actual) in exact.iter().enumerate() {
            let actual = actual.runs[0].expect("an exact fit tells all").value;
            let holds = |quantity: &Quantity| {
                let budget = quantity.budget.expect("all runs tell it");
                (budget.mean - actual).abs() <= budget.expanded
            };
            let held = all.iter().filter(|one| holds(&one[place])).count() as f64 / EXPERIMENTS as f64;
            let differs = all
                .iter()
                .filter(|one| one[place].budget.is_some_and(|budget| budget.differs()))
                .count();
            let name = &all[0][place].name;
            println!(
                "{runs} runs, effect {effect}: {name} held in {:.1} %, differs in {differs}",
                100.0 * held
            );
            assert!((0.925..=0.975).contains(&held), "{name}: {held}");
            // Without an effect the runs differ by no more than their errors, in 95 % of cases.
            if effect == 0.0 {
                assert!(differs as f64 <= 0.09 * EXPERIMENTS as f64, "{name}: {differs}");
            }
        }
    }
}

/// A prior is the same in all runs: it is in the error of their mean as it is in that of each.
#[test]
fn a_prior_is_in_the_budget() {
    let folder = TempDir::new().unwrap();
    let files = [1, 2, 3].map(|seed| write(&folder, &format!("run{seed}.csv"), run(seed, 0.0)));
    let fixed = ["--terms", "diffuse,surface", "--prior", "n=1.48+-0.02"];
    let read = |arguments: &[&str]| -> Value {
        let output = brdfit(&[arguments, &fixed, &["--format", "json"]].concat(), b"").output;
        serde_json::from_str(&output).unwrap()
    };
    let alone = read(&["fit", &files[0]]);
    let all = read(&["joint", "--repeats", &files[0], &files[1], &files[2]]);
    let budget = |name: &str| {
        let quantities = all["quantities"].as_array().unwrap();
        let one = quantities.iter().find(|one| one["name"] == name).unwrap();
        ["type_b", "within"].map(|part| one["budget"][part].as_f64().unwrap())
    };
    for name in ["n", "rho_s"] {
        let [type_b, within] = budget(name);
        let error = alone["uncertainty"]["stderr"][name].as_f64().unwrap();
        println!("{name}: type B {type_b}, within {within}, error of one run {error}");
        assert!(type_b < error && type_b > 0.8 * error, "{name}: {type_b} of {error}");
        assert!(
            ((type_b * type_b + within * within).sqrt() / error - 1.0).abs() < 0.2,
            "{name}: {within}"
        );
    }
    // It tells nothing of rho_s F.
    assert!(budget("rho_s F")[0] < 0.1 * budget("rho_s F")[1]);
    let runs = ["joint", "--repeats", &files[0], &files[1], &files[2]];
    let page = brdfit(&[&runs[..], &fixed].concat(), b"");
    let sentence = "which are the same in all runs, makes of each quantity: n = 1.48 +- 0.02.";
    assert!(page.output.contains(sentence), "{}{}", page.errors, page.output);
}

#[test]
fn a_run_that_stands_apart_is_named() {
    let folder = TempDir::new().unwrap();
    let mut files: Vec<String> = (0..6)
        .map(|k| write(&folder, &format!("run{k}.csv"), run(k, 0.1)))
        .collect();
    let mut odd = measurement("odd", &run(9, 0.1)).samples;
    odd.iter_mut().for_each(|sample| sample.brdf *= 1.3);
    files.push(write(&folder, "odd.csv", table(&odd)));
    let mut arguments = vec![
        "joint",
        "--repeats",
        "--terms",
        "diffuse,surface",
        "--fix",
        "n=1.5",
        "--scale-uncertainty",
        "2%",
    ];
    arguments.extend(files.iter().map(String::as_str));
    let ran = brdfit(&arguments, b"");
    assert_eq!(ran.code, 0, "{}", ran.errors);
    assert!(
        ran.output.contains("run 7 in rho_d") && ran.output.contains("Type B is the calibration, known to 2.0 %"),
        "{}",
        ran.output
    );
    assert!(
        ran.output
            .contains("Run 7 does not agree with the others within their own expanded errors in rho_d"),
        "{}",
        ran.output
    );
    // The page has the same sentences and numbers, and is the same each time.
    let page = |files: &[&str]| brdfit(&[files, &["--format", "html"]].concat(), b"").output;
    let html = page(&arguments);
    for part in [
        "Run 7 does not agree with the others",
        "run 7 in rho_d",
        "type A",
        "SHA-256",
        "brdfit joint --repeats",
    ] {
        assert!(html.contains(part), "{part}: {html}");
    }
    assert_eq!(html.matches("<tr>").count(), html.matches("</tr>").count());
    assert_eq!(page(&arguments), html);
    assert!(fail(&["joint", &files[0], &files[1], "--format", "html"]).contains("--repeats"));
    arguments.extend(["--format", "json"]);
    let found: Value = serde_json::from_str(&brdfit(&arguments, b"").output).unwrap();
    let rho_d = &found["quantities"][0];
    assert_eq!(rho_d["runs_that_disagree"], serde_json::json!([7]));
    let mean = rho_d["budget"]["mean"].as_f64().unwrap();
    assert!(html.contains(&format!("{mean:.4}")), "{mean}");
    assert_eq!(
        (rho_d["name"].as_str(), &rho_d["budget"]["run_apart"]),
        (Some("rho_d"), &7.into())
    );
    let number = |name: &str| rho_d["budget"][name].as_f64().unwrap();
    assert!((number("type_b") / number("mean") / 0.02 - 1.0).abs() < 1e-9);
    let [a, b] = [number("type_a"), number("type_b")];
    assert!(((a * a + b * b).sqrt() / number("combined") - 1.0).abs() < 1e-9);
    assert!((number("coverage_factor") * number("combined") / number("expanded") - 1.0).abs() < 1e-9);
    // A width takes nothing from the calibration.
    let width = found["quantities"]
        .as_array()
        .unwrap()
        .iter()
        .find(|one| one["name"] == "width")
        .unwrap();
    assert_eq!(
        (width["unit"].as_str(), width["budget"]["type_b"].as_f64()),
        (Some("deg"), Some(0.0))
    );
    // One run, copies of a run, a choice of models, and parameters to share make no repeats.
    assert!(fail(&["joint", "--repeats", &files[0]]).contains("two or more"));
    let copy = write(&folder, "copy.csv", std::fs::read(&files[0]).unwrap());
    assert!(fail(&["joint", "--repeats", &files[0], &files[1], &copy]).contains("run 3 has the same samples as run 1"));
    assert!(fail(&["joint", "--repeats", "--terms", "auto", &files[0], &files[1]]).contains("one model"));
    assert!(fail(&["joint", "--repeats", "--share", "m", &files[0], &files[1]]).contains("--share"));
}

/// Exact runs have no errors from within, and nothing is said to be beyond them.
#[test]
fn exact_runs_are_called_so() {
    let folder = TempDir::new().unwrap();
    let flat = |name: &str, value: f64| {
        let rows: String = (-60..=60).map(|theta_s| format!("30,{theta_s},{value}\n")).collect();
        write(&folder, name, format!("theta_i_deg,theta_s_deg,brdf_per_sr\n{rows}"))
    };
    let (a, b) = (flat("a.csv", 0.1), flat("b.csv", 0.11));
    let arguments = ["joint", "--repeats", "--terms", "diffuse", &a, &b];
    let page = brdfit(&arguments, b"").output;
    assert!(
        page.contains("The fits of runs 1 and 2 are exact") && !page.contains("inf"),
        "{page}"
    );
    assert!(!page.contains("differ by no more"), "{page}");
    let json = brdfit(&[&arguments[..], &["--format", "json"]].concat(), b"").output;
    let json: Value = serde_json::from_str(&json).unwrap();
    let budget = &json["quantities"][0]["budget"];
    assert_eq!((&budget["within"], &budget["by_chance"]), (&Value::Null, &Value::Null));
    assert!(budget["between"].is_f64());
}

#[test]
fn measured_runs_agree_within_the_budget() {
    let files = ["run1", "run2"].map(|run| shared(&format!("real/rt300s_aeroglaze_z307_{run}.csv")));
    if let Some(missing) = files.iter().find(|file| !file.exists()) {
        return left_out("two runs of one paint", missing);
    }
    let files = files.map(|file| file.to_str().unwrap().to_string());
    let ran = brdfit(&["joint", "--repeats", &files[0], &files[1], "--format", "json"], b"");
    assert_eq!(ran.code, 0, "{}", ran.errors);
    let found: Value = serde_json::from_str(&ran.output).unwrap();
    let mut budgets = 0;
    for quantity in found["quantities"].as_array().unwrap() {
        let budget = &quantity["budget"];
        if budget.is_null() {
            continue;
        }
        budgets += 1;
        for value in quantity["values"].as_array().unwrap() {
            let away = (value.as_f64().unwrap() - budget["mean"].as_f64().unwrap()).abs();
            assert!(away <= budget["expanded"].as_f64().unwrap(), "{quantity}");
        }
    }
    // A spread that is unlikely in one quantity is none of all of them together.
    let all = found["quantities"].as_array().unwrap();
    let at_70 = all.iter();
    let at_70 = at_70.filter(|one| one["name"] == "reflectance" && one["theta_i_deg"] == 70.0);
    for quantity in at_70.clone() {
        let by_chance = quantity["budget"]["by_chance"].as_f64().unwrap();
        assert!(by_chance < 0.05 && by_chance * all.len() as f64 > 0.05, "{by_chance}");
        assert_eq!(quantity["runs_that_disagree"], serde_json::json!([]));
    }
    assert_eq!(at_70.count(), 1);
    let text = brdfit(&["joint", "--repeats", &files[0], &files[1]], b"").output;
    let level = format!(
        "no more than their own errors (F test, 5 % for all {} quantities together)",
        all.len()
    );
    assert!(text.contains(&level) && text.contains("All runs agree"), "{text}");
    // rho_d is told by both, and differs.
    let rho_d = &found["quantities"][0];
    let (between, within) = (&rho_d["budget"]["between"], &rho_d["budget"]["within"]);
    println!("{budgets} budgets; rho_d differs by {between} between runs, of which each tells {within}");
    assert!(budgets > 5 && rho_d["name"] == "rho_d" && between.as_f64() > Some(1e-3));
}
