//! `brdfit simulate`, called in this process, and the fit of what it writes.

use brdfit_suite::program::{self, SCENE, fail, scene, succeed};
use brdfit_suite::tolerance::{self, check};
use serde_json::Value;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn a_simulated_scan_gives_back_its_parameters() {
    let (_folder, file) = scene();
    let found = json(&succeed(&["fit", &file, "--format", "json"]));
    let truth = [
        ("rho_d", 0.1),
        ("rho_s", 10.0),
        ("rho_v", 0.01),
        ("m", 0.1),
        ("n", 3.0),
        ("kappa", 1.0),
    ];
    let errors = truth.map(|(name, value)| (found["parameters"][name].as_f64().unwrap() / value - 1.0).abs());
    check(errors.into_iter().fold(0.0, f64::max), tolerance::IDEAL_PRINTED);
    check(found["rms_ln"].as_f64().unwrap(), tolerance::IDEAL_RMS);
}

#[test]
fn fit_reads_all_that_simulate_writes() {
    let out_of_plane = [
        &SCENE[..],
        &["--delta-phi", "0,90,180", "--noise", "0.1", "--noise-kind", "pos"],
    ]
    .concat();
    for arguments in [&[&SCENE[..], &["--ln"]].concat(), &out_of_plane] {
        let scan = succeed(arguments);
        let ran = program::brdfit(&["fit", "-", "--format", "json"], scan.as_bytes());
        assert_eq!((ran.code, ran.errors.as_str()), (0, ""));
        let found = json(&ran.output);
        assert_eq!(found["file"], "-");
        assert_eq!(found["samples"], scan.lines().count() - 1);
        assert!(tolerance::PIPED_RMS.admits(found["rms_ln"].as_f64().unwrap()));
    }
}

#[test]
fn noise_is_seeded_and_within_its_range() {
    let noisy = |kind: &str, seed: &str| {
        succeed(&[&SCENE[..], &["--noise", "0.1", "--noise-kind", kind, "--seed", seed]].concat())
    };
    let values = |scan: &str| -> Vec<f64> {
        let rows = scan.lines().skip(1);
        rows.map(|row| row.rsplit(',').next().unwrap().parse().unwrap())
            .collect()
    };
    assert_eq!(noisy("sym", "1"), noisy("sym", "1"));
    assert_ne!(noisy("sym", "1"), noisy("sym", "2"));
    let clean = values(&succeed(&SCENE));
    for (kind, least) in [("sym", 0.9), ("pos", 1.0)] {
        let factors = values(&noisy(kind, "1"))
            .into_iter()
            .zip(&clean)
            .map(|(noisy, clean)| noisy / clean);
        let factors: Vec<f64> = factors.collect();
        assert!(
            factors
                .iter()
                .all(|&factor| tolerance::PRINTED.admits(least - factor) && tolerance::PRINTED.admits(factor - 1.1)),
            "{kind}"
        );
        assert!(factors.iter().any(|&factor| factor < least + 0.02) && factors.iter().any(|&factor| factor > 1.08));
    }
}

#[test]
fn simulate_refuses_what_has_no_brdf() {
    let cases: [(&[&str], &str); 7] = [
        (&["--theta-i", "30", "--theta-s", "-90:90:1", "--rho-d", "1"], "horizon"),
        (&["--theta-i", "-5", "--theta-s", "0", "--rho-d", "1"], "horizon"),
        (
            &["--theta-i", "30", "--theta-s", "0:1", "--rho-d", "1"],
            "start:stop:step",
        ),
        (&["--theta-i", "30", "--theta-s", "0"], "0 everywhere"),
        (
            &["--theta-i", "30", "--theta-s", "0", "--rho-d", "-1"],
            "rho_d cannot be -1",
        ),
        (
            &["--theta-i", "30", "--theta-s", "0", "--rho-d", "1", "--noise", "1"],
            "noise",
        ),
        (
            &["--theta-i", "30", "--theta-s", "-80", "--rho-s", "1", "--m", "0.005"],
            "use --ln",
        ),
    ];
    for (options, what) in cases {
        let message = fail(&[&["simulate"], options].concat());
        assert!(message.contains(what), "{message}");
    }
}
