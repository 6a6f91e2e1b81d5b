//! What comes from elsewhere is shown and not obeyed: no escape, control character or mark of direction reaches a terminal, a table or JSON raw, and no cell is a formula.
#![cfg(unix)]

use std::fs;

use brdfit_suite::program::{self, SCENE, fail, succeed, write};
use serde_json::Value;

/// Clears the screen, turns the line round, rings, ends the line, hides.
const HOSTILE: &str = "\u{1b}[2J\u{202e}\u{7}\u{9b}31m\u{2066}\u{200b}";

fn is_hostile(c: char) -> bool {
    c != '\n' && (c.is_control() || HOSTILE.contains(c) && !c.is_ascii_graphic())
}

/// Nothing that a terminal or a spreadsheet would obey.
fn assert_plain(what: &str, text: &str) {
    let line = text.lines().find(|line| line.contains(is_hostile));
    assert_eq!(line, None, "{what}");
}

#[test]
fn hostile_names_are_shown_in_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let scan = write(&folder, &format!("a{HOSTILE}\nb.csv"), succeed(&SCENE));
    let out = folder.path().join("out.json");
    let out = out.to_str().unwrap();
    for arguments in [
        &["fit", &scan][..],
        &["fit", &scan, "--format", "csv"],
        &["fit", &scan, "--format", "json"],
        &["fit", &scan, "--mask-retro", "6"],
        &["batch", &scan, "--out", "-"],
        &["batch", &scan, "--out", "-", "--format", "json"],
        &["batch", &scan, "--out", out],
        &["profile", &scan, "--parameter", "m"],
        &["profile", &scan, "--parameter", "m", "--format", "json"],
        &["compare", &scan, "--models", "beckmann"],
        &["compare", &scan, "--models", "beckmann", "--format", "json"],
        &["joint", &scan, &scan],
        &["joint", &scan, &scan, "--format", "json"],
        &["converge", &scan, "--seeds", "1", "--format", "csv"],
        &["stability", &scan],
        &["report", &scan],
    ] {
        let ran = program::brdfit(arguments, b"");
        assert_eq!(ran.code, 0, "{arguments:?}: {}", ran.errors);
        assert!(
            (ran.output.clone() + &ran.errors).contains("\\u"),
            "{arguments:?}: {}",
            ran.output
        );
        // The figures themselves lift their exponents with a space of no width.
        assert_plain(&format!("{arguments:?}"), &ran.output.replace(">\u{200b}<", "><"));
        assert_plain(&format!("{arguments:?}"), &ran.errors);
    }
    // The escapes of JSON read back.
    let results: Value = serde_json::from_str(&succeed(&["fit", &scan, "--format", "json"])).unwrap();
    assert_eq!(results["file"], scan.as_str());
    for to in ["zemax", "glsl", "mitsuba", "mitsuba-native", "c", "rust", "bird"] {
        let results = write(&folder, "r.json", results.to_string());
        for name in [&[][..], &["--name", HOSTILE], &["--name", "class"]] {
            let ran = program::brdfit(&[&["export", &results, "--to", to], name].concat(), b"");
            assert_eq!(ran.code, 0, "{to}: {}", ran.errors);
            // A tab stands between the numbers of Zemax.
            assert_plain(to, &ran.output.replace('\t', " "));
        }
    }
}

#[test]
fn hostile_cells_units_and_errors_are_shown() {
    let folder = tempfile::tempdir().unwrap();
    let cases = [
        format!("theta_i,theta_s,brdf\n45,{HOSTILE},1\n"),
        format!("theta_i{HOSTILE},theta_{HOSTILE}s,brdf\n45,1,1\n"),
        format!("theta_i,theta_s,{HOSTILE}\n45,1,1\n"),
        format!("theta_i,theta_s,wavelength_nm,brdf\n45,1,{HOSTILE},1\n"),
        format!(
            "{{\"data\": {{\"theta_i\": {{\"unit\": \"{}\", \"values\": [1]}}}}}}",
            "\\u001b[2J\\u202e"
        ),
        format!("# {HOSTILE}\n{HOSTILE}\n"),
    ];
    for (place, contents) in cases.iter().enumerate() {
        let scan = write(&folder, &format!("{place}.csv"), contents);
        let ran = program::brdfit(&["fit", &scan], b"");
        assert_eq!(ran.code, 2, "{contents:?}");
        assert_plain("an error", &ran.errors);
        for format in ["csv", "json"] {
            let ran = program::brdfit(&["batch", &scan, "--out", "-", "--format", format], b"");
            assert_eq!(ran.code, 1);
            assert_plain("a stored error", &ran.output);
            assert_plain("a told error", &ran.errors);
        }
    }
    // The error in a file of results, which report tells.
    let results = format!(
        "[{{\"file\": \"gone{}\", \"scan\": null, \"error\": \"{}\"}}]",
        "\\u001b[2J", "\\u001b[2J\\u202e\\nline"
    );
    let results = write(&folder, "results.json", results);
    let ran = program::brdfit(&["report", &results], b"");
    assert_eq!(ran.code, 2);
    assert_plain("an error of results", &ran.errors);
    // Words of the user, which clap repeats.
    for arguments in [
        &["fit", "--method", HOSTILE][..],
        &[HOSTILE],
        &["fit", "x", "--bounds", HOSTILE],
    ] {
        for color in ["never", "always"] {
            let ran = program::brdfit(&[&["--color", color], arguments].concat(), b"");
            assert_eq!(ran.code, 2);
            let own = ["\u{1b}[1;31m", "\u{1b}[0m"]
                .iter()
                .fold(ran.errors, |text, code| text.replace(code, ""));
            assert_plain("wrong usage", &own);
        }
    }
}

