//! Prints the names of the readers, one a line.

use brdfit::input::format::Format;
use clap::ValueEnum;

// Instrumented code calls libFuzzer, also where nothing is fuzzed.
use libfuzzer_sys as _;

fn main() {
    for format in Format::value_variants() {
        println!("{}", format.name);
    }
}
