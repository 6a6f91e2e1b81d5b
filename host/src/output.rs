//! How results leave the program: numbers with all their digits, files that are whole or not there.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use crate::error::Error;

/// In which form a result leaves, and where to: options of most commands.
#[derive(Args, Debug)]
pub struct OutputArguments<F: ValueEnum + Clone + Send + Sync + 'static = Format> {
    /// Form of the result
    #[arg(long, value_enum, default_value = "text")]
    pub format: F,
    /// Writes the result to a file, or with - to standard output
    #[arg(short, long, visible_alias = "out", value_name = "FILE")]
    output: Option<PathBuf>,
}

/// The forms of a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A page for people
    Text,
    /// JSON
    Json,
}

/// The forms of a result that is also a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TableFormat {
    /// A page for people
    Text,
    /// JSON
    Json,
    /// A table with a head
    Csv,
}

impl<F: ValueEnum + Clone + Send + Sync + 'static> OutputArguments<F> {
    /// Writes the result where it is wanted.
    ///
    /// # Errors
    /// As [`deliver`].
    pub fn deliver(&self, contents: &str, stream: &mut dyn Write) -> Result<(), Error> {
        deliver(contents.as_bytes(), self.output.as_deref(), stream)
    }
}

/// The shortest decimal form that reads back as the same number.
pub fn shortest(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || (1e-5..1e16).contains(&size) {
        format!("{x}")
    } else {
        format!("{x:e}")
    }
}

/// Writes a file that never is there by half: to a temporary file beside it, which is then renamed.
///
/// # Errors
/// The folder is missing or not writable, or the disk is full; what stood at `path` is then as before.
pub fn replace_file(path: &Path, contents: &[u8]) -> Result<(), Error> {
    replace_with(path, |file| file.write_all(contents))
}

/// The same for what is written bit by bit.
///
/// # Errors
/// As [`replace_file`], and what `write` fails with; an [`Error`] inside its failure comes out as it is.
pub fn replace_with(path: &Path, write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>) -> Result<(), Error> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let buffered = |file: &File| -> io::Result<()> {
        let mut buffer = BufWriter::new(file);
        write(&mut buffer)?;
        buffer.flush()
    };
    let all = || -> io::Result<()> {
        // A device or a pipe, such as /dev/null, is written to and not replaced.
        if path.metadata().is_ok_and(|there| !there.is_file() && !there.is_dir()) {
            return buffered(&File::options().write(true).open(path)?);
        }
        let mut builder = tempfile::Builder::new();
        // Private by default; a result is an ordinary file, so the user's mask decides.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.prefix(".brdfit-").tempfile_in(folder)?;
        buffered(file.as_file())?;
        file.as_file().sync_all()?;
        file.persist(path)?;
        Ok(())
    };
    all().map_err(|error| match error.downcast::<Error>() {
        Ok(own) => own,
        Err(error) => Error::new(format!("can not be written: {error}"))
            .in_file(path.display().to_string())
            .help("check that the folder is there and writable"),
    })
}

/// Writes to `path`, or to the stream if there is none or it is `-`.
///
/// # Errors
/// As [`replace_file`], and if the stream breaks; a reader that wants no more, such as `head`, is no error.
pub fn deliver(contents: &[u8], path: Option<&Path>, stream: &mut dyn Write) -> Result<(), Error> {
    match path.filter(|path| path.as_os_str() != "-") {
        Some(path) => replace_file(path, contents),
        None => match stream.write_all(contents).and_then(|()| stream.flush()) {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                Err(Error::new(format!("standard output can not be written: {error}")))
            }
            _ => Ok(()),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back() {
        for x in [0.0, 45.0, -85.5, 0.1, 1e-33, 2.5e300, 1.0 / 3.0, f64::MIN_POSITIVE] {
            assert_eq!(shortest(x).parse::<f64>().unwrap(), x);
        }
        assert_eq!(shortest(45.0), "45");
        assert_eq!(shortest(1e-33), "1e-33");
    }
}
