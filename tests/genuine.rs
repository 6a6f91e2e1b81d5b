//! Genuine files of instruments and databases, against tables that others made of them.

use std::fs;
use std::path::Path;

use brdfit::input::{self, Measurement, ReadOptions};
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use brdfit_suite::scan::{left_out, number, rows, shared};
use brdfit_suite::tolerance::{self, check};

/// Reads a genuine file, if it is there.
fn genuine(name: &str, options: &ReadOptions) -> Option<Vec<Measurement>> {
    let path = shared(name);
    if !path.exists() {
        left_out(name, &path);
        return None;
    }
    let bytes = fs::read(&path).expect("a readable file");
    Some(input::parse(name, &bytes, options).unwrap_or_else(|error| panic!("{error}")))
}

fn dropping() -> ReadOptions {
    ReadOptions {
        drop_invalid: true,
        ..ReadOptions::default()
    }
}

/// The samples in plane of a scan at each row of a table of theta_i, theta_s in degrees and BRDF: how many were found within 1e-4 degrees, and the relative differences.
fn compare(scan: &[Sample<f64>], table: &Path) -> (usize, Vec<f64>) {
    let table = rows(table);
    let differences = table.iter().filter_map(|row| {
        let [theta_i, theta_s, brdf] = std::array::from_fn(|k| number(&row[k]));
        let near = |a: f64, b: f64| (a - b.to_radians()).abs() < 2e-6;
        let in_plane = |sample: &&Sample<f64>| {
            let forward = sample.delta_phi == f64::PI;
            let signed = if forward { sample.theta_s } else { -sample.theta_s };
            (forward || sample.delta_phi == 0.0) && near(sample.theta_i, theta_i) && near(signed, theta_s)
        };
        Some(scan.iter().find(in_plane)?.brdf / brdf - 1.0)
    });
    let differences: Vec<f64> = differences.collect();
    (table.len() - differences.len(), differences)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn genuine_files_agree_with_tables_made_of_them() {
    // Red of the garnet paint: the table has its plane of incidence, with six digits.
    if let Some(scans) = genuine("formats/garnet_red_RGB.astm", &dropping()) {
        let counts: Vec<usize> = scans.iter().map(|scan| scan.samples.len()).collect();
        assert_eq!(counts, [1438, 1311, 1344]);
        let (missing, differences) = compare(&scans[0].samples, &shared("real/cornell_garnet_red_R.csv"));
        assert_eq!(missing, 0);
        let largest = differences.into_iter().map(f64::abs).fold(0.0, f64::max);
        check(largest, tolerance::GARNET_TABLE);
    }
    if let Some(scans) = genuine("formats/starlink_v15_chassis_lumos.csv", &dropping()) {
        let (missing, differences) = compare(&scans[0].samples, &shared("real/raw/starlink_v15_chassis.csv"));
        assert_eq!(missing, 0);
        let largest = differences.into_iter().map(f64::abs).fold(0.0, f64::max);
        assert!(tolerance::LUMOS_TABLE.admits(largest));
    }
    // These two were averaged and smoothed by their makers: the middle of the differences is small.
    if let Some(scans) = genuine("formats/aeroglaze_z307_inplane_fred.txt", &dropping()) {
        let (missing, differences) = compare(&scans[0].samples, &shared("real/rt300s_aeroglaze_z307_run1.csv"));
        let middle = median(differences.iter().map(|x| x.abs()).collect());
        println!("FRED: {missing} missing, median difference {middle:.3}");
        assert_eq!(missing, 0);
        check(middle, tolerance::FRED_SMOOTHED);
    }
    if let Some(scans) = genuine("formats/AnoBlackEC1onAlum.bsdf", &ReadOptions::default()) {
        let (missing, differences) = compare(&scans[0].samples, &shared("real/rt300s_anoblack_ec1_al6061.csv"));
        let middle = median(differences.iter().map(|x| x.abs()).collect());
        println!(
            "Zemax: {missing} missing of {}, median difference {middle:.3}",
            missing + differences.len()
        );
        assert!(differences.len() > 50);
        check(middle, tolerance::ZEMAX_AVERAGED);
    }
    if let Some(scans) = genuine("formats/bird_example.brdf", &ReadOptions::default()) {
        let names: Vec<_> = scans.iter().filter_map(|scan| scan.name.as_deref()).collect();
        assert_eq!(
            (names.len(), names[0], names[1]),
            (8, "550 nm 1 1 0 0", "550 nm 1 -1 0 0")
        );
        let sample = scans[7].samples[0];
        assert_eq!(
            (sample.theta_i, sample.theta_s, sample.brdf),
            (0.0, 10f64.to_radians(), 0.301)
        );
    }
    if let Some(scans) = genuine("formats/BrownVinyl_zemax_format_sample.bsdf", &ReadOptions::default()) {
        assert_eq!((scans.len(), scans[0].samples.len()), (1, 640));
    }
}
