//! The records of an unfinished run, in the order in which the files were finished; a run that is killed leaves all but perhaps its last line.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::record::{self, Head, Record};
use crate::error::Error;

/// An open journal.
pub struct Journal {
    /// Its file.
    pub path: PathBuf,
    file: File,
    /// Of each file of the batch, where its last record is.
    places: Vec<Option<Place>>,
    end: u64,
}

/// Where the record of a file is, and whether it still holds.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    at: u64,
    length: u64,
    /// [`record::fingerprint`] of the file when it was fitted.
    pub contents: u64,
    /// A scan of it could not be fitted.
    pub failed: bool,
}

impl Journal {
    /// Opens the journal at `path`, or begins it; one that is there is only taken to `resume` it.
    ///
    /// # Errors
    /// There is one of another batch, or one that was not to be there, or another process writes to it.
    pub fn open(path: PathBuf, head: &Head, resume: bool) -> Result<Journal, Error> {
        let fail = |what: String, help: &str| Error::new(what).in_file(path.display().to_string()).help(help);
        let broken = |error: std::io::Error| {
            fail(
                format!("can not be written: {error}"),
                "check that the folder is there and writable",
            )
        };
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path)
            .map_err(broken)?;
        // Some network drives know no locks; there the user must see to it.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(fail(
                "another brdfit writes to this".into(),
                "wait for it to end, or take another --out",
            ));
        }
        let mut places = vec![None; head.files];
        let mut end = 0;
        if file.metadata().map_err(broken)?.len() > 0 {
            if !resume {
                return Err(fail(
                    "here are the finished fits of a run that was interrupted".into(),
                    "add --resume to go on from them, or remove the file",
                ));
            }
            end = read(&file, &path, head, &mut places)?;
        }
        // What a kill left of a last line goes.
        file.set_len(end)
            .and_then(|()| file.seek(SeekFrom::Start(end)))
            .map_err(broken)?;
        let mut journal = Journal {
            path,
            file,
            places,
            end,
        };
        if end == 0 {
            journal.append(record::line(head).as_bytes())?;
        }
        Ok(journal)
    }

    /// Keeps the record of a file.
    ///
    /// # Errors
    /// The disk is full or gone.
    pub fn keep(&mut self, record: &Record) -> Result<(), Error> {
        let line = record::line(record);
        let place = Place {
            at: self.end,
            length: line.len() as u64,
            contents: record.contents,
            failed: record.failed(),
        };
        self.append(line.as_bytes())?;
        self.places[record.index] = Some(place);
        Ok(())
    }

    fn append(&mut self, line: &[u8]) -> Result<(), Error> {
        self.file.write_all(line).map_err(|error| self.broken(&error))?;
        self.end += line.len() as u64;
        Ok(())
    }

    /// Where the record of file `index` is, if there is one.
    pub fn place(&self, index: usize) -> Option<Place> {
        self.places[index]
    }

    /// The record of file `index`, which must be there.
    ///
    /// # Errors
    /// The journal was changed meanwhile.
    pub fn record(&mut self, index: usize) -> Result<Record, Error> {
        let missing = || Error::new(format!("file {index} is not in here")).in_file(self.path.display().to_string());
        let place = self.places[index].ok_or_else(missing)?;
        let mut line = vec![0; place.length as usize];
        let read = self
            .file
            .seek(SeekFrom::Start(place.at))
            .and_then(|_| self.file.read_exact(&mut line));
        read.map_err(|error| self.broken(&error))?;
        serde_json::from_slice(&line).map_err(|error| self.broken(&error.into()))
    }

    /// The run is at its end, and its results are written.
    pub fn remove(self) {
        // What can not be removed can be resumed.
        let _ = std::fs::remove_file(&self.path);
    }

    fn broken(&self, error: &std::io::Error) -> Error {
        Error::new(format!("can not be kept: {error}"))
            .in_file(self.path.display().to_string())
            .help("check the disk, and go on with --resume")
    }
}

/// Finds the records that are there; the result is where the last whole one ends.
fn read(file: &File, path: &Path, head: &Head, places: &mut [Option<Place>]) -> Result<u64, Error> {
    let help = "remove the file, or take the options and files of the run that was interrupted";
    let fail =
        |error: std::io::Error| Error::new(format!("can not be read: {error}")).in_file(path.display().to_string());
    let mut lines = BufReader::new(file);
    let mut line = Vec::new();
    let mut end = 0;
    while lines.read_until(b'\n', &mut line).map_err(fail)? > 0 && line.ends_with(b"\n") {
        if end == 0 {
            let found: Head = serde_json::from_slice(&line).map_err(|_| {
                Error::new("this is no file of finished fits")
                    .in_file(path.display().to_string())
                    .help(help)
            })?;
            record::agree(&found, head, path, help)?;
        } else {
            let Ok(record) = serde_json::from_slice::<Record>(&line) else {
                break;
            };
            let Some(place) = places.get_mut(record.index) else {
                break;
            };
            *place = Some(Place {
                at: end,
                length: line.len() as u64,
                contents: record.contents,
                failed: record.failed(),
            });
        }
        end += line.len() as u64;
        line.clear();
    }
    Ok(end)
}
