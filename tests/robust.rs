//! A robust fit of scans with occluded and chopped samples comes near to the fit of the cleaned ones.

use brdfit::analysis::bootstrap::{Noise, copy};
use brdfit::engine::{self, FitOptions, Material, Outcome};
use brdfit::input::{self, Measurement, ReadOptions};
use brdfit_core::brdf::{ALL, DIFFUSE};
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use brdfit_suite::program::{brdfit, write};
use brdfit_suite::scan::{data, left_out, shared};
use brdfit_suite::tolerance::{self, check};
use serde_json::Value;

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
    assert_eq!((&robust.outliers, found.samples), (&spoilt, without.len()));
    check(apart(&clean, &found, &wanted), tolerance::ROBUST_SAME);
    assert!(apart(&clean, &plain, &wanted) > 0.1);
    // Where there are no outliers nothing is left out.
    let same = fit(&clean, true);
    assert_eq!(
        (same.params, same.robust.expect("a scale").outliers),
        (fit(&clean, false).params, vec![])
    );
}

/// A joint fit is that of the scans without what the robust fit of each alone leaves out.
#[test]
fn joint_fits_leave_outliers_out() {
    let folder = tempfile::tempdir().unwrap();
    let table = std::fs::read_to_string(data("testdata1_sym_seed1.csv")).unwrap();
    let spoilt = [100, 130, 160];
    let dirty = table.lines().enumerate().map(|(line, row)| match row.rsplit_once(',') {
        Some((angles, brdf)) if spoilt.contains(&line) => format!("{angles},{}\n", 20.0 * brdf.parse::<f64>().unwrap()),
        _ => format!("{row}\n"),
    });
    let dirty = write(&folder, "dirty.csv", dirty.collect::<String>());
    let cut = table.lines().enumerate().filter(|(line, _)| !spoilt.contains(line));
    let cut = write(
        &folder,
        "cut.csv",
        cut.map(|(_, row)| format!("{row}\n")).collect::<String>(),
    );
    let other = data("testdata1_sym_seed2.csv").display().to_string();
    let joint = |file: &str, more: &[&str]| -> Value {
        let ran = brdfit(&[&["joint", file, &other, "--format", "json"], more].concat(), b"");
        assert_eq!(ran.code, 0, "{}", ran.errors);
        serde_json::from_str(&ran.output).expect("JSON")
    };
    let (robust, wanted) = (joint(&dirty, &["--robust"]), joint(&cut, &[]));
    assert_eq!(robust["cost"], wanted["cost"]);
    assert_eq!(robust["scans"][0]["parameters"], wanted["scans"][0]["parameters"]);
    assert_eq!(robust["scans"][0]["left_out"][0]["samples"], spoilt.len());
    assert_ne!(joint(&dirty, &[])["cost"], wanted["cost"]);
    let text = brdfit(&["joint", &dirty, &other, "--robust"], b"").output;
    assert!(text.contains("    left out 3 samples: 3 far from the fit"), "{text}");
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

/// Uniform in 0 to 1.
fn unit(seed: u64, place: usize) -> f64 {
    Noise::new(seed, place as u64).unit()
}

/// A rough dielectric with noise of 5 %, of which each seed is another.
fn scene(seed: u64) -> (Material, Vec<Sample<f64>>) {
    let between = |place: usize, low: f64, high: f64| low + (high - low) * unit(seed, place);
    let material = Material::paper([
        between(1, 0.03, 0.3),
        between(2, 0.5, 3.0),
        0.0,
        between(3, 0.08, 0.3),
        between(4, 1.3, 2.0),
        0.0,
    ]);
    let theta_i = between(5, 10.0, 50.0).round().to_radians();
    let grid: Vec<Sample<f64>> = (-85..=85)
        .map(|theta_s| Sample::in_plane(theta_i, f64::from(theta_s).to_radians(), 1.0))
        .collect();
    (material, copy(&grid, &material, 0.05, &mut Noise::new(seed, 99)))
}

/// Root of the mean squared difference of ln f from the truth.
fn off(samples: &[Sample<f64>], found: &Outcome, truth: &Material) -> f64 {
    let squares = samples.iter().map(|sample| {
        let difference = found.material().ln_f(sample).unwrap() - truth.ln_f(sample).unwrap();
        difference * difference
    });
    (squares.sum::<f64>() / samples.len() as f64).sqrt()
}

#[test]
fn many_outliers_do_not_draw_the_fit() {
    // What is spoilt, by which factor: 30 % on one side, above or below, and a block of 20 %.
    type Spoils = fn(u64, usize, f64) -> f64;
    let kinds: [(&str, Spoils); 4] = [
        ("30 % above", |seed, place, part| {
            if unit(seed + 100, place) < 0.3 {
                1.5 * Real::portable_exp(2.7 * part)
            } else {
                1.0
            }
        }),
        ("30 % below", |seed, place, part| {
            if unit(seed + 200, place) < 0.3 {
                Real::portable_exp(-2.7 * part) / 1.5
            } else {
                1.0
            }
        }),
        ("a bright block", |_, place, part| {
            if (10..44).contains(&place) {
                3.0 + 6.0 * part
            } else {
                1.0
            }
        }),
        ("a dark block", |_, place, part| {
            if (10..44).contains(&place) {
                0.05 + 0.1 * part
            } else {
                1.0
            }
        }),
    ];
    let mut worst = 0.0f64;
    for (kind, spoils) in kinds {
        for seed in 0..5 {
            let (truth, clean) = scene(seed);
            let mut dirty = clean.clone();
            for (place, sample) in dirty.iter_mut().enumerate() {
                sample.brdf *= spoils(seed, place, unit(seed + 300, place));
            }
            let (found, wanted) = (fit(&dirty, true), fit(&clean, false));
            let (found_off, clean_off) = (off(&clean, &found, &truth), off(&clean, &wanted, &truth));
            println!("{kind}, seed {seed}: off by {found_off:.4}, clean {clean_off:.4}");
            worst = worst.max(found_off);
        }
    }
    check(worst, tolerance::ROBUST_TRUTH);
}

#[test]
fn a_scan_with_outliers_has_the_same_fit_each_time() {
    let (_, mut samples) = scene(3);
    for place in (0..samples.len()).step_by(5) {
        samples[place].brdf *= 7.0;
    }
    let one = fit(&samples, true);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert_eq!(pool.install(|| fit(&samples, true)), one);
    assert!(one.robust.unwrap().outliers.len() >= 30);
}

#[test]
fn a_narrow_lobe_is_no_outlier() {
    // Seven samples of a lobe, in a scan whose rough ground no fit with it meets, and which is shaded at its ends.
    let truth = Material::paper([0.8, 0.2, 0.0, 0.02, 1.5, 0.0]);
    for seed in 0..3 {
        let mut noise = Noise::new(7, seed);
        let mut samples = Vec::new();
        for delta_phi in (0..=180).step_by(10) {
            for theta_s in (0..=88).step_by(2) {
                let (theta_s, delta_phi) = (f64::from(theta_s).to_radians(), f64::from(delta_phi).to_radians());
                let mut sample = Sample {
                    delta_phi,
                    ..Sample::in_plane(40f64.to_radians(), theta_s, 1.0)
                };
                let shade = (theta_s.to_degrees() - 74.0).max(0.0) / 6.0;
                let ground = 0.06 * theta_s * theta_s;
                sample.brdf = Real::portable_exp(truth.ln_f(&sample).unwrap() + 0.01 * noise.normal() - ground - shade);
                samples.push(sample);
            }
        }
        let found = fit(&samples, true);
        let m = found.value("m").unwrap();
        println!(
            "seed {seed}: m {m:.5}, {} left out",
            found.robust.unwrap().outliers.len()
        );
        assert!((m / 0.02 - 1.0).abs() < 0.03);
    }
}

#[test]
fn the_cases_with_outliers_are_right() {
    let case = |name: &str| shared(&format!("cases/fit/{name}.csv"));
    let (lobe, many) = (case("f08_robust_drops_lobe"), case("robust30"));
    if !lobe.exists() {
        return left_out("cases of robust fits", &lobe);
    }
    let dropping = ReadOptions {
        drop_invalid: true,
        ..ReadOptions::default()
    };
    let found = fit(&read(&lobe, &dropping).samples, true);
    assert!((found.value("m").unwrap() - 0.02).abs() < 5e-4, "{:?}", found.params);
    let samples = read(&many, &dropping).samples;
    let found = fit(&samples, true);
    let outliers = found.robust.as_ref().unwrap().outliers.len();
    println!("{outliers} of {} left out, rms {:.4}", samples.len(), found.rms_ln);
    assert!((48..=54).contains(&outliers) && found.rms_ln < 0.055);
}

#[test]
fn clean_small_scans_are_left_alone() {
    let mut left_out = 0;
    const SCANS: u64 = 60;
    for seed in 0..SCANS {
        let (truth, _) = scene(seed);
        for count in [7usize, 8, 9] {
            let grid: Vec<Sample<f64>> = (0..count)
                .map(|k| Sample::in_plane(0.5, -1.2 + 2.4 * k as f64 / (count - 1) as f64, 1.0))
                .collect();
            let samples = copy(&grid, &truth, 0.05, &mut Noise::new(seed, count as u64));
            let grey = copy(
                &grid,
                &Material::paper([0.3, 0.0, 0.0, 1.0, 1.0, 0.0]),
                0.05,
                &mut Noise::new(seed, 50 + count as u64),
            );
            for (samples, terms) in [(&samples, ALL), (&grey, DIFFUSE)] {
                let options = FitOptions {
                    terms,
                    robust: true,
                    ..FitOptions::default()
                };
                let found = engine::fit(samples, &options).unwrap();
                left_out += found.robust.unwrap().outliers.len();
                // One gross outlier is seen where the others can tell.
                if terms == DIFFUSE && seed < 5 {
                    let mut dirty = samples.clone();
                    dirty[3].brdf *= 10.0;
                    let found = engine::fit(&dirty, &options).unwrap();
                    assert_eq!(found.robust.unwrap().outliers, [3]);
                }
            }
        }
    }
    println!("{left_out} samples left out of {} scans", 6 * SCANS);
    assert_eq!(left_out, 0);
}
