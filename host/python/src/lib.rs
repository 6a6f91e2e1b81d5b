//! The native half of the Python package `brdfit`: arrays in, arrays out.
//!
//! What users call, with its documentation, is in `python/brdfit`.

mod scans;
mod settings;
mod table;

use brdfit::engine::{self, FitError, FitOptions, Method, Model, Outcome, Values};
use brdfit::input::azimuth;
use brdfit::parameters::check;
use brdfit::result::cell::Cell;
use brdfit_core::brdf::{ALL, Brdf, Params};
use brdfit_core::geometry::Geometry;
use brdfit_core::lm::Stop;
use brdfit_core::real::Real;
use numpy::ndarray::{Array1, Array2, Array3, Axis};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use scans::{Arrays, Scans};
use settings::Settings;
use table::Table;

/// What users call is in the package around this module.
#[pymodule]
mod _brdfit {
    #[pymodule_export]
    use super::{brdf, fit, fit_many};
}

/// Scans that are fitted between two looks for Ctrl-C.
const CHUNK: usize = 1024;

/// Place in `MESSAGES` of `python/brdfit/results.py`.
fn status(outcome: &Outcome) -> u8 {
    match outcome.stop {
        _ if !outcome.cost.is_finite() => 3,
        Stop::Cost => 0,
        Stop::Step => 1,
        Stop::Passes => 2,
        Stop::NotFinite => 3,
    }
}
/// The same, of a scan with fewer valid samples than parameters.
const TOO_FEW: u8 = 4;

/// The fit of the only scan of `arrays`.
#[pyfunction]
fn fit<'py>(py: Python<'py>, arrays: Arrays<'py>, settings: Settings) -> PyResult<Bound<'py, PyDict>> {
    let options = settings.options()?;
    let scans = arrays.scans();
    let outcome = py.detach(|| {
        let samples = scans.samples(0, settings.drop_invalid)?;
        let outcome = match options.method {
            Method::Paper => pool(0)?.install(|| engine::fit(&samples, &options)),
            Method::Default => engine::fit(&samples, &options),
        };
        outcome.map_err(|error| explain(&error))
    });
    let outcome = outcome.map_err(PyValueError::new_err)?;
    let result = PyDict::new(py);
    result.set_item("x", outcome.params.to_vec().into_pyarray(py))?;
    result.set_item("cov", square(&outcome.uncertainty.cov).into_pyarray(py))?;
    result.set_item("stderr", outcome.uncertainty.stderr.to_vec().into_pyarray(py))?;
    result.set_item("fun", outcome.cost)?;
    result.set_item("mse2", outcome.mse2)?;
    result.set_item("samples", outcome.samples)?;
    result.set_item("status", status(&outcome))?;
    result.set_item("at_bound", &outcome.at_bound)?;
    let minima = outcome.minima.iter();
    let minima: Vec<_> = minima
        .map(|it| (it.mse2, it.params.to_vec().into_pyarray(py), it.hits))
        .collect();
    result.set_item("minima", minima)?;
    result.set_item("table", table::of_one(py, &options, &outcome)?)?;
    Ok(result)
}

/// The fits of all scans of `arrays`, on `threads` threads; 0 is one for each core.
#[pyfunction]
fn fit_many<'py>(
    py: Python<'py>,
    arrays: Arrays<'py>,
    settings: Settings,
    threads: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let options = settings.options()?;
    let scans = arrays.scans();
    let invalid = settings.drop_invalid;
    let count = scans.count();
    let pool = py.detach(|| {
        // A fault in the last scan is told before the first is fitted.
        for scan in 0..count {
            scans.samples(scan, invalid)?;
        }
        pool(threads)
    });
    let pool = pool.map_err(PyValueError::new_err)?;
    let mut rows = Vec::with_capacity(count);
    let mut table = Table::new(options.model);
    for first in (0..count).step_by(CHUNK) {
        let chunk = first..count.min(first + CHUNK);
        let one = |scan| row(&scans, scan, invalid, &options, &table);
        let done: Result<Vec<Kept>, String> = py.detach(|| pool.install(|| chunk.into_par_iter().map(one).collect()));
        for mut row in done.map_err(PyValueError::new_err)? {
            table.push(row.cells.take());
            rows.push(row);
        }
        py.check_signals()?;
    }
    let result = PyDict::new(py);
    let x = Array2::from_shape_fn((count, 6), |(scan, k)| rows[scan].x[k]);
    result.set_item("x", x.into_pyarray(py))?;
    let cov = Array3::from_shape_fn((count, 6, 6), |(scan, i, j)| rows[scan].cov[i][j]);
    result.set_item("cov", cov.into_pyarray(py))?;
    let stderr = Array2::from_shape_fn((count, 6), |(scan, k)| rows[scan].stderr[k]);
    result.set_item("stderr", stderr.into_pyarray(py))?;
    let column = |of: fn(&Kept) -> f64| rows.iter().map(of).collect::<Array1<f64>>().into_pyarray(py);
    result.set_item("fun", column(|row| row.fun))?;
    result.set_item("mse2", column(|row| row.mse2))?;
    result.set_item(
        "status",
        rows.iter()
            .map(|row| row.status)
            .collect::<Array1<u8>>()
            .into_pyarray(py),
    )?;
    result.set_item(
        "minima",
        rows.iter()
            .map(|row| row.minima)
            .collect::<Array1<u8>>()
            .into_pyarray(py),
    )?;
    result.set_item("table", table.into_dict(py)?)?;
    Ok(result)
}

