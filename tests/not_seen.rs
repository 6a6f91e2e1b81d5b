//! What a scan cannot see: lobes between its samples, exact fits, and terms without evidence.

use brdfit_suite::program;
use brdfit_suite::scan::data;
use serde_json::Value;

fn fitted(file: &str, more: &[&str]) -> Value {
    let path = data(file);
    let arguments = [&["fit", path.to_str().unwrap(), "--format", "json"], more].concat();
    let ran = program::brdfit(&arguments, b"");
    serde_json::from_str(&ran.output).unwrap()
}

/// Made with rho_v = 0, and without samples around retro: a narrow lobe there costs nothing, whatever its weight.
#[test]
fn a_lobe_between_the_samples_is_left_out() {
    let fit = fitted("fit/f01_phantom_retro.csv", &[]);
    assert_eq!(fit["parameters"]["rho_v"], 0.0);
    assert_eq!(fit["uncertainty"]["not_seen"], serde_json::json!(["rho_v"]));
    assert_eq!(fit["uncertainty"]["stderr"]["rho_v"], Value::Null);
    for at in fit["derived"].as_array().unwrap() {
        assert_eq!(at["rho_v_f"], Value::Null);
        let reflectance = at["reflectance"]["value"].as_f64().unwrap();
        assert!((reflectance - 0.84).abs() < 0.015 && at["reflectance"]["stderr"].as_f64().unwrap() < 0.01);
    }
    let path = data("fit/f01_phantom_retro.csv");
    let page = program::brdfit(&["fit", path.to_str().unwrap()], b"");
    let page = page.output;
    assert!(page.contains("rho_v is not seen by this scan"), "{page}");
    assert!(page.contains("--terms auto leaves"), "{page}");
}

/// A grey surface without noise: nothing tells of errors.
#[test]
fn an_exact_fit_has_no_errors() {
    let rows: String = (-85..=85).map(|theta_s| format!("45,{theta_s},0.1\n")).collect();
    let scan = format!("theta_i_deg,theta_s_deg,brdf_per_sr\n{rows}");
    let ran = program::brdfit(&["fit", "-", "--format", "json"], scan.as_bytes());
    let fit: Value = serde_json::from_str(&ran.output).unwrap();
    assert_eq!(fit["uncertainty"]["exact"], true);
    assert_eq!(fit["uncertainty"]["stderr"]["rho_d"], Value::Null);
    let reflectance = &fit["derived"][0]["reflectance"];
    assert!((reflectance["value"].as_f64().unwrap() - 0.1 * std::f64::consts::PI).abs() < 1e-12);
    assert_eq!(reflectance["stderr"], Value::Null);
    let page = program::brdfit(&["fit", "-"], scan.as_bytes());
    let page = page.output;
    assert!(page.contains("the fit is exact") && !page.contains("+- 0\n"), "{page}");
}

/// A model that makes energy is exported with a word.
#[test]
fn a_total_above_one_is_said() {
    let export = |rho_s: &str| {
        let params = format!("rho_d=0.1,rho_s={rho_s},rho_v=0,m=0.1,n=3,kappa=1");
        program::brdfit(&["export", "--params", &params, "--to", "zemax"], b"").errors
    };
    let said = export("10");
    assert!(
        said.contains("TIS is written as 1 at 18 of 18 angles of incidence"),
        "{said}"
    );
    assert_eq!(export("0.5"), "");
}
