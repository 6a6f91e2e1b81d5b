//! `brdfit certify` and `--certify`, called in this process.

use brdfit_suite::program::{brdfit, fail, succeed, write};
use brdfit_suite::scan::data;
use serde_json::Value;

fn noisy(set: u32) -> String {
    data(&format!("testdata{set}_sym_seed1.csv")).display().to_string()
}

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&succeed(&[arguments, &["--format", "json"]].concat())).expect("JSON")
}

/// A search that misses on purpose.
const ONE_START: [&str; 4] = ["--method", "paper", "--starts", "1"];

#[test]
fn results_say_what_is_proved() {
    let scan = noisy(3);
    let certified = json(&["certify", &scan, "--within", "5%"]);
    assert_eq!(certified, json(&["fit", &scan, "--certify", "0.05"]));
    let certificate = &certified["certificate"];
    assert_eq!(certificate["eps"], 0.05);
    assert_eq!(certificate["complete"], true);
    assert_eq!(certificate["better"], false);
    assert!(certificate["boxes"].as_u64().unwrap() > 0);
    assert!(certificate.get("elapsed_s").is_none());
    let timed = json(&["certify", &scan, "--within", "5%", "--time"]);
    assert!(timed["certificate"]["elapsed_s"].as_f64().unwrap() > 0.0);
    // Without a proof, and where it comes to nothing, there is no certificate.
    assert_eq!(json(&["fit", &scan])["certificate"], Value::Null);
    let nothing = json(&["fit", &noisy(1), "--certify", "1%", "--proof-boxes", "1"]);
    assert_eq!(nothing["certificate"], Value::Null);
    let text = succeed(&["certify", &scan]);
    assert!(text.contains("  proved     within 5.0 %: no parameters"), "{text}");
    let csv = succeed(&["certify", &scan, "--format", "csv"]);
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let place = reader
        .headers()
        .unwrap()
        .iter()
        .position(|name| name == "certified_eps");
    assert_eq!(&reader.records().next().unwrap().unwrap()[place.unwrap()], "0.05");
}

#[test]
fn the_report_says_what_is_proved() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page.html").display().to_string();
    succeed(&["report", &noisy(3), "--certify", "5%", "-o", &page]);
    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.contains("Proved: within 5.0 %: no parameters"));
}

/// What ends a proof early says how far it came, and is the same in each run on any number of threads.
#[test]
fn a_limit_of_boxes_leaves_what_is_proved_so_far() {
    let scan = noisy(3);
    let limited = |more: &[&str]| json(&[&["certify", &scan, "--within", "1%", "--proof-boxes", "70"], more].concat());
    let one = limited(&["--threads", "1"]);
    let eps = one["certificate"]["eps"].as_f64().unwrap();
    assert_eq!(one["certificate"]["complete"], false);
    assert!(eps > 0.01 && eps < 0.5, "{eps}");
    assert_eq!(one, limited(&["--threads", "3"]));
    let text = succeed(&["certify", &scan, "--within", "1%", "--proof-boxes", "70"]);
    assert!(text.contains("% so far, of 1.0 % asked for"), "{text}");
}

#[test]
fn a_better_minimum_takes_the_place_of_the_fit() {
    let scan = noisy(3);
    let missed = json(&[&["fit", &scan][..], &ONE_START].concat());
    let found = json(&[&["certify", &scan][..], &ONE_START].concat());
    let best = json(&["fit", &scan]);
    let mse2 = |result: &Value| result["mse2"].as_f64().unwrap();
    assert!(mse2(&missed) > 1.01 * mse2(&best));
    assert!(mse2(&found) < 1.000_001 * mse2(&best));
    assert_eq!(found["certificate"]["better"], true);
    // The first of the minima is the fit.
    assert_eq!(found["minima"][0]["mse2"], found["mse2"]);
}

#[test]
fn single_precision_is_proved_of_what_it_reports() {
    let single = json(&["certify", &noisy(3), "--precision", "f32"]);
    let eps = single["certificate"]["eps"].as_f64().unwrap();
    assert!((0.05..0.0501).contains(&eps), "{eps}");
    assert_eq!(single["certificate"]["complete"], true);
}

/// The data lines of a table, each BRDF times a factor.
fn scaled(table: &str, factor: f64) -> String {
    let line = |line: &str| {
        let (angles, brdf) = line.rsplit_once(',').expect("columns");
        match brdf.parse::<f64>() {
            Ok(brdf) => format!("{angles},{}\n", brdf * factor),
            Err(_) => format!("{line}\n"),
        }
    };
    table.lines().map(line).collect()
}

