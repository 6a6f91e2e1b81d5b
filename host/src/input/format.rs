//! A format of files: its names, how it is known, and what reads it.

use std::fmt;

use serde::{Serialize, Serializer};

use super::options::ReadOptions;
use super::raw::RawScan;
use crate::error::Error;

/// A format of files with scans; two are equal if their names are.
#[derive(Clone, Copy)]
pub struct Format {
    /// Its name as an option.
    pub name: &'static str,
    /// What people call it.
    pub title: &'static str,
    /// What it is, for the help of the option.
    pub about: &'static str,
    /// How it is known and read.
    pub reader: Reader,
}

/// How files of a format are known and read.
#[derive(Clone, Copy)]
pub enum Reader {
    /// From the bytes as they are.
    Bytes {
        /// True if they begin as files of this format do.
        is: fn(&[u8]) -> bool,
        /// The scans as they stand in the file.
        read: fn(&[u8], &ReadOptions) -> Result<Vec<RawScan>, Error>,
    },
    /// As several texts, each of which is read as a file of its own.
    Sheets {
        /// True if they begin as files of this format do.
        is: fn(&[u8]) -> bool,
        /// The texts that the options ask for by name or number, or all.
        texts: fn(&[u8], &ReadOptions) -> Result<Vec<NamedText>, Error>,
    },
    /// From text, whatever its encoding was.
    Text {
        /// True if the text is of this format.
        is: fn(&str) -> bool,
        /// The scans as they stand in the file.
        read: fn(&str, &ReadOptions) -> Result<Vec<RawScan>, Error>,
    },
}

/// One of several texts in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedText {
    /// What tells it from the others, such as the name of a sheet.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// That of samples which no file holds.
pub const SAMPLES: Format = Format {
    name: "samples",
    title: "samples",
    about: "samples that another program gives",
    reader: Reader::Bytes {
        is: |_| false,
        read: |_, _| Err(Error::new("samples are read from no file")),
    },
};

impl PartialEq for Format {
    fn eq(&self, other: &Format) -> bool {
        self.name == other.name
    }
}

impl fmt::Debug for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

impl Serialize for Format {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name)
    }
}
