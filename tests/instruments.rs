//! Files of instruments and optical programs, as people have them: what is in them is found, or what they are is said.

use std::f64::consts::PI;
use std::fs;

use brdfit::input::{self, Measurement, ReadOptions};
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use brdfit_suite::program::{self, write};
use brdfit_suite::scan::data;
use serde_json::Value;

/// A made-up file of a kind that people have.
fn case(name: &str) -> String {
    let path = data("read").join(name);
    path.to_str().expect("a path in UTF-8").to_string()
}

fn fit(arguments: &[&str]) -> Value {
    let ran = program::brdfit(&[&["fit", "--format", "json"], arguments].concat(), b"");
    assert_eq!(ran.code, 0, "{}", ran.errors);
    serde_json::from_str(&ran.output).expect("JSON")
}

/// The parameter of a fit.
fn parameter(fit: &Value, name: &str) -> f64 {
    fit["parameters"][name].as_f64().expect("a number")
}

#[test]
fn astm_whose_vars_forgets_the_azimuth_is_the_scan_that_it_was() {
    // Made with rho_d = 0.3 and m = 0.2, noise 0.5 %.
    let found = fit(&[&case("f07_astm_vars_without_phi_s.astm")]);
    assert_eq!(
        (&found["input"]["format"], &found["samples"]),
        (&"astm".into(), &140.into())
    );
    let (rho_d, m) = (parameter(&found, "rho_d"), parameter(&found, "m"));
    assert!((rho_d - 0.3).abs() < 0.001 && (m - 0.2).abs() < 0.001, "{rho_d} {m}");
    assert!(found["rms_ln"].as_f64().expect("a number") < 0.006);
}

#[test]
fn one_text_in_every_encoding_and_with_every_line_end_is_one_scan() {
    let folder = tempfile::tempdir().expect("a folder");
    let bytes = fs::read(case("f14_latin1_degree.csv")).expect("the case is there");
    let text: String = bytes.iter().map(|&byte| char::from(byte)).collect();
    assert!(text.contains('°') && std::str::from_utf8(&bytes).is_err());
    let expected = fit(&[&case("f14_latin1_degree.csv")])["parameters"].clone();
    let wide = |pair: fn(u16) -> [u8; 2]| -> Vec<u8> { text.encode_utf16().flat_map(pair).collect() };
    for bytes in [
        text.clone().into_bytes(),
        [&[0xff, 0xfe], &wide(u16::to_le_bytes)[..]].concat(),
        [&[0xfe, 0xff], &wide(u16::to_be_bytes)[..]].concat(),
        wide(u16::to_le_bytes),
        text.replace("\r\n", "\n").replace('\n', "\r").into_bytes(),
        text.replace("\r\n", "\n").replace('\n', "\r\n").into_bytes(),
    ] {
        assert_eq!(fit(&[&write(&folder, "scan.csv", bytes)])["parameters"], expected);
    }
}

