//! Forms that are tables: read back, they are the model.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::fs;

use super::{LIST, NAMES, PARAMETERS, brdfit, export, exported, off, off_from};
use brdfit::engine::Model;
use brdfit::input::{self, ReadOptions};
use brdfit_core::geometry::Sample;
use brdfit_suite::literal;
use brdfit_suite::program;
use brdfit_suite::tolerance::{self, check};
use serde_json::Value;

/// The tables hold any model: read back, its values are those of the model.
#[test]
fn tables_of_any_model_read_back() {
    for (name, list) in [
        ("ggx", "rho_d=0.1,rho_s=10,rho_v=0.01,m=0.1,n=3,kappa=1"),
        ("abg", "rho_d=0.05,A=0.01,B=0.001,g=1.8"),
    ] {
        let model = Model::find(name).unwrap();
        let given = list.split(',').map(|one| one.split_once('=').unwrap().1);
        let values: Vec<f64> = given.map(|value| value.parse().unwrap()).collect();
        for (to, least) in [("zemax", 20_000), ("bird", 1000), ("openmaterial", 15_000)] {
            let arguments = ["export", "--model", name, "--params", list, "--to", to];
            let wavelength: &[&str] = if to == "openmaterial" {
                &["--wavelength", "905"]
            } else {
                &[]
            };
            let text = exported(&[&arguments[..], wavelength].concat());
            let f = |angles: [f64; 3]| {
                let [theta_i, theta_s, delta_phi] = angles;
                let sample = Sample {
                    theta_i,
                    theta_s,
                    delta_phi,
                    ..Sample::in_plane(0.0, 0.0, 1.0)
                };
                libm::exp(model.ln_f(&values, &sample).unwrap())
            };
            // The file's digits of angles near a narrow peak.
            let off = off_from(&text, least, f);
            assert!(tolerance::TABLE_ROUND_TRIP.admits(off), "{name} {to}: {off:e}");
        }
    }
}

/// Results of scans at three wavelengths, as `brdfit fit --format json` writes them.
fn results(parameters: [[f64; 6]; 3]) -> Vec<u8> {
    let lengths = [450, 550, 650];
    let each = lengths.into_iter().zip(parameters).map(|(nm, values)| {
        let named: serde_json::Map<_, _> = NAMES
            .map(String::from)
            .into_iter()
            .zip(values.map(Value::from))
            .collect();
        serde_json::json!({"file": "paint.csv", "scan": format!("{nm} nm"), "model": "beckmann", "parameters": named})
    });
    Value::Array(each.collect()).to_string().into_bytes()
}

const BLUE: [f64; 6] = [0.05, 0.5, 0.0, 0.3, 1.5, 0.0];
const GREEN: [f64; 6] = [0.1, 0.5, 0.0, 0.3, 1.5, 0.0];
const RED: [f64; 6] = [0.4, 0.5, 0.0, 0.3, 1.5, 0.0];

/// The table of Mitsuba's measured BSDF holds any model and several wavelengths: read back, its values are those of the models.
#[test]
fn rgl_tables_read_back() {
    let file = std::env::temp_dir().join(format!("brdfit_rgl_{}.bsdf", std::process::id()));
    let to = file.to_str().unwrap();
    let all = program::brdfit(&["export", "-", "--to", "rgl", "-o", to], &results([BLUE, GREEN, RED]));
    assert_eq!((all.code, all.errors.as_str()), (0, ""));
    let read = ReadOptions {
        drop_invalid: true,
        column: vec!["450 nm".into(), "650 nm".into()],
        ..ReadOptions::default()
    };
    let bytes = fs::read(&file).unwrap();
    fs::remove_file(&file).unwrap();
    let scans = input::parse("file", &bytes, &read).unwrap();
    assert_eq!(scans.len(), 2);
    for (scan, values) in scans.iter().zip([BLUE, RED]) {
        assert!(scan.samples.len() > 200_000);
        let off = scan.samples.iter().map(|sample| {
            let angles = [sample.theta_i, sample.theta_s, sample.delta_phi];
            // Near the horizon single precision does not know the cosine.
            let cos = libm::cos(sample.theta_s);
            (sample.brdf / literal::f(angles, values) - 1.0).abs() * cos
        });
        let off = off.fold(0.0, f64::max);
        assert!(tolerance::RGL_ROUND_TRIP.admits(off), "{off:e}");
    }
}

