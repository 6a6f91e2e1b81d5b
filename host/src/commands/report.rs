//! `brdfit report`: one HTML page on each scan, with figures, for people and for print.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;

use super::prove::{ProofArguments, part};
use super::subject::{self, Subject};
use crate::analysis::proof::provable;
use crate::engine::threads;
use crate::error::Error;
use crate::input::{ReadOptions, measurement};
use crate::options::SearchArguments;
use crate::output;
use crate::page::provenance;
use crate::page::section::Section;
use crate::page::{html, results};
use crate::plot::picture;
use crate::streams::Streams;
use crate::target::{NO_INPUTS, Target};

/// Writes a page with figures, tables and provenance of the fits of scans, as one HTML file
#[derive(Args, Debug)]
#[command(
    after_help = "Minima and the errors of all starts come from 250 fits by the paper's method, or from the fit itself with --method paper.\nOf results the scans are read and fitted again, with the options given here; the parameters must agree to the last bit.\n\nExample:\n  brdfit report paint.csv -o report.html\n  brdfit report results.json -o report.html"
)]
pub struct Arguments {
    /// Scans, as `brdfit fit` reads them, or results of `brdfit fit` or `batch` (JSON, CSV); - is standard input
    #[arg(required = true, value_name = "SCAN|RESULTS")]
    scans: Vec<PathBuf>,
    #[command(flatten)]
    search: SearchArguments,
    /// Writes the page to a file, or with - to standard output
    #[arg(short, long, visible_alias = "out", value_name = "FILE.html")]
    output: Option<PathBuf>,
    /// Writes each figure into a folder too, as SVG, and as PNG if brdfit is built with it
    #[arg(long, value_name = "DIR")]
    plot: Option<PathBuf>,
    /// Proves that no parameters within the bounds have an MSE^2 lower by more than this part, such as 5%, or finds them
    #[arg(long, value_name = "PART", value_parser = part)]
    certify: Option<f64>,
    #[command(flatten)]
    proof: ProofArguments,
    #[command(flatten)]
    read: ReadOptions,
}

/// Runs the subcommand; `given` are all arguments of the program, which the page shows.
///
/// # Errors
/// The first thing that is wrong with options, files or a fit.
pub fn run(arguments: &Arguments, given: &[OsString], streams: &mut Streams) -> Result<(), Error> {
    let wanted = arguments.search.wanted()?;
    arguments.proof.refuse_without(arguments.certify)?;
    arguments.read.refuse_together("report")?;
    if arguments.certify.is_some() {
        provable(wanted.candidates())?;
    }
    // Results name further files, which are inputs too.
    let target = |inputs: &[PathBuf]| output::target(arguments.output.as_deref(), inputs);
    target(&arguments.scans)?;
    let subjects = subject::read(&arguments.scans, &arguments.read, "report", streams)?;
    let inputs = subject::inputs(&arguments.scans, &subjects);
    let target = target(&inputs)?;
    let subjects = subject::settled(subjects, &wanted);
    if let Some(folder) = &arguments.plot {
        if arguments.output.as_ref() == Some(folder) {
            return Err(Error::new("--output is the page, and --plot a folder for its figures")
                .in_file(folder.display().to_string())
                .help("give them two names"));
        }
        make(folder)?;
    }
    let goal = arguments
        .certify
        .map(|eps| arguments.proof.goal(eps, &|| false, &|_| {}));
    let section = |Subject { measurement, stored }: &Subject| {
        let section = Section::new(measurement, &wanted, goal.as_ref())?;
        if let Some(Ok(stored)) = stored.as_ref().map(|stored| &stored.material) {
            // Results of a fit with a proof may have what the proof found.
            results::agree(&section.label, &section.searched, stored).or_else(|error| {
                results::agree(&section.label, &section.fit.outcome.material(), stored).map_err(|_| error)
            })?;
        }
        Ok(section)
    };
    let sections: Vec<Result<Section, Error>> = arguments.search.pool()?.install(|| match goal {
        // One proof after the other, each on all threads: so a limit of time is one of each.
        Some(_) => subjects.iter().map(section).collect(),
        None => threads::map(&subjects, &section),
    });
    let sections: Vec<Section> = sections.into_iter().collect::<Result<_, _>>()?;
    if let Some(folder) = &arguments.plot {
        draw(folder, &sections, &inputs)?;
    }
    let page = html::page(&sections, &provenance::command(given));
    output::deliver(page.as_bytes(), target.as_ref(), streams.output)?;
    for subject in &subjects {
        measurement::note(std::slice::from_ref(&subject.measurement), streams.errors);
    }
    Ok(())
}

/// Makes a folder for figures, which must take files.
fn make(folder: &Path) -> Result<(), Error> {
    let fail = |error| Error::file(format!("cannot be made: {error}")).in_file(folder.display().to_string());
    fs::create_dir_all(folder).map_err(fail)?;
    Target::new(&folder.join("1-curves.svg"), &NO_INPUTS).map(drop)
}

/// Writes every figure in each form that pictures have: `1-curves.svg` and so on, the number being that of the scan.
fn draw(folder: &Path, sections: &[Section], inputs: &[PathBuf]) -> Result<(), Error> {
    for (place, section) in sections.iter().enumerate() {
        for figure in &section.figures {
            for ending in picture::ENDINGS {
                let name = format!("{}-{}.{ending}", place + 1, figure.name);
                picture::save(&Target::new(&folder.join(name), inputs)?, &figure.svg)?;
            }
        }
    }
    Ok(())
}
