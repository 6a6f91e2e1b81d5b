//! `brdfit stability`: its JSON contract, that all its numbers are numbers, and that every fit converged.

use brdfit_suite::program;
use brdfit_suite::scan::data;
use brdfit_suite::tolerance::{self, check};
use serde_json::Value;

fn brdfit(arguments: &[&str], input: &[u8]) -> (u8, String, String) {
    let all: Vec<&str> = ["stability"].iter().chain(arguments).copied().collect();
    let ran = program::brdfit(&all, input);
    (ran.code, ran.output, ran.errors)
}

fn succeed(arguments: &[&str]) -> String {
    let (code, output, errors) = brdfit(arguments, b"");
    assert_eq!((code, errors.as_str()), (0, ""), "{arguments:?}");
    output
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

fn keys(value: &Value) -> Vec<&str> {
    value
        .as_object()
        .expect("an object")
        .keys()
        .map(String::as_str)
        .collect()
}

/// A number that is not finite would be null.
fn all_finite(value: &Value) -> bool {
    match value {
        Value::Null => false,
        Value::Array(values) => values.iter().all(all_finite),
        Value::Object(map) => map.values().all(all_finite),
        _ => true,
    }
}

fn keeps_the_contract(case: &Value) {
    let contract = [
        "condition",
        "error_ulp",
        "f32_is_good_enough",
        "fit",
        "free",
        "loss",
        "name",
        "samples",
        "terms",
    ];
    // Only a scan has an origin.
    let members: Vec<_> = keys(case).into_iter().filter(|key| *key != "provenance").collect();
    assert_eq!(members, contract);
    assert!(all_finite(case), "{case}");
    assert!(case["condition"].as_f64() >= Some(1.0) && case["f32_is_good_enough"].is_boolean());
    for precision in ["f64", "f32"] {
        assert_eq!(keys(&case["error_ulp"][precision]), ["gradient", "ln_f"]);
        assert_eq!(keys(&case["fit"][precision]), ["mse2", "passes", "rms_ln", "stop"]);
    }
    assert_eq!(keys(&case["loss"]), ["curve_rms_ln", "excess_mse2", "parameters"]);
    for parameter in case["loss"]["parameters"].as_array().expect("six parameters") {
        assert_eq!(keys(parameter), ["change", "f32", "f64", "name"]);
    }
}

#[test]
fn built_in_cases() {
    let cases = json(&succeed(&["--format", "json"]));
    let cases = cases.as_array().expect("an array");
    assert_eq!(cases.len(), 15);
    let mut worst = [0.0f64; 2];
    for case in cases {
        keeps_the_contract(case);
        for precision in ["f64", "f32"] {
            let stop = &case["fit"][precision]["stop"];
            assert!(stop == "cost" || stop == "step", "{}: {stop}", case["name"]);
        }
        let error = &case["error_ulp"]["f64"];
        for (worst, of) in worst.iter_mut().zip(["ln_f", "gradient"]) {
            *worst = worst.max(error[of].as_f64().expect("a number"));
        }
    }
    println!("f64: ln f {:.2}, gradient {:.2} ulp", worst[0], worst[1]);
    check(worst[0], tolerance::STABLE_LN_F);
    check(worst[1], tolerance::STABLE_GRADIENT);
    // What is called stiff is seen to be.
    let stiff = cases.iter().filter(|case| case["condition"].as_f64() >= Some(1e4));
    assert!(stiff.count() >= 14);
}

#[test]
fn a_scan_gets_a_verdict() {
    let file = data("testdata2_sym_seed2.csv");
    let file = file.to_str().expect("UTF-8");
    let case = json(&succeed(&[file, "--format", "json"]));
    keeps_the_contract(&case);
    assert_eq!((&case["name"], &case["samples"]), (&file.into(), &171.into()));
    assert_eq!(case["f32_is_good_enough"], true);
    let text = succeed(&[file]);
    for word in [
        "Verdict: f32 firmware is good enough",
        "rms in ln f",
        "condition",
        "kappa",
        "ulp",
    ] {
        assert!(text.contains(word), "{word} is not in:\n{text}");
    }
    assert!(!text.contains("NaN") && !text.contains("inf "));
}

/// Without a volume lobe and absorption the data still tell four parameters, well.
#[test]
fn fewer_terms_are_judged_alone() {
    let file = data("testdata2_sym_seed2.csv");
    let arguments = [
        file.to_str().expect("UTF-8"),
        "--format",
        "json",
        "--terms",
        "diffuse,surface",
    ];
    let case = json(&succeed(&arguments));
    keeps_the_contract(&case);
    assert_eq!(case["terms"], serde_json::json!(["diffuse", "surface"]));
    assert!(case["free"].as_u64() <= Some(4));
    assert!(case["loss"]["parameters"][2]["f64"] == 0.0 && case["loss"]["parameters"][5]["f64"] == 0.0);
}

#[test]
fn what_has_no_answer_is_an_error_in_one_line() {
    let scan = b"theta_i_deg,theta_s_deg,brdf_per_sr\n45,10,0.1\n";
    let (code, output, errors) = brdfit(&["-"], scan);
    assert_eq!((code, output.as_str(), errors.lines().count()), (2, "", 1));
    assert!(errors.contains("1 samples cannot determine 6 parameters"), "{errors}");
    // A BRDF that f32 does not hold.
    let mut scan = String::from("theta_i_deg,theta_s_deg,brdf_per_sr\n");
    (0..20).for_each(|k| scan += &format!("45,{k},{}\n", if k == 7 { 1e-300 } else { 0.1 }));
    let (code, _, errors) = brdfit(&["-"], scan.as_bytes());
    assert_eq!(code, 2);
    assert!(errors.starts_with("-:9: ") && errors.lines().count() == 1, "{errors}");
}
