//! How results leave the program: in which form, and where to.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use crate::error::Error;
use crate::input::STDIN;
use crate::interrupt;
use crate::target::{Target, stdout_is_no_input};

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
    /// Where the result goes.
    ///
    /// # Errors
    /// As [`target`].
    pub fn target(&self, inputs: &[impl AsRef<Path>]) -> Result<Option<Target>, Error> {
        target(self.output.as_deref(), inputs)
    }

    /// Where the result and a picture of it go.
    ///
    /// # Errors
    /// As [`target`] for both, and if they are one file.
    pub fn targets(
        &self,
        picture: Option<&Path>,
        inputs: &[impl AsRef<Path>],
    ) -> Result<(Option<Target>, Option<Target>), Error> {
        let result = self.target(inputs)?;
        let picture = picture.map(|path| Target::new(path, inputs)).transpose()?;
        let both: Vec<&Target> = result.iter().chain(&picture).collect();
        Target::differ(&both)?;
        Ok((result, picture))
    }
}

/// Where a result goes: a file that may be written, or standard output for none or `-`.
///
/// # Errors
/// As [`Target::new`], and if standard output goes to one of the inputs.
pub fn target(path: Option<&Path>, inputs: &[impl AsRef<Path>]) -> Result<Option<Target>, Error> {
    let target = path
        .filter(|path| path.as_os_str() != STDIN)
        .map(|path| Target::new(path, inputs))
        .transpose()?;
    if target.is_none() {
        stdout_is_no_input(inputs)?;
    }
    interrupt::await_reader(target.is_none());
    Ok(target)
}

/// Writes to a file, or to the stream if there is none.
///
/// # Errors
/// As [`Target::write`], and if the stream breaks; a reader that closes early, such as `head`, is not an error.
pub fn deliver(contents: &[u8], target: Option<&Target>, stream: &mut dyn Write) -> Result<(), Error> {
    match target {
        Some(target) => target.write(contents),
        None => to_stream(stream, |stream| stream.write_all(contents)),
    }
}

/// Writes to standard output.
///
/// # Errors
/// The stream breaks, or what `write` fails with; a reader that closes early, such as `head`, is not an error.
pub fn to_stream(stream: &mut dyn Write, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Error> {
    interrupt::await_reader(false);
    match write(stream).and_then(|()| stream.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error
            .downcast::<Error>()
            .unwrap_or_else(|error| Error::file(format!("standard output cannot be written: {error}")))),
        _ => Ok(()),
    }
}
