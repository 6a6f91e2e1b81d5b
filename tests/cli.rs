//! The command line, called in this process: outputs, the JSON contract, and every error as one line with file, line and exit code 2.

use std::fs;
use std::path::{Path, PathBuf};

use brdfit_suite::program::{self, Ran};
use brdfit_suite::tolerance::{self, check};
use serde_json::Value;
use tempfile::TempDir;

fn brdfit(arguments: &[&str]) -> Ran {
    program::brdfit(arguments, b"")
}

/// Runs what must succeed without a word on standard error.
fn succeed(arguments: &[&str]) -> String {
    let ran = brdfit(arguments);
    assert_eq!((ran.code, ran.errors.as_str()), (0, ""), "{arguments:?}");
    ran.output
}

/// Runs what must fail, and gives its one line.
fn fail(arguments: &[&str]) -> String {
    let ran = brdfit(arguments);
    assert_eq!(
        (ran.code, ran.output.as_str()),
        (2, ""),
        "{arguments:?}: {}",
        ran.errors
    );
    assert_eq!(ran.errors.matches('\n').count(), 1, "{}", ran.errors);
    ran.errors
}

fn write(folder: &TempDir, name: &str, contents: impl AsRef<[u8]>) -> String {
    let path = folder.path().join(name);
    fs::write(&path, contents).unwrap();
    text(&path)
}

fn text(path: &Path) -> String {
    path.to_str().unwrap().to_string()
}

const SCENE: [&str; 17] = [
    "simulate",
    "--theta-i",
    "30,60",
    "--theta-s",
    "-80:80:4",
    "--rho-d",
    "0.1",
    "--rho-s",
    "10",
    "--rho-v",
    "0.01",
    "--m",
    "0.1",
    "--n",
    "3",
    "--kappa",
    "1",
];

