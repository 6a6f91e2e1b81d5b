//! The fits of many scans, on several threads.

use std::sync::atomic::{AtomicUsize, Ordering};

use brdfit::analysis::fit::known;
use brdfit::analysis::{choose, deviations};
use brdfit::engine::{FitError, Model, Until, Values, robust};
use brdfit::input::Measurement;
use brdfit::result::cell::Cell;
use brdfit::result::columns::every;
use brdfit::terms::term_names;
use numpy::IntoPyArray;
use numpy::ndarray::{Array2, Array3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use crate::one::status;
use crate::options::{self, Asked};
use crate::rows::{Arrays, Scans};
use crate::table::Table;
use crate::watch::scoped;

/// Scans whose results are put into arrays together.
const CHUNK: usize = 1024;
/// Place in `MESSAGES` of `python/brdfit/results.py`: a scan has fewer valid samples than parameters.
const TOO_FEW: u8 = 4;

/// The fits of all scans of `arrays`, as the fields of `Fits` in `python/brdfit/results.py`.
///
/// `words` are the options of all scans, or of each; `progress` is called with the number of scans that are done.
#[pyfunction]
pub fn fit_many<'py>(
    py: Python<'py>,
    arrays: Arrays<'py>,
    words: Vec<Vec<String>>,
    drop_invalid: bool,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let work = Work {
        scans: arrays.scans()?,
        asked: words
            .iter()
            .map(|words| options::search(words))
            .collect::<PyResult<_>>()?,
        drop_invalid,
        done: AtomicUsize::new(0),
    };
    let tell = |done: usize| match &progress {
        Some(progress) => progress.call1((done,)).map(drop),
        None => Ok(()),
    };
    let found = scoped(py, |until| work.all(until), |_| tell(work.done.load(Ordering::Relaxed)))?;
    let (rows, table) = found.map_err(PyValueError::new_err)?;
    tell(rows.len())?;

    let models = work.models();
    let parameters: Vec<&str> = every(&models).iter().map(|parameter| parameter.name).collect();
    // Where each parameter of the result is among those of each model.
    let places = |row: &Kept| -> Vec<Option<usize>> {
        let model = row.model;
        parameters
            .iter()
            .map(|name| model.and_then(|model| model.place(name)))
            .collect()
    };
    let places: Vec<_> = rows.iter().map(places).collect();
    let (count, size) = (rows.len(), parameters.len());
    let value = |of: fn(&Kept) -> &Values, row: usize, k: usize| places[row][k].map_or(f64::NAN, |k| of(&rows[row])[k]);
    let x = Array2::from_shape_fn((count, size), |(row, k)| value(|row| &row.x, row, k));
    let stderr = Array2::from_shape_fn((count, size), |(row, k)| value(|row| &row.stderr, row, k));
    let cov = Array3::from_shape_fn((count, size, size), |(row, i, j)| {
        let places = &places[row];
        places[i].zip(places[j]).map_or(f64::NAN, |(i, j)| rows[row].cov[i][j])
    });
    let column = |of: fn(&Kept) -> f64| rows.iter().map(of).collect::<Vec<f64>>().into_pyarray(py);
    let small = |of: fn(&Kept) -> u8| rows.iter().map(of).collect::<Vec<u8>>().into_pyarray(py);
    let result = PyDict::new(py);
    result.set_item("names", &parameters)?;
    result.set_item("x", x.into_pyarray(py))?;
    result.set_item("cov", cov.into_pyarray(py))?;
    result.set_item("stderr", stderr.into_pyarray(py))?;
    result.set_item("fun", column(|row| row.fun))?;
    result.set_item("mse2", column(|row| row.mse2))?;
    result.set_item("status", small(|row| row.status))?;
    result.set_item("minima", small(|row| row.minima))?;
    let names: Vec<&str> = rows
        .iter()
        .map(|row| row.model.map_or("", |model| model.name))
        .collect();
    result.set_item("model", names)?;
    let terms: Vec<String> = rows.iter().map(|row| term_names(row.terms).join(",")).collect();
    result.set_item("terms", terms)?;
    result.set_item("table", table.into_dict(py)?)?;
    Ok(result)
}