#[test]
fn no_cell_is_a_formula() {
    let folder = tempfile::tempdir().unwrap();
    // As it is named when the program is called in its folder; here the name of a scan in a file begins so.
    let mut table = String::from("theta_i,theta_s,=1+cmd()\n");
    for theta_s in (-80..=80).step_by(4) {
        table += &format!("45,{theta_s},0.1\n");
    }
    let scan = write(&folder, "a.csv", table);
    for arguments in [
        &[
            "fit", &scan, "--column", "=1+cmd()", "--terms", "diffuse", "--format", "csv",
        ][..],
        &[
            "batch", &scan, "--column", "=1+cmd()", "--terms", "diffuse", "--out", "-",
        ],
    ] {
        let ran = program::brdfit(arguments, b"");
        assert_eq!(ran.code, 0, "{}", ran.errors);
        let row = ran.output.lines().nth(1).unwrap();
        assert!(!row.contains(",=") && !row.starts_with('='), "{row}");
    }
}

#[test]
fn results_that_name_no_file_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let fifo = folder.path().join("fifo");
    let made = std::process::Command::new("mkfifo").arg(&fifo).status().unwrap();
    assert!(made.success());
    let parameters = "{\"rho_d\":0.1,\"rho_s\":0,\"rho_v\":0,\"m\":0.1,\"n\":1.5,\"kappa\":0}";
    for named in ["/dev/zero", fifo.to_str().unwrap()] {
        let json = format!("{{\"file\": \"{named}\", \"scan\": null, \"parameters\": {parameters}}}");
        let results = write(&folder, "results.json", json);
        assert!(fail(&["report", &results]).contains("this is not a file"));
        let csv = format!("file,scan,rho_d,rho_s,rho_v,m,n,kappa,error\n{named},,0.1,0,0,0.1,1.5,0,\n");
        let results = write(&folder, "results.csv", csv);
        assert!(fail(&["report", &results]).contains("this is not a file"));
    }
    assert!(fail(&["fit", "/dev/zero"]).contains("this is a device"));
    fs::remove_file(fifo).unwrap();
}

#[test]
fn sizes_without_end_are_refused() {
    let errors = fail(&[
        "simulate",
        "--theta-i",
        "0:89:0.0001",
        "--theta-s",
        "0:89:0.001",
        "--rho-d",
        "0.1",
    ]);
    assert!(
        errors.contains("rows") && errors.contains("at most 10000000"),
        "{errors}"
    );
}

#[test]
fn weights_of_any_size_are_those_of_size_1() {
    let folder = tempfile::tempdir().unwrap();
    let scan = write(&folder, "scan.csv", succeed(&SCENE));
    let run = |factor: &str| {
        let both = [format!("30={factor}"), format!("60={factor}")];
        let weights = ["--weight-angle", &both[0], "--weight-angle", &both[1]];
        succeed(&[&["fit", &scan, "--format", "csv", "--minima"], &weights[..]].concat())
    };
    let unit = run("1");
    // Powers of two, of which every digit of a scaled weight is exact.
    for factor in [
        "1.0715086071862673e301",
        "1.3292279957849159e36",
        "9.332636185032189e-302",
    ] {
        assert_eq!(run(factor), unit, "{factor}");
    }
    let far = program::brdfit(&["stability", &scan, "--weight-angle", "30=1e300"], b"");
    assert_eq!(far.code, 0, "{}", far.errors);
}

#[test]
fn numbers_in_messages_are_short() {
    let folder = tempfile::tempdir().unwrap();
    for row in [
        "45,1e300,1",
        "1e300,1,1",
        "45,1,-1e300",
        "45,1,1e-320",
        "-1e300,1,1",
        "45,1,1e309",
    ] {
        for head in ["theta_i,theta_s,brdf", "theta_i_rad,theta_s_rad,ln_brdf"] {
            let scan = write(&folder, "scan.csv", format!("{head}\n{row}\n45,2,1\n45,3,1\n"));
            for drop in [&[][..], &["--drop-invalid"]] {
                let ran = program::brdfit(&[&["fit", &scan], drop].concat(), b"");
                let longest = ran
                    .errors
                    .split(|c: char| !(c.is_ascii_digit() || ".e+-".contains(c)))
                    .map(str::len)
                    .max();
                assert!(longest <= Some(24), "{head} {row}: {}", ran.errors);
            }
        }
    }
    for arguments in [
        &["simulate", "--theta-i", "1e300", "--theta-s", "1", "--rho-d", "0.1"][..],
        &["fit", "x", "--fix", "n=1e300"],
    ] {
        let errors = fail(arguments);
        assert!(errors.len() < 300 && !errors.contains("0000000000"), "{errors}");
    }
}
