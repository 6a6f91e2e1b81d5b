//! Files and standard input as bytes, and bytes as text.

use std::fs;
use std::io::Read;
use std::path::Path;

use crate::error::Error;

/// The name that stands for standard input.
pub const STDIN: &str = "-";

/// Reads the bytes of a file.
///
/// # Errors
/// It is missing, a directory, or not readable.
pub fn of_file(path: &Path) -> Result<Vec<u8>, Error> {
    let fail = |what: String| Error::new(what).in_file(path.display().to_string());
    // On some systems a directory opens like a file, and only reading it fails.
    if path.is_dir() {
        return Err(fail("this is a directory".into()).help("name the files in it"));
    }
    fs::read(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => fail("no such file".into()).help("check the name and the folder"),
        _ => fail(format!("can not be read: {error}")).help("check its permissions"),
    })
}

/// Reads all of standard input.
///
/// # Errors
/// The stream breaks.
pub fn of_stdin(stream: &mut dyn Read) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    match stream.read_to_end(&mut bytes) {
        Ok(_) => Ok(bytes),
        Err(error) => Err(Error::new(format!("can not be read: {error}")).in_file(STDIN)),
    }
}

/// The text in the bytes of a file, without its byte order mark.
///
/// # Errors
/// There are no bytes, or they are not UTF-8.
pub fn text(bytes: &[u8]) -> Result<&str, Error> {
    if bytes.is_empty() {
        return Err(Error::new("the file is empty").help("give a file with a header line and one row a sample"));
    }
    let binary = |end: usize| {
        Error::new("this is not UTF-8 text")
            .at_line(line_at(bytes, end))
            .help("give a CSV file, or save it again as UTF-8 text")
    };
    let text = std::str::from_utf8(bytes).map_err(|error| binary(error.valid_up_to()))?;
    match text.find('\0') {
        Some(end) => Err(binary(end)),
        None => Ok(text.strip_prefix('\u{feff}').unwrap_or(text)),
    }
}

/// The line of the byte at `end`; the first is 1.
fn line_at(bytes: &[u8], end: usize) -> u64 {
    1 + bytes[..end].iter().filter(|&&byte| byte == b'\n').count() as u64
}

/// Where the lines of a text begin.
pub struct Lines(Vec<usize>);

impl Lines {
    /// Finds them.
    pub fn new(text: &str) -> Lines {
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        Lines(std::iter::once(0).chain(ends.map(|(end, _)| end + 1)).collect())
    }

    /// Line and column of `part`, which is a part of `text`; the first are 1.
    pub fn place(&self, text: &str, part: &str) -> (u64, u64) {
        let at = part.as_ptr().addr().saturating_sub(text.as_ptr().addr());
        let line = self.0.partition_point(|&begin| begin <= at);
        (line as u64, (at - self.0[line - 1]) as u64 + 1)
    }
}
