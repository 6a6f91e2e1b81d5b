//! Files as instruments write them: the same scan in every format gives the same fit, errors name their place, and genuine files are read.

use std::fs;

use brdfit::input::{self, ReadOptions};
use brdfit_core::brdf::{ALL, Brdf, Params};
use brdfit_core::geometry::{Geometry, Sample};
use brdfit_core::real::Real;
use brdfit_suite::program::{self, write};
use brdfit_suite::scan::data;
use brdfit_suite::tolerance::{self, check};
use brdfit_suite::written::{INCIDENT, TRUTH, brdf, scattered, texts};
use serde_json::Value;

fn fit(arguments: &[&str]) -> Value {
    let ran = program::brdfit(&[&["fit", "--format", "json"], arguments].concat(), b"");
    assert_eq!(ran.code, 0, "{}", ran.errors);
    serde_json::from_str(&ran.output).expect("JSON")
}

fn fail(arguments: &[&str]) -> String {
    let ran = program::brdfit(&[&["fit"], arguments].concat(), b"");
    assert_eq!(
        (ran.code, ran.output.as_str(), ran.errors.matches('\n').count()),
        (2, "", 1),
        "{}",
        ran.errors
    );
    ran.errors
}

/// The largest relative error of the parameters of one result.
fn error(found: &Value) -> f64 {
    let names = ["rho_d", "rho_s", "rho_v", "m", "n", "kappa"].into_iter().zip(TRUTH);
    let errors = names.map(|(name, truth)| (found["parameters"][name].as_f64().expect("a number") / truth - 1.0).abs());
    errors.fold(0.0, f64::max)
}

#[test]
fn the_same_scan_in_every_format_gives_the_same_fit() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut worst = 0.0f64;
    for (format, text) in texts() {
        // The name says nothing.
        let file = write(&folder, "scan.dat", &text);
        let found = fit(&[&file]);
        assert_eq!(found["input"]["format"], format);
        let error = error(&found);
        println!("{format}: {} samples, parameters to {error:.1e}", found["samples"]);
        worst = worst.max(error);
        assert_eq!(
            fit(&[&file, "--input-format", format])["parameters"],
            found["parameters"]
        );
    }
    check(worst, tolerance::FORMATS);
}

#[test]
fn quantities_units_and_signs_are_what_the_options_say() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut text = String::from("theta_i,theta_s,brdf\n");
    for theta_i in INCIDENT {
        for theta_s in scattered() {
            let (i, s) = (theta_i.to_radians(), theta_s.to_radians());
            let value = f64::PI * brdf(theta_i, theta_s, 180.0) * Real::portable_sin_cos(s).1;
            text += &format!("{i},{},{value}\n", -s);
        }
    }
    let file = write(&folder, "scan.csv", text);
    let found = fit(&[
        &file,
        "--quantity",
        "brf-cos",
        "--angles",
        "rad",
        "--forward",
        "negative",
    ]);
    assert!(tolerance::FORMATS.admits(error(&found)), "{found}");
    let input = serde_json::json!({
        "format": "table", "angles": "rad", "quantity": "brf-cos", "forward": "negative", "weighted": false
    });
    assert_eq!(found["input"], input);
    let page = program::brdfit(
        &[
            "fit",
            &file,
            "--quantity",
            "ccbrdf",
            "--angles",
            "rad",
            "--forward",
            "negative",
        ],
        b"",
    );
    let said =
        "read as    table with named columns: BRDF cos(theta_s) over radians, specular peak at theta_s = -theta_i\n";
    assert!(page.output.contains(said), "{}", page.output);
}

#[test]
fn columns_are_fitted_as_scans_of_their_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut text = String::from("theta_i,theta_s,R,550 nm\n");
    for theta_i in INCIDENT {
        for theta_s in scattered() {
            let f = brdf(theta_i, theta_s, 180.0);
            text += &format!("{theta_i},{theta_s},{f},{}\n", 0.5 * f);
        }
    }
    let file = write(&folder, "scan.csv", text);
    let found = fit(&[&file]);
    let [red, green] = found.as_array().expect("a list").as_slice() else {
        panic!("two results")
    };
    assert_eq!((&red["scan"], &green["scan"]), (&"R".into(), &"550 nm".into()));
    let half = green["parameters"]["rho_d"].as_f64().expect("a number") / TRUTH[0];
    assert!(tolerance::FORMATS.admits((half / 0.5 - 1.0).abs()) && tolerance::FORMATS.admits(error(red)));
    assert_eq!(fit(&[&file, "--column", "550nm"])["parameters"], green["parameters"]);
    let table = program::brdfit(&["fit", &file, "--format", "csv"], b"").output;
    assert!(table.starts_with("file,scan,samples,") && table.contains(",R,82,") && table.contains(",550 nm,82,"));
    assert!(fail(&[&file, "--column", "G"]).contains("there is no scan 'G'"));
    assert!(fail(&[&file, "--plot", "x.svg"]).contains("--plot draws one scan"));
    let one = program::brdfit(&["stability", &file], b"");
    assert!(
        one.code == 2
            && one
                .errors
                .contains("there are 2 scans: R, 550 nm; choose one with --column")
    );
}

