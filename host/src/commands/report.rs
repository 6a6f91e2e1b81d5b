//! `brdfit report`: one HTML page on each scan, with figures, for people and for print.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use rayon::prelude::*;

use crate::engine::Material;
use crate::error::Error;
use crate::input::{self, Measurement, ReadOptions, left_out};
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
    #[command(flatten)]
    read: ReadOptions,
}

/// A scan to report.
#[derive(Clone)]
struct Subject {
    measurement: Measurement,
    /// What its results say.
    stored: Option<Material>,
}

/// Runs the subcommand; `given` are all arguments of the program, which the page shows.
///
/// # Errors
/// The first thing that is wrong with options, files or a fit.
pub fn run(arguments: &Arguments, given: &[OsString], streams: &mut Streams) -> Result<(), Error> {
    let options = arguments.search.fit_options()?;
    arguments.read.refuse_together("report")?;
    // Results name further files, which are inputs too.
    let target = |inputs: &[PathBuf]| output::target(arguments.output.as_deref(), inputs);
    target(&arguments.scans)?;
    let mut subjects = Vec::new();
    for (name, bytes) in input::read_bytes(&arguments.scans, streams.input)? {
        match results::parse(&bytes) {
            None => subjects.extend(scans(&name, &bytes, &arguments.read)?),
            Some(fitted) => subjects.extend(of_results(&name, fitted, arguments, streams)?),
        }
    }
    let named = subjects.iter().map(|subject| PathBuf::from(&subject.measurement.file));
    let inputs: Vec<PathBuf> = arguments.scans.iter().cloned().chain(named).collect();
    let target = target(&inputs)?;
    if let Some(folder) = &arguments.plot {
        make(folder)?;
    }
    let sections: Vec<Result<Section, Error>> = arguments.search.pool()?.install(|| {
        let each = subjects.par_iter();
        each.map(|Subject { measurement, stored }| {
            let section = Section::new(measurement, &options)?;
            if let Some(stored) = stored {
                results::agree(&section.label, &section.fit.outcome.material(), stored)?;
            }
            Ok(section)
        })
        .collect()
    });
    let sections: Vec<Section> = sections.into_iter().collect::<Result<_, _>>()?;
    if let Some(folder) = &arguments.plot {
        draw(folder, &sections, &inputs)?;
    }
    let page = html::page(&sections, &provenance::command(given));
    output::deliver(page.as_bytes(), target.as_ref(), streams.output)?;
    for subject in &subjects {
        left_out::note(std::slice::from_ref(&subject.measurement), streams.errors);
    }
    Ok(())
}

/// The scans in the bytes of a file.
fn scans(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<Vec<Subject>, Error> {
    let subject = |measurement| Subject {
        measurement,
        stored: None,
    };
    Ok(input::parse(name, bytes, options)?.into_iter().map(subject).collect())
}

/// The scans that results name; those without a fit are left out, and standard error is told.
fn of_results(
    name: &str,
    fitted: Vec<results::StoredFit>,
    arguments: &Arguments,
    streams: &mut Streams,
) -> Result<Vec<Subject>, Error> {
    let mut files: HashMap<PathBuf, Vec<Subject>> = HashMap::new();
    let mut found = Vec::new();
    for one in fitted {
        let stored = match one.material {
            Ok(material) => material,
            Err(why) => {
                // If standard error is closed, the page still says what it is of.
                let _ = writeln!(streams.errors, "{name}: left out, as it has no fit: {why}");
                continue;
            }
        };
        let file = one.file.display().to_string();
        // A file with many scans is read once.
        let all = match files.entry(one.file) {
            Entry::Occupied(read) => read.into_mut(),
            Entry::Vacant(place) => {
                // A file of results may name anything; reading a pipe would wait for ever.
                if place.key().metadata().is_ok_and(|there| !there.is_file()) {
                    return Err(Error::new("this is not a file")
                        .in_file(file)
                        .help(format!("{name} names it; give the results of scans in files")));
                }
                let bytes = input::read_bytes(std::slice::from_ref(place.key()), &mut std::io::empty());
                let help = || format!("{name} names it; call report where the fit was made");
                let bytes = bytes.map_err(|error| error.help(help()))?;
                let mut all = Vec::new();
                for (file, bytes) in bytes {
                    all.extend(scans(&file, &bytes, &arguments.read)?);
                }
                place.insert(all)
            }
        };
        let subject = all.iter().find(|subject| subject.measurement.name == one.scan);
        let mut subject = subject.cloned().ok_or_else(|| {
            let scan = one.scan.as_deref().unwrap_or("without a name");
            Error::new(format!("there is no scan {scan}, which {name} names")).in_file(file)
        })?;
        subject.stored = Some(stored);
        found.push(subject);
    }
    if found.is_empty() {
        return Err(Error::new("these results have no fit").in_file(name));
    }
    Ok(found)
}

/// Makes a folder for figures, which must take files.
fn make(folder: &Path) -> Result<(), Error> {
    let fail = |error| Error::new(format!("cannot be made: {error}")).in_file(folder.display().to_string());
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
