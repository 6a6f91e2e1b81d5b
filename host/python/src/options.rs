//! Options, as the words that the program's command line takes.

use brdfit::analysis::choose::Wanted;
use brdfit::cli::usage;
use brdfit::engine::models::MODELS;
use brdfit::engine::{Method, Until};
use brdfit::error::Error;
use brdfit::input::ReadOptions;
use brdfit::options::SearchArguments;
use brdfit::parameters;
use brdfit::until::{give_up, until};
use clap::Parser;
use pyo3::prelude::*;
use rayon::ThreadPool;

#[derive(Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct Searching {
    #[command(flatten)]
    search: SearchArguments,
}

#[derive(Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct Reading {
    #[command(flatten)]
    read: ReadOptions,
}

/// How to search.
pub struct Asked {
    /// What is wanted.
    pub wanted: Wanted,
    search: SearchArguments,
}

impl Asked {
    /// The same, given up when `until` says so.
    pub fn until(&self, until: Until) -> Wanted {
        self.wanted.until(until)
    }

    /// Runs `work` on the threads asked for: of a pool for this call, as one that lasts, such as rayon's own, would hang in a process that is forked later.
    ///
    /// # Errors
    /// The system gives no threads.
    pub fn on_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> Result<T, Error> {
        // What this thread gives up, the pool's gives up too.
        let until = until();
        Ok(self.pool()?.install(|| {
            give_up(until);
            work()
        }))
    }

    /// The same for one fit, which most often has no use for a pool.
    ///
    /// # Errors
    /// The system gives no threads.
    pub fn for_one<T: Send>(&self, work: impl FnOnce() -> T + Send) -> Result<T, Error> {
        match &self.wanted {
            Wanted::One(options) if options.method == Method::Default => Ok(work()),
            _ => self.on_threads(work),
        }
    }

    fn pool(&self) -> Result<ThreadPool, Error> {
        self.search.pool()
    }
}

/// How to search, in words such as `--seed=7`.
///
/// # Errors
/// `brdfit.Error`, one line.
pub fn search(words: &[String]) -> PyResult<Asked> {
    let Searching { search } = Searching::try_parse_from(words).map_err(|error| refuse(&usage(&error)))?;
    let wanted = search.wanted().map_err(|error| refuse(&error))?;
    Ok(Asked { wanted, search })
}

/// How to read, in words such as `--column=R`.
///
/// # Errors
/// `brdfit.Error`, one line.
pub fn reading(words: &[String]) -> PyResult<ReadOptions> {
    let Reading { read } = Reading::try_parse_from(words).map_err(|error| refuse(&usage(&error)))?;
    Ok(read)
}

/// Names of all models with what each is, that of the paper first.
#[pyfunction]
pub fn models() -> Vec<(&'static str, &'static str)> {
    MODELS.iter().map(|model| (model.name, model.what)).collect()
}

/// The parameters of a model: name, unit, what it is, value where it is absent.
#[pyfunction]
pub fn names(model: &str) -> PyResult<Vec<(&'static str, &'static str, &'static str, f64)>> {
    let model = parameters::model(model).map_err(|error| refuse(&error))?;
    let each = model.parameters.iter().enumerate();
    Ok(each
        .map(|(place, it)| (it.name, it.unit, it.what, model.absent(place)))
        .collect())
}

/// The exception of Python for an error of the program, `brdfit.Error`.
pub fn refuse(error: &Error) -> PyErr {
    let told = (
        error.in_exception(),
        error.kind.name(),
        error.file.as_deref(),
        error.line,
        error.column,
    );
    Python::attach(|py| {
        let class = py.import("brdfit._errors").and_then(|errors| errors.getattr("Error"));
        class
            .and_then(|class| class.call1(told))
            .map_or_else(|error| error, PyErr::from_value)
    })
}