#[test]
fn scans_in_any_unit_are_proved_as_in_steradians() {
    let folder = tempfile::tempdir().unwrap();
    let table = std::fs::read_to_string(noisy(2)).unwrap();
    for factor in [1e-200, 1e-12] {
        let scan = write(&folder, "scan.csv", scaled(&table, factor));
        let proved = json(&["certify", &scan, "--within", "50%"]);
        assert_eq!(proved["certificate"]["eps"], 0.5, "{factor}");
        assert_eq!(proved["certificate"]["complete"], true, "{factor}");
    }
}

/// Below the cost of an exact fit there is only rounding, of which no proof tells.
#[test]
fn nothing_is_proved_of_an_exact_fit() {
    let scan = data("testdata2_ideal.csv").display().to_string();
    assert_eq!(json(&["certify", &scan])["certificate"], Value::Null);
    let text = succeed(&["certify", &scan]);
    assert!(
        text.contains("  proved     nothing: the fit is exact, its MSE^2 is rounding"),
        "{text}"
    );
}

#[test]
fn results_are_proved_too() {
    let folder = tempfile::tempdir().unwrap();
    let scan = noisy(3);
    let result = |name: &str, form: &str, more: &[&str]| {
        let text = succeed(&[&["fit", &scan, "--format", form], more].concat());
        write(&folder, name, text)
    };
    let best = json(&["certify", &scan]);
    for (name, form) in [("best.json", "json"), ("best.csv", "csv")] {
        assert_eq!(json(&["certify", &result(name, form, &[])]), best);
    }
    // What the results know is not lost: the search here misses it.
    let known = result("known.json", "json", &[]);
    let kept = json(&[&["certify", &known][..], &ONE_START].concat());
    assert_eq!(kept["certificate"]["better"], false);
    assert!(kept["mse2"].as_f64().unwrap() < 1.000_001 * best["mse2"].as_f64().unwrap());
}

/// Results are of the file as it was: what took its place is neither proved nor reported in their name.
#[test]
fn another_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let copy = |set: u32| write(&folder, "scan.csv", std::fs::read(noisy(set)).unwrap());
    let scan = copy(3);
    let json = write(&folder, "fit.json", succeed(&["fit", &scan, "--format", "json"]));
    let table = succeed(&["fit", &scan, "--format", "csv"]);
    let csv = write(&folder, "fit.csv", table.clone());
    let minima = succeed(&["fit", &scan, "--format", "csv", "--minima"]);
    let minima = write(&folder, "minima.csv", minima);
    let report = |results: &str| brdfit(&["report", results, "-o", "-"], b"");
    assert_eq!(report(&csv).code, 0);
    copy(1);
    for result in [json, csv, minima] {
        for command in ["certify", "report"] {
            let message = fail(&[command, &result]);
            assert!(
                message.starts_with(&scan)
                    && message.contains("its SHA-256 is ")
                    && message.contains(&format!("; give {command} the files as they were")),
                "{message}"
            );
        }
    }
    // Tables of version 0.1 have no such column, and are read.
    let without = |line: &str| match line.rsplitn(3, ',').collect::<Vec<_>>()[..] {
        [time, _, before] => format!("{before},{time}\n"),
        _ => panic!("{line}"),
    };
    assert!(table.lines().next().unwrap().ends_with(",sha256,elapsed_s"));
    copy(3);
    let old = write(&folder, "old.csv", table.lines().map(without).collect::<String>());
    assert_eq!(report(&old).code, 0);
}

#[test]
fn what_has_no_proof_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let scan = noisy(3);
    for arguments in [
        &["certify", &scan, "--model", "ggx"][..],
        &["fit", &scan, "--model", "auto", "--certify", "5%"],
        &["report", &scan, "--model", "beckmann,ggx", "--certify", "5%"],
    ] {
        assert!(
            fail(arguments).contains("only --model beckmann has one"),
            "{arguments:?}"
        );
    }
    let results = |name: &str, more: &[&str]| {
        let text = succeed(&[&["fit", &scan, "--format", "json"], more].concat());
        write(&folder, name, text)
    };
    let other = results("model.json", &["--model", "ggx"]);
    assert!(fail(&["certify", &other]).contains("the results are of the model ggx"));
    let fewer = results("terms.json", &["--terms", "diffuse,surface"]);
    assert!(fail(&["certify", &fewer]).contains("give --terms diffuse,surface"));
    let wide = results("wide.json", &[]);
    assert!(fail(&["certify", &wide, "--fix", "n=1.5"]).contains("n is "));
    for (more, what) in [
        (&["--fix", "n=1.5"][..], "n was held between 1.5 and 1.5 in the results"),
        (&["--prior", "n=1.5+-0.1"], "instrument: "),
        (&["--fit-offset"], "instrument: "),
        (&["--robust"], "robust: true in the results, false here"),
        (&["--max-angle", "60", "--quiet"], "read options: "),
    ] {
        let message = fail(&["certify", &results("other.json", more)]);
        assert!(message.contains(what), "{message}");
    }
    // A table tells no options, but how many samples the fit had and what its parameters cost.
    let table = |more: &[&str]| {
        let text = succeed(&[&["fit", &scan, "--format", "csv"], more].concat());
        write(&folder, "other.csv", text)
    };
    let message = fail(&["certify", &table(&["--max-angle", "60", "--quiet"])]);
    assert!(message.contains(" samples in the results, 171 here"), "{message}");
    let message = fail(&["certify", &table(&["--fit-offset"])]);
    assert!(message.contains("the MSE^2 is "), "{message}");
    for part in ["0", "100%", "-1%", "nan", "five"] {
        let ran = brdfit(&["certify", &scan, &format!("--within={part}")], b"");
        assert!(
            ran.code == 2 && ran.errors.contains("between 0 and 100 %"),
            "{part}: {}",
            ran.errors
        );
    }
}

