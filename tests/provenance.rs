//! JSON says what someone needs who wants the same result again, and two runs give the same bytes.

use brdfit_suite::program::{succeed, write};
use serde_json::{Value, json};
use tempfile::TempDir;

const SIZE: usize = 461;
/// As `sha256sum` gives it.
const SHA256: &str = "e393dd22ad8e067696521da8cf87cdabce7469ca9765a2ca1f01c2377dcde333";

/// A scan of these bytes.
fn scan() -> (TempDir, String) {
    let mut text = String::from("theta_i_deg,theta_s_deg,brdf_per_sr\n");
    for theta_s in (-80..84).step_by(4) {
        let brdf = if i32::abs(theta_s - 45) > 8 { "0.1" } else { "1.5" };
        text += &format!("45,{theta_s},{brdf}\n");
    }
    let folder = tempfile::tempdir().unwrap();
    let file = write(&folder, "scan.csv", text);
    (folder, file)
}

fn object(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn a_fit_says_what_it_was_made_from() {
    let (_folder, file) = scan();
    let one = object(&succeed(&[
        "fit",
        &file,
        "--format",
        "json",
        "--precision",
        "f32",
        "--bounds",
        "m=0.01:2",
        "--fix",
        "kappa=0",
        "--max-angle",
        "75",
        "--weight-angle",
        "45=2",
        "-q",
    ]));
    let provenance = &one["provenance"];
    assert_eq!(provenance["brdfit"], env!("CARGO_PKG_VERSION"));
    assert_eq!(
        provenance["files"],
        json!([{ "file": file, "bytes": SIZE, "sha256": SHA256 }])
    );
    assert_eq!(provenance["precision"], "f32");
    assert_eq!(provenance["robust"], false);
    assert_eq!(provenance["bounds"]["m"], json!([0.01, 2.0]));
    assert_eq!(provenance["bounds"]["kappa"], json!([0.0, 0.0]));
    assert_eq!(provenance["bounds"]["n"], json!([1.0, 100.0]));
    // What is as usual is not said.
    assert_eq!(
        provenance["read_options"],
        json!({ "max_angle": 75.0, "weight_angle": [[45.0, 2.0]] })
    );
    // The page of a report names the same file.
    let page = succeed(&["report", &file]);
    assert!(page.contains(SHA256) && page.contains(&format!("{SIZE} bytes")));
}

#[test]
fn every_document_names_its_files() {
    let (_folder, file) = scan();
    for (arguments, path) in [
        (&["batch", &file, "--out", "-", "--format", "json"][..], "/0/provenance"),
        (&["joint", &file, &file, "--format", "json"], "/scans/1/provenance"),
        (
            &["compare", &file, "--models", "beckmann", "--format", "json"],
            "/provenance",
        ),
        (
            &["profile", &file, "--parameter", "rho_d", "--format", "json"],
            "/provenance",
        ),
        (&["converge", &file, "--seeds", "1", "--format", "json"], "/provenance"),
        (&["stability", &file, "--format", "json"], "/provenance"),
        (&["inspect", &file, "--format", "json"], "/provenance"),
    ] {
        let document = object(&succeed(arguments));
        let provenance = document.pointer(path).unwrap_or_else(|| panic!("{arguments:?}"));
        assert_eq!(provenance["files"][0]["sha256"], SHA256, "{arguments:?}");
        // Each model of a comparison has bounds of its own, and nothing is searched in an inspection.
        let bounds = match arguments[0] {
            "inspect" => continue,
            "compare" => &document["models"][0]["bounds"],
            _ => &provenance["bounds"],
        };
        assert_eq!(bounds["rho_d"], json!([0.0, 1.0]), "{arguments:?}");
    }
}

#[test]
fn two_runs_give_the_same_bytes() {
    let (_folder, file) = scan();
    for arguments in [
        &["fit", &file, "--format", "json"][..],
        &["fit", &file, "--format", "csv"],
        &["joint", &file, &file, "--format", "json"],
        &["compare", &file, "--models", "ggx", "--format", "json"],
        &["profile", &file, "--parameter", "rho_d", "--format", "json"],
        &["paper", "--starts", "5", "--format", "json"],
        &["report", &file],
    ] {
        assert!(succeed(arguments) == succeed(arguments), "{arguments:?}");
    }
    let timed = object(&succeed(&["fit", &file, "--format", "json", "--time"]));
    assert!(timed["elapsed_s"].as_f64().unwrap() > 0.0);
    let table = succeed(&["fit", &file, "--format", "csv", "--time"]);
    let mut rows = table.lines().map(|row| row.rsplit(',').next().unwrap());
    assert_eq!(rows.next(), Some("elapsed_s"));
    assert!(rows.next().unwrap().parse::<f64>().unwrap() > 0.0);
}
