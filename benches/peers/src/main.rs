//! Other people's solvers beside brdfit's, on NIST's certified problems and on the paper's three sets; `benches/peers/run` prepares what is not Rust.

mod brdf;
mod fits;
mod nist;
mod outside;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["nist"] => nist::print(),
        ["brdf", starts] => brdf::print(starts.parse().expect("the number of starts")),
        _ => {
            eprintln!("say which: nist, or brdf and the number of starts");
            std::process::exit(2);
        }
    }
}
