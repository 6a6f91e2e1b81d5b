//! Reads scans: from the bytes of a file to samples in radians and sr^-1, with their weights.
//!
//! A file goes through the table in `formats` to the reader of that format, which gives each scan in it as a [`raw::RawScan`]: numbers as they stand in the file.
//! [`check`] makes samples of these: units, masks, validity, weights.
//! Degrees and file formats exist here and in `simulate` only.

pub mod about;
mod azimuths;
pub mod bytes;
mod channel;
pub mod check;
pub mod columns;
mod cut;
mod direction;
pub mod doubt;
mod facts;
mod file_name;
mod find;
mod finder;
pub mod format;
pub mod formats;
pub mod head;
mod idle;
mod incidence;
mod join;
pub mod kind;
mod large_sigma;
mod lately;
pub mod left_out;
mod marks;
pub mod measurement;
pub mod options;
pub mod own;
pub mod part;
pub mod plane;
mod polarisation;
pub mod raw;
pub mod read_as;
mod repeats;
pub mod role;
mod rows;
mod sheet;
pub mod side;
pub mod source;
mod spell;
mod table;
pub mod uncertainty;
pub mod unit;
pub mod units;
mod wavelength;
pub mod weight;
mod wide;

use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::engine::FitError;
use crate::error::{Error, ErrorKind, shown};
use crate::plain::some_of;
pub use about::About;
pub use bytes::STDIN;
use format::Format;
use kind::Kind;
pub use left_out::LeftOut;
pub use measurement::{Measurement, label};
pub use options::ReadOptions;
use raw::RawScan;
pub use read_as::ReadAs;
use source::Source;
pub use units::azimuth;

/// Reads every scan of every file, in order; a file may hold several.
///
/// # Errors
/// The first file that is missing, not understood, or leaves a doubt about what was measured: with its line and column.
pub fn read(paths: &[PathBuf], options: &ReadOptions, stdin: &mut dyn Read) -> Result<Vec<Measurement>, Error> {
    once(paths)?;
    let files = paths.iter();
    let files = files.map(|path| Ok((path.display().to_string(), bytes_of(path, stdin)?)));
    read_each(files, paths.len(), options)
}

/// The same of files whose bytes are at hand, which are only named here.
///
/// # Errors
/// As [`read`].
pub fn read_named(files: &[&(String, Vec<u8>)], options: &ReadOptions) -> Result<Vec<Measurement>, Error> {
    let each = files.iter().map(|(name, bytes)| Ok((name.clone(), bytes)));
    read_each(each, files.len(), options)
}

/// Reads one file after the other, and holds the bytes of one at a time.
fn read_each<B: AsRef<[u8]>>(
    given: impl Iterator<Item = Result<(String, B), Error>>,
    count: usize,
    options: &ReadOptions,
) -> Result<Vec<Measurement>, Error> {
    let each = join::options_of_each(options, count)?;
    let mut files = Vec::new();
    for (file, options) in given.zip(&each) {
        let (file, bytes) = file?;
        let scans = raw_scans(&file, bytes.as_ref(), options).map_err(|error| error.in_file(&file))?;
        files.push((file, scans));
    }
    if options.one_scan {
        files = vec![join::one(files)?];
    }
    let several = files.len() > 1;
    let mut measurements = Vec::new();
    for (file, scans) in files {
        measurements.extend(measured(&file, scans, options)?);
    }
    idle::refuse(&measurements, options)?;
    // One file an angle of incidence is most often one scan.
    if several && measurements.iter().all(|measurement| measurement.about.one_angle) {
        let note = "this is one angle of incidence; --one-scan takes all files as one scan".to_string();
        measurements
            .iter_mut()
            .for_each(|measurement| measurement.about.notes.push(note.clone()));
    }
    Ok(measurements)
}

/// The name and the bytes of every file, in order.
///
/// # Errors
/// The first file that is missing or not readable.
pub fn read_bytes(paths: &[PathBuf], stdin: &mut dyn Read) -> Result<Vec<(String, Vec<u8>)>, Error> {
    once(paths)?;
    let each = paths.iter();
    each.map(|path| Ok((path.display().to_string(), bytes_of(path, stdin)?)))
        .collect()
}

/// Reads the scans of one file, or of standard input if its name is `-`.
///
/// # Errors
/// As [`read`].
pub fn read_file(path: &Path, options: &ReadOptions, stdin: &mut dyn Read) -> Result<Vec<Measurement>, Error> {
    let bytes = bytes_of(path, stdin)?;
    parse(&path.display().to_string(), &bytes, options)
}

/// Refuses to read standard input twice.
fn once(paths: &[PathBuf]) -> Result<(), Error> {
    if paths.iter().filter(|path| path.as_os_str() == STDIN).count() > 1 {
        return Err(Error::new("standard input can be read only once").help("give - once"));
    }
    Ok(())
}

