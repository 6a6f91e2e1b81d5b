//! `brdfit batch` and `brdfit merge`: results in order, one bad file among good ones, interrupted runs, parts.

use std::fs;
use std::path::{Path, PathBuf};

use brdfit_suite::program::{self, Ran};
use brdfit_suite::scan::data;
use serde_json::Value;
use tempfile::TempDir;

fn brdfit(arguments: &[&str]) -> Ran {
    program::brdfit(arguments, b"")
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// A folder with `count` copies of the paper's sets, which differ in name, and the place of results beside it.
fn scans(count: usize) -> (TempDir, PathBuf, PathBuf) {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("scans");
    fs::create_dir(&folder).unwrap();
    for index in 0..count {
        let set = data(&format!("testdata{}_sym_seed{}.csv", index % 3 + 1, index / 3 % 3 + 1));
        fs::copy(set, folder.join(format!("{index:02}.csv"))).unwrap();
    }
    let out = root.path().join("results.csv");
    (root, folder, out)
}

/// A line of finished fits with the checksum that it should have: FNV-1a of its JSON.
fn summed(line: &str) -> String {
    let (_, json) = line.split_once(' ').unwrap();
    let step = |hash: u64, &byte: &u8| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
    let sum = json.trim_end().as_bytes().iter().fold(0xcbf2_9ce4_8422_2325, step);
    format!("{sum:016x} {json}")
}

/// Runs what must succeed, and gives the file of results.
fn batch(folder: &Path, out: &Path, options: &[&str]) -> String {
    let ran = brdfit(&[&["batch", text(folder), "--out", text(out)], options].concat());
    assert_eq!((ran.code, ran.errors.as_str()), (0, ""), "{options:?}");
    fs::read_to_string(out).unwrap()
}

fn fail(arguments: &[&str], what: &str) {
    let errors = program::fail(arguments);
    assert!(errors.contains(what), "{what} is not in: {errors}");
}

/// The cells of a table, without columns that `leave_out` names.
fn cells(table: &str, leave_out: &[&str]) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(table.as_bytes());
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let kept: Vec<usize> = (0..rows[0].len())
        .filter(|&place| !leave_out.contains(&&rows[0][place]))
        .collect();
    rows.iter()
        .map(|row| kept.iter().map(|&place| row[place].to_string()).collect())
        .collect()
}

#[test]
fn results_are_those_of_single_fits_in_order() {
    let (_root, folder, out) = scans(7);
    let table = batch(&folder, &out, &[]);
    let names: Vec<PathBuf> = (0..7).map(|index| folder.join(format!("{index:02}.csv"))).collect();
    let fit = |threads: &str| {
        let files: Vec<&str> = names.iter().map(|name| text(name)).collect();
        let ran = brdfit(&[&["fit", "--format", "csv", "--threads", threads], &files[..]].concat());
        cells(&ran.output, &["elapsed_s"])
    };
    let serial = fit("1");
    assert_eq!(serial, fit("2"));
    assert_eq!(serial, cells(&table, &["error"]));
    let json = out.with_extension("json");
    let objects: Value = serde_json::from_str(&batch(&folder, &json, &["--threads", "1"])).unwrap();
    for (object, row) in objects.as_array().unwrap().iter().zip(&serial[1..]) {
        let mse2 = serial[0].iter().position(|name| name == "mse2").unwrap();
        assert_eq!(object["file"], row[0].as_str());
        assert_eq!(object["mse2"].as_f64(), row[mse2].parse().ok());
    }
}

#[test]
fn threads_and_repetition_change_no_byte() {
    let (_root, folder, out) = scans(6);
    let options = ["--method", "paper", "--starts", "20"];
    let once = batch(&folder, &out, &[&options[..], &["--threads", "1"]].concat());
    for threads in ["1", "2", "3"] {
        assert_eq!(
            once,
            batch(&folder, &out, &[&options[..], &["--threads", threads]].concat())
        );
    }
    assert_eq!(
        fs::read_dir(out.parent().unwrap()).unwrap().count(),
        2,
        "something is left behind"
    );
}

