//! Joint fits and the commands take what is known, or refuse it.

use super::angles::averaged;
use super::{PLACE_M, PLACE_N, dielectric, grid, json, noisy, options};
use brdfit::analysis::bootstrap::Noise;
use brdfit::analysis::joint;
use brdfit::engine::{Material, Prior};
use brdfit::instrument::ENERGY;
use brdfit_core::geometry::Sample;
use brdfit_suite::program::{brdfit, fail, succeed, write};
use tempfile::TempDir;

#[test]
fn joint_fits_take_part() {
    let material = Material::paper([0.05, 3.0, 0.0, 0.02, 1.5, 0.0]);
    let half_angle = 2.15f64.to_radians();
    let seen = |seed: u64| {
        let mut samples = grid(&[30.0], 2, 80);
        for (place, sample) in samples.iter_mut().enumerate() {
            let noise = 0.01 * Noise::new(seed, place as u64).normal();
            sample.brdf = (averaged(&material, sample, half_angle) + noise).exp();
        }
        samples
    };
    let (a, b) = (seen(1), seen(2));
    let wanted = options(|options| {
        options.instrument.aperture = half_angle;
        options.instrument.scale_uncertainty = 0.03;
        options.instrument.priors[PLACE_N] = Some(Prior { mean: 1.5, sigma: 0.01 });
        options.instrument.limit = Some(ENERGY);
    });
    let shared: Vec<bool> = (0..6).map(|place| place >= PLACE_M).collect();
    let fits = joint::fit(&[&a, &b], &[(wanted, shared)], None).unwrap();
    let (fitted, errors) = (&fits.best().fitted, &fits.best().known.errors);
    assert!(
        (fitted.scans[0][PLACE_M] / 0.02 - 1.0).abs() < 0.01,
        "{:?}",
        fitted.scans
    );
    // A prior of a shared parameter counts once.
    let error = errors[0][PLACE_N].expect("n is known");
    assert!((error / 0.01 - 1.0).abs() < 0.02, "{error}");
    let rho_d = errors[0][0].expect("rho_d is known") / fitted.scans[0][0];
    assert!((0.03..0.04).contains(&rho_d), "{rho_d}");
}

/// All that can be known of an instrument.
const ALL: [&str; 9] = [
    "--terms",
    "diffuse,surface",
    "--prior",
    "n=1.50+-0.02",
    "--aperture-half-angle",
    "0.5",
    "--scale-uncertainty",
    "3%",
    "--conserve-energy",
];

/// A command line with all of it.
fn with_all<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    [arguments, &ALL].concat()
}

/// A scan whose detector is off by half a degree.
fn scan(folder: &TempDir) -> String {
    scan_by(folder, 4)
}

/// The same with a sample each so many degrees.
fn scan_by(folder: &TempDir, step: usize) -> String {
    let samples = noisy(&dielectric(), &grid(&[20.0, 40.0], step, 80), 0.02, 5);
    let row = |sample: &Sample<f64>| {
        let (theta_i, theta_s) = (sample.theta_i.to_degrees(), sample.theta_s.to_degrees() + 0.5);
        format!("{theta_i},{theta_s},{}\n", sample.brdf)
    };
    let table: String = samples.iter().map(row).collect();
    write(
        folder,
        "scan.csv",
        format!("theta_i_deg,theta_s_deg,brdf_per_sr\n{table}"),
    )
}

#[test]
fn fit_and_batch_honour_all() {
    let folder = TempDir::new().unwrap();
    let file = scan(&folder);
    let fit = json(&with_all(&["fit", &file, "--fit-offset"]));
    let beside = &fit["provenance"]["instrument"];
    assert_eq!(beside["priors"]["n"], serde_json::json!([1.5, 0.02]));
    assert_eq!(
        (&beside["fit_offset"], &beside["conserve_energy"]),
        (&true.into(), &true.into())
    );
    assert_eq!(
        (&beside["aperture_half_angle_deg"], &beside["scale_uncertainty"]),
        (&0.5.into(), &0.03.into())
    );
    assert!((fit["offset_deg"].as_f64().unwrap() - 0.5).abs() < 0.3);
    assert!((fit["parameters"]["n"].as_f64().unwrap() - 1.5).abs() < 0.05);
    let out = folder.path().join("results.csv");
    let ran = brdfit(
        &with_all(&["batch", &file, "--fit-offset", "--out", out.to_str().unwrap()]),
        b"",
    );
    assert_eq!(ran.code, 0, "{}", ran.errors);
    let results = std::fs::read_to_string(&out).unwrap();
    let cell = |name: &str| {
        let mut lines = results.lines();
        let place = lines.next()?.split(',').position(|head| head == name)?;
        lines.next()?.split(',').nth(place)?.parse::<f64>().ok()
    };
    assert_eq!(cell("offset_deg"), fit["offset_deg"].as_f64());
}

