//! Programs in other languages, which print one result a line.

use std::path::Path;
use std::process::{Command, Stdio};

/// The lines that `program` prints, by cells; none, and a word on standard error, if it cannot be run.
pub fn rows(program: &str, arguments: &[&Path]) -> Vec<Vec<String>> {
    let output = Command::new(program).args(arguments).stderr(Stdio::inherit()).output();
    match output {
        Ok(output) if output.status.success() => String::from_utf8_lossy(&output.stdout)
            .lines()
            .map(|line| line.split(',').map(str::to_string).collect())
            .collect(),
        _ => {
            eprintln!("left out: {program} {arguments:?} does not run");
            Vec::new()
        }
    }
}

/// The interpreter that has SciPy.
pub fn python() -> String {
    std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_string())
}

/// A file of this folder.
pub fn beside(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}
