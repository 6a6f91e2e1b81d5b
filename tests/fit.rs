//! `brdfit fit`, called in this process: its options, the JSON contract, and files that are whole or as before.

use std::fs;
use std::path::{Path, PathBuf};

use brdfit_suite::program::{self, Ran, fail, scene, succeed, write};
use brdfit_suite::tolerance::{self, check};
use serde_json::Value;

fn brdfit(arguments: &[&str]) -> Ran {
    program::brdfit(arguments, b"")
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

fn text(path: &Path) -> String {
    path.to_str().unwrap().to_string()
}

#[test]
fn json_keeps_its_contract() {
    let (_folder, file) = scene();
    let one = json(&succeed(&[
        "fit", &file, "--format", "json", "--starts", "64", "--seed", "3",
    ]));
    let keys: Vec<&String> = one.as_object().unwrap().keys().collect();
    let mut contract = vec![
        "file",
        "scan",
        "input",
        "left_out",
        "samples",
        "method",
        "seed",
        "starts",
        "terms",
        "model",
        "mse2",
        "rms_ln",
        "parameters",
        "at_bound",
        "selection",
        "uncertainty",
        "derived",
        "stop",
        "minima",
        "certificate",
        "evaluations",
        "provenance",
    ];
    contract.sort_unstable();
    assert_eq!(keys, contract);
    assert_eq!(one["file"], file.as_str());
    assert_eq!(
        (&one["samples"], &one["seed"], &one["starts"]),
        (&82.into(), &3.into(), &64.into())
    );
    assert_eq!(one["method"], "default");
    assert_eq!(
        one["terms"],
        serde_json::json!(["diffuse", "surface", "volume", "absorbing"])
    );
    assert!(one["at_bound"].is_array());
    assert!(["cost", "step", "passes", "not_finite"].contains(&one["stop"].as_str().unwrap()));
    let names = ["kappa", "m", "n", "rho_d", "rho_s", "rho_v"];
    let first = &one["minima"][0];
    for parameters in [&one["parameters"], &first["parameters"]] {
        assert!(parameters.as_object().unwrap().keys().eq(names));
        assert!(names.iter().all(|name| parameters[name].is_f64()));
    }
    assert_eq!(
        (&first["mse2"], &first["parameters"]),
        (&one["mse2"], &one["parameters"])
    );
    assert!(one["selection"].is_null());
    let known = &one["uncertainty"];
    assert_eq!(known["degrees_of_freedom"], 76);
    assert!(known["residual_scale"].is_f64() && known["condition"].as_f64() >= Some(1.0));
    // A scan without noise tells of no errors.
    assert_eq!(
        (&known["exact"], &known["stderr"]["m"]),
        (&Value::Bool(true), &Value::Null)
    );
    assert!(known["stderr_without_bounds"]["m"].is_f64());
    assert_eq!(known["correlation"]["n"]["n"], 0.0);
    assert!(known["on_bound"].is_array() && known["undetermined"].is_array());
    let angles = one["derived"].as_array().unwrap();
    assert_eq!(angles.len(), 2);
    let theta_i = angles[0]["theta_i_deg"].as_f64().unwrap();
    assert!(tolerance::DEGREES.admits((theta_i - 30.0).abs()));
    for quantity in ["rho_s_f", "rho_v_f", "peak_brdf_per_sr", "width_deg", "reflectance"] {
        assert!(angles[0][quantity]["value"].is_f64() && angles[0][quantity]["stderr"].is_null());
    }
    assert_eq!(
        angles[0]["energy_conserved"],
        angles[0]["reflectance"]["value"].as_f64() <= Some(1.0)
    );
    let table = succeed(&["fit", &file, "--format", "csv", "--starts", "64", "--seed", "3"]);
    let mut lines = table.lines().map(|line| line.split(','));
    let name = "reflectance_least_theta_i";
    let place = lines.next().unwrap().position(|column| column == name).expect(name);
    let cell: f64 = lines.next().unwrap().nth(place).unwrap().parse().unwrap();
    assert_eq!(Some(cell), angles[0]["reflectance"]["value"].as_f64());
    assert!(first["hits"].as_u64() >= Some(1) && first["first_start"].is_u64());
    assert!(one["evaluations"]["cost"].is_u64() && one["evaluations"]["linearize"].is_u64());
    let several = json(&succeed(&[
        "fit", &file, &file, "--format", "json", "--starts", "64", "--seed", "3",
    ]));
    let several = several.as_array().unwrap();
    assert_eq!(several.len(), 2);
    assert!(several.iter().all(|other| other["parameters"] == one["parameters"]));
}

#[test]
fn options_do_what_they_say() {
    let (_folder, file) = scene();
    let fitted = |options: &[&str]| json(&succeed(&[&["fit", &file, "--format", "json"], options].concat()));
    let fixed = fitted(&["--fix", "n=1.75", "--fix", "rho_v=0", "--bounds", "m=0.2:0.3"]);
    assert_eq!(fixed["parameters"]["n"], 1.75);
    assert_eq!(fixed["parameters"]["rho_v"], 0.0);
    assert_eq!(fixed["parameters"]["m"], 0.2);
    let at_bound = fixed["at_bound"].as_array().unwrap();
    assert!(at_bound.contains(&"m".into()) && !at_bound.contains(&"n".into()));
    let surface = fitted(&["--terms", "diffuse,surface"]);
    assert_eq!(surface["terms"], serde_json::json!(["diffuse", "surface"]));
    assert_eq!(surface["parameters"]["kappa"], 0.0);
    let diffuse = fitted(&["--terms", "diffuse"]);
    assert!(diffuse["rms_ln"].as_f64().unwrap() > surface["rms_ln"].as_f64().unwrap());
    let single = fitted(&["--precision", "f32"]);
    let rho_d = single["parameters"]["rho_d"].as_f64().unwrap();
    assert!(rho_d == f64::from(rho_d as f32));
    check((rho_d / 0.1 - 1.0).abs(), tolerance::IDEAL_F32);
    let paper = fitted(&["--method", "paper", "--starts", "20", "--threads", "2"]);
    assert_eq!((&paper["method"], &paper["starts"]), (&"paper".into(), &20.into()));
}

#[test]
fn text_and_csv_tell_the_same() {
    let (_folder, file) = scene();
    let page = succeed(&["fit", &file, "--minima"]);
    for word in [
        &file,
        "rho_d",
        "kappa",
        "theta_i       30 deg:   41 samples",
        "MSE^2",
        "distinct",
        "stop",
        "time",
        "hits",
    ] {
        assert!(page.contains(word), "{word} is not in:\n{page}");
    }
    let table = succeed(&["fit", &file, &file, "--format", "csv"]);
    let rows: Vec<Vec<&str>> = table.lines().map(|row| row.split(',').collect()).collect();
    assert_eq!(rows.len(), 3);
    assert!(rows.iter().all(|row| row.len() == rows[0].len()));
    let rho_d = rows[0].iter().position(|&name| name == "rho_d").unwrap();
    assert!(tolerance::IDEAL_PRINTED.admits((rows[1][rho_d].parse::<f64>().unwrap() / 0.1 - 1.0).abs()));
    assert!(succeed(&["fit", &file, "--format", "csv", "--minima"]).lines().count() >= 2);
}

#[test]
fn csv_and_json_have_the_same_values() {
    let (folder, _) = scene();
    let row = |k: i32| {
        let brdf = 0.1 + 0.001 * f64::from(k * k);
        format!("30,{},{brdf},{}\n", 10 * k, 0.1 * brdf)
    };
    let scan = "theta_i,theta_s,brdf,sigma\n".to_string() + &(-8..=8).map(row).collect::<String>();
    let file = write(&folder, "weighted.csv", scan);
    let object = json(&succeed(&["fit", &file, "--robust", "--format", "json"]));
    let table = succeed(&["fit", &file, "--robust", "--format", "csv"]);
    let mut rows = table.lines().map(|row| row.split(',').collect::<Vec<_>>());
    let (head, row) = (rows.next().unwrap(), rows.next().unwrap());
    // What is not determined is named in both, whatever the order.
    let sets = object["uncertainty"]["undetermined"].as_array().unwrap();
    let names = sets.iter().flat_map(|one| one["parameters"].as_array().unwrap());
    let mut open: Vec<&str> = names.map(|name| name.as_str().unwrap()).collect();
    let place = head.iter().position(|&name| name == "undetermined").unwrap();
    let mut cell: Vec<&str> = row[place].split('+').collect();
    open.sort_unstable();
    cell.sort_unstable();
    assert!(!open.is_empty());
    assert_eq!(cell, open);
    let mut compared = Vec::new();
    for (name, cell) in head.into_iter().zip(row) {
        if let Some(parameter) = name.strip_prefix("stderr_") {
            let stderr = &object["uncertainty"]["stderr"][parameter];
            assert_eq!(cell.parse().ok(), stderr.as_f64(), "{name}");
        }
        let value = [&object, &object["parameters"]]
            .into_iter()
            .find_map(|members| members.get(name));
        match value {
            Some(serde_json::Value::Number(number)) => {
                assert_eq!(cell.parse().ok(), number.as_f64(), "{name}");
            }
            Some(serde_json::Value::String(text)) => assert_eq!(cell, text, "{name}"),
            _ => continue,
        }
        compared.push(name);
    }
    let both = "file samples method seed starts model mse2 rho_d rho_s rho_v m n kappa rms_ln stop robust_scale chi2";
    assert_eq!(compared, both.split(' ').collect::<Vec<_>>());
}

#[test]
fn dropped_rows_are_counted() {
    let (folder, file) = scene();
    let clean = json(&succeed(&["fit", &file, "--format", "json"]));
    let scan = fs::read_to_string(&file).unwrap() + "30,85,0\n30,90,1\n30,86,NaN\n";
    let dirty = write(&folder, "dirty.csv", scan);
    assert!(fail(&["fit", &dirty]).contains("3 rows are not valid, on lines 84, 85, 86"));
    let ran = brdfit(&["fit", &dirty, "--format", "json", "--drop-invalid"]);
    assert_eq!(ran.code, 0);
    assert_eq!(
        ran.errors,
        format!("{dirty}: kept 82, left out 3 samples: 3 not valid (3 at 30 deg)\n")
    );
    let fitted = json(&ran.output);
    assert_eq!(fitted["parameters"], clean["parameters"]);
    let counts = serde_json::json!([{"reason": "not_valid", "theta_i_deg": 30.0, "samples": 3}]);
    assert_eq!(fitted["left_out"], counts);
    let hopeless = write(&folder, "hopeless.csv", "theta_i,theta_s,brdf\n1,2,0\n");
    assert!(fail(&["fit", &hopeless, "--drop-invalid"]).contains("none of the 1 rows"));
}

#[test]
fn rounding_to_single_precision_names_the_line() {
    let (folder, file) = scene();
    let grazing = write(
        &folder,
        "grazing.csv",
        fs::read_to_string(&file).unwrap() + "30,89.9999999,1\n",
    );
    assert!(json(&succeed(&["fit", &grazing, "--format", "json"]))["rms_ln"].is_f64());
    let message = fail(&["fit", &grazing, "--precision", "f32"]);
    assert!(
        message.starts_with(&format!("{grazing}:84: ")) && message.contains("f64"),
        "{message}"
    );
}

#[test]
fn extreme_bounds_neither_panic_nor_give_nan() {
    let (_folder, file) = scene();
    for fix in ["m=1e-6", "m=1e6", "n=1e6", "kappa=1e6", "rho_s=1e6", "rho_d=0"] {
        for precision in ["f64", "f32"] {
            for method in ["default", "paper"] {
                let options = [
                    "--fix",
                    fix,
                    "--precision",
                    precision,
                    "--method",
                    method,
                    "--starts",
                    "20",
                ];
                let found = json(&succeed(&[&["fit", &file, "--format", "json"], &options[..]].concat()));
                assert!(found["mse2"].is_f64(), "{options:?}");
            }
        }
    }
}

#[test]
fn output_is_whole_or_as_before() {
    let (folder, file) = scene();
    let result: PathBuf = folder.path().join("result.json");
    let arguments = ["fit", &file, "--format", "json", "--output", &text(&result)];
    assert_eq!(succeed(&arguments), "");
    let before = fs::read_to_string(&result).unwrap();
    assert_eq!(json(&before)["samples"], 82);
    // One bad file among good ones: nothing is written at all, and no temporary file is left.
    let bad = write(&folder, "bad.csv", "theta_i,theta_s,brdf\n1,2,x\n");
    let message = fail(&["fit", &file, &bad, "--output", &text(&result)]);
    assert!(message.starts_with(&format!("{bad}:2:3: ")));
    assert_eq!(fs::read_to_string(&result).unwrap(), before);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
}

#[test]
fn a_million_rows_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let rows = (0..1_000_000).map(|row| format!("{},{},0.1\n", row % 80, row % 171 - 85));
    let mut scan = String::from("theta_i_deg,theta_s_deg,brdf_per_sr\n");
    scan.extend(rows);
    let file = write(&folder, "large.csv", &scan);
    // A flat BRDF has no lobes to search, so two starts of one parameter are enough.
    let found = json(&succeed(&[
        "fit", &file, "--terms", "diffuse", "--starts", "2", "--format", "json",
    ]));
    assert_eq!(found["samples"], 1_000_000);
    let rho_d = found["parameters"]["rho_d"].as_f64().unwrap();
    assert!(tolerance::IDEAL_PRINTED.admits((rho_d / (0.1 * std::f64::consts::PI) - 1.0).abs()));
    let bad = write(&folder, "bad.csv", scan + "1,2,x\n");
    assert!(fail(&["fit", &bad]).starts_with(&format!("{bad}:1000002:3: ")));
}
