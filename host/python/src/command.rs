//! The program itself, called from Python.

use std::ffi::OsString;
use std::io::{Cursor, IsTerminal, stderr, stdin, stdout};

use brdfit::cli::{call, run};
use brdfit::error::Error;
use brdfit::interrupt;
use brdfit::streams::Streams;
use brdfit::until::give_up;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::options::refuse;
use crate::watch::apart;

/// What a command prints that has `input` as its standard input.
///
/// # Errors
/// `brdfit.Error`, one line.
#[pyfunction]
pub fn command<'py>(py: Python<'py>, words: Vec<OsString>, input: &[u8]) -> PyResult<Bound<'py, PyBytes>> {
    let input = input.to_vec();
    let ended = apart(py, move |until| {
        give_up(until);
        let mut output = Vec::new();
        let words = std::iter::once(OsString::from("brdfit")).chain(words);
        let ended = call(
            words,
            &mut Streams {
                input: &mut Cursor::new(input),
                output: &mut output,
                errors: &mut std::io::sink(),
                progress: false,
                color: false,
                quiet: true,
            },
        );
        match ended {
            Ok(ended) if ended.code != 0 => Err(Error::new(ended.why)),
            ended => ended.map(|_| output),
        }
    })?;
    let output = ended.map_err(|error| refuse(&error))?;
    Ok(PyBytes::new(py, &output))
}

/// The program `brdfit` on the process's own standard streams; `words` begin with its name. The exit code.
#[pyfunction]
pub fn main(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| {
        interrupt::listen();
        let color = stderr().is_terminal()
            && stdout().is_terminal()
            && std::env::var_os("NO_COLOR").is_none_or(|set| set.is_empty());
        run(
            words,
            &mut Streams {
                input: &mut stdin(),
                output: &mut stdout(),
                errors: &mut stderr(),
                progress: stderr().is_terminal(),
                color,
                quiet: false,
            },
        )
    })
}