#[test]
fn a_bad_file_stops_nothing() {
    let (_root, folder, out) = scans(4);
    let good = batch(&folder, &out, &[]);
    let bad = folder.join("01a.csv");
    fs::write(&bad, "theta_i,theta_s,brdf\n45,x,1\n").unwrap();
    let ran = brdfit(&["batch", text(&folder), "--out", text(&out)]);
    assert_eq!(ran.code, 1);
    let message = format!("{}:2:2: 'x' is not a number; ", bad.display());
    assert!(
        ran.errors.starts_with(&message) && ran.errors.ends_with("1 of 5 scans could not be fitted\n"),
        "{}",
        ran.errors
    );
    let rows = cells(&fs::read_to_string(&out).unwrap(), &[]);
    assert_eq!(rows[3][0], text(&bad));
    assert!(rows[3].last().unwrap().starts_with(&message));
    assert!(rows[3][1..rows[3].len() - 1].iter().all(String::is_empty));
    let others: Vec<_> = [&rows[..3], &rows[4..]].concat();
    assert_eq!(others, cells(&good, &[]));
    let json = out.with_extension("json");
    assert_eq!(brdfit(&["batch", text(&folder), "--out", text(&json)]).code, 1);
    let objects: Value = serde_json::from_str(&fs::read_to_string(json).unwrap()).unwrap();
    assert_eq!(objects[2]["file"], text(&bad));
    assert!(objects[2]["error"].as_str().unwrap().starts_with(&message));
}

#[test]
fn the_page_is_table_3() {
    let (_root, folder, out) = scans(3);
    let ran = brdfit(&[
        "batch",
        text(&folder),
        "--out",
        text(&out),
        "--method",
        "paper",
        "--starts",
        "40",
    ]);
    let rows = cells(&fs::read_to_string(&out).unwrap(), &[]);
    let column = |name: &str| {
        let place = rows[0].iter().position(|column| column == name).unwrap();
        rows[1..]
            .iter()
            .map(|row| row[place].parse::<f64>().unwrap())
            .collect::<Vec<_>>()
    };
    let (low, high, potential, minima) = (
        column("mse2"),
        column("mse2_high"),
        column("improvement_potential"),
        column("minima"),
    );
    for row in 0..3 {
        assert!(minima[row] > 1.0 && potential[row] > 0.5);
        // The program divides costs, which are not rounded to MSE^2 first.
        assert_eq!(
            format!("{:.9}", potential[row]),
            format!("{:.9}", (high[row] - low[row]) / high[row])
        );
    }
    let lines: Vec<&str> = ran.output.lines().collect();
    assert_eq!(lines.len(), 5);
    assert!(
        lines[1].contains(&format!(
            "  45             {:>6}  {:>10.2e}  {:>10.2e}  {:.2} #",
            minima[0], high[0], low[0], potential[0]
        )),
        "{}",
        lines[1]
    );
    let mean = |values: &[f64]| values.iter().sum::<f64>() / 3.0;
    assert!(
        lines[4].starts_with("mean ")
            && lines[4].contains(&format!("{:.1} ", mean(&minima)))
            && lines[4].contains(&format!("{:.2} #", mean(&potential)))
    );
}

#[test]
fn a_run_is_resumed_where_it_was_killed() {
    let (_root, folder, out) = scans(6);
    let whole = batch(&folder, &out, &[]);
    // A part has the records of its files, as a run that is interrupted has them; its last line is torn by a kill.
    let ran = brdfit(&["batch", text(&folder), "--out", text(&out), "--shard", "1/1"]);
    assert_eq!(ran.code, 0);
    let part = fs::read_to_string(out.with_extension("csv.1-of-1")).unwrap();
    let lines: Vec<&str> = part.split_inclusive('\n').collect();
    assert_eq!(lines.len(), 7);
    let partial = out.with_extension("csv.partial");
    // One record is marked, so that it shows whether it was taken over.
    let marked = summed(&lines[3].replace("\"default\"", "\"marked\""));
    assert_ne!(marked, lines[3]);
    assert_eq!(summed(lines[3]), lines[3]);
    let torn = format!("{}{}{marked}{}", lines[0], lines[5], &lines[2][..lines[2].len() / 2]);
    fs::write(&partial, &torn).unwrap();
    fs::remove_file(&out).unwrap();
    let arguments = ["batch", text(&folder), "--out", text(&out)];
    fail(&arguments, "add --resume");
    fail(
        &[&arguments[..], &["--resume", "--seed", "1"]].concat(),
        "made with other options",
    );
    fail(
        &[&arguments[..], &["--resume", text(&data("testdata1_ideal.csv"))]].concat(),
        "of other files",
    );
    assert_eq!(fs::read_to_string(&partial).unwrap(), torn);
    let ran = brdfit(&[&arguments[..], &["--resume"]].concat());
    assert_eq!(ran.code, 0);
    let said = format!(
        "{}:4: this record is not whole; its fit is made again\n",
        text(&partial)
    );
    assert_eq!(ran.errors, said);
    let resumed = fs::read_to_string(&out).unwrap();
    assert_eq!(resumed.matches("marked").count(), 1);
    assert_eq!(resumed.replace("marked", "default"), whole);
    assert!(!partial.exists());
    // A file that was changed since, or failed, is fitted again.
    fs::write(&partial, torn).unwrap();
    let third = folder.join("02.csv");
    fs::write(&third, fs::read_to_string(&third).unwrap() + "\n").unwrap();
    assert_eq!(brdfit(&[&arguments[..], &["--resume"]].concat()).code, 0);
    let resumed = fs::read_to_string(&out).unwrap();
    // Its SHA-256 is another, and all else as it was.
    assert!(resumed != whole && resumed == batch(&folder, &out, &[]));
}

