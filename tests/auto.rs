//! `--model auto` and lists of models: the model that made a scan is found again, every command tells what was compared, and those that take one model say so.

use std::fs;

use brdfit::engine::models::MODELS;
use brdfit::engine::{Material, Model};
use brdfit_suite::program::{self, fail, succeed, write};
use serde_json::Value;
use tempfile::TempDir;

/// What is within another model: each of the second becomes the first in some place of its bounds.
const WITHIN: [(&str, &[&str]); 8] = [
    ("beckmann", &["beckmann-own-slope", "beckmann-second"]),
    ("cook-torrance", &["beckmann", "beckmann-own-slope", "beckmann-second"]),
    ("walter", &["ggx-smith", "ggx-smith-second"]),
    ("ggx-smith", &["ggx-smith-second"]),
    (
        "ggx",
        &[
            "ggx-own-slope",
            "ggx-second",
            "ggx-mirrors",
            "hyper-cauchy",
            "hyper-cauchy-own-slope",
        ],
    ),
    ("ggx-own-slope", &["hyper-cauchy-own-slope"]),
    ("hyper-cauchy", &["hyper-cauchy-own-slope"]),
    ("k-correlation", &["k-correlation-2"]),
];

/// Parameters with which each part of a model is plain to see.
fn scene(model: &'static Model) -> Material {
    let second = model.place("rho_2").is_some();
    let value = |name: &str| match name {
        "rho_d" => 0.03,
        "rho_s" => 2.0,
        "rho_v" => 0.3,
        "m" if second => 0.1,
        "m" => 0.3,
        "n" => 2.0,
        "kappa" => 0.5,
        "m_v" => 1.0,
        "rho_2" => 3.0,
        "m_2" => 0.5,
        "q" => 1.3,
        "rho_m" => 0.2,
        "tau" => 0.3,
        "Omega" => 0.1,
        "A" => 0.02,
        "B" => 1e-3,
        "g" => 1.7,
        "b_0" => 30.0,
        "l" => 0.02,
        "s" => 1.7,
        "a" => 50.0,
        "b" => 60.0,
        "c" => 2.2,
        "a_2" => 1.0,
        "b_2" => 4.0,
        "c_2" => 3.0,
        other => panic!("no value for {other}"),
    };
    Material {
        model,
        values: model.parameters.iter().map(|parameter| value(parameter.name)).collect(),
    }
}

/// A scan of it with 1 % noise, as CSV.
fn scan(model: &'static Model) -> String {
    let material = scene(model);
    let parameters = model
        .named(&material.values)
        .map(|(name, value)| format!("{name}={value}"));
    let parameters = parameters.collect::<Vec<_>>().join(",");
    succeed(&[
        "simulate",
        "--model",
        model.name,
        "--params",
        &parameters,
        "--theta-i",
        "10,45,75",
        "--theta-s",
        "-84:84:3",
        "--noise",
        "0.01",
        "--seed",
        "5",
    ])
}

fn json(arguments: &[&str], input: &str) -> Value {
    let ran = program::brdfit(arguments, input.as_bytes());
    assert_eq!((ran.code, ran.errors.as_str()), (0, ""), "{arguments:?}");
    serde_json::from_str(&ran.output).expect("JSON")
}

/// A scan of ABg in a folder.
fn abg(name: &str) -> (TempDir, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = write(&folder, name, scan(Model::find("abg").expect("ABg")));
    (folder, file)
}

const LIST: &str = "beckmann,ggx,abg,harvey-shack";

#[test]
fn the_model_that_made_a_scan_is_found_again() {
    for model in &MODELS {
        let found = json(&["fit", "-", "--model", "auto", "--format", "json"], &scan(model));
        let name = found["model"].as_str().expect("a name");
        let around = WITHIN.iter().find(|(within, _)| *within == model.name);
        let contains = around.is_some_and(|(_, list)| list.contains(&name));
        assert!(
            name == model.name || contains,
            "{}: {:#}",
            model.name,
            found["selection"]
        );
        let candidates = found["selection"]["candidates"].as_array().expect("a list");
        assert_eq!(candidates.len(), MODELS.len());
        let rms = found["rms_ln"].as_f64().expect("a number");
        // Uniform noise of 1 % has a standard deviation of 0.58 %.
        assert!((0.005..0.0065).contains(&rms), "{}: {rms}", model.name);
    }
}

