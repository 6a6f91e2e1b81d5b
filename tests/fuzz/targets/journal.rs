//! Any bytes in place of the finished fits of a run: it goes on from those that are whole, and takes nothing away.
#![no_main]

use std::fs;
use std::sync::LazyLock;

use brdfit::records::journal::Journal;
use brdfit::records::record::{self, Head, Record, Rows, ScanRecord, Written};
use brdfit::records::shard::Shard;
use brdfit::result::cell::{Cell, Kind};
use libfuzzer_sys::fuzz_target;
use tempfile::TempDir;

static FOLDER: LazyLock<TempDir> = LazyLock::new(|| tempfile::tempdir().expect("a folder"));

fn head() -> Head {
    Head {
        brdfit: "0".into(),
        options: String::new(),
        files: 4,
        names: 0,
        rows: Rows::Cells,
        columns: vec![("file".into(), Kind::Text)],
        shard: Shard::WHOLE,
    }
}

/// The bytes after a head of this batch or after none, each line with its checksum or without.
fn file(choice: u8, data: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    if choice & 1 != 0 {
        file.extend(record::line(&head()).into_bytes());
    }
    for line in data.split_inclusive(|&byte| byte == b'\n') {
        if choice & 2 != 0 {
            let json = line.strip_suffix(b"\n").unwrap_or(line);
            file.extend(format!("{:016x} ", record::fingerprint(json)).into_bytes());
        }
        file.extend(line);
    }
    file
}

fuzz_target!(|data: &[u8]| {
    let Some((&choice, data)) = data.split_first() else {
        return;
    };
    let file = file(choice, data);
    let path = FOLDER.path().join("out.csv.partial");
    fs::write(&path, &file).expect("a file");
    let Ok(mut journal) = Journal::open(path.clone(), &head(), true) else {
        assert_eq!(fs::read(&path).expect("the file"), file, "a foreign file was changed");
        return;
    };
    for index in 0..4 {
        if journal.place(index).is_some() {
            assert_eq!(journal.record(index).expect("a whole record").index, index);
        }
    }
    let kept = Record {
        index: 1,
        contents: 7,
        scans: vec![ScanRecord {
            row: Written::Cells(vec![Cell::Text("a.csv".into())]),
            line: Err("no".into()),
        }],
    };
    journal.keep(&kept).expect("room");
    drop(journal);
    assert!(
        fs::read(&path).expect("the file").starts_with(&file),
        "something was taken away"
    );
    let mut again = Journal::open(path, &head(), true).expect("the same batch");
    assert_eq!(again.record(1).expect("what was kept"), kept);
});
