//! The program `brdfit`; all of it is in [`brdfit::cli`].

use std::io::{IsTerminal, stderr, stdin, stdout};
use std::process::ExitCode;

use brdfit::cli::{Streams, run};

fn main() -> ExitCode {
    ExitCode::from(run(
        std::env::args_os(),
        &mut Streams {
            input: &mut stdin(),
            output: &mut stdout(),
            errors: &mut stderr(),
            progress: stderr().is_terminal(),
        },
    ))
}