fn bytes_of(path: &Path, stdin: &mut dyn Read) -> Result<Vec<u8>, Error> {
    if path.as_os_str() == STDIN {
        bytes::of_stdin(stdin)
    } else {
        bytes::of_file(path)
    }
}

/// Reads a file that must hold one scan.
///
/// # Errors
/// As [`read`], and if there are several scans.
pub fn read_one(path: &Path, options: &ReadOptions, stdin: &mut dyn Read) -> Result<Measurement, Error> {
    let mut scans = read(&[path.to_path_buf()], options, stdin)?;
    if scans.len() > 1 {
        let names: Vec<String> = scans
            .iter()
            .filter_map(|scan| scan.name.as_deref().map(shown))
            .collect();
        return Err(
            Error::new(format!("there are {} scans: {}", scans.len(), some_of(&names)))
                .in_file(path.display().to_string())
                .help("choose one with --column"),
        );
    }
    scans
        .pop()
        .ok_or_else(|| Error::new("there is no scan").in_file(path.display().to_string()))
}

/// Reads the scans in the bytes of `file`, which is only named here.
///
/// # Errors
/// As [`read`].
///
/// ```
/// use brdfit::input::{ReadOptions, parse};
///
/// let table = b"theta_i_deg,theta_s_deg,brdf_per_sr\n30,-20,0.13\n30,30,2.7\n30,90,0.1\n";
/// let refused = parse("paint.csv", table, &ReadOptions::default()).err().map(|error| error.to_string());
/// assert!(refused.is_some_and(|line| line.starts_with("paint.csv:")));
/// let options = ReadOptions { drop_invalid: true, ..ReadOptions::default() };
/// let scans = parse("paint.csv", table, &options)?;
/// assert_eq!((scans.len(), scans[0].samples.len()), (1, 2));
/// # Ok::<(), brdfit::error::Error>(())
/// ```
pub fn parse(file: &str, bytes: &[u8], options: &ReadOptions) -> Result<Vec<Measurement>, Error> {
    let scans = raw_scans(file, bytes, options).map_err(|error| error.in_file(file))?;
    let scans = measured(file, scans, options)?;
    idle::refuse(&scans, options)?;
    Ok(scans)
}

/// The scans that are wanted of the bytes of a file, as they stand there, and its format.
fn raw_scans(file: &str, bytes: &[u8], options: &ReadOptions) -> Result<(Format, Vec<RawScan>), Error> {
    let (format, scans) = formats::scans(bytes, options)?;
    if !options.sheet.is_empty() && format.name != "xlsx" {
        return Err(
            Error::new(format!("--sheet is for Excel workbooks, and this is {}", format.title)).help("leave it out"),
        );
    }
    if let Some(scan) = scans.first() {
        options.refuse_for(scan.about.kind, format.title)?;
    }
    let mut scans = raw::select(scans, &options.column)?;
    cut::suspect(format, bytes, &mut scans);
    // Once, for a spectral file may have thousands of scans.
    let sources: Arc<[Source]> = Arc::new([Source::new(file, bytes)]);
    let asked = Arc::new(options.clone());
    for scan in &mut scans {
        scan.about.sources = sources.clone();
        scan.about.asked = asked.clone();
        incidence::give_theta_i(file, scan, options)?;
        if scan.about.kind != Kind::Own {
            doubt::settle(scan, options)?;
        }
    }
    Ok((format, scans))
}

/// The measurements in the scans of a file.
fn measured(
    file: &str,
    (format, scans): (Format, Vec<RawScan>),
    options: &ReadOptions,
) -> Result<Vec<Measurement>, Error> {
    let each = scans.into_iter();
    each.map(|scan| check::measurement(file, format, scan, options).map_err(|error| error.in_file(file)))
        .collect()
}

/// Says of a scan that cannot be fitted what to do, and names the line instead of the sample.
pub fn explain(measurement: &Measurement, error: FitError) -> Error {
    let plain = Error::new(error.to_string()).in_file(measurement.label());
    match error {
        // A scan that was read is valid in f64; only rounding to f32 can move a sample out of range.
        FitError::Sample(index, error) => Error::new(error.to_string())
            .in_file(&measurement.file)
            .at_line(measurement.lines[index])
            .help("take f64, or leave out the row"),
        FitError::OutOfPlane(index) => {
            Error::new("this direction is out of the plane of incidence, where there is no offset of theta_s to fit")
                .in_file(&measurement.file)
                .at_line(measurement.lines[index])
                .help("leave out --fit-offset, or the rows out of plane")
        }
        FitError::Limit => plain
            .of(ErrorKind::Fit)
            .help("widen --bounds, or leave out --conserve-energy"),
        FitError::TooFew(..) => plain.of(ErrorKind::Fit).help("measure more, or take fewer terms"),
        FitError::NoProof(_) => plain.of(ErrorKind::Options).help("only --model beckmann has one"),
        FitError::Interrupted => plain.of(ErrorKind::Interrupted),
        _ => plain.of(ErrorKind::Options),
    }
}
