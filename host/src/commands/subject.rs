//! Scans, or results of earlier fits whose scans are to be read again.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::{Path, PathBuf};

use crate::analysis::choose::Wanted;
use crate::analysis::deviations;
use crate::error::Error;
use crate::input::{self, Measurement, ReadOptions, STDIN};
use crate::page::results::{self, StoredFit};
use crate::streams::Streams;

/// A scan that a command is about.
#[derive(Clone)]
pub(super) struct Subject {
    pub measurement: Measurement,
    /// What its results say.
    pub stored: Option<StoredFit>,
}

/// The scans in files, or those that results in them name; `-` is standard input, and `command` is what messages call the command.
///
/// # Errors
/// The first file that cannot be read.
pub(super) fn read(
    files: &[PathBuf],
    options: &ReadOptions,
    command: &str,
    streams: &mut Streams,
) -> Result<Vec<Subject>, Error> {
    let mut subjects = Vec::new();
    for (name, bytes) in input::read_bytes(files, streams.input)? {
        match results::parse(&bytes) {
            None => subjects.extend(scans(&name, &bytes, options)?),
            Some(fitted) => subjects.extend(of_results(&name, fitted, options, command, streams)?),
        }
    }
    Ok(subjects)
}

/// The same with weights from the fitted BRDF, where the files give standard deviations.
pub(super) fn settled(subjects: Vec<Subject>, wanted: &Wanted) -> Vec<Subject> {
    let settled = |subject: Subject| Subject {
        measurement: deviations::settled(subject.measurement, wanted),
        ..subject
    };
    subjects.into_iter().map(settled).collect()
}

/// All files that are read: those given, and those that results among them name.
pub(super) fn inputs(given: &[PathBuf], subjects: &[Subject]) -> Vec<PathBuf> {
    let named = subjects.iter().map(|subject| Path::new(&subject.measurement.file));
    given
        .iter()
        .map(PathBuf::as_path)
        .chain(named)
        .map(PathBuf::from)
        .collect()
}

/// The scans in the bytes of a file.
fn scans(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<Vec<Subject>, Error> {
    let subject = |measurement| Subject {
        measurement,
        stored: None,
    };
    Ok(input::parse(name, bytes, options)?.into_iter().map(subject).collect())
}

/// The scans that results name, in the files as they were; those without a fit are left out, and standard error is told.
fn of_results(
    name: &str,
    fitted: Vec<StoredFit>,
    options: &ReadOptions,
    command: &str,
    streams: &mut Streams,
) -> Result<Vec<Subject>, Error> {
    let mut files: HashMap<PathBuf, Vec<Subject>> = HashMap::new();
    let mut found = Vec::new();
    for one in fitted {
        if let Err(why) = &one.material {
            // If standard error is closed, the result still says what it is of.
            let _ = writeln!(streams.errors, "{name}: left out, as it has no fit: {why}");
            continue;
        }
        let file = one.file.display().to_string();
        if one.file == Path::new(STDIN) {
            return Err(
                Error::new("the scan of this result came from standard input, and is gone")
                    .in_file(name)
                    .help("give the scan in a file, and fit it anew"),
            );
        }
        // A file with many scans is read once.
        let all = match files.entry(one.file.clone()) {
            Entry::Occupied(read) => read.into_mut(),
            Entry::Vacant(place) => {
                // A file of results may name anything; reading a pipe would wait for ever.
                if place.key().metadata().is_ok_and(|there| !there.is_file()) {
                    return Err(Error::new("this is not a file")
                        .in_file(file)
                        .help(format!("{name} names it; give the results of scans in files")));
                }
                let bytes = input::read_bytes(std::slice::from_ref(place.key()), &mut std::io::empty());
                let help = || format!("{name} names it; call {command} where the fit was made");
                let bytes = bytes.map_err(|error| error.help(help()))?;
                let mut all = Vec::new();
                for (file, bytes) in bytes {
                    all.extend(scans(&file, &bytes, options)?);
                }
                place.insert(all)
            }
        };
        let subject = all.iter().find(|subject| subject.measurement.name == one.scan);
        let mut subject = subject.cloned().ok_or_else(|| {
            let scan = one.scan.as_deref().unwrap_or("without a name");
            Error::new(format!("there is no scan {scan}, which {name} names")).in_file(file)
        })?;
        results::same_files(&subject.measurement.about.sources, &one, command)?;
        subject.stored = Some(one);
        found.push(subject);
    }
    if found.is_empty() {
        return Err(Error::new("these results have no fit").in_file(name));
    }
    Ok(found)
}
