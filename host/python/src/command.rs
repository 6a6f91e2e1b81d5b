//! The program itself, called from Python.

use std::ffi::OsString;
use std::io::{Cursor, IsTerminal, stderr, stdin, stdout};

use brdfit::cli::run;
use brdfit::interrupt;
use brdfit::streams::Streams;
use brdfit::until::give_up;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::watch::apart;

/// Runs a command on `input` as its standard input: the exit code, standard output, and standard error.
#[pyfunction]
pub fn command<'py>(
    py: Python<'py>,
    words: Vec<OsString>,
    input: Vec<u8>,
) -> PyResult<(u8, Bound<'py, PyBytes>, String)> {
    let (code, output, errors) = apart(py, move |until| {
        give_up(until);
        let (mut output, mut errors) = (Vec::new(), Vec::new());
        let words = std::iter::once(OsString::from("brdfit")).chain(words);
        let code = run(
            words,
            &mut Streams {
                input: &mut Cursor::new(input),
                output: &mut output,
                errors: &mut errors,
                progress: false,
                color: false,
                quiet: true,
            },
        );
        (code, output, String::from_utf8_lossy(&errors).into_owned())
    })?;
    Ok((code, PyBytes::new(py, &output), errors))
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
