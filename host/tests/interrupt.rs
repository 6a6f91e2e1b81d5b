//! The program as a process: what Ctrl-C, a request to end and a kill leave behind.
#![cfg(unix)]

use std::fs;
use std::io::Read;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::Duration;

/// A folder of scans that differ a little, so that no two results are the same.
fn scans(root: &Path) -> PathBuf {
    let folder = root.join("scans");
    fs::create_dir(&folder).unwrap();
    for index in 0..40 {
        let mut scan = String::from("theta_i,theta_s,brdf\n");
        for theta_s in (-80..=80).step_by(4) {
            let peak = f64::from(theta_s - 45) / f64::from(6 + index % 5);
            scan += &format!(
                "45,{theta_s},{}\n",
                0.03 + 2.0 / (1.0 + peak * peak) + 1e-3 * f64::from(index * (theta_s + 81) % 17)
            );
        }
        fs::write(folder.join(format!("{index:02}.csv")), scan).unwrap();
    }
    folder
}

fn batch(folder: &Path, out: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_brdfit"));
    command.args([
        "batch",
        "--method",
        "paper",
        "--starts",
        "50",
        "--threads",
        "2",
        "--resume",
        "--out",
    ]);
    command.args([out, folder]).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// Sends `signal` as soon as some files are done.
fn interrupted(mut child: Child, partial: &Path, signal: &str) -> ExitStatus {
    let lines = || fs::read_to_string(partial).map_or(0, |text| text.lines().count());
    while lines() < 4 {
        assert!(child.try_wait().unwrap().is_none(), "ended before it was interrupted");
        sleep(Duration::from_millis(1));
    }
    let kill = Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(kill.unwrap().success());
    child.wait().unwrap()
}

#[test]
fn what_is_done_is_kept() {
    let root = tempfile::tempdir().unwrap();
    let folder = scans(root.path());
    let whole = root.path().join("whole.csv");
    assert!(batch(&folder, &whole).status().unwrap().success());
    let out = root.path().join("results.csv");
    let partial = root.path().join("results.csv.partial");
    for (signal, code) in [("-INT", Some(130)), ("-TERM", Some(130)), ("-KILL", None)] {
        let status = interrupted(batch(&folder, &out).spawn().unwrap(), &partial, signal);
        assert_eq!(
            (status.code(), status.signal()),
            (code, code.map_or(Some(9), |_| None)),
            "{signal}"
        );
        let kept = fs::read_to_string(&partial).unwrap();
        let done = kept.lines().count() - 1;
        assert!((3..40).contains(&done) && !out.exists(), "{signal}: {done}");
        assert!(signal == "-KILL" || kept.ends_with('\n'));
        assert!(batch(&folder, &out).status().unwrap().success());
        assert!(!partial.exists());
        assert!(fs::read(&out).unwrap() == fs::read(&whole).unwrap(), "{signal}");
        fs::remove_file(&out).unwrap();
    }
}

/// A command of which the search takes hours, with its streams.
fn endless(arguments: &[&str], folder: &Path) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_brdfit"));
    command.args(arguments).current_dir(folder);
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Waits until the program answers interrupts.
fn listens(child: &mut Child) {
    let status = format!("/proc/{}/status", child.id());
    let caught = || {
        let status = fs::read_to_string(&status).unwrap_or_default();
        let mask = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        mask.is_some_and(|mask| u64::from_str_radix(mask.trim(), 16).unwrap() >> 1 & 1 == 1)
    };
    while !caught() {
        assert!(child.try_wait().unwrap().is_none(), "ended before it was interrupted");
        sleep(Duration::from_millis(1));
    }
    // Until it is at work.
    sleep(Duration::from_millis(300));
}

fn signal(child: &Child, signal: &str) {
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(sent.unwrap().success());
}

/// How it ended, and what it had written to both streams; hours are too long.
fn ended(mut child: Child) -> (Option<i32>, String, String) {
    for _ in 0..6000 {
        if let Some(status) = child.try_wait().unwrap() {
            let (mut output, mut errors) = (String::new(), String::new());
            if let Some(mut stream) = child.stdout.take() {
                stream.read_to_string(&mut output).unwrap();
            }
            child.stderr.take().unwrap().read_to_string(&mut errors).unwrap();
            return (status.code(), output, errors);
        }
        sleep(Duration::from_millis(10));
    }
    child.kill().unwrap();
    panic!("it did not end");
}

const LONG: [&str; 4] = ["--method", "paper", "--starts", "1000000"];

#[cfg(target_os = "linux")]
#[test]
fn every_command_ends_and_says_what_is_left() {
    let root = tempfile::tempdir().unwrap();
    let folder = scans(root.path());
    for arguments in [
        &[&["fit", "00.csv", "--output", "out.csv", "--format", "csv"], &LONG[..]].concat()[..],
        &[&["report", "00.csv", "--output", "out.html"], &LONG[..]].concat(),
        &["profile", "00.csv", "--bootstrap", "1000000"],
        &["converge", "00.csv", "--seeds", "10000"],
        &["paper", "--starts", "1000000"],
    ] {
        let mut child = endless(arguments, &folder);
        listens(&mut child);
        signal(&child, "-INT");
        let (code, output, errors) = ended(child);
        assert_eq!(code, Some(130), "{arguments:?}: {errors}");
        assert_eq!(
            (output.as_str(), errors.as_str()),
            ("", "interrupted: nothing was written\n")
        );
    }
    // No result, no temporary file.
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 40);
}

