//! `brdfit compare` and `brdfit joint`, called in this process.

use std::fmt::Write;

use brdfit::engine::Model;
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use brdfit_suite::program::brdfit;
use serde_json::Value;

/// A scan as CSV of the model of that name, which has these parameters; times 1 +- `noise` alternately.
fn scan(model: &str, parameters: &[f64], noise: f64) -> String {
    let model = Model::find(model).expect("a known model");
    let mut csv = String::from("theta_i,theta_s,brdf\n");
    for theta_i in [20.0f64, 60.0] {
        for theta_s in (-80..=80).step_by(2) {
            let sample = Sample::in_plane(theta_i.to_radians(), f64::from(theta_s).to_radians(), 1.0);
            let f = Real::portable_exp(model.ln_f(parameters, &sample).expect("valid directions"));
            let sign = if theta_s % 4 == 0 { 1.0 } else { -1.0 };
            let _ = writeln!(csv, "{theta_i},{theta_s},{:e}", f * (1.0 + sign * noise));
        }
    }
    csv
}

fn json(arguments: &[&str], input: &str) -> Value {
    let ran = brdfit(arguments, input.as_bytes());
    assert_eq!((ran.code, ran.errors.as_str()), (0, ""), "{arguments:?}");
    serde_json::from_str(&ran.output).expect("JSON")
}

#[test]
fn the_model_that_made_the_scan_is_preferred() {
    let cases: [(&str, &[f64]); 4] = [
        ("beckmann", &[0.05, 2.0, 0.3, 0.3, 2.0, 0.5]),
        ("ggx", &[0.05, 2.0, 0.3, 0.3, 2.0, 0.5]),
        ("beckmann-own-slope", &[0.05, 2.0, 0.3, 0.2, 2.0, 0.5, 0.6]),
        ("ggx-second", &[0.05, 2.0, 0.3, 0.1, 2.0, 0.5, 3.0, 0.5]),
    ];
    for (name, parameters) in cases {
        let scan = scan(name, parameters, 0.02);
        let models = "beckmann,ggx,beckmann-own-slope,ggx-second";
        let result = json(&["compare", "-", "--models", models, "--format", "json"], &scan);
        let models = result["models"].as_array().expect("a list");
        let least = models
            .iter()
            .min_by(|a, b| a["aicc"].as_f64().unwrap().total_cmp(&b["aicc"].as_f64().unwrap()));
        assert_eq!(least.unwrap()["model"], name, "{result:#}");
    }
}

#[test]
fn compare_draws_every_model_and_refuses_unknown_ones() {
    let folder = tempfile::tempdir().unwrap();
    let plot = folder.path().join("models.svg");
    let scan = scan("beckmann", &[0.05, 2.0, 0.3, 0.3, 2.0, 0.5], 0.0);
    let arguments = [
        "compare",
        "-",
        "--models",
        "beckmann,ggx",
        "--plot",
        plot.to_str().unwrap(),
    ];
    let ran = brdfit(&arguments, scan.as_bytes());
    assert_eq!((ran.code, ran.errors.as_str()), (0, ""));
    assert!(ran.output.contains("* beckmann "), "{}", ran.output);
    let svg = std::fs::read_to_string(&plot).unwrap();
    assert!(
        svg.contains(">beckmann, rms 0.000<") && svg.contains(">ggx, rms 0."),
        "{svg}"
    );
    let ran = brdfit(&["compare", "-", "--models", "phong"], scan.as_bytes());
    assert_eq!((ran.code, ran.output.as_str()), (2, ""));
    assert!(
        ran.errors.contains("there is no model 'phong'") && ran.errors.contains("ggx-smith"),
        "{}",
        ran.errors
    );
}

#[test]
fn joint_fits_share_what_they_are_told_to() {
    let folder = tempfile::tempdir().unwrap();
    let files = [[0.05, 2.0], [0.1, 4.0], [0.2, 8.0]].map(|[rho_d, rho_s]| {
        let path = folder.path().join(format!("{rho_d}.csv"));
        std::fs::write(&path, scan("beckmann", &[rho_d, rho_s, 0.3, 0.2, 2.0, 0.5], 0.02)).unwrap();
        path.to_str().unwrap().to_string()
    });
    let [a, b, c] = files.each_ref().map(String::as_str);
    let result = json(&["joint", a, b, c, "--share", "m,n,kappa", "--format", "json"], "");
    let scans = result["scans"].as_array().expect("a list");
    for scan in scans {
        for name in ["m", "n", "kappa"] {
            assert_eq!(scan["parameters"][name], scans[0]["parameters"][name]);
        }
    }
    assert_ne!(scans[1]["parameters"]["rho_d"], scans[0]["parameters"]["rho_d"]);
    let together = result["cost"].as_f64().unwrap();
    assert!(together >= result["cost_separate"].as_f64().unwrap());
    let ran = brdfit(&["joint", a, b, "--share", "slope"], b"");
    assert_eq!((ran.code, ran.output.as_str()), (2, ""));
    let ran = brdfit(&["joint", a], b"");
    assert!(
        ran.code == 2 && ran.errors.contains("give 2 to 8 scans"),
        "{}",
        ran.errors
    );
    let ran = brdfit(&["joint", a, b, c], b"");
    assert!(ran.code == 0 && ran.output.contains("shared: m\n"), "{}", ran.output);
}