#[test]
fn a_flipped_digit_is_found_and_fitted_again() {
    let (_root, folder, out) = scans(4);
    let whole = batch(&folder, &out, &[]);
    fs::remove_file(&out).unwrap();
    let shard = ["batch", text(&folder), "--out", text(&out), "--shard", "1/1"];
    assert_eq!(brdfit(&shard).code, 0);
    let path = out.with_extension("csv.1-of-1");
    let part = fs::read_to_string(&path).unwrap();
    // A digit of a parameter in the third record, such as a disk may lose.
    let third = part.match_indices('\n').nth(2).unwrap().0;
    let digit = third + part[third..].find("0.").unwrap() + 3;
    let other = if part.as_bytes()[digit] == b'7' { "8" } else { "7" };
    let mut flipped = part.clone();
    flipped.replace_range(digit..=digit, other);
    fs::write(&path, &flipped).unwrap();
    let error = program::fail(&["merge", "--out", text(&out)]);
    assert!(
        error.contains("the record of file 3 is broken; run --shard 1/1 again with --resume"),
        "{error}"
    );
    let again = brdfit(&[&shard[..], &["--resume"]].concat());
    assert_eq!(again.code, 0);
    assert!(
        again.errors.contains(":4: this record is not whole"),
        "{}",
        again.errors
    );
    assert_eq!(fs::read_to_string(&path).unwrap(), part);
    assert_eq!(brdfit(&["merge", "--out", text(&out)]).code, 0);
    assert_eq!(fs::read_to_string(&out).unwrap(), whole);
    // The same in the finished fits of a run that was interrupted.
    let partial = out.with_extension("csv.partial");
    fs::write(&partial, flipped).unwrap();
    let resumed = brdfit(&["batch", text(&folder), "--out", text(&out), "--resume"]);
    assert_eq!(resumed.code, 0);
    assert!(
        resumed.errors.contains(":4: this record is not whole"),
        "{}",
        resumed.errors
    );
    assert_eq!(fs::read_to_string(&out).unwrap(), whole);
}

#[test]
fn a_repaired_file_is_fitted_on_resuming() {
    let (_root, folder, out) = scans(2);
    let whole = batch(&folder, &out, &[]);
    let second = folder.join("01.csv");
    let good = fs::read_to_string(&second).unwrap();
    fs::write(&second, "nothing").unwrap();
    assert_eq!(
        brdfit(&["batch", text(&folder), "--out", text(&out), "--shard", "1/1"]).code,
        1
    );
    fs::rename(out.with_extension("csv.1-of-1"), out.with_extension("csv.partial")).unwrap();
    fs::write(&second, good).unwrap();
    assert_eq!(batch(&folder, &out, &["--resume"]), whole);
}

