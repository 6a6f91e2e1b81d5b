//! The program, called in this process.

use std::ffi::OsString;

use brdfit::cli::{Streams, run};

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
