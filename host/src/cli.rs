//! The command line: one function, which the program and the tests call alike.

mod usage;

use std::ffi::OsString;
use std::io::Write;

use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{ColorChoice, CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::commands::{
    batch, certify, compare, completions, converge, export, fit, inspect, joint, man, merge, paper, profile, report,
    simulate, stability,
};
use crate::error::{EXIT_CODE, Error};
use crate::input::formats;
use crate::plain::{self, Lines};
use crate::streams::{Ended, Streams};
pub use usage::usage;

/// Finds the parameters of microfacet BRDF models from scatterometer scans
#[derive(Parser, Debug)]
#[command(
    name = "brdfit",
    version,
    propagate_version = true,
    disable_help_subcommand = true,
    after_help = "Exit codes: 0 done, 1 some scans of a batch could not be fitted, 2 wrong input or options, 130 interrupted.\nExample: brdfit fit paint.csv"
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Shows no progress, notes or summaries: only results and errors
    #[arg(short, long, global = true)]
    quiet: bool,
    /// Colours of help and errors
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto")]
    color: ColorChoice,
}

// A further subcommand is a module with `Arguments` and `run`, one variant here and one arm in `dispatch`.
#[derive(Subcommand, Debug)]
enum Command {
    Fit(fit::Arguments),
    Inspect(inspect::Arguments),
    Report(report::Arguments),
    Certify(certify::Arguments),
    Batch(batch::Arguments),
    Merge(merge::Arguments),
    Simulate(simulate::Arguments),
    Paper(paper::Arguments),
    Profile(profile::Arguments),
    Compare(compare::Arguments),
    Joint(joint::Arguments),
    Converge(converge::Arguments),
    Stability(stability::Arguments),
    Export(export::Arguments),
    Completions(completions::Arguments),
    Man(man::Arguments),
}

/// The program's commands and options, of which help, completions and manual are made.
pub fn command() -> clap::Command {
    Cli::command().mut_subcommands(with_formats)
}

/// A command whose `--input-format`, if it has one, takes the names of the formats and shows them in its help.
fn with_formats(command: clap::Command) -> clap::Command {
    const ID: &str = "input_format";
    let reads = command.get_arguments().any(|argument| argument.get_id() == ID);
    if !reads {
        return command;
    }
    let names = formats::all()
        .iter()
        .map(|format| PossibleValue::new(format.name).help(format.about));
    command.mut_arg(ID, |argument| argument.value_parser(PossibleValuesParser::new(names)))
}

/// Runs the program on its arguments, of which the first is its own name; the result is the exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>, streams: &mut Streams) -> u8 {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let color = color(&arguments, streams.color);
    let ended = match parsed(&arguments) {
        Ok(cli) => started(&cli, &arguments, color, streams),
        Err(error) => return explain(&error, color, streams),
    };
    // If even standard error is closed, the exit code remains.
    match ended {
        Ok(ended) => {
            let _ = Lines(streams.errors).write_all(ended.why.as_bytes());
            ended.code
        }
        Err(error) => {
            let _ = writeln!(
                streams.errors,
                "{}",
                if color { error.in_color() } else { error.to_string() }
            );
            EXIT_CODE
        }
    }
}

/// The same for callers that take errors as values: what [`run`] says on standard error at its end is told to them.
///
/// # Errors
/// What is wrong with arguments or input.
pub fn call(arguments: impl IntoIterator<Item = OsString>, streams: &mut Streams) -> Result<Ended, Error> {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let color = color(&arguments, streams.color);
    match parsed(&arguments) {
        Ok(cli) => started(&cli, &arguments, color, streams),
        Err(error) if error.use_stderr() => Err(usage(&error)),
        Err(error) => {
            explain(&error, color, streams);
            Ok(Ended::default())
        }
    }
}

fn parsed(arguments: &[OsString]) -> Result<Cli, clap::Error> {
    let matches = command().try_get_matches_from(arguments)?;
    Cli::from_arg_matches(&matches)
}

fn started(cli: &Cli, arguments: &[OsString], color: bool, streams: &mut Streams) -> Result<Ended, Error> {
    let mut nowhere = std::io::sink();
    // Names and cells in notes and failures come from elsewhere.
    let mut shown = Lines(streams.errors);
    dispatch(
        &cli.command,
        arguments,
        &mut Streams {
            input: streams.input,
            output: streams.output,
            errors: if cli.quiet { &mut nowhere } else { &mut shown },
            progress: streams.progress && !cli.quiet,
            color,
            quiet: cli.quiet,
        },
    )
}

/// Are colours wanted? Also known where the other arguments make no sense.
fn color(arguments: &[OsString], auto: bool) -> bool {
    let texts: Vec<_> = arguments.iter().map(|argument| argument.to_string_lossy()).collect();
    let given = texts
        .iter()
        .enumerate()
        .rev()
        .find_map(|(place, text)| match text.strip_prefix("--color") {
            Some("") => texts.get(place + 1).map(|next| next.as_ref()),
            Some(rest) => rest.strip_prefix('='),
            None => None,
        });
    match given {
        Some("always") => true,
        Some("never") => false,
        _ => auto,
    }
}

fn dispatch(command: &Command, given: &[OsString], streams: &mut Streams) -> Result<Ended, Error> {
    match command {
        Command::Batch(arguments) => return batch::run(arguments, streams),
        Command::Certify(arguments) => return certify::run(arguments, streams),
        Command::Fit(arguments) => return fit::run(arguments, streams),
        Command::Inspect(arguments) => inspect::run(arguments, streams),
        Command::Merge(arguments) => return merge::run(arguments, streams),
        Command::Report(arguments) => report::run(arguments, given, streams),
        Command::Simulate(arguments) => simulate::run(arguments, streams),
        Command::Paper(arguments) => paper::run(arguments, streams),
        Command::Profile(arguments) => profile::run(arguments, streams),
        Command::Compare(arguments) => compare::run(arguments, streams),
        Command::Joint(arguments) => joint::run(arguments, given, streams),
        Command::Converge(arguments) => converge::run(arguments, streams),
        Command::Stability(arguments) => stability::run(arguments, streams),
        Command::Export(arguments) => export::run(arguments, streams),
        Command::Completions(arguments) => completions::run(arguments, self::command(), streams),
        Command::Man(arguments) => man::run(arguments, self::command(), streams),
    }?;
    Ok(Ended::default())
}

/// Help, the version, or what clap says of wrong usage.
fn explain(error: &clap::Error, color: bool, streams: &mut Streams) -> u8 {
    let to: &mut dyn Write = if error.use_stderr() {
        streams.errors
    } else {
        streams.output
    };
    let text = error.render();
    // Wrong usage is told in the user's own words, whose escapes are not for the terminal.
    let ours = !error.use_stderr() || plain::lines(&text.to_string()) == text.to_string();
    let _ = if color && ours {
        write!(to, "{}", text.ansi())
    } else {
        write!(Lines(to), "{text}")
    };
    if error.use_stderr() { EXIT_CODE } else { 0 }
}