#[test]
fn the_choice_is_the_fit_of_that_model_alone() {
    let scan = scan(Model::find("abg").expect("ABg"));
    let found = json(&["fit", "-", "--model", LIST, "--format", "json"], &scan);
    let alone = json(&["fit", "-", "--model", "abg", "--format", "json"], &scan);
    assert_eq!(found["model"], "abg");
    for member in ["parameters", "uncertainty", "minima", "mse2"] {
        assert_eq!(found[member], alone[member], "{member}");
    }
    assert!(alone["selection"].is_null());
    let selection = &found["selection"];
    assert_eq!(selection["criterion"], "bic");
    let candidates = selection["candidates"].as_array().expect("a list");
    let names: Vec<&str> = candidates.iter().filter_map(|one| one["model"].as_str()).collect();
    assert_eq!(names.join(","), LIST);
    assert_eq!(candidates[2]["values"], alone["parameters"]);
    assert_eq!(
        (&candidates[2]["parameters"], &candidates[0]["parameters"]),
        (&4.into(), &6.into())
    );
    // compare is the table of the same choice.
    let compared = json(&["compare", "-", "--models", LIST, "--format", "json"], &scan);
    assert_eq!(compared["model"], "abg");
    for (one, other) in candidates.iter().zip(compared["models"].as_array().expect("a list")) {
        for (member, same) in [("bic", "bic"), ("aicc", "aicc"), ("values", "parameters")] {
            assert_eq!(one[member], other[same], "{member}");
        }
    }
}

#[test]
fn pages_and_tables_tell_what_was_compared() {
    let (folder, file) = abg("abg.csv");
    let text = succeed(&["fit", &file, "--model", LIST]);
    assert!(text.contains("of 4 models abg has the least BIC; that of "), "{text}");
    assert!(text.contains("  * abg ") && text.contains("    ggx "), "{text}");
    let table = succeed(&["fit", &file, "--model", LIST, "--format", "csv"]);
    let head: Vec<&str> = table.lines().next().expect("a head").split(',').collect();
    let place = |name: &str| head.iter().position(|column| *column == name).expect("a column");
    let row: Vec<&str> = table.lines().nth(1).expect("a row").split(',').collect();
    assert_eq!(row[place("model")], "abg");
    assert!(!row[place("A")].is_empty() && !head.contains(&"rho_s"), "{table}");

    let out = folder.path().join("results.csv");
    let out = out.to_str().expect("a path in UTF-8");
    let other = write(&folder, "ggx.csv", scan(Model::find("ggx").expect("GGX")));
    let summary = succeed(&["batch", &file, &other, "--model", LIST, "--out", out]);
    assert!(
        summary.contains("model") && summary.contains("  abg ") && summary.contains("  ggx "),
        "{summary}"
    );
    let mut rows = csv::Reader::from_path(out).expect("a table");
    let head = rows.headers().expect("a head").clone();
    let place = |name: &str| head.iter().position(|column| column == name).expect("a column");
    let (model, a, rho_s) = (place("model"), place("A"), place("rho_s"));
    let rows: Vec<csv::StringRecord> = rows.records().collect::<Result<_, _>>().expect("rows");
    assert_eq!([&rows[0][model], &rows[1][model]], ["abg", "ggx"]);
    assert!(!rows[0][a].is_empty() && rows[0][rho_s].is_empty());
    assert!(rows[1][a].is_empty() && !rows[1][rho_s].is_empty());

    // The results of a choice are reported again to the same bits.
    let page = folder.path().join("page.html");
    succeed(&[
        "report",
        out,
        "--model",
        LIST,
        "-o",
        page.to_str().expect("a path in UTF-8"),
    ]);
    let page = fs::read_to_string(page).expect("a page");
    assert_eq!(page.matches("What was compared").count(), 2);
    assert!(page.contains("<b>abg</b>") && page.contains("of 4 models ggx has the least BIC"));
}