#[test]
fn parts_merge_to_the_bytes_of_the_whole() {
    for ending in ["csv", "json"] {
        let (_root, folder, out) = scans(7);
        let out = out.with_extension(ending);
        fs::write(folder.join("03a.csv"), "theta_i,theta_s,brdf\n45,x,1\n").unwrap();
        let arguments = ["batch", text(&folder), "--out", text(&out)];
        let ran = brdfit(&arguments);
        let whole = fs::read(&out).unwrap();
        fs::remove_file(&out).unwrap();
        let merge = ["merge", "--out", text(&out)];
        let parts = ["3", "1", "2"].map(|part| out.with_extension(format!("{ending}.{part}-of-3")));
        let missing = ["there are no parts", "part 1/3 is missing", "part 2/3 is missing"];
        for (part, missing) in ["3/3", "1/3", "2/3"].into_iter().zip(missing) {
            fail(&merge, missing);
            assert_ne!(
                brdfit(&[&arguments[..], &["--shard", part, "--resume"]].concat()).code,
                2
            );
        }
        let merged = brdfit(&merge);
        assert_eq!(
            (merged.code, merged.output, merged.errors),
            (ran.code, ran.output, ran.errors)
        );
        assert!(fs::read(&out).unwrap() == whole);
        let to_stdout = brdfit(
            &[
                &["merge", "--out", "-", "--format", ending],
                &parts.each_ref().map(|part| text(part))[..],
            ]
            .concat(),
        );
        assert!(to_stdout.output.as_bytes() == whole);
    }
}

#[test]
fn merge_takes_nothing_missing_or_doubled() {
    let (_root, folder, out) = scans(6);
    let shard = |options: &[&str]| {
        let ran = brdfit(&[&["batch", text(&folder), "--out", text(&out)], options].concat());
        assert_eq!(ran.code, 0, "{}", ran.errors);
    };
    shard(&["--shard", "1/2"]);
    shard(&["--shard", "2/2"]);
    let second = out.with_extension("csv.2-of-2");
    let part = fs::read_to_string(&second).unwrap();
    let lines: Vec<&str> = part.split_inclusive('\n').collect();
    let merge = ["merge", "--out", text(&out)];
    let broken = [
        (lines[..3].concat(), "file 6 of the batch is missing"),
        (
            [&lines[..2], &lines[3..]].concat().concat(),
            "file 4 of the batch is missing",
        ),
        (
            [&lines[..3], &lines[2..]].concat().concat(),
            "file 4 of the batch is doubled",
        ),
        (
            [&lines[..], &lines[3..]].concat().concat(),
            "more files than the batch has",
        ),
        (
            part[..part.len() - 9].to_string(),
            "file 6 of the batch is missing: the part is cut off",
        ),
        (
            part.replace("\"contents\"", "\"content\""),
            "the record of file 2 is broken",
        ),
        (
            lines
                .iter()
                .map(|line| summed(&line.replace("\"contents\"", "\"content\"")))
                .collect(),
            "the record of file 2 is broken",
        ),
        (lines[1..].concat(), "not a part of a batch"),
    ];
    for (contents, what) in broken {
        fs::write(&second, contents).unwrap();
        fail(&merge, what);
        assert!(!out.exists());
    }
    let first = out.with_extension("csv.1-of-2");
    fs::write(&second, &part).unwrap();
    fail(
        &[&merge[..], &[text(&first), text(&first), text(&second)]].concat(),
        "this is part 1/2, and so is",
    );
    fail(
        &[
            "merge",
            "--out",
            text(&out.with_extension("json")),
            text(&first),
            text(&second),
        ],
        "results of another form",
    );
    shard(&["--shard", "2/3"]);
    fail(&merge, "one of 3 parts, not of 2");
    shard(&["--shard", "2/2", "--seed", "5"]);
    fail(&merge, "made with other options");
}

#[test]
fn options_that_make_no_sense_are_one_line() {
    let (_root, folder, out) = scans(1);
    let folder = text(&folder);
    fail(&["batch", folder, "--out", "results.txt"], "does not say in which form");
    fail(&["batch", folder, "--out", "results.parquet"], "built without Parquet");
    fail(&["batch", folder, "--out", "-", "--shard", "1/2"], "needs a file");
    fail(&["batch", "no/such/*.csv", "--out", text(&out)], "no file matches");
    fail(&["batch", "-", "--out", text(&out)], "@-");
    fail(
        &["batch", folder, "--out", "no/folder/results.csv"],
        "cannot be written",
    );
    assert_eq!(
        brdfit(&["batch", folder, "--out", text(&out), "--shard", "3/2"]).code,
        2
    );
    let list = format!("# two names of one file, and one of none\n{folder}/00.csv\n{folder}/00.csv\ngone.csv\n");
    let ran = program::brdfit(&["batch", "@-", "--out", "-"], list.as_bytes());
    assert_eq!((ran.code, cells(&ran.output, &[]).len()), (1, 3));
    assert!(ran.errors.starts_with("gone.csv: no such file; "), "{}", ran.errors);
}
