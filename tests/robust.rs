//! A robust fit of scans with occluded and chopped samples comes near to the fit of the cleaned ones.

use brdfit::engine::{self, FitOptions, Outcome};
use brdfit::input::{self, Measurement, ReadOptions};
use brdfit_core::geometry::Sample;
use brdfit_suite::scan::{data, left_out, shared};
use brdfit_suite::tolerance::{self, check};

fn read(path: &std::path::Path, options: &ReadOptions) -> Measurement {
    let bytes = std::fs::read(path).expect("a readable file");
    let scans = input::parse("scan", &bytes, options);
    scans.unwrap_or_else(|error| panic!("{error}")).remove(0)
}

fn fit(samples: &[Sample<f64>], robust: bool) -> Outcome {
    let options = FitOptions {
        robust,
        ..FitOptions::default()
    };
    engine::fit(samples, &options).expect("a valid scan")
}

/// Root of the mean squared difference of two fitted curves in ln f, at these samples.
fn apart(samples: &[Sample<f64>], a: &Outcome, b: &Outcome) -> f64 {
    let squares = samples.iter().map(|sample| {
        let ln_f = |outcome: &Outcome| outcome.material().ln_f(sample).expect("valid angles");
        let difference = ln_f(a) - ln_f(b);
        difference * difference
    });
    (squares.sum::<f64>() / samples.len() as f64).sqrt()
}

#[test]
fn outliers_of_a_synthetic_scan_are_found() {
    let clean = read(&data("testdata1_sym_seed1.csv"), &ReadOptions::default()).samples;
    let mut dirty = clean.clone();
    // A window like that of a detector in the beam, and a few glints.
    let spoilt: Vec<usize> = (36..46).chain([100, 130, 160]).collect();
    for &k in &spoilt {
        dirty[k].brdf *= if k < 50 { 0.05 } else { 20.0 };
    }
    let without: Vec<_> = (0..clean.len())
        .filter(|k| !spoilt.contains(k))
        .map(|k| clean[k])
        .collect();
    let (wanted, found, plain) = (fit(&without, false), fit(&dirty, true), fit(&dirty, false));
    let robust = found.robust.as_ref().expect("what was left out");
    assert_eq!(
        (&robust.outliers, found.params, found.samples),
        (&spoilt, wanted.params, without.len())
    );
    assert!(apart(&clean, &plain, &wanted) > 0.1);
    // Where there are no outliers nothing is left out.
    let same = fit(&clean, true);
    assert_eq!(
        (same.params, same.robust.expect("a scale").outliers),
        (fit(&clean, false).params, vec![])
    );
}

#[test]
fn raw_scans_come_near_to_the_cleaned_ones() {
    let cases = [
        ("rt300s_aeroglaze_z307_run1", tolerance::ROBUST_AEROGLAZE),
        ("rt300s_magic_black", tolerance::ROBUST_MAGIC),
        ("rt300s_singularity_black_run1", tolerance::ROBUST_SINGULARITY),
    ];
    let dropping = ReadOptions {
        drop_invalid: true,
        ..ReadOptions::default()
    };
    for (name, tolerance) in cases {
        let (clean, raw) = (
            shared(&format!("real/{name}.csv")),
            shared(&format!("real/raw/{name}.csv")),
        );
        if !raw.exists() {
            left_out(name, &raw);
            continue;
        }
        let (clean, raw) = (read(&clean, &dropping).samples, read(&raw, &dropping).samples);
        let (wanted, found, plain) = (fit(&clean, false), fit(&raw, true), fit(&raw, false));
        let (robust, least_squares) = (apart(&clean, &found, &wanted), apart(&clean, &plain, &wanted));
        println!("{name}: {} of {} left out; ", raw.len() - found.samples, raw.len());
        println!("  curve off by {robust:.4}, without --robust {least_squares:.4}");
        println!("  wanted {:?}\n  found  {:?}", wanted.params, found.params);
        check(robust, tolerance);
        let rho_d = (found.params[0] / wanted.params[0] - 1.0).abs();
        let m = (found.params[3] / wanted.params[3] - 1.0).abs();
        println!("  rho_d off by {rho_d:.4}, m by {m:.4}");
        assert!(tolerance::ROBUST_RHO_D.admits(rho_d) && tolerance::ROBUST_M.admits(m) && robust < least_squares / 5.0);
    }
}

#[test]
fn masks_make_the_satellite_panel_what_its_cleaning_made_it() {
    // The model misses this scan by a factor of two and more, so no residual tells its chopped edge from the rest.
    let (clean, raw) = (
        shared("real/starlink_v15_chassis.csv"),
        shared("real/raw/starlink_v15_chassis.csv"),
    );
    if !raw.exists() {
        return left_out("masks of a raw scan", &raw);
    }
    let masked = ReadOptions {
        max_angle: Some(85.0),
        ..ReadOptions::default()
    };
    let (clean, masked) = (
        read(&clean, &ReadOptions::default()).samples,
        read(&raw, &masked).samples,
    );
    assert_eq!(clean, masked);
    // Nor is there a mask that --mask-retro could not make.
    for name in [
        "rt300s_aeroglaze_z307_run1",
        "rt300s_magic_black",
        "rt300s_singularity_black_run1",
    ] {
        let masked = ReadOptions {
            mask_retro: Some(6.0),
            drop_invalid: true,
            ..ReadOptions::default()
        };
        let raw = read(&shared(&format!("real/raw/{name}.csv")), &masked).samples;
        assert_eq!(read(&shared(&format!("real/{name}.csv")), &masked).samples, raw);
    }
}
