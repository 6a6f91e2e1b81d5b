//! `brdfit completions` and `brdfit man`: what a shell and a reader of manuals want.

use clap::Args;
use clap_complete::Shell;
use clap_mangen::Man;

use crate::cli::{self, Streams};
use crate::error::Error;
use crate::output::deliver;

/// Prints the completions for a shell
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  brdfit completions bash > ~/.local/share/bash-completion/completions/brdfit")]
pub struct Completions {
    /// The shell
    shell: Shell,
}

/// Prints the manual page of the program or of a command
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  brdfit man fit | man -l -")]
pub struct Manual {
    /// A command [default: the program]
    command: Option<String>,
}

/// Runs `brdfit completions`.
///
/// # Errors
/// Standard output breaks.
pub fn completions(arguments: &Completions, streams: &mut Streams) -> Result<(), Error> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut cli::command(), "brdfit", &mut script);
    deliver(&script, None, streams.output)
}

/// Runs `brdfit man`.
///
/// # Errors
/// There is no such command, or standard output breaks.
pub fn manual(arguments: &Manual, streams: &mut Streams) -> Result<(), Error> {
    let mut program = cli::command();
    program.build();
    let page = match &arguments.command {
        None => program,
        Some(name) => {
            let names: Vec<&str> = program.get_subcommands().map(|command| command.get_name()).collect();
            let unknown = || {
                Error::new(format!("there is no command '{name}'")).help(format!("take one of {}", names.join(", ")))
            };
            program.find_subcommand(name).ok_or_else(unknown)?.clone()
        }
    };
    let mut roff = Vec::new();
    // Writing to memory does not fail.
    let _ = Man::new(page).render(&mut roff);
    deliver(&roff, None, streams.output)
}
