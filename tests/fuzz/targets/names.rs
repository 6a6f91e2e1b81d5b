//! Prints the names of the readers, one a line.

use brdfit::input::formats;

// Instrumented code calls libFuzzer, also where nothing is fuzzed.
use libfuzzer_sys as _;

fn main() {
    for format in formats::all() {
        println!("{}", format.name);
    }
}
