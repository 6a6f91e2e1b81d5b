//! What is made from the source is what is checked in; `BLESS=1 cargo test -p brdfit-capi --test header` makes it anew.

use std::ffi::CStr;
use std::path::Path;

use brdfit_capi::*;

fn compare(file: &str, made: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, made).unwrap();
    }
    let there = std::fs::read_to_string(&path).unwrap_or_default();
    for (number, (ours, theirs)) in made.lines().zip(there.lines()).enumerate() {
        assert_eq!(ours, theirs, "{file}, line {}", number + 1);
    }
    assert_eq!(made.len(), there.len(), "{file}: length");
}

#[test]
fn every_error_and_stop_has_its_text() {
    let text = |pointer: *const std::ffi::c_char| {
        // SAFETY: the library gives texts that end with 0 and live for ever.
        unsafe { CStr::from_ptr(pointer) }.to_str().unwrap()
    };
    let errors: Vec<_> = (brdfit_error::Small as i32..=0)
        .map(|code| text(brdfit_error_text(code)))
        .collect();
    let stops: Vec<_> = (0..=brdfit_stop::NotFinite as i32)
        .map(|code| text(brdfit_stop_text(code)))
        .collect();
    for (list, unknown) in [(errors, "unknown error"), (stops, "unknown stop")] {
        for (place, one) in list.iter().enumerate() {
            assert!(*one != unknown && !list[..place].contains(one), "{one}");
        }
    }
    assert_eq!(text(brdfit_error_text(1)), "unknown error");
    assert_eq!(text(brdfit_stop_text(-1)), "unknown stop");
    assert_eq!(text(brdfit_version()), env!("CARGO_PKG_VERSION"));
}

#[test]
fn the_header_is_that_of_the_source() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(folder.join("cbindgen.toml")).unwrap();
    let mut builder = cbindgen::Builder::new().with_config(config);
    for file in [
        "src/types.rs",
        "src/names.rs",
        "src/single.rs",
        concat!(env!("OUT_DIR"), "/src/double.rs"),
    ] {
        builder = builder.with_src(folder.join(file));
    }
    let mut header = Vec::new();
    builder.generate().unwrap().write(&mut header);
    compare("include/brdfit.h", &String::from_utf8(header).unwrap());
}

#[test]
fn readme_has_every_code() {
    let (header, readme) = (include_str!("../include/brdfit.h"), include_str!("../README.md"));
    let mut codes = 0;
    for line in header.lines() {
        let Some((name, code)) = line.trim_end_matches(',').split_once(" = ") else {
            continue;
        };
        let (name, Ok(code)) = (name.trim(), code.parse()) else {
            continue;
        };
        let meaning = match name {
            _ if name.starts_with("BRDFIT_ERROR_") => brdfit_error_text(code),
            _ if name.starts_with("BRDFIT_STOP_") => brdfit_stop_text(code),
            _ => continue,
        };
        // SAFETY: the library gives texts that end with 0 and live for ever.
        let meaning = unsafe { CStr::from_ptr(meaning) }.to_str().unwrap();
        let row = format!("| {code} | `{name}` | {meaning} |\n");
        assert!(readme.contains(&row), "README.md lacks {row}");
        codes += 1;
    }
    assert_eq!(codes, 17 + 5);
}
