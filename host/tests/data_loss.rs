//! The program as a process: a file that standard input or output is connected to is no other's.
#![cfg(unix)]

use std::fs::{self, File};
use std::process::{Command, Stdio};

#[test]
fn redirected_inputs_are_not_replaced() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("scan.csv");
    let mut scan = String::from("theta_i,theta_s,brdf\n");
    for theta_s in (-80..=80).step_by(4) {
        scan += &format!("45,{theta_s},0.1\n");
    }
    fs::write(&path, &scan).unwrap();
    let run = |arguments: &[&str], input: Stdio, output: Stdio| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_brdfit"));
        command
            .args(arguments)
            .current_dir(root.path())
            .stdin(input)
            .stdout(output);
        let ran = command.stderr(Stdio::piped()).output().unwrap();
        (ran.status.code(), String::from_utf8(ran.stderr).unwrap())
    };
    let fit = ["fit", "-", "--terms", "diffuse", "--format", "csv", "--output"];
    let (code, errors) = run(
        &[&fit[..], &["scan.csv"]].concat(),
        File::open(&path).unwrap().into(),
        Stdio::null(),
    );
    assert_eq!(code, Some(2));
    assert!(errors.contains("this is an input too"), "{errors}");
    for command in [
        &["fit", "scan.csv", "--terms", "diffuse"][..],
        &["batch", "scan.csv", "--out", "-"],
    ] {
        let append = File::options().append(true).open(&path).unwrap();
        let (code, errors) = run(command, Stdio::null(), append.into());
        assert_eq!(code, Some(2));
        assert!(errors.contains("standard output goes to an input"), "{errors}");
    }
    assert_eq!(fs::read_to_string(&path).unwrap(), scan);
    // Any other redirection is fine.
    let other = File::create(root.path().join("out.csv")).unwrap();
    let done = run(
        &["fit", "-", "--terms", "diffuse"],
        File::open(&path).unwrap().into(),
        other.into(),
    );
    assert_eq!(done, (Some(0), String::new()));
}
