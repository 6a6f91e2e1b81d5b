//! The one error of the host: what is wrong, where, and what to do about it, in one line.

use std::fmt;

use crate::plain::plain;

/// Exit code of the program where input, options or files are at fault.
pub const EXIT_CODE: u8 = 2;

/// What is at fault, for callers that act on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// Options, or something else that was asked for.
    Options,
    /// What a file or a scan says.
    Input,
    /// A file or a stream that cannot be read or written.
    File,
    /// The samples allow no such fit.
    Fit,
    /// The work was no longer wanted.
    Interrupted,
}

impl ErrorKind {
    /// One word for other languages: `options`, `input`, `file`, `fit`, `interrupted`.
    pub fn name(self) -> &'static str {
        match self {
            ErrorKind::Options => "options",
            ErrorKind::Input => "input",
            ErrorKind::File => "file",
            ErrorKind::Fit => "fit",
            ErrorKind::Interrupted => "interrupted",
        }
    }
}

/// Something that the user can put right.
///
/// It prints as one line, `file:line:column: what; help`, as far as these are known, and as `error: what; help` where no file is at fault.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// What is at fault.
    pub kind: ErrorKind,
    /// What is wrong.
    pub what: String,
    /// The file at fault.
    pub file: Option<String>,
    /// The line in it; the first is 1.
    pub line: Option<u64>,
    /// The column of the table, not of the text; the first is 1.
    pub column: Option<u64>,
    /// What to do about it.
    pub help: Option<String>,
}

impl Error {
    /// An error that belongs to no file, of [`ErrorKind::Options`].
    pub fn new(what: impl Into<String>) -> Self {
        Error {
            kind: ErrorKind::Options,
            what: what.into(),
            file: None,
            line: None,
            column: None,
            help: None,
        }
    }

    /// An error of [`ErrorKind::File`].
    pub fn file(what: impl Into<String>) -> Self {
        Error::new(what).of(ErrorKind::File)
    }

    /// The same error, of this kind.
    pub fn of(mut self, kind: ErrorKind) -> Self {
        self.kind = kind;
        self
    }

    /// The same error, in `file`, whose content is at fault unless another kind was told.
    pub fn in_file(mut self, file: impl Into<String>) -> Self {
        self.file = Some(file.into());
        if self.kind == ErrorKind::Options {
            self.kind = ErrorKind::Input;
        }
        self
    }

    /// The same error, in this line of its file.
    pub fn at_line(mut self, line: u64) -> Self {
        self.line = Some(line);
        self
    }

    /// The same error, in this column of its line.
    pub fn at_column(mut self, column: u64) -> Self {
        self.column = Some(column);
        self
    }

    /// The same error, at the place of a row, as far as it is known: the line is 0 in a file without lines.
    pub(crate) fn at(self, line: u64, column: Option<u64>) -> Self {
        Error {
            line: if line > 0 { Some(line) } else { self.line },
            column: column.or(self.column),
            ..self
        }
    }

    /// The same error, with what to do about it.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

impl Error {
    /// As it prints, with the place in red for a terminal.
    pub fn in_color(&self) -> String {
        format!("\x1b[1;31m{}\x1b[0m: {}", self.place(), self.message())
    }

    /// `file:line:column`, as far as they are known.
    fn place(&self) -> String {
        let file = plain(self.file.as_deref().unwrap_or("error"));
        match (self.line, self.column) {
            (None, _) => file.into_owned(),
            (Some(line), None) => format!("{file}:{line}"),
            (Some(line), Some(column)) => format!("{file}:{line}:{column}"),
        }
    }

    /// As it prints, without the word `error` where no file is at fault: for callers that say so themselves, as an exception does.
    pub fn in_exception(&self) -> String {
        match self.file {
            Some(_) => self.to_string(),
            None => self.message(),
        }
    }

    /// What is wrong and what to do about it, without the place.
    pub fn message(&self) -> String {
        // What is wrong may be told in words of a file, such as the name of a column.
        let what = bounded(&plain(&self.what));
        match &self.help {
            Some(help) => format!("{what}; {}", bounded(&plain(help))),
            None => what,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place(), self.message())
    }
}

impl std::error::Error for Error {}

/// The text, without its middle where it is so long that nobody reads it: a list may come from a file.
fn bounded(text: &str) -> String {
    const HALF: usize = 400;
    let count = text.chars().count();
    if count <= 2 * HALF {
        return text.to_string();
    }
    let begin = text.chars().take(HALF);
    begin
        .chain(" ... ".chars())
        .chain(text.chars().skip(count - HALF))
        .collect()
}

/// Foreign text inside a message: on one line, and not too long.
pub fn shown(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut short: String = plain(&text.trim().chars().take(LONGEST).collect::<String>()).into_owned();
    if text.trim().chars().nth(LONGEST).is_some() {
        short.push_str("...");
    }
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prints_as_one_line() {
        let error = Error::new("the BRDF is -0.1, which has no logarithm")
            .in_file("scan.csv")
            .at_line(12)
            .at_column(3)
            .help("use --drop-invalid to leave such rows out");
        assert_eq!(
            error.to_string(),
            "scan.csv:12:3: the BRDF is -0.1, which has no logarithm; use --drop-invalid to leave such rows out"
        );
        assert_eq!(error.kind, ErrorKind::Input);
        assert_eq!(Error::new("no").kind, ErrorKind::Options);
        assert_eq!(Error::file("no").in_file("a").kind, ErrorKind::File);
        assert_eq!(Error::new("no").to_string(), "error: no");
        assert_eq!(Error::new("no").in_exception(), "no");
        assert_eq!(error.in_exception(), error.to_string());
        assert_eq!(Error::new("no").in_color(), "\x1b[1;31merror\x1b[0m: no");
        assert_eq!(shown(" a\nb "), "a\\nb");
        let long = Error::new(format!("first {} last", "µ, ".repeat(1000))).to_string();
        assert!(long.chars().count() < 900 && long.starts_with("error: first µ") && long.ends_with("µ,  last"));
        let hostile = Error::new("a\u{1b}[2Jb").in_file("c\n\u{202e}d").help("e\rf");
        assert_eq!(hostile.to_string(), "c\\n\\u{202e}d: a\\u{1b}[2Jb; e\\rf");
    }
}
