//! `brdfit converge`, called in this process: its outputs, that all but times is the same in every run, and its errors.

use brdfit::engine::trace::trace;
use brdfit::engine::{FitError, FitOptions};
use brdfit_suite::program;
use brdfit_suite::scan::{data, scan as samples};
use serde_json::Value;

fn brdfit(arguments: &[&str], input: &[u8]) -> (u8, String, String) {
    let all: Vec<&str> = ["converge"].iter().chain(arguments).copied().collect();
    let ran = program::brdfit(&all, input);
    (ran.code, ran.output, ran.errors)
}

const TRUTH: &str = "rho_d=0.1,rho_s=10,rho_v=0.01,m=0.1,n=3,kappa=1";

/// A scan small enough for two hundred fits without optimisation.
fn scan() -> String {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let text = std::fs::read_to_string(folder.join("testdata1_sym_seed1.csv")).unwrap();
    let lines = text
        .lines()
        .enumerate()
        .filter(|(place, _)| *place == 0 || place % 6 == 1);
    lines.map(|(_, line)| format!("{line}\n")).collect()
}

fn succeed(arguments: &[&str], input: &str) -> String {
    let (code, output, errors) = brdfit(arguments, input.as_bytes());
    assert_eq!((code, errors.as_str()), (0, ""), "{arguments:?}");
    output
}

/// Without what depends on the clock.
fn timeless(value: &mut Value) {
    match value {
        Value::Object(map) => {
            map.retain(|key, _| key != "by_time" && key != "elapsed_s");
            map.values_mut().for_each(timeless);
        }
        Value::Array(list) => list.iter_mut().for_each(timeless),
        _ => {}
    }
}

#[test]
fn json_is_the_same_in_every_run_but_for_times() {
    let arguments = ["-", "--truth", TRUTH, "--seeds", "2", "--format", "json"];
    let read = || -> Value { serde_json::from_str(&succeed(&arguments, &scan())).unwrap() };
    let (mut one, mut two) = (read(), read());
    let scan = &one["scans"][0];
    assert_eq!(
        (&one["seeds"], &scan["name"], &scan["samples"]),
        (&2.into(), &"-".into(), &29.into())
    );
    assert_eq!(scan["truth"][3], 0.1);
    let methods = scan["methods"].as_array().unwrap();
    let names: Vec<String> = methods
        .iter()
        .map(|m| format!("{} {}", m["method"], m["precision"]))
        .collect();
    assert_eq!(
        names,
        [
            r#""default" "f64""#,
            r#""default" "f32""#,
            r#""paper" "f64""#,
            r#""paper" "f32""#
        ]
    );
    for method in methods {
        assert!(method["elapsed_s"].as_f64() > Some(0.0));
        for axis in ["by_passes", "by_time"] {
            let points = method[axis].as_array().unwrap();
            assert!(points.len() > 5);
            for quantity in ["excess", "rho_d", "m", "curve"] {
                let band = &points.last().unwrap()[quantity];
                let [low, middle, high] = ["p10", "median", "p90"].map(|key| band[key].as_f64().unwrap());
                assert!(0.0 <= low && low <= middle && middle <= high, "{quantity} {band}");
            }
        }
    }
    let reached = &methods[0]["reached"][2];
    assert_eq!(reached["within"], 1e-6);
    assert_eq!(reached["share"], 1.0, "every default search ends at the best known");
    assert!(reached["passes"].as_f64() < methods[2]["linearize"].as_f64());
    timeless(&mut one);
    timeless(&mut two);
    assert_eq!(one, two);
}

#[test]
fn csv_text_and_plot() {
    let folder = tempfile::tempdir().unwrap();
    let [svg, table] = ["a.svg", "a.csv"].map(|name| folder.path().join(name).to_str().unwrap().to_string());
    let arguments = [
        "-", "--seeds", "1", "--format", "csv", "--output", &table, "--plot", &svg,
    ];
    assert_eq!(succeed(&arguments, &scan()), "");
    let table = std::fs::read_to_string(table).unwrap();
    assert!(table.starts_with("scan,method,precision,axis,at,quantity,p10,median,p90\n-,default,f64,passes,1,excess,"));
    assert!(table.contains("\n-,paper,f32,seconds,") && !table.contains("curve") && !table.contains("NaN"));
    let svg = std::fs::read_to_string(svg).unwrap();
    assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n") && !svg.contains("NaN"));
    assert_eq!(svg.matches("fill-opacity").count(), 4);
    let text = succeed(&["-", "--seeds", "1", "--truth", TRUTH], &scan());
    assert!(text.contains("29 samples") && text.contains("\ndefault f64 ") && text.contains("curve"));
    assert!(text.lines().all(|line| line.chars().count() <= 110), "{text}");
}

#[test]
fn errors_are_one_line() {
    let short = "theta_i,theta_s,brdf\n30,10,1\n";
    let faint = format!("{}30,31,1e-50\n", scan());
    let cases: [(&[&str], &str, &str); 7] = [
        (
            &["-", "--truth", "m=0.1"],
            short,
            "--truth lacks rho_d, rho_s, rho_v, n, kappa",
        ),
        (&["-", "--truth", "x=1"], short, "no parameter 'x'"),
        (&["-", "--truth", "m"], short, "write --truth NAME=VALUE"),
        (&["-", "--truth", "m=1,m=1"], short, "gives m twice"),
        (&["-"], short, "cannot determine 6 parameters; measure more"),
        (&["-"], &faint, "-:31: the BRDF is not positive"),
        (&["no_such.csv"], "", "no such file"),
    ];
    for (arguments, input, expected) in cases {
        let (code, output, errors) = brdfit(arguments, input.as_bytes());
        assert_eq!(
            (code, output.as_str(), errors.matches('\n').count()),
            (2, "", 1),
            "{errors}"
        );
        assert!(errors.contains(expected), "{errors}");
    }
    assert_eq!(brdfit(&[], b"").0, 2);
    assert_eq!(brdfit(&["--paper", "x.csv"], b"").0, 2);
    assert!(succeed(&["--help"], "").contains("Example:"));
}

/// The course is that of a search without an instrument: one with an aperture is refused.
#[test]
fn an_instrument_is_not_traced() {
    let samples = samples(&data("testdata1_sym_seed1.csv"));
    let mut options = FitOptions {
        starts: Some(5),
        ..FitOptions::default()
    };
    assert!(!trace(&samples, &options).unwrap().records.is_empty());
    options.instrument.aperture = 0.01;
    assert_eq!(trace(&samples, &options), Err(FitError::Trace));
}
