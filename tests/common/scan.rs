//! Scans and other tables of numbers, from files.

use std::io::Write;
use std::path::{Path, PathBuf};

use brdfit_core::geometry::Sample;

/// A file that is part of the project.
pub fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

/// A file that the project may read, but not contain; it is not there on every machine.
pub fn shared(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared").join(name)
}

/// Says that a test did not run; straight to stderr, because what a passing test prints is not shown.
pub fn left_out(what: &str, missing: &Path) {
    let _ = writeln!(
        std::io::stderr(),
        "left out: {what}, because {} is not there",
        missing.display()
    );
}

/// The rows below the heading of a CSV file, cell by cell.
pub fn rows(path: &Path) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines.map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

/// The scan in a CSV file with the columns theta_i and theta_s, in degrees, and BRDF.
pub fn scan(path: &Path) -> Vec<Sample<f64>> {
    let sample = |row: Vec<String>| {
        let [theta_i, theta_s, brdf] = std::array::from_fn(|k| number(&row[k]));
        Sample::in_plane(theta_i.to_radians(), theta_s.to_radians(), brdf)
    };
    rows(path).into_iter().map(sample).collect()
}

/// The number in a cell.
pub fn number(cell: &str) -> f64 {
    cell.parse().unwrap_or_else(|_| panic!("`{cell}` is not a number"))
}

/// The parameters of Eq. 14 in the order of their names.
pub fn six(values: &[f64]) -> [f64; 6] {
    values.try_into().expect("Eq. 14 has six parameters")
}