/// Three results are one colour: the base follows the channels, and everything else is common.
#[test]
fn three_results_are_one_colour() {
    let run = |to: &str, index: &str| {
        program::brdfit(
            &["export", "-", "--to", to, "--index", index],
            &results([BLUE, GREEN, RED]),
        )
    };
    let gltf = run("gltf", "3,2,1");
    assert!(
        gltf.errors.starts_with("red is paint.csv 650 nm, green "),
        "{}",
        gltf.errors
    );
    // Without an index the longest wavelength is red.
    let unordered = program::brdfit(&["export", "-", "--to", "gltf"], &results([BLUE, GREEN, RED]));
    assert_eq!((unordered.code, &unordered.output), (0, &gltf.output));
    let material = &serde_json::from_str::<Value>(&gltf.output).unwrap()["materials"][0];
    let base: Vec<f64> = material["pbrMetallicRoughness"]["baseColorFactor"]
        .as_array()
        .unwrap()
        .iter()
        .map(|value| value.as_f64().unwrap())
        .collect();
    assert!(
        base[0] > 2.0 * base[1] && base[1] > 1.5 * base[2] && base[3] == 1.0,
        "{base:?}"
    );
    let ior = material["extensions"]["KHR_materials_ior"]["ior"].as_f64().unwrap();
    assert!((1.0..2.0).contains(&ior), "{ior}");
    let surface = run("openpbr", "3,2,1");
    assert!(
        surface.errors.contains("; against the fitted model -"),
        "{}",
        surface.errors
    );
    let input = |name: &str| {
        let line = surface
            .output
            .lines()
            .find(|line| line.contains(&format!("name=\"{name}\"")));
        let value = line.and_then(|line| line.split("value=\"").nth(1)?.split('"').next());
        let value = value.unwrap_or_else(|| panic!("{name}: {}", surface.output));
        value
            .split(", ")
            .map(|part| part.parse().unwrap())
            .collect::<Vec<f64>>()
    };
    let base = input("base_color");
    assert!(base[0] > 2.0 * base[1] && base[1] > 1.5 * base[2], "{base:?}");
    assert!((0.0..=1.0).contains(&input("base_metalness")[0]) && (0.1..1.0).contains(&input("specular_roughness")[0]));
    assert!((1.0..2.0).contains(&input("specular_ior")[0]));
    for (to, index, what) in [
        ("gltf", "3,2", "a colour has one result or three, not 2"),
        ("zemax", "3,2,1", "there are 3 results"),
        ("rgl", "1,1", "two results have the same wavelength"),
        ("materialx", "4", "none is number 4"),
    ] {
        let refused = run(to, index);
        assert_eq!(refused.code, 2, "{to} {index}");
        assert!(refused.errors.contains(what), "{}", refused.errors);
    }
}

#[test]
fn zemax_reads_back() {
    check(off(&export("zemax", "paint"), 20_000), tolerance::ZEMAX_ROUND_TRIP);
}

#[test]
fn bird_has_the_model_and_its_brdf() {
    let text = export("bird", "paint");
    check(off(&text, 1000), tolerance::BIRD_ROUND_TRIP);
    let file: Value = serde_json::from_str(&text).unwrap();
    let model = &file["metadata"]["software"]["simulation_model"];
    for (place, parameter) in model["parameters"].as_array().unwrap().iter().enumerate() {
        assert_eq!(parameter["name"], NAMES[place]);
        assert_eq!(parameter["value"].as_f64(), Some(PARAMETERS[place]));
        assert!(parameter.get("uncertainty").is_none());
        assert!(["description", "unit"].iter().all(|key| parameter[key].is_string()));
    }
}

#[test]
fn openmaterial_reads_back_and_has_what_its_schema_requires() {
    let export = |more: &[&str]| {
        let all = [
            &["export", "--params", LIST, "--to", "openmaterial", "--name", "paint"],
            more,
        ]
        .concat();
        brdfit(&all)
    };
    let ran = export(&["--wavelength", "905"]);
    assert_eq!((ran.code, ran.errors.as_str()), (0, ""));
    check(off(&ran.output, 15_000), tolerance::OPENMATERIAL_ROUND_TRIP);
    let scan = input::parse("x", ran.output.as_bytes(), &ReadOptions::default()).unwrap();
    assert_eq!(
        (scan[0].name.as_deref(), scan[0].read_as.format.name),
        (Some("905 nm"), "openmaterial")
    );
    let file: Value = serde_json::from_str(&ran.output).unwrap();
    let metadata = &file["metadata"];
    for key in [
        "name",
        "uuid",
        "materialVersion",
        "openMaterial3dVersion",
        "license",
        "sources",
    ] {
        assert!(metadata[key].is_string(), "{key}");
    }
    assert!(["copyrights", "authors"].iter().all(|key| metadata[key][0].is_string()));
    let lengths: Vec<usize> = metadata["uuid"].as_str().unwrap().split('-').map(str::len).collect();
    assert_eq!(lengths, [8, 4, 4, 4, 12]);
    let rows: Vec<Vec<f64>> = serde_json::from_value(file["brdf"]["lookupTable"].clone()).unwrap();
    assert!(rows.is_sorted(), "the schema sorts the table by its columns");
    let largest = [17.16e-3, FRAC_PI_2, FRAC_PI_2, TAU, f64::MAX];
    assert!(
        rows.iter()
            .flat_map(|row| row.iter().zip(largest))
            .all(|(x, most)| (0.0..=most).contains(x))
    );
    let three = program::brdfit(&["export", "-", "--to", "openmaterial"], &results([BLUE, GREEN, RED]));
    assert_eq!(three.code, 0, "{}", three.errors);
    let scans = input::parse("x", three.output.as_bytes(), &ReadOptions::default()).unwrap();
    let names: Vec<_> = scans.iter().map(|scan| scan.name.as_deref().unwrap()).collect();
    assert_eq!(names, ["450 nm", "550 nm", "650 nm"]);
    // The same material has the same identifier, another one another.
    let uuid = |more: &[&str]| {
        let file: Value = serde_json::from_str(&export(more).output).unwrap();
        file["metadata"]["uuid"].as_str().map(String::from)
    };
    assert_eq!(uuid(&["--wavelength", "905"]).as_deref(), metadata["uuid"].as_str());
    assert_ne!(uuid(&["--wavelength", "1550"]).as_deref(), metadata["uuid"].as_str());
    let without = export(&[]);
    assert!(
        without.code == 2 && without.errors.contains("give --wavelength"),
        "{}",
        without.errors
    );
    assert_eq!(export(&["--wavelength", "0"]).code, 2);
}