/// A table of a scan at 30 and 50 degrees whose instrument reads `off` too much: theta_i and theta_s have these signs at each of the two.
fn misread(folder: &TempDir, name: &str, signs: [[f64; 2]; 2], off: f64) -> String {
    let material = Material::paper([0.05, 3.0, 0.0, 0.1, 1.5, 0.0]);
    let mut table = "theta_i_deg,theta_s_deg,brdf_per_sr\n".to_string();
    for (theta_i, [sign_i, sign_s]) in [30.0f64, 50.0].into_iter().zip(signs) {
        for k in -35..=35 {
            let theta_s = 2.0 * f64::from(k);
            let sample = Sample::in_plane(theta_i.to_radians(), theta_s.to_radians(), 1.0);
            let noise = 0.01 * Noise::new(3, (k + 100 + theta_i as i32 * 1000) as u64).normal();
            let f = (material.ln_f(&sample).unwrap() + noise).exp();
            table += &format!("{},{},{f}\n", sign_i * theta_i, sign_s * theta_s + off);
        }
    }
    write(folder, name, table)
}

#[test]
fn texts_tell_what_took_part() {
    let folder = TempDir::new().unwrap();
    let file = scan(&folder);
    let run = |seed: u64| {
        let samples = noisy(&dielectric(), &grid(&[20.0, 40.0], 4, 80), 0.02, seed);
        let row = |sample: &Sample<f64>| {
            let (theta_i, theta_s) = (sample.theta_i.to_degrees(), sample.theta_s.to_degrees() + 0.5);
            format!("{theta_i},{theta_s},{}\n", sample.brdf)
        };
        let table: String = samples.iter().map(row).collect();
        let name = format!("run{seed}.csv");
        write(&folder, &name, format!("theta_i_deg,theta_s_deg,brdf_per_sr\n{table}"))
    };
    let other = run(6);
    let words = ["n = 1.5 +- 0.02", "a calibration known to 3.0 % is part of the errors"];
    for command in [
        &["profile", file.as_str(), "--parameter", "m"][..],
        &["joint", &file, &other],
    ] {
        let page = succeed(
            &[
                command,
                &[
                    "--terms",
                    "diffuse,surface",
                    "--prior",
                    "n=1.50+-0.02",
                    "--scale-uncertainty",
                    "3%",
                    "--robust",
                ],
            ]
            .concat(),
        );
        for words in words.iter().chain(&["robust  "]) {
            assert!(page.contains(words), "{words}: {page}");
        }
    }
    let page = succeed(&[
        "profile",
        &file,
        "--parameter",
        "m",
        "--terms",
        "diffuse,surface",
        "--fix",
        "n=1.5",
        "--fit-offset",
    ]);
    assert!(page.contains("offset     theta_s reads 0."), "{page}");
    let runs = [
        "joint",
        "--repeats",
        &file,
        &other,
        "--terms",
        "diffuse,surface",
        "--fix",
        "n=1.5",
        "--fit-offset",
    ];
    let page = succeed(&runs);
    assert_eq!(page.matches("offset   theta_s reads 0.").count(), 2, "{page}");
    for run in json(&runs)["runs"].as_array().unwrap() {
        let number = |name: &str| run[name].as_f64().unwrap();
        assert!(
            (number("offset_deg") - 0.5).abs() < 4.0 * number("offset_stderr_deg"),
            "{run}"
        );
    }
}

#[test]
fn an_offset_is_that_of_theta_s_in_the_file() {
    let folder = TempDir::new().unwrap();
    let fixed = ["--terms", "diffuse,surface", "--fix", "n=1.5", "--fit-offset"];
    let usual = misread(&folder, "usual.csv", [[1.0, 1.0]; 2], 2.0);
    let forward_negative = misread(&folder, "negative.csv", [[1.0, -1.0]; 2], 2.0);
    let negative_theta_i = misread(&folder, "turned.csv", [[-1.0, -1.0]; 2], 2.0);
    for (file, more) in [
        (&usual, &[][..]),
        (&forward_negative, &["--forward", "negative"]),
        (&negative_theta_i, &[]),
    ] {
        let arguments = [&["fit", file.as_str()], &fixed[..], more].concat();
        let page = succeed(&arguments);
        assert!(page.contains("deg too much") && !page.contains("too little"), "{page}");
        let fit = json(&arguments);
        assert!((fit["offset_deg"].as_f64().unwrap() - 2.0).abs() < 0.05, "{fit}");
        let csv = succeed(&[&arguments[..], &["--format", "csv"]].concat());
        let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let place = lines
            .next()
            .unwrap()
            .iter()
            .position(|&head| head == "offset_deg")
            .unwrap();
        let cell: f64 = lines.next().unwrap()[place].parse().unwrap();
        assert_eq!(Some(cell), fit["offset_deg"].as_f64());
    }
    // One axis that is off cannot be so in both senses.
    let both = misread(&folder, "both.csv", [[1.0, 1.0], [-1.0, -1.0]], 2.0);
    let said = fail(&[&["fit", both.as_str()], &fixed[..]].concat());
    assert!(said.contains("one offset cannot be both"), "{said}");
    succeed(&["fit", &both, "--terms", "diffuse,surface"]);
}