/// A scan without noise in a new folder.
fn scene() -> (TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let file = write(&folder, "scan.csv", succeed(&SCENE));
    (folder, file)
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn each_error_of_a_file_names_its_place() {
    const HEAD: &str = "# remark\ntheta_i_deg,theta_s_deg,brdf_per_sr\n45,10,0.1\n";
    let long = "1,2,0\n".repeat(100);
    let cases: [(&str, Vec<u8>, &str, &str); 22] = [
        ("empty", vec![], "", "the file is empty"),
        ("remarks", b"# a\n\n# b\n".into(), "", "no header line"),
        ("no_rows", b"theta_i,theta_s,brdf\n\n".into(), "", "no rows"),
        (
            "no_header",
            b"45,-85,0.03\n45,-84,0.03\n".into(),
            ":1",
            "among the columns 45, -85, 0.03",
        ),
        (
            "no_brdf",
            b"#\ntheta_i,theta_s,x\n".into(),
            ":2",
            "no column brdf_per_sr among the columns theta_i, theta_s, x",
        ),
        (
            "twice",
            b"theta_i,theta_s,theta_r,brdf\n".into(),
            ":1:3",
            "more than one column for theta_s",
        ),
        (
            "word",
            format!("{HEAD}\n45,oops,0.1\n").into(),
            ":5:2",
            "'oops' is not a number",
        ),
        (
            "comma",
            b"theta_i;theta_s;brdf\n45;1;0,1\n".into(),
            ":2:3",
            "decimal point",
        ),
        ("hole", format!("{HEAD}45,,0.1\n").into(), ":4:2", "'' is not a number"),
        ("nan", format!("{HEAD}45,10,NaN\n").into(), ":4:3", "--drop-invalid"),
        ("inf", format!("{HEAD}45,10,inf\n").into(), ":4:3", "--drop-invalid"),
        ("nan_angle", format!("{HEAD}nan,10,1\n").into(), ":4:1", "no angle"),
        ("horizon", format!("{HEAD}45,90,0.1\n").into(), ":4:2", "horizon"),
        ("below", format!("{HEAD}45,-91,0.1\n").into(), ":4:2", "horizon"),
        (
            "negative_i",
            format!("{HEAD}-45,10,0.1\n").into(),
            ":4:1",
            "change the signs",
        ),
        (
            "zero",
            format!("{HEAD}45,10,0\n").into(),
            ":4:3",
            "the BRDF is 0, which has no logarithm; use --drop-invalid",
        ),
        (
            "negative",
            format!("{HEAD}45,11,-0.1\n45,12,1\n45,13,0\n").into(),
            ":4:3",
            "2 rows are not valid, on lines 4, 6",
        ),
        (
            "many",
            format!("{HEAD}{long}").into(),
            ":4:3",
            "100 rows are not valid, on lines 4, 5, 6, 7, 8, 9, 10, 11, ...",
        ),
        (
            "ragged",
            format!("{HEAD}45,10\n").into(),
            ":4",
            "the row has 2 cells, the header 3",
        ),
        (
            "few",
            format!("{HEAD}45,11,0.1\n").into(),
            "",
            "2 samples can not determine 6 parameters",
        ),
        ("binary", b"\x89PNG\r\n\x1a\n\0\0\xff\xfe".into(), ":1", "not UTF-8"),
        (
            "latin1",
            b"theta_i,theta_s,brdf\n# Stra\xdfe\n".into(),
            ":2",
            "not UTF-8",
        ),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (name, contents, place, what) in cases {
        let file = write(&folder, &format!("{name}.csv"), contents);
        let message = fail(&["fit", &file]);
        assert!(message.starts_with(&format!("{file}{place}: ")), "{name}: {message}");
        assert!(message.contains(what) && message.contains("; "), "{name}: {message}");
    }
    let directory = text(folder.path());
    assert!(fail(&["fit", &directory]).starts_with(&format!("{directory}: this is a directory; ")));
    let missing = text(&folder.path().join("missing.csv"));
    assert!(fail(&["fit", &missing]).starts_with(&format!("{missing}: no such file; ")));
}

#[test]
fn errors_of_options_are_one_line() {
    let (_folder, file) = scene();
    let cases: [(&[&str], &str); 13] = [
        (&["--bounds", "n=2:1"], "wrong way round"),
        (&["--bounds", "n=1:NaN"], "can not be NaN"),
        (&["--bounds", "n=0.5:2"], "n can not be 0.5"),
        (&["--bounds", "m=0:1"], "m can not be 0"),
        (&["--bounds", "kappa=-1:1"], "kappa can not be -1"),
        (
            &["--bounds", "alpha=0:1"],
            "the parameters are rho_d, rho_s, rho_v, m, n, kappa",
        ),
        (&["--bounds", "n"], "NAME=LO:HI"),
        (&["--fix", "rho_d=-1"], "rho_d can not be -1"),
        (&["--fix", "n=1.5", "--bounds", "n=1:2"], "twice"),
        (
            &["--fix", "kappa=0", "--terms", "diffuse,surface"],
            "no parameter of the terms",
        ),
        (&["--terms", "volume"], "--terms takes one of: "),
        (&["--terms", "gloss"], "no term 'gloss'"),
        (&["--output", "missing/folder/out.json"], "can not be written"),
    ];
    for (options, what) in cases {
        let message = fail(&[&["fit", &file], options].concat());
        assert!(message.contains(what) && message.contains("; "), "{message}");
    }
    assert!(fail(&["fit", "-", "-"]).contains("only once"));
    for usage in [
        &["fit"] as &[&str],
        &["nothing"],
        &["fit", &file, "--starts", "0"],
        &["fit", &file, "--threads", "0"],
    ] {
        assert_eq!(brdfit(usage).code, 2);
    }
}

#[test]
fn help_fits_a_screen_and_its_examples_are_valid() {
    let help = succeed(&["--help"]);
    assert!(help.lines().count() <= 30, "{help}");
    assert!(help.contains("Exit codes: 0 done, 1 "));
    let program = brdfit::cli::command();
    for command in program.get_subcommands().map(clap::Command::get_name) {
        let help = succeed(&[command, "--help"]);
        let (_, examples) = help
            .split_once("\nExample:\n")
            .unwrap_or_else(|| panic!("{command} has no example"));
        assert!(
            examples
                .lines()
                .any(|example| example.starts_with(&format!("  brdfit {command}")))
        );
        for example in examples.lines() {
            // As far as it is for this program, and without what is for the shell.
            let words = example.split(['|', '>']).next().unwrap().replace('\'', "");
            let parsed = program.clone().try_get_matches_from(words.split_whitespace());
            assert!(parsed.is_ok(), "{example}: {}", parsed.unwrap_err());
        }
    }
}

#[test]
fn completions_and_manual_know_every_command() {
    let program = brdfit::cli::command();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = succeed(&["completions", shell]);
        for command in program.get_subcommands().map(clap::Command::get_name) {
            assert!(script.contains(command), "{shell}: {command}");
        }
        assert!(script.contains("drop-invalid"), "{shell}");
    }
    let page = succeed(&["man"]);
    assert!(page.contains(".TH brdfit 1") && page.contains("Exit codes"), "{page}");
    let page = succeed(&["man", "fit"]);
    assert!(
        page.contains(".TH brdfit\\-fit 1") || page.contains(".TH brdfit-fit 1"),
        "{page}"
    );
    assert!(page.contains("drop\\-invalid"));
    assert!(fail(&["man", "woman"]).contains("take one of fit, report, batch"));
}

#[test]
fn quiet_leaves_results_and_errors() {
    let (folder, file) = scene();
    let dirty = write(&folder, "dirty.csv", fs::read_to_string(&file).unwrap() + "30,85,0\n");
    let arguments = ["fit", &dirty, "--drop-invalid", "--format", "csv"];
    let loud = brdfit(&arguments);
    let quiet = brdfit(&[&arguments[..], &["--quiet"]].concat());
    assert!(loud.errors.contains("left out") && quiet.errors.is_empty());
    assert_eq!(
        (quiet.code, quiet.output.lines().count()),
        (0, loud.output.lines().count())
    );
    assert!(fail(&["-q", "fit", "missing.csv"]).contains("no such file"));
    let out = text(&folder.path().join("out.csv"));
    let ran = brdfit(&["-q", "batch", &file, "missing.csv", "-o", &out]);
    assert_eq!((ran.code, ran.output.as_str()), (1, ""));
    assert!(
        ran.errors.starts_with("missing.csv: no such file")
            && ran.errors.ends_with("1 of 2 scans could not be fitted\n")
    );
}

#[test]
fn colours_are_where_they_are_asked_for() {
    let red = "\x1b[1;31mmissing.csv\x1b[0m: no such file";
    for always in [&["--color", "always"] as &[&str], &["--color=always"]] {
        assert!(
            brdfit(&[&["fit", "missing.csv"], always].concat())
                .errors
                .starts_with(red)
        );
        assert!(
            brdfit(&[always, &["fit", "missing.csv"]].concat())
                .errors
                .starts_with(red)
        );
        assert!(succeed(&[&["--help"], always].concat()).contains('\x1b'));
        assert!(
            brdfit(&[&["fit", "--nonsense"], always].concat())
                .errors
                .contains('\x1b')
        );
    }
    for other in ["auto", "never"] {
        assert!(!fail(&["fit", "missing.csv", "--color", other]).contains('\x1b'));
        assert!(!succeed(&["--help", "--color", other]).contains('\x1b'));
    }
    assert_eq!(brdfit(&["fit", "missing.csv", "--color", "sometimes"]).code, 2);
}

#[test]
fn standard_input_and_output_are_a_dash() {
    let (_folder, file) = scene();
    let scan = fs::read(&file).unwrap();
    let named = succeed(&["fit", &file, "--minima", "--format", "csv"]);
    let piped = program::brdfit(&["fit", "-", "--minima", "--format", "csv", "--output", "-"], &scan);
    assert_eq!((piped.code, piped.errors.as_str()), (0, ""));
    assert_eq!(piped.output.replace("\n-,", &format!("\n{file},")), named);
    assert_eq!(succeed(&[&SCENE[..], &["-o", "-"]].concat()), succeed(&SCENE));
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
        "mse2",
        "rms_ln",
        "parameters",
        "at_bound",
        "selection",
        "uncertainty",
        "derived",
        "stop",
        "minima",
        "evaluations",
        "elapsed_s",
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
    assert!(one["elapsed_s"].as_f64().unwrap() > 0.0);
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
    check(known["stderr"]["m"].as_f64().unwrap(), tolerance::IDEAL_STDERR);
    assert!(known["stderr_without_bounds"]["m"].is_f64());
    assert_eq!(known["correlation"]["n"]["n"].as_f64().unwrap().round(), 1.0);
    assert!(known["on_bound"].is_array() && known["undetermined"].is_array());
    let angles = one["derived"].as_array().unwrap();
    assert_eq!(angles.len(), 2);
    let theta_i = angles[0]["theta_i_deg"].as_f64().unwrap();
    assert!(tolerance::DEGREES.admits((theta_i - 30.0).abs()));
    for quantity in ["rho_s_f", "rho_v_f", "peak_brdf_per_sr", "width_deg", "reflectance"] {
        assert!(angles[0][quantity]["value"].is_f64() && angles[0][quantity]["stderr"].is_f64());
    }
    assert_eq!(
        angles[0]["energy_conserved"],
        angles[0]["reflectance"]["value"].as_f64() <= Some(1.0)
    );
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
            "rho_d can not be -1",
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