#[test]
fn standard_deviations_are_weights() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut text = String::from("theta_i,theta_s,brdf,sigma\n");
    for theta_i in INCIDENT {
        for theta_s in scattered() {
            let f = brdf(theta_i, theta_s, 180.0);
            // One in four is ten times too bright, and known to be.
            let (f, sigma) = if theta_s % 16.0 == 0.0 {
                (10.0 * f, 1e6 * f)
            } else {
                // So small that it takes nothing from ln f on average.
                (f, 1e-6 * f)
            };
            text += &format!("{theta_i},{theta_s},{f},{sigma}\n");
        }
    }
    let file = write(&folder, "scan.csv", text);
    let (weighted, equal) = (fit(&[&file]), fit(&[&file, "--weights", "equal"]));
    println!(
        "weighted: parameters to {:.1e}, equal: {:.1e}",
        error(&weighted),
        error(&equal)
    );
    check(error(&weighted), tolerance::WEIGHTED);
    assert!(weighted["input"]["weighted"] == true && error(&equal) > 0.1);
    let left_out = fit(&[&file, "--weights", "equal", "--weight-angle", "60=0"]);
    let counts = serde_json::json!([{"reason": "no_weight", "theta_i_deg": 60.0, "samples": 41}]);
    assert_eq!((&left_out["samples"], &left_out["left_out"]), (&41.into(), &counts));
    for option in [
        ["--weight-angle", "60"],
        ["--sigma-floor", "-1"],
        ["--mask-retro", "x"],
        ["--thin", "0"],
    ] {
        assert_eq!(program::brdfit(&[&["fit", &file], &option[..]].concat(), b"").code, 2);
    }
}

#[test]
fn chi_squared_is_of_the_standard_deviations() {
    let folder = tempfile::tempdir().expect("a folder");
    let plain = fs::read_to_string(data("testdata1_sym_seed1.csv")).expect("the set is there");
    let mut text = String::from("theta_i_deg,theta_s_deg,brdf_per_sr,rel_sigma\n");
    for row in plain.lines().skip(1) {
        text += &format!("{row},0.05\n");
    }
    let file = write(&folder, "scan.csv", text);
    let fit = fit(&[&file]);
    let number = |name: &str| fit[name].as_f64().expect("a number");
    // To second order the logarithm of a value with normal noise sigma spreads by sigma sqrt(1 + 2.5 sigma^2).
    let scales = number("rms_ln") / (0.05 * (1.0f64 + 2.5 * 0.05 * 0.05).sqrt());
    let expected = number("samples") * scales * scales;
    check((number("chi2") / expected - 1.0).abs(), tolerance::CHI2);
    let page = program::brdfit(&["fit", &file], b"").output;
    assert!(page.contains(&format!("  chi^2      {:.2} ", number("chi2"))), "{page}");
    let equal = program::brdfit(&["fit", &file, "--weights", "equal"], b"").output;
    assert!(!equal.contains("chi^2"), "{equal}");
}

