//! `brdfit completions`: what a shell wants.

use clap::{Args, Command};
use clap_complete::Shell;

use crate::error::Error;
use crate::output::deliver;
use crate::streams::Streams;

/// Prints the completions for a shell
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  brdfit completions bash > ~/.local/share/bash-completion/completions/brdfit")]
pub struct Arguments {
    /// The shell
    shell: Shell,
}

/// Runs the subcommand for the program of these commands.
///
/// # Errors
/// Standard output breaks.
pub fn run(arguments: &Arguments, mut program: Command, streams: &mut Streams) -> Result<(), Error> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut program, "brdfit", &mut script);
    deliver(&script, None, streams.output)
}
