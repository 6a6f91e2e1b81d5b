//! The program, called in this process.

use std::ffi::OsString;
use std::fs;

use brdfit::cli::run;
use brdfit::streams::Streams;
use tempfile::TempDir;

/// What a call left behind.
pub struct Ran {
    /// The exit code.
    pub code: u8,
    /// Standard output.
    pub output: String,
    /// Standard error.
    pub errors: String,
}

/// Calls `brdfit` with these arguments and this standard input.
pub fn brdfit(arguments: &[&str], mut input: &[u8]) -> Ran {
    let (mut output, mut errors) = (Vec::new(), Vec::new());
    let all = ["brdfit"].iter().chain(arguments).map(OsString::from);
    let code = run(
        all,
        &mut Streams {
            input: &mut input,
            output: &mut output,
            errors: &mut errors,
            progress: false,
            color: false,
            quiet: false,
        },
    );
    let text = |bytes| String::from_utf8(bytes).expect("the program writes UTF-8");
    Ran {
        code,
        output: text(output),
        errors: text(errors),
    }
}

/// Runs what must succeed without a word on standard error.
pub fn succeed(arguments: &[&str]) -> String {
    let ran = brdfit(arguments, b"");
    assert_eq!((ran.code, ran.errors.as_str()), (0, ""), "{arguments:?}");
    ran.output
}

/// Runs what must fail without a result, and gives its one line.
pub fn fail(arguments: &[&str]) -> String {
    let ran = brdfit(arguments, b"");
    assert_eq!(
        (ran.code, ran.output.as_str()),
        (2, ""),
        "{arguments:?}: {}",
        ran.errors
    );
    assert_eq!(ran.errors.matches('\n').count(), 1, "{}", ran.errors);
    ran.errors
}

/// Writes a file, and gives its path.
pub fn write(folder: &TempDir, name: &str, contents: impl AsRef<[u8]>) -> String {
    let path = folder.path().join(name);
    fs::write(&path, contents).expect("a writable folder");
    path.to_str().expect("a path in UTF-8").to_string()
}

/// The options of a scene of two angles of incidence, without noise.
pub const SCENE: [&str; 17] = [
    "simulate",
    "--theta-i",
    "30,60",
    "--theta-s",
    "-80:80:4",
    "--rho-d",
    "0.1",
    "--rho-s",
    "10",
    "--rho-v",
    "0.01",
    "--m",
    "0.1",
    "--n",
    "3",
    "--kappa",
    "1",
];

/// That scene in a new folder.
pub fn scene() -> (TempDir, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = write(&folder, "scan.csv", succeed(&SCENE));
    (folder, file)
}
