//! Prints what the solver makes of certified problems and of stiff valleys as a Markdown table: `cargo run --release --example certified -- mgh` (or `valley`).

use brdfit_suite::{mgh_problems, nist_models, valley};

fn main() {
    match std::env::args().nth(1).as_deref() {
        Some("mgh") => {
            println!(
                "# Problems of Moré, Garbow and Hillstrom with at most 9 parameters, from 1, 10 and 100 times the standard start\n"
            );
            println!("What is not reached is explained in tests/mgh.rs.");
            println!("Regenerate: `cargo run --release --example certified -- mgh > benches/results/mgh.md`.\n");
            print!(
                "{}",
                mgh_problems::table(&mgh_problems::run_all(&nist_models::options()))
            );
        }
        Some("valley") => {
            println!("# Passes of one fit to the end of its valley\n");
            println!(
                "From each of {} candidates of the default search to convergence, f64, all six parameters; the sets of the paper without noise (ideal) and with +-10 %.",
                valley::FITS
            );
            println!("Straight steps are the plain Levenberg-Marquardt method, bent ones are `Scan::bend`.");
            println!("Not converged: in 20,000 passes.");
            println!("Regenerate: `cargo run --release --example certified -- valley > benches/results/valley.md`.\n");
            print!("{}", valley::table());
        }
        _ => {
            eprintln!("say which: mgh or valley");
            std::process::exit(2);
        }
    }
}