#[test]
fn errors_name_file_line_and_column() {
    let folder = tempfile::tempdir().expect("a folder");
    let breaks = [
        (
            "table",
            "brdf\n30;-80;",
            "brdf\n30;oops;",
            ":2:2: 'oops' is not a number",
        ),
        ("matrix", "\n-80\t", "\n-80\tx", ":2:2: 'x"),
        (
            "astm",
            "NUM_POINTS 82",
            "NUM_POINTS 81",
            ":2: NUM_POINTS promises 81 rows, and there are 82",
        ),
        (
            "bird",
            "\"theta_r\": {\"unit\": \"rad\"",
            "\"theta_r\": {\"unit\": \"gon\"",
            ": the unit of theta_r is 'gon'",
        ),
        (
            "bird",
            "\"values\": [30,",
            "\"values\": [true,",
            ":1:65: 'true' is not a number",
        ),
        ("fred", "angles=deg", "angles=sin", ":2: 'angles=sin' is not understood"),
        (
            "lumos",
            "\n30 -180 -80 0 ",
            "\n30 -180 -80 ",
            ":2: the row has 4 numbers",
        ),
        (
            "zemax",
            "ScatterType BRDF",
            "ScatterType BTDF",
            ":4: ScatterType is 'BTDF'",
        ),
    ];
    for (format, from, to, expected) in breaks {
        let (_, text) = texts().into_iter().find(|(name, _)| *name == format).expect("a format");
        assert!(text.contains(from), "{format}: {from}");
        let file = write(&folder, "bad.dat", text.replacen(from, to, 1));
        let message = fail(&[&file]);
        assert!(
            message.starts_with(&format!("{file}{expected}")) && message.contains("; "),
            "{message}"
        );
    }
    let file = write(&folder, "bad.dat", "just text\n");
    for format in ["merl", "zemax", "astm", "bird"] {
        assert!(fail(&[&file, "--input-format", format]).starts_with(&format!("{file}:")));
    }
}

#[test]
fn a_whole_merl_file_gives_its_parameters_back() {
    // Bins are narrow where the file has its peak, so a fit of their middles is exact; theta_d is rounded in plane.
    const BINS: [usize; 3] = [90, 90, 180];
    let mut file: Vec<u8> = BINS.iter().flat_map(|&bins| (bins as u32).to_le_bytes()).collect();
    for scale in [1.0, 1.15, 1.66] {
        for bin in 0..BINS.iter().product() {
            let (k, j, i) = (bin % 180, bin / 180 % 90, bin / 180 / 90);
            let raw = middle(i, j, k).map_or(-1.0, |f| f * 1500.0 / scale);
            file.extend(raw.to_le_bytes());
        }
    }
    let read = |merl_whole| {
        let options = ReadOptions {
            merl_whole,
            column: vec!["G".into()],
            max_angle: Some(80.0),
            ..ReadOptions::default()
        };
        input::parse("merl", &file, &options).expect("a MERL file").remove(0)
    };
    for (whole, least) in [(true, 3000), (false, 700)] {
        let scan = read(whole);
        let rms = rms_from_truth(&scan.samples);
        println!(
            "MERL, whole: {whole}: {} samples, rms ln f {rms:.1e}",
            scan.samples.len()
        );
        assert!(scan.samples.len() > least);
        check(
            rms,
            if whole {
                tolerance::MERL_WHOLE
            } else {
                tolerance::MERL_IN_PLANE
            },
        );
    }
}

/// The BRDF of [`TRUTH`] in the middle of a bin of a MERL file, by rotating vectors; none below the surface.
fn middle(i: usize, j: usize, k: usize) -> Option<f64> {
    let half = i as f64 + 0.5;
    let [h, d, p] = [half * half / 90.0, j as f64 + 0.5, k as f64 + 0.5].map(f64::to_radians);
    let turn = |sign: f64| {
        let (sin_d, cos_d) = (Real::portable_sin_cos(d).0 * sign, Real::portable_sin_cos(d).1);
        let (x, y, z) = (sin_d * libm::cos(p), sin_d * libm::sin(p), cos_d);
        [
            libm::cos(h) * x + libm::sin(h) * z,
            y,
            libm::cos(h) * z - libm::sin(h) * x,
        ]
    };
    let (a, b) = (turn(1.0), turn(-1.0));
    if a[2] <= 1e-6 || b[2] <= 1e-6 {
        return None;
    }
    let azimuth = |v: [f64; 3]| libm::atan2(v[1], v[0]).to_degrees();
    Some(brdf(
        libm::acos(a[2]).to_degrees(),
        libm::acos(b[2]).to_degrees(),
        azimuth(b) - azimuth(a),
    ))
}

fn rms_from_truth(samples: &[Sample<f64>]) -> f64 {
    let squares = samples.iter().map(|sample| {
        let geometry = Geometry::new(sample.theta_i, sample.theta_s, sample.delta_phi).expect("valid angles");
        let residual =
            Brdf::<f64, ALL>::new(&Params::from_array(TRUTH)).ln_f(&geometry) - Real::portable_ln(sample.brdf);
        residual * residual
    });
    (squares.sum::<f64>() / samples.len() as f64).sqrt()
}