/// A batch proves what `fit --certify` does, with the same bytes on any number of threads.
#[test]
fn a_batch_is_proved_scan_by_scan() {
    let folder = tempfile::tempdir().unwrap();
    let scans = [1, 2].map(|seed| data(&format!("testdata3_sym_seed{seed}.csv")).display().to_string());
    let out = folder.path().join("results.json").display().to_string();
    let batch = |more: &[&str]| {
        succeed(&[&["batch", &scans[0], &scans[1], "--certify", "5%", "--out", &out], more].concat());
        std::fs::read_to_string(&out).unwrap()
    };
    let text = batch(&["--threads", "1"]);
    let results: Value = serde_json::from_str(&text).unwrap();
    for (result, scan) in results.as_array().unwrap().iter().zip(&scans) {
        assert_eq!(result["certificate"]["complete"], true);
        assert_eq!(*result, json(&["fit", scan, "--certify", "5%"]));
    }
    assert_eq!(text, batch(&["--threads", "3"]));
    let refused = fail(&["batch", &scans[0], "--certify", "5%", "--model", "ggx", "--out", &out]);
    assert!(refused.contains("only --model beckmann has one"), "{refused}");
}

/// Where the proof betters a fit whose terms the scan chose, the table of the choice is that of the new minimum.
#[test]
fn the_choice_of_terms_is_made_anew() {
    // The place of the chosen one, costs and BIC of all.
    let table = |result: &Value| -> (usize, Vec<(f64, f64)>) {
        let candidates = result["selection"]["candidates"].as_array().unwrap();
        let own = candidates.iter().position(|one| one["terms"] == result["terms"]);
        let number = |value: &Value| value.as_f64().unwrap();
        let numbers = candidates.iter().map(|one| (number(&one["cost"]), number(&one["bic"])));
        (own.unwrap(), numbers.collect())
    };
    let scan = noisy(2);
    for seed in ["1", "11"] {
        let auto = [&ONE_START[..], &["--terms", "auto", "--seed", seed]].concat();
        let missed = json(&[&["fit", &scan][..], &auto].concat());
        let found = json(&[&["certify", &scan][..], &auto].concat());
        assert_eq!(found["certificate"]["better"], true);
        assert_eq!(found["certificate"]["complete"], true);
        let ((before, old), (own, new)) = (table(&missed), table(&found));
        let (cost, bic) = new[own];
        assert!(cost < 0.99 * old[before].0 && bic < old[before].1, "{old:?} {new:?}");
        assert!(new.iter().all(|one| one.1 >= bic), "{new:?}");
        // The last has all terms, so it contains the new minimum.
        assert!(new.last().unwrap().0 <= cost * (1.0 + 1e-9), "{new:?}");
        let samples = found["samples"].as_f64().unwrap();
        let told = found["mse2"].as_f64().unwrap() * samples * samples;
        assert!((told / cost - 1.0).abs() < 1e-12, "{told} is not {cost}");
    }
}

/// The page of the guide shows what the program prints, but for the time.
#[test]
fn the_guide_shows_what_is_printed() {
    let guide = include_str!("../host/src/guide/certificates.md");
    let block = |fence: &str| {
        guide
            .split(fence)
            .nth(1)
            .and_then(|rest| rest.split("```").next())
            .unwrap()
            .trim_end()
    };
    let command: Vec<&str> = block("```sh\ncargo run --release -- ").split(' ').collect();
    let shown = block("```text\n").split(" boxes").next().unwrap();
    let printed = succeed(&command);
    assert!(printed.contains(&format!("{shown} boxes")), "{printed}");
}
