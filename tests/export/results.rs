//! Results as the source of what is exported.

use std::fs;

use super::{NAMES, brdfit};
use brdfit_suite::program;
use brdfit_suite::scan::data;
use serde_json::Value;

#[test]
fn a_result_brings_its_uncertainty_and_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let result = folder.path().join("results.json");
    let scans = ["testdata1_sym_seed1.csv", "testdata2_sym_seed1.csv"].map(data);
    let [first, second] = scans.each_ref().map(|path| path.to_str().unwrap());
    let result = result.to_str().unwrap();
    assert_eq!(
        brdfit(&["fit", first, second, "--format", "json", "-o", result]).code,
        0
    );
    let fitted: Value = serde_json::from_str(&fs::read_to_string(result).unwrap()).unwrap();
    let ran = brdfit(&["export", result, "--to", "bird", "--index", "2"]);
    assert_eq!((ran.code, ran.errors.as_str()), (0, ""));
    let file: Value = serde_json::from_str(&ran.output).unwrap();
    assert_eq!(file["metadata"]["sample"]["name"], second);
    let parameters = &file["metadata"]["software"]["simulation_model"]["parameters"];
    let mut known = 0;
    for (place, name) in NAMES.into_iter().enumerate() {
        assert_eq!(parameters[place]["value"], fitted[1]["parameters"][name]);
        let stderr = &fitted[1]["uncertainty"]["stderr"][name];
        assert_eq!(&parameters[place]["uncertainty"], stderr, "{name}");
        known += usize::from(stderr.is_f64());
    }
    assert!(known >= 2);
    for (index, what) in [
        (&[] as &[&str], "choose one with --index"),
        (&["--index", "3"], "none is number 3"),
        (&["--index", "0"], "none is number 0"),
    ] {
        let ran = brdfit(&[&["export", result, "--to", "c"], index].concat());
        assert!(ran.code == 2 && ran.errors.contains(what), "{}", ran.errors);
    }
}

#[test]
fn what_is_no_result_is_refused() {
    for (text, what) in [
        ("{", "no JSON"),
        ("{}", "no parameters.rho_d"),
        ("[]", "0 results"),
        ("7", "no parameters.rho_d"),
    ] {
        let ran = program::brdfit(&["export", "-", "--to", "c"], text.as_bytes());
        assert!(ran.code == 2 && ran.errors.contains(what), "{text}: {}", ran.errors);
    }
    let bad = r#"{"parameters": {"rho_d": 0.1, "rho_s": 1, "rho_v": 0, "m": 0, "n": 1.5, "kappa": 0}}"#;
    assert!(
        program::brdfit(&["export", "-", "--to", "c"], bad.as_bytes())
            .errors
            .contains("m cannot be 0")
    );
    for (list, what) in [
        ("rho_d=1", "--params lacks rho_s, rho_v"),
        ("n=0.5", "n cannot be 0.5"),
        ("n=2,n=3", "gives n twice"),
    ] {
        let ran = brdfit(&["export", "--params", list, "--to", "c"]);
        assert!(ran.code == 2 && ran.errors.contains(what), "{list}: {}", ran.errors);
    }
}
