//! The program as a process: what Ctrl-C, a request to end and a kill leave behind.
#![cfg(unix)]

use std::fs;
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