/// At one angle of incidence the shape of a wide lobe and an offset stand for each other along a curve of fits that are as good: the fit of this scan is at an offset of -1.6 degrees, where the instrument reads 2 too much.
#[test]
fn an_offset_at_one_angle_of_incidence_is_not_told_by_a_wide_lobe() {
    let folder = TempDir::new().unwrap();
    let of = |m: f64, n: f64, rho_s: f64, copy: u64| {
        let material = Material::paper([0.1, rho_s, 0.0, m, n, 0.0]);
        let mut table = "theta_i_deg,theta_s_deg,brdf_per_sr\n".to_string();
        for k in -35..=35 {
            let theta_s = 2.0 * f64::from(k);
            let sample = Sample::in_plane(40f64.to_radians(), theta_s.to_radians(), 1.0);
            let noise = 0.01 * Noise::new(copy, (k + 100) as u64).normal();
            table += &format!(
                "40,{},{}\n",
                theta_s + 2.0,
                (material.ln_f(&sample).unwrap() + noise).exp()
            );
        }
        json(&["fit", &write(&folder, "one.csv", table), "--fit-offset"])
    };
    let mut told = 0;
    for copy in 0..4 {
        let fit = of(0.3, 1.98, 3.0, copy);
        if let Some(offset) = fit["offset_deg"].as_f64() {
            let error = fit["offset_stderr_deg"].as_f64().unwrap();
            assert!((offset - 2.0).abs() < 3.0 * error, "{offset} +- {error}");
            told += usize::from(error < 0.5);
        }
    }
    assert_eq!(told, 0);
}

#[test]
fn an_offset_that_nothing_tells_has_no_number() {
    let folder = TempDir::new().unwrap();
    let row = |k: i32| format!("30,{},{}\n", 2 * k, 0.1 + 0.001 * f64::from(k.rem_euclid(3)));
    let table: String = (-35..=35).map(row).collect();
    let file = write(
        &folder,
        "flat.csv",
        format!("theta_i_deg,theta_s_deg,brdf_per_sr\n{table}"),
    );
    let flat = ["fit", &file, "--terms", "diffuse", "--fit-offset"];
    assert!(succeed(&flat).contains("\n  offset     not determined"));
    let fit = json(&flat);
    assert!(
        fit["offset_deg"].is_null() && fit["offset_stderr_deg"].is_null(),
        "{fit}"
    );
}

#[test]
fn text_and_report_honour_all() {
    let folder = TempDir::new().unwrap();
    let file = scan(&folder);
    let text = succeed(&with_all(&["fit", &file, "--fit-offset"]));
    for word in ["offset", "priors", "aperture", "scale", "energy"] {
        assert!(text.contains(&format!("\n  {word} ")), "{word}\n{text}");
    }
    // Without any of it nothing is said of it.
    assert!(json(&["fit", &file])["provenance"]["instrument"].is_null());
    let page = brdfit(&with_all(&["report", &file, "--fit-offset"]), b"");
    assert!(
        page.code == 0
            && page.output.contains("averaged over a half-angle of 0.5 deg")
            && page.output.contains("offset_deg")
    );
}

#[test]
fn profiles_honour_all() {
    let folder = TempDir::new().unwrap();
    let file = scan_by(&folder, 8);
    let profile = json(&with_all(&["profile", &file, "--parameter", "n"]));
    let interval = &profile["parameters"][0]["intervals"][1];
    let (low, high) = (interval["low"].as_f64().unwrap(), interval["high"].as_f64().unwrap());
    assert!(1.35 < low && low < high && high < 1.55, "{interval}");
    let parts = [
        "--terms",
        "diffuse,surface",
        "--prior",
        "n=1.50+-0.02",
        "--fit-offset",
        "--bootstrap",
        "20",
    ];
    let shifted = json(&[&["profile", &file, "--parameter", "m"], &parts[..]].concat());
    let interval = &shifted["parameters"][0]["intervals"][1];
    assert!(
        interval["low"].as_f64() < Some(0.15) && interval["high"].as_f64() > Some(0.15),
        "{interval}"
    );
}

#[test]
fn joint_honours_all() {
    let folder = TempDir::new().unwrap();
    let file = scan(&folder);
    let joint = json(&with_all(&["joint", &file, &file, "--share", "m,n"]));
    assert!((joint["scans"][0]["parameters"]["n"].as_f64().unwrap() - 1.5).abs() < 0.05);
}

#[test]
fn what_cannot_be_honoured_is_refused() {
    let folder = TempDir::new().unwrap();
    let file = scan(&folder);
    for (bad, word) in [
        (&["joint", &file, &file, "--fit-offset"][..], "--fit-offset"),
        (&["fit", &file, "--fit-offset", "--robust"], "--robust"),
        (
            &["fit", &file, "--aperture-half-angle", "1", "--precision", "f32"],
            "f32",
        ),
        (&["fit", &file, "--prior", "n=1.5+-0.1", "--fix", "n=1.5"], "fixed"),
        (&["fit", &file, "--prior", "x=1.5+-0.1"], "x"),
        (&["profile", &file, "--fit-offset", "--calibrate", "20"], "--fit-offset"),
    ] {
        let message = fail(bad);
        assert!(message.contains(word), "{message}");
    }
}
