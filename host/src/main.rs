//! The program `brdfit`; all of it is in [`brdfit::cli`].

use std::env;
use std::io::{IsTerminal, stderr, stdin, stdout};
use std::process::ExitCode;

use brdfit::cli::run;
use brdfit::interrupt;
use brdfit::streams::Streams;

fn main() -> ExitCode {
    interrupt::listen();
    ExitCode::from(run(
        env::args_os(),
        &mut Streams {
            input: &mut stdin(),
            output: &mut stdout(),
            errors: &mut stderr(),
            progress: stderr().is_terminal(),
            color: stderr().is_terminal()
                && stdout().is_terminal()
                && env::var_os("NO_COLOR").is_none_or(|set| set.is_empty()),
            quiet: false,
        },
    ))
}
