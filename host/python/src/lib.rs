//! The native half of the Python package `brdfit`.
//!
//! What users call, with its documentation, is in `python/brdfit`; options come from there as the words of the program's command line, so that both take the same.

mod command;
mod curve;
mod many;
mod one;
mod options;
mod rows;
mod scan;
mod table;
mod watch;

use pyo3::prelude::*;

/// What users call is in the package around this module.
#[pymodule]
mod _brdfit {
    #[pymodule_export]
    use super::command::{command, main};
    #[pymodule_export]
    use super::curve::brdf;
    #[pymodule_export]
    use super::many::fit_many;
    #[pymodule_export]
    use super::one::{fit, picture, report};
    #[pymodule_export]
    use super::options::{models, names};
    #[pymodule_export]
    use super::scan::{Scan, read, read_bytes, scan, table};
}