/// What is to be fitted.
struct Work<'a> {
    scans: Scans<'a>,
    /// Of all scans, or of each.
    asked: Vec<Asked>,
    drop_invalid: bool,
    done: AtomicUsize,
}

/// What is kept of the fit of one scan.
struct Kept {
    /// None without a fit.
    model: Option<&'static Model>,
    terms: u8,
    x: Values,
    cov: Vec<Values>,
    stderr: Values,
    fun: f64,
    mse2: f64,
    status: u8,
    minima: u8,
    cells: Option<Vec<Cell>>,
}

impl Work<'_> {
    fn asked(&self, scan: usize) -> &Asked {
        match &self.asked[..] {
            [one] => one,
            each => &each[scan],
        }
    }

    /// The models of all scans, each once.
    fn models(&self) -> Vec<&'static Model> {
        let mut models: Vec<&'static Model> = Vec::new();
        for model in self.asked.iter().flat_map(|asked| asked.wanted.models()) {
            if !models.contains(&model) {
                models.push(model);
            }
        }
        models
    }

    fn all(&self, until: Until) -> Result<(Vec<Kept>, Table), String> {
        let count = self.scans.count();
        // A fault in the last scan is told before the first is fitted.
        for scan in 0..count {
            if until.is_over() {
                break;
            }
            self.scans.seen(scan, self.drop_invalid, until)?;
        }
        let mut table = Table::new(&self.models());
        let Some(first) = self.asked.first() else {
            return Ok((Vec::new(), table));
        };
        let all = first.on_threads(|| {
            let mut rows = Vec::with_capacity(count);
            for first in (0..count).step_by(CHUNK) {
                let chunk = first..count.min(first + CHUNK);
                let fits = chunk.into_par_iter().map(|scan| self.one(scan, until, &table));
                let fits: Vec<Kept> = fits.collect::<Result<_, String>>()?;
                for mut row in fits {
                    table.push(row.cells.take());
                    rows.push(row);
                }
            }
            Ok((rows, table))
        });
        all.map_err(|error| error.in_exception())?
    }

    fn one(&self, scan: usize, until: Until, table: &Table) -> Result<Kept, String> {
        let seen = self.scans.seen(scan, self.drop_invalid, until)?;
        let wanted = self.asked(scan).until(until);
        let measurement = Measurement {
            deviations: seen.deviations,
            ..Measurement::of_samples("scan", seen.samples, seen.sigma_ln)
        };
        let measurement = deviations::settled(measurement, &wanted);
        let samples = &measurement.samples;
        let found = choose::fit(samples, &wanted).map(|(options, outcome, choice)| {
            let kept = robust::kept(samples, &outcome);
            let (outcome, _) = known(&measurement, &kept, &options, outcome);
            (options, outcome, choice)
        });
        let kept = match found {
            Ok((options, outcome, _)) => Kept {
                model: Some(outcome.model),
                terms: outcome.terms,
                x: outcome.params,
                fun: outcome.cost,
                mse2: outcome.mse2,
                status: status(&outcome),
                minima: outcome.minima.len() as u8,
                cells: Some(table.cells(&options, &outcome)),
                stderr: outcome.uncertainty.stderr,
                cov: outcome.uncertainty.cov,
            },
            Err(FitError::TooFew(..)) if self.drop_invalid => Kept {
                model: None,
                terms: 0,
                x: Values::from([]),
                cov: Vec::new(),
                stderr: Values::from([]),
                fun: f64::NAN,
                mse2: f64::NAN,
                status: TOO_FEW,
                minima: 0,
                cells: None,
            },
            Err(error) if self.scans.count() > 1 => {
                return Err(format!("scan {scan}: {error}; measure more, or leave out terms"));
            }
            Err(error) => return Err(format!("{error}; measure more, or leave out terms")),
        };
        self.done.fetch_add(1, Ordering::Relaxed);
        Ok(kept)
    }
}
