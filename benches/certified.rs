//! Prints the solver's results on certified problems as a Markdown table: `cargo run --release --example certified -- nist` (or `mgh`).

use brdfit_suite::{mgh_problems, nist_models};

fn main() {
    let options = nist_models::options();
    match std::env::args().nth(1).as_deref() {
        Some("nist") => {
            println!("# NIST StRD nonlinear regression, both certified starts\n");
            println!(
                "LRE: log relative error, -log10 of the relative distance from the certified value, the least over the parameters; at most 11, the digits that are certified."
            );
            println!("A pass evaluates the residuals and J once.");
            println!("Regenerate: `cargo run --release --example certified -- nist > benches/results/nist.md`.\n");
            print!("{}", nist_models::table(&nist_models::run_all(&options)));
        }
        Some("mgh") => {
            println!(
                "# Problems of Moré, Garbow and Hillstrom with at most 9 parameters, from 1, 10 and 100 times the standard start\n"
            );
            println!("What is not reached is explained in tests/mgh.rs.");
            println!("Regenerate: `cargo run --release --example certified -- mgh > benches/results/mgh.md`.\n");
            print!("{}", mgh_problems::table(&mgh_problems::run_all(&options)));
        }
        _ => {
            eprintln!("say which: nist or mgh");
            std::process::exit(2);
        }
    }
}