#[cfg(target_os = "linux")]
#[test]
fn long_fits_end_between_passes() {
    let root = tempfile::tempdir().unwrap();
    let folder = scans(root.path());
    for (arguments, why) in [
        (
            &["fit", "00.csv", "01.csv", "--output", "out.csv", "--format", "csv"][..],
            "0 of 2 scans are fitted",
        ),
        (&["fit", "00.csv", "01.csv", "--robust"], "0 of 2 scans are fitted"),
        (
            &["batch", ".", "--out", "../out.csv", "--threads", "2"],
            "0 of 40 files are done; they are kept in ../out.csv.partial",
        ),
    ] {
        let mut child = endless(&[arguments, &LONG[..]].concat(), &folder);
        listens(&mut child);
        signal(&child, "-INT");
        let (code, output, errors) = ended(child);
        assert_eq!((code, output.as_str()), (Some(130), ""), "{arguments:?}: {errors}");
        let said: Vec<&str> = errors.lines().collect();
        assert_eq!(said[0], "interrupted: what is finished is kept; once more ends at once");
        assert!(said.len() == 2 && said[1].contains(why), "{errors}");
    }
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 40);
}

#[cfg(target_os = "linux")]
#[test]
fn what_is_proved_is_kept() {
    let root = tempfile::tempdir().unwrap();
    let folder = scans(root.path());
    for arguments in [
        &["certify", "00.csv", "--within", "0.001%"][..],
        &["fit", "00.csv", "--certify", "0.001%"],
    ] {
        let mut child = endless(arguments, &folder);
        listens(&mut child);
        signal(&child, "-INT");
        let (code, output, errors) = ended(child);
        assert_eq!(code, Some(130), "{arguments:?}: {errors}");
        assert!(
            errors.ends_with("interrupted: what is proved so far is written\n"),
            "{errors}"
        );
        assert!(
            output.contains("  proved     ") && output.contains(" so far"),
            "{output}"
        );
    }
}

/// Of a batch that is proved, an interrupt keeps the scans whose proofs are whole, and none that it cut short.
#[cfg(target_os = "linux")]
#[test]
fn a_batch_keeps_whole_proofs_alone() {
    let root = tempfile::tempdir().unwrap();
    let folder = scans(root.path());
    let mut child = endless(
        &["batch", "00.csv", "--certify", "0.001%", "--out", "../one.json"],
        &folder,
    );
    listens(&mut child);
    signal(&child, "-INT");
    let (code, output, errors) = ended(child);
    assert_eq!((code, output.as_str()), (Some(130), ""), "{errors}");
    assert!(errors.contains("0 of 1 files are done"), "{errors}");
    assert!(!root.path().join("one.json").exists());

    // With its index known, each scan is proved in some hundred boxes.
    let files: Vec<String> = (0..12).map(|index| format!("{index:02}.csv")).collect();
    let proved = |out: &Path| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_brdfit"));
        command.args(["batch", "--certify", "10%", "--fix", "n=1.5", "--threads", "1"]);
        command.args(["--resume", "--out"]).arg(out).args(&files);
        command.current_dir(&folder).stdout(Stdio::null()).stderr(Stdio::null());
        command
    };
    let (whole, out) = (root.path().join("whole.json"), root.path().join("results.json"));
    assert!(proved(&whole).status().unwrap().success());
    let partial = root.path().join("results.json.partial");
    let status = interrupted(proved(&out).spawn().unwrap(), &partial, "-INT");
    assert_eq!(status.code(), Some(130));
    let done = fs::read_to_string(&partial).unwrap().lines().count() - 1;
    assert!((3..files.len()).contains(&done) && !out.exists(), "{done}");
    assert!(proved(&out).status().unwrap().success());
    let text = fs::read_to_string(&out).unwrap();
    assert_eq!(text.matches("\"complete\": true").count(), files.len());
    assert!(text == fs::read_to_string(&whole).unwrap());
}

#[cfg(target_os = "linux")]
#[test]
fn a_result_that_nobody_reads_is_not_waited_for() {
    let root = tempfile::tempdir().unwrap();
    let folder = scans(root.path());
    for command in [&["fit", "00.csv"][..], &["batch", ".", "--out", "-"]] {
        let mut child = endless(&[command, &LONG[..]].concat(), &folder);
        listens(&mut child);
        drop(child.stdout.take());
        let (code, _, errors) = ended(child);
        assert_eq!(code, Some(2), "{errors}");
        assert_eq!(errors, "standard output was closed before there was a result\n");
    }
    // A result that goes to a file does not need a reader.
    let mut child = endless(&["batch", ".", "--out", "../out.csv"], &folder);
    drop(child.stdout.take());
    assert_eq!(ended(child).0, Some(0));
}
