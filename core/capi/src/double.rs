//! The functions of C in `f64`: those of `single.rs`, as `build.rs` writes them.

include!(concat!(env!("OUT_DIR"), "/src/double.rs"));