/// The scans in a made-up file: samples, and each direction with its value, degrees, azimuth from incidence.
fn read(name: &str) -> Vec<Measurement> {
    let bytes = fs::read(case(name)).expect("the case is there");
    input::parse(name, &bytes, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// The brightest sample of a scan of one angle of incidence: theta_i, theta_s and azimuth in degrees, and the value.
fn brightest(scan: &Measurement) -> [f64; 4] {
    let most = scan
        .samples
        .iter()
        .max_by(|a, b| a.brdf.total_cmp(&b.brdf))
        .expect("a sample");
    let degrees = |angle: f64| (angle.to_degrees() * 1e9).round() / 1e9;
    [
        degrees(most.theta_i),
        degrees(most.theta_s),
        degrees(most.delta_phi),
        most.brdf,
    ]
}

#[test]
fn each_program_puts_the_specular_peak_forward() {
    for (name, format, samples, peak) in [
        ("f15_lighttools.bsdf", "lighttools", 7, [30.0, 30.0, 180.0, 0.5]),
        ("f15_pabopto.dat", "pabopto", 4, [30.0, 30.0, 180.0, 0.3]),
        ("f15_ssdd.ssdd", "ssdd", 6, [30.0, 45.0, 180.0, 0.2]),
    ] {
        let scans = read(name);
        assert_eq!(
            (scans.len(), scans[0].read_as.format.name, scans[0].samples.len()),
            (1, format, samples)
        );
        assert_eq!(brightest(&scans[0]), peak, "{name}");
    }
    let scan = &read("f15_openmaterial.xompt")[0];
    assert_eq!((scan.name.as_deref(), scan.samples.len()), (Some("905 nm"), 2));
    assert_eq!(scan.samples[0], Sample::in_plane(0.5, 0.5, 0.3));
    // Its reflectance, 20 %, and not its values says how bright it is.
    let scan = &read("f15_speos.brdf")[0];
    assert_eq!((scan.name.as_deref(), scan.samples.len()), (Some("550 nm"), 9));
    let [theta_i, theta_s, azimuth, value] = brightest(scan);
    assert_eq!([theta_i, theta_s, azimuth], [30.0, 30.0, 180.0]);
    let (sin, cos) = Real::portable_sin_cos(30f64.to_radians());
    let rings = [
        0.0,
        2.0 * PI * 0.55 / 4.0 * sin * cos,
        2.0 * PI * 0.35 / 4.0 * sin * cos,
    ];
    let integral = 30f64.to_radians() * (rings[1] + rings[2] / 2.0);
    assert!((value / (0.3 * 0.2 / integral) - 1.0).abs() < 1e-14);
}

#[test]
fn what_is_no_measured_reflectance_is_refused_by_its_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let speos = fs::read_to_string(case("f15_speos.brdf")).expect("the case is there");
    let lighttools = fs::read_to_string(case("f15_lighttools.bsdf")).expect("the case is there");
    let pabopto = fs::read_to_string(case("f15_pabopto.dat")).expect("the case is there");
    let ssdd = fs::read_to_string(case("f15_ssdd.ssdd")).expect("the case is there");
    for (name, bytes, what) in [
        (
            "a.brdf",
            speos.replace("\n1\t1\n1\n", "\n0\t1\n1\n"),
            "transmission (BTDF)",
        ),
        ("b.bsdf", lighttools.replace("BRDF", "BTDF"), "transmission (BTDF)"),
        ("c.dat", pabopto.replace("BRDF", "BTDF"), "transmission (BTDF)"),
        ("d.ssdd", ssdd.replace("brdf", "btdf"), "no BRDF, but btdf"),
        (
            "e.scattering",
            "OPTIS - Scattering surface file v1.0\nScattering surface\n19 2\n".into(),
            "Speos",
        ),
        (
            "f.xml",
            "<?xml version=\"1.0\"?>\n<WindowElement xmlns=\"x\">\n".into(),
            "Klems XML",
        ),
        ("g.txt", "!! a\n!! b\n1 2 3\n".into(), "RPC Photonics"),
        (
            "h.json",
            "{\"points\": [1, 2]}".into(),
            "neither a BiRD nor an OpenMATERIAL",
        ),
        (
            "i.txt",
            "Dear all,\nplease find enclosed\n".into(),
            "begins with 'Dear all,'",
        ),
        ("j.pdf", "%PDF-1.7\n1 0 obj\n".into(), "a PDF document"),
    ] {
        let file = write(&folder, name, bytes);
        let message = program::fail(&["fit", &file]);
        assert!(
            message.starts_with(&file) && message.contains(what) && message.contains("; "),
            "{message}"
        );
    }
}

#[test]
fn workbooks_are_read_or_refused_by_name() {
    // As little of an archive as tells a workbook.
    let folder = tempfile::tempdir().expect("a folder");
    let file = write(&folder, "scan.xlsx", b"PK\x03\x04......xl/workbook.xml");
    let message = program::fail(&["fit", &file]);
    assert!(
        message.contains("Excel workbook") && message.contains("save the sheet as CSV"),
        "{message}"
    );
}
