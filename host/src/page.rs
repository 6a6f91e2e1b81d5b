//! `brdfit report`: one HTML page on each scan, with figures, for people and for print.

mod html;
mod provenance;
mod section;

use std::ffi::OsString;
use std::path::PathBuf;

use clap::Args;
use rayon::prelude::*;

use crate::cli::Streams;
use crate::error::Error;
use crate::input::{self, ReadOptions, left_out};
use crate::options::SearchArguments;
use crate::output::deliver;
use provenance::Source;
use section::Section;

/// Writes a page with figures, tables and provenance of the fits of scans, as one HTML file
#[derive(Args, Debug)]
#[command(
    after_help = "Minima and the errors of all starts come from 250 fits by the paper's method, or from the fit itself with --method paper.\n\nExample:\n  brdfit report paint.csv -o report.html"
)]
pub struct Arguments {
    /// Scans, as `brdfit fit` reads them; - is standard input
    #[arg(required = true, value_name = "SCAN")]
    scans: Vec<PathBuf>,
    #[command(flatten)]
    search: SearchArguments,
    /// Writes the page to a file, or with - to standard output
    #[arg(short, long, visible_alias = "out", value_name = "FILE.html")]
    output: Option<PathBuf>,
    #[command(flatten)]
    read: ReadOptions,
}

/// Runs the subcommand; `given` are all arguments of the program, which the page shows.
///
/// # Errors
/// The first thing that is wrong with options, files or a fit.
pub fn run(arguments: &Arguments, given: &[OsString], streams: &mut Streams) -> Result<(), Error> {
    let options = arguments.search.fit_options()?;
    let files = input::read_bytes(&arguments.scans, streams.input)?;
    let mut scans = Vec::new();
    for (name, bytes) in &files {
        let source = Source::new(bytes);
        let measurements = input::parse(name, bytes, &arguments.read)?;
        scans.extend(
            measurements
                .into_iter()
                .map(|measurement| (measurement, source.clone())),
        );
    }
    let sections: Vec<Result<Section, Error>> = arguments.search.pool()?.install(|| {
        let each = scans.par_iter();
        each.map(|(measurement, source)| Section::new(measurement, source, &options))
            .collect()
    });
    let sections: Vec<Section> = sections.into_iter().collect::<Result<_, _>>()?;
    let page = html::page(&sections, &provenance::command(given));
    deliver(page.as_bytes(), arguments.output.as_deref(), streams.output)?;
    for (measurement, _) in &scans {
        left_out::note(std::slice::from_ref(measurement), streams.errors);
    }
    Ok(())
}