/// A square matrix by its rows.
fn square(rows: &[Values]) -> Array2<f64> {
    Array2::from_shape_fn((rows.len(), rows.len()), |(i, j)| rows[i][j])
}

/// What is kept of the fit of one scan of many.
struct Kept {
    x: Values,
    cov: Vec<Values>,
    stderr: Values,
    fun: f64,
    mse2: f64,
    status: u8,
    minima: u8,
    /// Those of the table; none without a fit.
    cells: Option<Vec<Cell>>,
}

fn row(scans: &Scans, scan: usize, drop_invalid: bool, options: &FitOptions, table: &Table) -> Result<Kept, String> {
    let samples = scans.samples(scan, drop_invalid)?;
    match engine::fit(&samples, options) {
        Ok(outcome) => Ok(Kept {
            x: outcome.params,
            fun: outcome.cost,
            mse2: outcome.mse2,
            status: status(&outcome),
            minima: outcome.minima.len() as u8,
            cells: Some(table.cells(options, &outcome)),
            stderr: outcome.uncertainty.stderr,
            cov: outcome.uncertainty.cov,
        }),
        Err(FitError::TooFew(..)) if drop_invalid => Ok(Kept {
            x: [f64::NAN; 6].into(),
            cov: vec![[f64::NAN; 6].into(); 6],
            stderr: [f64::NAN; 6].into(),
            fun: f64::NAN,
            mse2: f64::NAN,
            status: TOO_FEW,
            minima: 0,
            cells: None,
        }),
        Err(error) => Err(explain(&error)),
    }
}

/// The BRDF in sr^-1, or ln of it, at angles in degrees of shape (samples), with parameters of shape (samples, 6); NaN where a parameter is NaN.
#[pyfunction]
fn brdf<'py>(
    py: Python<'py>,
    theta_i: PyReadonlyArray1<'py, f64>,
    theta_s: PyReadonlyArray1<'py, f64>,
    delta_phi: PyReadonlyArray1<'py, f64>,
    x: PyReadonlyArray2<'py, f64>,
    ln: bool,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let (theta_i, theta_s, delta_phi, x) = (
        theta_i.as_array(),
        theta_s.as_array(),
        delta_phi.as_array(),
        x.as_array(),
    );
    let one = |index: usize| -> Result<f64, String> {
        let (angle_i, angle_s) = (theta_i[index], theta_s[index]);
        let geometry = Geometry::new(angle_i.to_radians(), angle_s.to_radians(), azimuth(delta_phi[index]));
        let geometry = geometry.map_err(|error| {
            let at = format!("theta_i = {angle_i}, theta_s = {angle_s} degrees");
            format!("{error} at {at}; take 0 <= theta_i < 90 and -90 < theta_s < 90")
        })?;
        let x = x.index_axis(Axis(0), index);
        let x: [f64; 6] = std::array::from_fn(|k| x[k]);
        if x.iter().any(|value| value.is_nan()) {
            return Ok(f64::NAN);
        }
        for (k, value) in x.into_iter().enumerate() {
            check(Model::paper(), k, value).map_err(|error| error.message())?;
        }
        let ln_f = Brdf::<f64, ALL>::new(&Params::from_array(x)).ln_f(&geometry);
        // Below this the exponential is not a normal number.
        const LEAST_LN: f64 = -708.0;
        Ok(match ln {
            true => ln_f,
            false if ln_f < LEAST_LN => 0.0,
            false => Real::exp(ln_f),
        })
    };
    let values: Result<Vec<f64>, String> = py.detach(|| (0..theta_i.len()).map(one).collect());
    Ok(values.map_err(PyValueError::new_err)?.into_pyarray(py))
}

/// Threads for one call: a pool that lasts, as rayon's own does, would hang in a process that is forked later.
fn pool(threads: usize) -> Result<rayon::ThreadPool, String> {
    let built = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    built.map_err(|error| format!("no threads: {error}; take fewer"))
}

fn explain(error: &FitError) -> String {
    format!("{error}; measure more, or leave out terms")
}
