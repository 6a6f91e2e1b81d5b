//! Other people's solvers beside brdfit's, on NIST's certified problems and in a race to the optimum; `benches/peers/run` prepares what is not Rust.
#![allow(
    clippy::disallowed_methods,
    reason = "those who race against brdfit may use std's functions; its fits may not"
)]

#[cfg(ceres)]
mod ceres;
mod course;
mod fits;
mod globals;
mod nist;
mod octave;
mod outside;
mod profile;
mod race;
mod racers;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["nist"] => nist::print(),
        ["race"] => race::write(&outside::beside("../results")),
        _ => {
            eprintln!("say which: nist, or race");
            std::process::exit(2);
        }
    }
}
