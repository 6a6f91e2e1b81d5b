//! Genuine files of instruments and databases, against tables that others made of them.

use std::collections::BTreeMap;
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

/// The samples in plane at one angle of incidence, by theta_s in whole degrees.
fn in_plane(scan: &Measurement, theta_i: f64) -> BTreeMap<i64, f64> {
    let here = scan
        .samples
        .iter()
        .filter(|sample| (sample.theta_i - theta_i.to_radians()).abs() < 1e-9);
    let signed = here.filter_map(|sample| match sample.delta_phi {
        azimuth if azimuth == f64::PI => Some((sample.theta_s, sample.brdf)),
        0.0 => Some((-sample.theta_s, sample.brdf)),
        _ => None,
    });
    signed
        .map(|(theta_s, brdf)| (theta_s.to_degrees().round() as i64, brdf))
        .collect()
}

#[test]
fn a_material_in_the_forms_of_speos_and_zemax_is_the_same() {
    let options = ReadOptions::default();
    let (speos, zemax) = (
        genuine(
            "formats/test_13_planesymmetric_brdf_speos_reference.anisotropicbsdf",
            &options,
        ),
        genuine("formats/BrownVinyl_zemax_format_sample.bsdf", &options),
    );
    let (Some(speos), Some(zemax)) = (speos, zemax) else {
        return;
    };
    assert_eq!((speos.len(), speos[0].name.as_deref()), (1, None));
    // The form of Speos was made absolute by reflectances that are not in that of Zemax, so each angle of incidence has a factor.
    let (mut worst, mut largest) = (0.0f64, 0.0f64);
    for theta_i in [15.0, 30.0, 50.0, 70.0] {
        let (a, b) = (in_plane(&speos[0], theta_i), in_plane(&zemax[0], theta_i));
        // Towards the horizon the converter has mixed in the zeros below it.
        let both = b.iter().filter(|(theta_s, _)| theta_s.abs() <= 75);
        let ratios: Vec<f64> = both
            .filter_map(|(theta_s, brdf)| Some(a.get(theta_s)? / brdf))
            .collect();
        assert!(ratios.len() >= 12, "{}", ratios.len());
        let factor = median(ratios.clone());
        worst = ratios
            .iter()
            .map(|ratio| (ratio / factor - 1.0).abs())
            .fold(worst, f64::max);
        largest = largest.max((factor - 1.0).abs());
        println!("theta_i {theta_i}: {} directions, factor {factor:.4}", ratios.len());
    }
    check(worst, tolerance::SPEOS_ZEMAX);
    check(largest, tolerance::SPEOS_ZEMAX_FACTOR);
}

#[test]
fn genuine_files_are_read_or_called_by_their_name() {
    if let Some(scans) = genuine("formats/example_material_lidar_brdf.xompt", &ReadOptions::default()) {
        let scan = &scans[0];
        assert_eq!(
            (scans.len(), scan.name.as_deref(), scan.samples.len()),
            (1, Some("905 nm"), 716)
        );
        assert_eq!(scan.left_out.iter().map(|one| one.samples).sum::<usize>(), 189);
    }
    let scattering = shared("formats/Black_Paint.scattering");
    if scattering.exists() {
        let bytes = fs::read(&scattering).expect("a readable file");
        let error = input::parse("x", &bytes, &ReadOptions::default()).unwrap_err();
        assert!(
            error
                .what
                .contains("'OPTIS - Scattering surface file v1.0' is a model of Speos"),
            "{error}"
        );
    } else {
        left_out("Black_Paint.scattering", &scattering);
    }
}
