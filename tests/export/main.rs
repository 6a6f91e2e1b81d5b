//! `brdfit export`: what each form says is the model, to the digits that it has.

mod code;
mod results;
mod tables;

use brdfit::input::{self, ReadOptions};
use brdfit_suite::literal;
use brdfit_suite::program::{self, Ran};

/// Test data 1 of the paper.
const PARAMETERS: [f64; 6] = [0.1, 10.0, 0.01, 0.1, 3.0, 1.0];
const LIST: &str = "rho_d=0.1,rho_s=10,rho_v=0.01,m=0.1,n=3,kappa=1";
const NAMES: [&str; 6] = ["rho_d", "rho_s", "rho_v", "m", "n", "kappa"];

fn brdfit(arguments: &[&str]) -> Ran {
    program::brdfit(arguments, b"")
}

fn export(to: &str, name: &str) -> String {
    exported(&["export", "--params", LIST, "--to", to, "--name", name])
}

/// What is written, with no word but that the parameters make energy, which a Zemax table cannot hold.
fn exported(arguments: &[&str]) -> String {
    let ran = brdfit(arguments);
    let said = ran.errors.lines().all(|line| line.starts_with("TIS is written as 1"));
    assert!(ran.code == 0 && said, "{}", ran.errors);
    ran.output
}

/// The largest relative difference between a file's values, read as `brdfit fit` reads it, and Eq. 14 as printed.
fn off(text: &str, least: usize) -> f64 {
    off_from(text, least, |angles| literal::f(angles, PARAMETERS))
}

/// The same of any model.
fn off_from(text: &str, least: usize, f: impl Fn([f64; 3]) -> f64) -> f64 {
    let scans = input::parse(
        "file",
        text.as_bytes(),
        &ReadOptions {
            drop_invalid: true,
            ..ReadOptions::default()
        },
    )
    .unwrap();
    let [scan] = scans.as_slice() else {
        panic!("{} scans", scans.len())
    };
    assert!(scan.samples.len() > least, "{}", scan.samples.len());
    let each = scan
        .samples
        .iter()
        .map(|sample| (sample.brdf / f([sample.theta_i, sample.theta_s, sample.delta_phi]) - 1.0).abs());
    each.fold(0.0, f64::max)
}
