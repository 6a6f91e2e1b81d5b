//! What the program writes reads back as what it was, whatever the numbers and names.

use std::path::PathBuf;

use brdfit::document::{json, write_row};
use brdfit::engine::Material;
use brdfit::export::model::Model;
use brdfit::export::{bird, zemax};
use brdfit::input::{self, ReadOptions};
use brdfit::number::shortest;
use brdfit::page::results;
use brdfit::plain::{of_cell, plain};
use brdfit_core::brdf::Params;
use brdfit_suite::program::succeed;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Names of any characters, of which many have no picture.
fn name() -> impl Strategy<Value = String> {
    let c = prop_oneof![
        any::<char>(),
        prop::char::range('\0', '\u{a0}'),
        prop::char::range('\u{2000}', '\u{2070}'),
        prop::sample::select(vec!['=', '+', '-', '@', '\'', '"', ',', '\\']),
    ];
    vec(c, 0..12).prop_map(String::from_iter)
}

/// Any parameters that a model can have.
fn params() -> impl Strategy<Value = Params<f64>> {
    let rho = || prop_oneof![Just(0.0), 0.0..1e6, 1e-300..1e-3];
    (rho(), rho(), rho(), 1e-6..1e6, 1.0..1e6, rho())
        .prop_map(|(rho_d, rho_s, rho_v, m, n, kappa)| Params::from_array([rho_d, rho_s, rho_v, m, n, kappa]))
}

/// The same cases in each run, and no files of them.
fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(18),
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(cases(256))]

    #[test]
    fn every_number_has_at_most_24_characters(bits in any::<u64>()) {
        let x = f64::from_bits(bits);
        prop_assume!(x.is_finite());
        let text = shortest(x);
        prop_assert!(text.len() <= 24, "{}", text);
        prop_assert_eq!(text.parse::<f64>().unwrap().to_bits(), bits);
    }

    #[test]
    fn json_holds_any_name(name in name()) {
        let text = json(&[&name]);
        prop_assert!(!text.contains(|c: char| c != '\n' && c.is_control()));
        prop_assert_eq!(&serde_json::from_str::<Vec<String>>(&text).unwrap()[0], &name);
    }

    #[test]
    fn tables_hold_any_name(names in vec(name(), 2..5)) {
        let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
        write_row(&mut writer, &names).unwrap();
        let table = writer.into_inner().unwrap();
        let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(&table[..]);
        let row = reader.records().next().unwrap().unwrap();
        for (cell, name) in row.iter().zip(&names) {
            prop_assert!(cell.len() < 2 || !cell.starts_with(['=', '@']), "{}", cell);
            // A name that has an apostrophe before a formula loses none of it, unless it is one of ours.
            if !name.starts_with('\'') {
                prop_assert_eq!(of_cell(cell), &plain(name));
            }
        }
        prop_assert_eq!(row.len(), names.len());
    }

    #[test]
    fn results_keep_every_bit(params in params(), file in name(), scan in proptest::option::of(name())) {
        let values = params.to_array();
        let object = serde_json::json!({
            "file": file, "scan": scan,
            "parameters": {
                "rho_d": values[0], "rho_s": values[1], "rho_v": values[2], "m": values[3], "n": values[4], "kappa": values[5],
            },
        });
        let found = results::parse(json(&object).as_bytes()).unwrap().remove(0);
        prop_assert_eq!((found.file, found.scan), (PathBuf::from(&file), scan));
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(&found.material.unwrap().values), bits(&values));
        let exported = Model::of_json(object.to_string().as_bytes(), &[]).unwrap().remove(0);
        prop_assert_eq!(bits(&exported.material.values), bits(&values));
    }
}

proptest! {
    #![proptest_config(cases(32))]

    #[test]
    fn exports_are_files_that_are_read(name in name(), m in 0.01..1.0f64, rho_d in 0.01..1.0f64) {
        let material = Material::paper([rho_d, 1.0, 0.0, m, 1.5, 0.0]);
        let model = Model { name: name.clone(), origin: plain(&name).into_owned(), ..Model::of_params(material) };
        let options = ReadOptions { drop_invalid: true, ..ReadOptions::default() };
        for text in [zemax::write(&model), bird::write(&model)] {
            let scans = input::parse("export", text.as_bytes(), &options).unwrap();
            for sample in scans[0].samples.iter().step_by(97) {
                let exact = model.f(sample.theta_i, sample.theta_s, sample.delta_phi);
                // Ten digits are written, and angles in degrees.
                prop_assert!((sample.brdf / exact - 1.0).abs() < 1e-6, "{} {}", sample.brdf, exact);
            }
        }
    }

    #[test]
    fn simulated_scans_keep_every_bit(
        theta_i in vec(0.0..89.0f64, 1..4),
        theta_s in vec(-89.0..89.0f64, 1..20),
        noise in 0.0..0.5f64,
    ) {
        let list = |angles: &[f64]| angles.iter().map(|&x| shortest(x)).collect::<Vec<_>>().join(",");
        let noise = shortest(noise);
        let text = succeed(&[
            "simulate", "--theta-i", &list(&theta_i), "--theta-s", &list(&theta_s), "--rho-d", "0.1", "--noise", &noise,
        ]);
        let written: Vec<Vec<f64>> = text.lines().skip(1).map(|row| row.split(',').map(|x| x.parse().unwrap()).collect()).collect();
        let options = ReadOptions { angles: Some(brdfit::input::units::Angles::Deg), ..ReadOptions::default() };
        let scan = input::parse("scan", text.as_bytes(), &options).unwrap().remove(0);
        prop_assert_eq!(scan.samples.len(), written.len());
        for (sample, row) in scan.samples.iter().zip(&written) {
            prop_assert_eq!([sample.theta_i, sample.theta_s], [row[0].to_radians(), row[1].to_radians()]);
            prop_assert_eq!(sample.brdf.to_bits(), row[2].to_bits());
        }
    }
}
