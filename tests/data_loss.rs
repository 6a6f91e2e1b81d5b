//! Nothing that is there is lost: inputs, links, modes, read-only files, other people's files beside the results.

use std::fs;
use std::path::Path;

use brdfit_suite::program::{self, SCENE, fail, succeed, write};
use tempfile::TempDir;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// A folder with a scan and with what other commands take.
fn folder() -> (TempDir, String, String) {
    let folder = tempfile::tempdir().unwrap();
    let scan = write(&folder, "scan.csv", succeed(&SCENE));
    let results = write(&folder, "results.json", succeed(&["fit", &scan, "--format", "json"]));
    (folder, scan, results)
}

/// Every file of a folder with its contents.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .map(|path| (text(&path).to_string(), fs::read(&path).unwrap()))
        .collect();
    all.sort();
    all
}

#[test]
fn no_command_replaces_its_input() {
    let (folder, scan, results) = folder();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_string();
    let mut names = vec![path("./scan.csv")];
    fs::hard_link(&scan, path("hard.csv")).unwrap();
    names.push(path("hard.csv"));
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("scan.csv", path("link.csv")).unwrap();
        names.push(path("link.csv"));
    }
    let list = write(&folder, "list.txt", &scan);
    let before = contents(folder.path());
    for output in &names {
        let svg = ["--format", "csv", "--plot"];
        for arguments in [
            &["fit", &scan, "--output", output][..],
            &["fit", &scan, "--format", "csv", "--output", output],
            &["batch", &scan, "--format", "csv", "--out", output],
            &["batch", &format!("@{list}"), "--format", "json", "--out", output],
            &["report", &scan, "--output", output],
            &["report", &results, "--output", output],
            &["profile", &scan, "--parameter", "m", "--output", output],
            &["compare", &scan, "--models", "beckmann", "--output", output],
            &["joint", &scan, &scan, "--output", output],
            &["converge", &scan, "--seeds", "1", "--output", output],
            &["stability", &scan, "--output", output],
        ] {
            let error = fail(arguments);
            assert!(error.contains("this is an input too"), "{arguments:?}: {error}");
        }
        // The ending of a picture is that of a picture.
        let picture = output.replace(".csv", ".svg");
        if fs::hard_link(&scan, &picture).is_ok() {
            let error = fail(&[&["fit", scan.as_str()], &svg[..], &[&picture]].concat());
            assert!(error.contains("this is an input too"), "{error}");
            fs::remove_file(&picture).unwrap();
        }
    }
    let error = fail(&["batch", &format!("@{list}"), "--format", "csv", "--out", &list]);
    assert!(error.contains("this is an input too"), "{error}");
    let error = fail(&["export", &results, "--to", "c", "--output", &results]);
    assert!(error.contains("this is an input too"), "{error}");
    assert_eq!(contents(folder.path()), before);
}

#[test]
fn two_results_need_two_names() {
    let (folder, scan, _) = folder();
    let same = folder.path().join("same.svg");
    let error = fail(&["fit", &scan, "--output", text(&same), "--plot", text(&same)]);
    assert!(error.contains("two results would go to this file") && !same.exists());
}

#[test]
fn scans_named_like_results_are_fitted_and_stay() {
    let (folder, scan, _) = folder();
    fs::remove_file(folder.path().join("results.json")).unwrap();
    for name in ["scan.csv2", "scan.csv.1-of-2", "scan.csv.old"] {
        fs::copy(&scan, folder.path().join(name)).unwrap();
    }
    let before = contents(folder.path());
    let batch = |out: &str| program::brdfit(&["batch", text(folder.path()), "--out", out], b"");
    let refused = batch(&scan);
    assert_eq!(refused.code, 2);
    assert!(refused.errors.contains("this is an input too"), "{}", refused.errors);
    // The finished fits would go to a scan.
    let partial = folder.path().join("out.csv.partial");
    fs::copy(&scan, &partial).unwrap();
    let out = folder.path().join("out.csv");
    assert!(batch(text(&out)).errors.contains("this is a scan"));
    fs::remove_file(&partial).unwrap();
    assert_eq!(contents(folder.path()), before);
    for round in 0..2 {
        // The results of the round before are no scan.
        let ran = batch(text(&out));
        assert_eq!((ran.code, ran.errors.as_str()), (0, ""), "{round}");
        assert_eq!(fs::read_to_string(&out).unwrap().lines().count(), 5);
    }
    fs::remove_file(&out).unwrap();
    assert_eq!(contents(folder.path()), before);
}