#[test]
fn profiles_and_joint_fits_choose_too() {
    let (_folder, file) = abg("abg.csv");
    let profile = ["profile", &file, "--model", LIST, "--parameter", "g"];
    assert!(succeed(&profile).contains("of 4 models abg has the least BIC"));
    let found = json(&[&profile[..], &["--format", "json"]].concat(), "");
    assert_eq!(
        (&found["model"], &found["selection"]["criterion"]),
        (&"abg".into(), &"bic".into())
    );

    let joint = ["joint", &file, &file, "--model", LIST, "--share", "rho_d"];
    let text = succeed(&joint);
    assert!(text.contains("* abg ") && text.contains("  ggx "), "{text}");
    let found = json(&[&joint[..], &["--format", "json"]].concat(), "");
    assert_eq!(found["model"], "abg");
    let candidates = found["selection"]["candidates"].as_array().expect("a list");
    assert_eq!(candidates.len(), 4);
    assert_eq!(candidates[2]["parameters"], 7);
    // Models without the shared parameter are no candidates.
    let found = json(
        &[
            "joint", &file, &file, "--model", LIST, "--share", "m", "--format", "json",
        ],
        "",
    );
    assert_eq!(found["selection"]["candidates"].as_array().expect("a list").len(), 2);
    assert_eq!(found["not_compared"], serde_json::json!(["abg", "harvey-shack"]));
    let message = fail(&["joint", &file, &file, "--model", LIST, "--share", "m,g"]);
    assert!(
        message.contains("no model of the list has all parameters of --share m,g"),
        "{message}"
    );
}

/// Outliers, bounds and terms hold for every candidate.
#[test]
fn options_hold_for_every_candidate() {
    let clean = scan(Model::find("abg").expect("ABg"));
    let mut rows: Vec<String> = clean.lines().map(String::from).collect();
    for place in [20, 60, 100] {
        rows[place] += "e1";
    }
    let spoiled = rows.join("\n") + "\n";
    let arguments = ["fit", "-", "--model", LIST, "--robust", "--format", "json"];
    let ran = program::brdfit(&arguments, spoiled.as_bytes());
    let found: Value = serde_json::from_str(&ran.output).expect("JSON");
    assert_eq!(
        (&found["model"], &found["samples"]),
        (&"abg".into(), &(rows.len() - 4).into())
    );

    let fixed = ["fit", "-", "--model", LIST, "--fix", "n=1.5", "--format", "json"];
    let found = json(&fixed, &clean);
    let counts = found["selection"]["candidates"].as_array().expect("a list");
    let counts: Vec<u64> = counts.iter().filter_map(|one| one["parameters"].as_u64()).collect();
    assert_eq!(counts, [5, 5, 4, 4]);

    let found = json(
        &["fit", "-", "--model", "ggx,abg", "--terms", "auto", "--format", "json"],
        &scan(Model::find("ggx").expect("GGX")),
    );
    let candidates = found["selection"]["candidates"].as_array().expect("a list");
    assert_eq!((&found["model"], candidates.len()), (&"ggx".into(), 6));
    assert!(candidates[1]["f_test_p"].is_number() && candidates[5]["f_test_p"].is_null());
}

#[test]
fn what_makes_no_sense_is_refused_in_one_line() {
    let (_folder, file) = abg("abg.csv");
    for (arguments, what) in [
        (
            &["fit", &file, "--model", "abg,abg"][..],
            "the model abg is given twice",
        ),
        (&["fit", &file, "--model", "auto,abg"], "auto is all models"),
        (&["fit", &file, "--model", "abg,phong"], "there is no model 'phong'"),
        (
            &["fit", &file, "--model", LIST, "--fix", "x=1"],
            "no model of the list has a parameter 'x'",
        ),
        (&["fit", &file, "--model", LIST, "--bounds", "g=1"], "gives no bounds"),
        (&["converge", &file, "--model", "auto"], "takes one model"),
        (&["stability", &file, "--model", "ggx,abg"], "takes one model"),
        (
            &["simulate", "--theta-i", "1", "--theta-s", "1", "--model", "auto"],
            "takes one model",
        ),
        (
            &["export", "--model", "auto", "--params", "g=1", "--to", "zemax"],
            "takes one model",
        ),
    ] {
        let message = fail(arguments);
        assert!(message.contains(what), "{arguments:?}: {message}");
    }
}
