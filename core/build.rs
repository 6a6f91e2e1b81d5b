//! Refuses the one optimisation level that makes everything worse on a microcontroller.

use std::env::var;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let is = |name, value| var(name).is_ok_and(|it| it == value);
    if is("OPT_LEVEL", "z") && is("CARGO_CFG_TARGET_OS", "none") {
        println!(
            "cargo::error=with opt-level \"z\" a fit takes five times as long, more flash than with \"s\", and can panic: set opt-level to \"s\", 2 or 3 in the profile of the program"
        );
    }
}
