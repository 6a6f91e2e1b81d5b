//! What is said once, in `f32`, is compiled in `f64` too: functions and their tests.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or(io::ErrorKind::NotFound)?);
    for folder in ["src", "tests"] {
        fs::create_dir_all(out.join(folder))?;
    }
    double(Path::new("src/single.rs"), &out.join("src/double.rs"))?;
    println!("cargo::rerun-if-changed=tests/single");
    for file in fs::read_dir("tests/single")? {
        let file = file?;
        double(&file.path(), &out.join("tests").join(file.file_name()))?;
    }
    Ok(())
}

/// Writes a source file anew for `f64`, without what only the top of a file of its own may have.
fn double(from: &Path, to: &Path) -> io::Result<()> {
    println!("cargo::rerun-if-changed={}", from.display());
    let text = fs::read_to_string(from)?;
    let lines = text
        .lines()
        .filter(|line| !line.starts_with("//!") && !line.starts_with("#!["));
    let text: String = lines.flat_map(|line| [line, "\n"]).collect();
    fs::write(to, text.replace("f32", "f64").replace("F32", "F64"))
}
