//! `brdfit profile`: which values of a parameter a scan allows.

use std::path::PathBuf;

use clap::Args;

use crate::analysis::profile::findings::{Asked, find};
use crate::error::Error;
use crate::input::{self, ReadOptions, measurement};
use crate::options::SearchArguments;
use crate::output::{Format, OutputArguments, deliver};
use crate::plot::picture;
use crate::result::profile::{json, svg, text};
use crate::streams::Streams;

/// Shows which values of a parameter a scan allows: the cost over it, minimised over the others
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  brdfit profile paint.csv --parameter n --plot n.svg")]
pub struct Arguments {
    /// A scan, as `brdfit fit` reads it; - is standard input
    #[arg(value_name = "SCAN")]
    scan: PathBuf,
    /// Parameter to profile; repeatable [default: all that are not fixed]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    parameter: Vec<String>,
    /// Adds percentiles over N copies of the fitted scan with new noise
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(20..=1_000_000))]
    bootstrap: Option<u32>,
    /// Takes the thresholds of the intervals from N copies of the scan at each end, in place of the F test's
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(20..=1_000_000))]
    calibrate: Option<u32>,
    #[command(flatten)]
    search: SearchArguments,
    #[command(flatten)]
    output: OutputArguments,
    /// Draws the profiles, as SVG, or as PNG if brdfit is built with it
    #[arg(long, value_name = "FILE", value_parser = picture::name)]
    plot: Option<PathBuf>,
    #[command(flatten)]
    read: ReadOptions,
}

/// Runs the subcommand.
///
/// # Errors
/// The first thing that is wrong with options, file or scan.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    let wanted = arguments.search.wanted()?;
    if arguments.calibrate.is_some() {
        arguments.search.instrument.refuse_offset("profile --calibrate")?;
    }
    let inputs = std::slice::from_ref(&arguments.scan);
    let (target, picture) = arguments.output.targets(arguments.plot.as_deref(), inputs)?;
    let measurement = input::read_one(&arguments.scan, &arguments.read, streams.input)?;
    let asked = Asked {
        parameters: &arguments.parameter,
        calibrate: arguments.calibrate.unwrap_or(0),
        bootstrap: arguments.bootstrap.unwrap_or(0),
    };
    let findings = arguments
        .search
        .pool()?
        .install(|| find(&measurement, &wanted, &asked))?;
    let written = match arguments.output.format {
        Format::Text => text(&findings),
        Format::Json => json(&findings),
    };
    if let Some(picture) = &picture {
        picture::save(picture, &svg(&findings))?;
    }
    deliver(written.as_bytes(), target.as_ref(), streams.output)?;
    measurement::note(&[measurement], streams.errors);
    Ok(())
}
