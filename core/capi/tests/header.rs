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

fn what_is_written_for_float_is_the_same_for_double() {
    let double = |text: &str| text.replace("f32", "f64").replace("F32", "F64");
    compare("src/double.rs", &double(include_str!("../src/single.rs")));
    compare("tests/double.rs", &double(include_str!("float.rs")));
}

#[test]
fn every_error_and_stop_has_its_text() {
    let text = |pointer: *const std::ffi::c_char| {
        // SAFETY: the library gives texts that end with 0 and live for ever.
        unsafe { CStr::from_ptr(pointer) }.to_str().unwrap()
    };
    let errors: Vec<_> = (brdfit_error::Saved as i32..=0)
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
    // First, for the header is made from it.
    what_is_written_for_float_is_the_same_for_double();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(folder.join("cbindgen.toml")).unwrap();
    let mut builder = cbindgen::Builder::new().with_config(config);
    for file in ["types.rs", "names.rs", "single.rs", "double.rs"] {
        builder = builder.with_src(folder.join("src").join(file));
    }
    let mut header = Vec::new();
    builder.generate().unwrap().write(&mut header);
    compare("include/brdfit.h", &String::from_utf8(header).unwrap());
}
