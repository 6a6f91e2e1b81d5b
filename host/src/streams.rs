//! What a command reads and writes, and how it ended.

use std::io::{Read, Write};

/// What the program reads and writes.
pub struct Streams<'a> {
    /// Standard input.
    pub input: &'a mut dyn Read,
    /// Standard output: results only.
    pub output: &'a mut dyn Write,
    /// Standard error: failures and notes.
    pub errors: &'a mut dyn Write,
    /// Show progress on the terminal that standard error is.
    pub progress: bool,
    /// Colours where `--color` does not say.
    pub color: bool,
    /// Show no summaries.
    pub quiet: bool,
}

/// How a command ended that did what it was asked for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ended {
    /// The exit code.
    pub code: u8,
    /// What standard error is told, even with `--quiet`: nothing, or whole lines.
    pub why: String,
}
