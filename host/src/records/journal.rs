//! The records of an unfinished run, in the order in which the files were finished; a run that is killed leaves all but perhaps its last line.
//!
//! Nothing in the file is ever taken away: a record that is not whole is passed over, and the user is told.

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
    /// The lines whose records are not whole; the first line of a file is 1.
    pub damaged: Vec<u64>,
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
        let shown = path.display().to_string();
        let fail = |what: String, help: &str| Error::new(what).in_file(&shown).help(help);
        let broken = |error: std::io::Error| {
            Error::file(format!("cannot be written: {error}"))
                .in_file(&shown)
                .help("check that the folder is there and writable")
        };
        let file = OpenOptions::new()
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
        let mut journal = Journal {
            file,
            places: vec![None; head.files],
            end: 0,
            damaged: Vec::new(),
            path,
        };
        if journal.file.metadata().map_err(broken)?.len() == 0 {
            journal.append(record::line(head).as_bytes())?;
            return Ok(journal);
        }
        if !resume {
            return Err(fail(
                "here are the finished fits of a run that was interrupted".into(),
                "add --resume to go on from them, or remove the file",
            ));
        }
        journal.read(head)?;
        Ok(journal)
    }

    /// Keeps the record of a file.
    ///
    /// # Errors
    /// The disk is full or gone.
    pub fn keep(&mut self, record: &Record) -> Result<(), Error> {
        let line = record::line(record);
        let place = Place::of(record, self.end, line.as_bytes());
        self.append(line.as_bytes())?;
        self.places[record.index] = Some(place);
        Ok(())
    }

    fn append(&mut self, line: &[u8]) -> Result<(), Error> {
        // A record that was read may have left the file in its middle.
        let sought = self.file.seek(SeekFrom::Start(self.end));
        let written = sought.and_then(|_| self.file.write_all(line));
        written.map_err(|error| self.broken(&error))?;
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
        let changed = || std::io::Error::other("a record was changed meanwhile");
        record::of_line(&line).ok_or_else(|| self.broken(&changed()))
    }

    /// The run is at its end, and its results are written.
    pub fn remove(self) {
        // What cannot be removed can be resumed.
        let _ = std::fs::remove_file(&self.path);
    }

    fn broken(&self, error: &std::io::Error) -> Error {
        Error::file(format!("cannot be kept: {error}"))
            .in_file(self.path.display().to_string())
            .help("check the disk, and go on with --resume")
    }

    /// Finds the records that are there.
    fn read(&mut self, head: &Head) -> Result<(), Error> {
        let help = "remove the file, or take the options and files of the run that was interrupted";
        let path = self.path.clone();
        let fail =
            |error: std::io::Error| Error::file(format!("cannot be read: {error}")).in_file(path.display().to_string());
        let mut lines = BufReader::new(&self.file);
        let Some((found, length)) = record::head(&mut lines).map_err(fail)? else {
            return Err(Error::new("this is not a file of finished fits")
                .in_file(path.display().to_string())
                .help("move it elsewhere, or take another --out"));
        };
        record::agree(&found, head, &path, help)?;
        let (mut end, mut number) = (length, 1);
        let mut line = Vec::new();
        let mut torn = false;
        while lines.read_until(b'\n', &mut line).map_err(fail)? > 0 {
            number += 1;
            let record = record::of_line::<Record>(&line);
            let place = record.as_ref().and_then(|record| self.places.get_mut(record.index));
            match (record.as_ref(), place) {
                (Some(record), Some(place)) => *place = Some(Place::of(record, end, &line)),
                _ => self.damaged.push(number),
            }
            torn = !line.ends_with(b"\n");
            end += line.len() as u64;
            line.clear();
        }
        self.end = end;
        self.file.seek(SeekFrom::Start(end)).map_err(fail)?;
        // What a kill left of a last line ends here, so that the next record has a line of its own.
        if torn { self.append(b"\n") } else { Ok(()) }
    }
}

impl Place {
    fn of(record: &Record, at: u64, line: &[u8]) -> Place {
        Place {
            at,
            length: line.len() as u64,
            contents: record.contents,
            failed: record.failed(),
        }
    }
}

/// Makes a journal of a part that is finished, so that only what is damaged in it is fitted again; nothing if there is no such part, or a journal already.
///
/// # Errors
/// The part is of another batch, or cannot be read or copied.
pub fn take_over(part: &Path, journal: &Path, head: &Head) -> Result<(), Error> {
    let fail =
        |error: std::io::Error| Error::file(format!("cannot be read: {error}")).in_file(part.display().to_string());
    if journal.exists() || !part.is_file() {
        return Ok(());
    }
    let found = File::open(part).and_then(|file| record::head(&mut BufReader::new(file)));
    let Some((found, _)) = found.map_err(fail)? else {
        return Err(Error::new("this is not a part of a batch")
            .in_file(part.display().to_string())
            .help("move it elsewhere, or take another --out"));
    };
    record::agree(&found, head, part, "remove the file, or leave out --resume")?;
    std::fs::copy(part, journal).map(drop).map_err(fail)
}
