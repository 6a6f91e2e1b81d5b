//! Files of instruments and optical programs, as people have them: what is in them is found, or what they are is said.

use std::fs;

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
