//! The tests of `single` in `f64`; `build.rs` writes them.

#![allow(clippy::unnecessary_cast, clippy::useless_conversion)]

include!(concat!(env!("OUT_DIR"), "/tests/main.rs"));
