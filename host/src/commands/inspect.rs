//! `brdfit inspect`: what was read of a file, before any fit.

use std::path::PathBuf;

use clap::Args;

use crate::error::Error;
use crate::input::{self, ReadOptions, own};
use crate::output::{self, Format, deliver};
use crate::plot::{self, picture};
use crate::result::inspect::{Inspected, json, text};
use crate::streams::Streams;
use crate::target::Target;

/// Shows what is read of files: columns, units, scans, angles, what is left out, and hints
#[derive(Args, Debug)]
#[command(
    after_help = "Example:\n  brdfit inspect paint.csv --plot paint.svg\n  brdfit inspect scan_20.txt scan_45.txt --columns theta_s=1,brdf=2 --one-scan -o scan.csv"
)]
pub struct Arguments {
    /// Files with scans; - is standard input
    #[arg(required = true, value_name = "SCAN")]
    scans: Vec<PathBuf>,
    /// Form of the summary
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Writes the samples as the program's own table, which reads back to the same bits; with - to standard output, in place of the summary
    #[arg(short, long, visible_alias = "out", value_name = "FILE")]
    output: Option<PathBuf>,
    /// Draws the samples, as SVG or PNG; for one scan
    #[arg(long, value_name = "FILE", value_parser = picture::name)]
    plot: Option<PathBuf>,
    #[command(flatten)]
    read: ReadOptions,
}

/// Runs the subcommand.
///
/// # Errors
/// A file that cannot be read, or an output that cannot be written.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    let table = output::target(arguments.output.as_deref(), &arguments.scans)?;
    let picture = arguments.plot.as_deref();
    let picture = picture.map(|path| Target::new(path, &arguments.scans)).transpose()?;
    Target::differ(&table.iter().chain(&picture).collect::<Vec<_>>())?;
    let measurements = input::read(&arguments.scans, &arguments.read, streams.input)?;
    if let (Some(target), [measurement]) = (&picture, &measurements[..]) {
        let drawn = plot::scan_svg(&measurement.label(), &plot::Drawn::of_scan(measurement).data(), &[]);
        picture::save(target, &drawn)?;
    } else if picture.is_some() {
        return Err(Error::new("--plot draws one scan").help("give one scan, or choose one with --column"));
    }
    if arguments.output.is_some() {
        deliver(own::table(&measurements).as_bytes(), table.as_ref(), streams.output)?;
        if table.is_none() {
            return Ok(());
        }
    }
    let scans: Vec<Inspected> = measurements.iter().map(Inspected::new).collect();
    let summary = match arguments.format {
        Format::Text => text(&scans),
        Format::Json => json(&scans),
    };
    deliver(summary.as_bytes(), None, streams.output)
}
