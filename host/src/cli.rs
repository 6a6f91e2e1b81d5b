//! The command line: one function, which the program and the tests call alike.

use std::ffi::OsString;
use std::io::{Read, Write};

use clap::{Parser, Subcommand};

use crate::batch::{self, merge};
use crate::error::{EXIT_CODE, Error};
use crate::{converge, fit, paper, simulate, stability};

/// Finds the parameters of microfacet BRDF models from scatterometer scans
#[derive(Parser, Debug)]
#[command(name = "brdfit", version, propagate_version = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

// A further subcommand is a module with `Arguments` and `run`, one variant here and one arm in `dispatch`.
#[derive(Subcommand, Debug)]
enum Command {
    Fit(fit::Arguments),
    Batch(batch::Arguments),
    Merge(merge::Arguments),
    Simulate(simulate::Arguments),
    Paper(paper::Arguments),
    Converge(converge::Arguments),
    Stability(stability::Arguments),
}

/// What the program reads and writes.
pub struct Streams<'a> {
    /// Standard input.
    pub input: &'a mut dyn Read,
    /// Standard output: results only.
    pub output: &'a mut dyn Write,
    /// Standard error: failures and notes.
    pub errors: &'a mut dyn Write,
    /// Show progress on the terminal that standard error is.
    pub progress: bool,
}

/// Runs the program on its arguments, of which the first is its own name; the result is the exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>, streams: &mut Streams) -> u8 {
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(error) => return explain(&error, streams),
    };
    match dispatch(&cli.command, streams) {
        Ok(code) => code,
        Err(error) => {
            // If even standard error is closed, the exit code remains.
            let _ = writeln!(streams.errors, "{error}");
            EXIT_CODE
        }
    }
}

fn dispatch(command: &Command, streams: &mut Streams) -> Result<u8, Error> {
    match command {
        Command::Batch(arguments) => return batch::run(arguments, streams),
        Command::Merge(arguments) => return merge::run(arguments, streams),
        Command::Fit(arguments) => fit::run(arguments, streams),
        Command::Simulate(arguments) => simulate::run(arguments, streams),
        Command::Paper(arguments) => paper::run(arguments, streams),
        Command::Converge(arguments) => converge::run(arguments, streams),
        Command::Stability(arguments) => stability::run(arguments, streams),
    }?;
    Ok(0)
}

/// Help, the version, or what clap says of wrong usage.
fn explain(error: &clap::Error, streams: &mut Streams) -> u8 {
    let to: &mut dyn Write = if error.use_stderr() {
        streams.errors
    } else {
        streams.output
    };
    let _ = write!(to, "{}", error.render());
    if error.use_stderr() { EXIT_CODE } else { 0 }
}
