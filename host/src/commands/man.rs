//! `brdfit man`: what a reader of manuals wants.

use clap::{Args, Command};
use clap_mangen::Man;

use crate::error::Error;
use crate::output::deliver;
use crate::streams::Streams;

/// Prints the manual page of the program or of a command
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  brdfit man fit | man -l -")]
pub struct Arguments {
    /// A command [default: the program]
    command: Option<String>,
}

/// Runs the subcommand for the program of these commands.
///
/// # Errors
/// There is no such command, or standard output breaks.
pub fn run(arguments: &Arguments, mut program: Command, streams: &mut Streams) -> Result<(), Error> {
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