#[test]
fn what_cannot_be_written_is_said_before_any_fit() {
    let (folder, scan, _) = folder();
    // A scan that cannot be read shows that the output was looked at before.
    let bad = write(&folder, "bad.csv", "theta_i,theta_s,brdf\n45,x,1\n");
    let missing = folder.path().join("none/out.csv");
    for arguments in [
        &["fit", &bad, "--output", text(&missing)][..],
        &["fit", &bad, "--plot", text(&missing.with_extension("svg"))],
        &["batch", &bad, "--out", text(&missing)],
        &["batch", &bad, "--shard", "1/2", "--out", text(&missing)],
        &["report", &bad, "--output", text(&missing)],
        &["profile", &bad, "--output", text(&missing)],
        &["compare", &bad, "--output", text(&missing)],
        &["joint", &bad, &bad, "--output", text(&missing)],
        &["converge", &bad, "--output", text(&missing)],
        &["stability", &bad, "--output", text(&missing)],
        &["export", &bad, "--to", "c", "--output", text(&missing)],
    ] {
        let error = fail(arguments);
        assert!(error.contains("cannot be written"), "{arguments:?}: {error}");
    }
    let out = folder.path().join("out.csv");
    fs::write(&out, "mine").unwrap();
    let mut read_only = fs::metadata(&out).unwrap().permissions();
    read_only.set_readonly(true);
    fs::set_permissions(&out, read_only).unwrap();
    for command in ["fit", "batch"] {
        let error = fail(&[command, &scan, "--out", text(&out)]);
        assert!(error.contains("read-only"), "{error}");
    }
    assert_eq!(fs::read(&out).unwrap(), b"mine");
}

#[cfg(unix)]
#[test]
fn results_keep_mode_and_links() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let (folder, scan, _) = folder();
    let (file, link) = (folder.path().join("file.csv"), folder.path().join("link.csv"));
    fs::write(&file, "").unwrap();
    fs::set_permissions(&file, PermissionsExt::from_mode(0o640)).unwrap();
    symlink("file.csv", &link).unwrap();
    for arguments in [
        &["fit", &scan, "--format", "csv", "--output", text(&link)][..],
        &["batch", &scan, "--out", text(&link)],
    ] {
        fs::write(&file, "").unwrap();
        assert_eq!(program::brdfit(arguments, b"").code, 0);
        assert!(link.is_symlink());
        assert!(fs::read_to_string(&file).unwrap().starts_with("file,scan"));
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o7777, 0o640);
    }
}

#[cfg(unix)]
#[test]
fn what_cannot_be_listed_or_found_is_said() {
    use std::os::unix::fs::symlink;
    let (folder, _, _) = folder();
    fs::remove_file(folder.path().join("results.json")).unwrap();
    symlink("gone.csv", folder.path().join("dangling.csv")).unwrap();
    let ran = program::brdfit(&["batch", text(folder.path()), "--out", "-"], b"");
    assert_eq!(ran.code, 1);
    assert!(ran.errors.contains("dangling.csv: no such file"), "{}", ran.errors);
    // Names longer than the system takes cannot be listed.
    let pattern = format!("{}/{}/*.csv", text(folder.path()), "x".repeat(300));
    let errors = fail(&["batch", &pattern, "--out", "-"]);
    assert!(
        errors.contains("no file matches") || errors.contains("cannot be listed"),
        "{errors}"
    );
}

#[test]
fn a_foreign_or_torn_journal_stays() {
    let (folder, scan, _) = folder();
    let out = folder.path().join("out.csv");
    let partial = folder.path().join("out.csv.partial");
    for foreign in [
        "my notes",
        "my notes\n",
        "theta_i,theta_s,brdf\n45,1,1\n",
        "{\"brdfit\":\"0.1.0\"}\n",
        "\n",
    ] {
        fs::write(&partial, foreign).unwrap();
        for options in [&[][..], &["--resume"]] {
            fail(&[&["batch", scan.as_str(), "--out", text(&out)], options].concat());
            assert_eq!(fs::read_to_string(&partial).unwrap(), foreign);
        }
    }
    assert!(!out.exists());
}
