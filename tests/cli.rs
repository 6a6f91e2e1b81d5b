//! The command line, called in this process: help, streams, and every error as one line with file, line and exit code 2.

use std::fs;
use std::path::Path;

use brdfit_suite::program::{self, Ran, SCENE, fail, scene, succeed, write};

fn brdfit(arguments: &[&str]) -> Ran {
    program::brdfit(arguments, b"")
}

fn text(path: &Path) -> String {
    path.to_str().unwrap().to_string()
}

#[test]
fn each_error_of_a_file_names_its_place() {
    const HEAD: &str = "# remark\ntheta_i_deg,theta_s_deg,brdf_per_sr\n45,10,0.1\n";
    let long = "1,2,0\n".repeat(100);
    let cases: [(&str, Vec<u8>, &str, &str); 21] = [
        ("empty", vec![], "", "the file is empty"),
        ("remarks", b"# a\n\n# b\n".into(), "", "no header line"),
        ("no_rows", b"theta_i,theta_s,brdf\n\n".into(), "", "no rows"),
        (
            "no_header",
            b"45,-85,0.03\n45,-84,0.03\n".into(),
            ":1",
            "the columns have no names; say what they are, such as --columns theta_i=1,theta_s=2,brdf=3",
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
            b"theta_i;theta_s;brdf\n45;1;0,1\n45;2;0.1\n".into(),
            ":3:3",
            "decimal comma",
        ),
        (
            "hole",
            format!("{HEAD}45,,0.1\n").into(),
            ":4:2",
            "theta_s is not an angle",
        ),
        ("nan", format!("{HEAD}45,10,NaN\n").into(), ":4:3", "--drop-invalid"),
        ("inf", format!("{HEAD}45,10,inf\n").into(), ":4:3", "--drop-invalid"),
        ("nan_angle", format!("{HEAD}nan,10,1\n").into(), ":4:1", "not an angle"),
        ("horizon", format!("{HEAD}45,90,0.1\n").into(), ":4:2", "horizon"),
        ("below", format!("{HEAD}45,-91,0.1\n").into(), ":4:2", "horizon"),
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
            "2 samples cannot determine 6 parameters",
        ),
        ("binary", b"\x89PNG\r\n\x1a\n\0\0\xff\xfe".into(), "", "a PNG picture"),
        (
            "latin1",
            b"theta_i,theta_s,brdf\n# Stra\xdfe\n45,\x01,1\n".into(),
            ":3",
            "not text",
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
    let cases: [(&[&str], &str); 17] = [
        (&["--bounds", "n=2:1"], "wrong way round"),
        (&["--bounds", "n=1:NaN"], "cannot be NaN"),
        (&["--bounds", "n=0.5:2"], "n cannot be 0.5"),
        (&["--bounds", "m=0:1"], "m cannot be 0"),
        (&["--bounds", "kappa=-1:1"], "kappa cannot be -1"),
        (
            &["--bounds", "alpha=0:1"],
            "the parameters are rho_d, rho_s, rho_v, m, n, kappa",
        ),
        (&["--bounds", "n"], "NAME=LO:HI"),
        (&["--fix", "rho_d=-1"], "rho_d cannot be -1"),
        (&["--fix", "n=1.5", "--bounds", "n=1:2"], "twice"),
        (
            &["--fix", "kappa=0", "--terms", "diffuse,surface"],
            "not a parameter of the terms",
        ),
        (
            &["--prior", "kappa=1+-0.1", "--terms", "diffuse,surface"],
            "not a parameter of the terms",
        ),
        (&["--proof-boxes", "10"], "--proof-boxes limits a proof"),
        (&["--model", "abg", "--terms", "auto"], "abg has no terms"),
        (&["--model", "abg", "--terms", "diffuse"], "abg has no terms"),
        (&["--terms", "volume"], "--terms takes one of: "),
        (&["--terms", "gloss"], "no term 'gloss'"),
        (&["--output", "missing/folder/out.json"], "cannot be written"),
    ];
    for (options, what) in cases {
        let message = fail(&[&["fit", &file], options].concat());
        assert!(message.contains(what) && message.contains("; "), "{message}");
    }
    assert!(fail(&["joint", &file, &file, "--terms", "diffuse", "--share", "m"]).contains("cannot be shared"));
    assert!(fail(&["converge", &file, "--model", "abg", "--terms", "diffuse"]).contains("abg has no terms"));
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
    assert!(fail(&["man", "woman"]).contains("take one of fit, inspect, report, certify, batch"));
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
