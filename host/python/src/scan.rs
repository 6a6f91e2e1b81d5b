//! A scan, as it was read or as arrays give it.

use std::path::PathBuf;

use brdfit::input::{self, Measurement, azimuth, own};
use brdfit::number::shortest;
use brdfit_core::geometry::Sample;
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::options::{reading, refuse};
use crate::rows::Arrays;
use crate::watch::{apart, scoped};

/// A measured scan: samples in degrees and sr^-1, with what was left out of it.
#[pyclass(frozen, module = "brdfit", name = "Scan")]
pub struct Scan(pub Measurement);

/// The scan in arrays of shape (1, samples); `name` is what messages call it.
#[pyfunction]
pub fn scan(py: Python<'_>, arrays: Arrays<'_>, drop_invalid: bool, name: &str) -> PyResult<Scan> {
    let scans = arrays.scans()?;
    let seen = scoped(py, |until| scans.seen(0, drop_invalid, until), |_| Ok(()))?;
    let seen = seen.map_err(PyValueError::new_err)?;
    Ok(Scan(Measurement {
        left_out: seen.left_out.list(),
        deviations: seen.deviations,
        ..Measurement::of_samples(name, seen.samples, seen.sigma_ln)
    }))
}

/// The scans of files, in order.
#[pyfunction]
pub fn read(py: Python<'_>, paths: Vec<PathBuf>, words: Vec<String>) -> PyResult<Vec<Scan>> {
    let options = reading(&words)?;
    let found = apart(py, move |_| input::read(&paths, &options, &mut std::io::empty()))?;
    Ok(found.map_err(|error| refuse(&error))?.into_iter().map(Scan).collect())
}

/// The scans in the bytes of a file, which messages call `name`.
#[pyfunction]
pub fn read_bytes(py: Python<'_>, name: String, bytes: &[u8], words: Vec<String>) -> PyResult<Vec<Scan>> {
    let options = reading(&words)?;
    let bytes = bytes.to_vec();
    let found = apart(py, move |_| input::parse(&name, &bytes, &options))?;
    Ok(found.map_err(|error| refuse(&error))?.into_iter().map(Scan).collect())
}

/// The table of several scans, which are named by their places.
#[pyfunction]
pub fn table(py: Python<'_>, scans: Vec<Bound<'_, Scan>>) -> PyResult<String> {
    let scans: Vec<&Measurement> = scans.iter().map(|scan| &scan.get().0).collect();
    let numbered = || {
        scans.iter().enumerate().map(|(place, scan)| Measurement {
            name: Some(format!("{}", place + 1)),
            ..(*scan).clone()
        })
    };
    scoped(py, |_| own::table(&numbered().collect::<Vec<_>>()), |_| Ok(()))
}

impl Scan {
    fn column<'py>(&self, py: Python<'py>, of: impl Fn(&Sample<f64>) -> f64) -> Bound<'py, PyArray1<f64>> {
        self.0.samples.iter().map(of).collect::<Vec<f64>>().into_pyarray(py)
    }
}

/// Angles of incidence that are shown at most.
const ANGLES: usize = 8;

/// The degrees that were read as these radians, if there are any.
fn degrees(radians: f64, read: fn(f64) -> f64) -> f64 {
    own::degrees(radians, read).unwrap_or_else(|| radians.to_degrees())
}

#[pymethods]
impl Scan {
    /// Angles of incidence, degrees.
    #[getter]
    fn theta_i<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, |sample| degrees(sample.theta_i, f64::to_radians))
    }

    /// Scattering angles, degrees.
    #[getter]
    fn theta_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, |sample| degrees(sample.theta_s, f64::to_radians))
    }

    /// Azimuths of scattering less those of incidence, degrees.
    #[getter]
    fn delta_phi<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, |sample| degrees(sample.delta_phi, azimuth))
    }

    /// Measured BRDF, sr^-1.
    #[getter]
    fn brdf<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, |sample| sample.brdf)
    }

    /// Factors of the residuals, whose squares have a mean of 1.
    #[getter]
    fn weight<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.column(py, |sample| sample.weight)
    }

    /// The standard deviation of ln BRDF that a weight of 1 stands for, or None.
    #[getter]
    fn sigma_ln(&self) -> Option<f64> {
        self.0.sigma_ln
    }

    /// The file, or what messages call the scan.
    #[getter]
    fn file(&self) -> &str {
        &self.0.file
    }

    /// Which scan of the file it is, or None.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.0.name.as_deref()
    }

    /// What was left out: the reason, the angle of incidence in degrees, and how many samples.
    #[getter]
    fn left_out(&self) -> Vec<(&'static str, f64, usize)> {
        let all = self.0.left_out.iter();
        all.map(|one| (one.reason.title(), one.theta_i_deg, one.samples))
            .collect()
    }

    /// What was done to the numbers of the file, and what may be wrong with it.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.0.about.notes.clone()
    }

    /// Columns of the file that are not used.
    #[getter]
    fn not_used(&self) -> Vec<String> {
        self.0.about.unused.to_vec()
    }

    /// The scan as the program's own table, which reads back to the same bits.
    fn table(&self, py: Python<'_>) -> PyResult<String> {
        scoped(py, |_| own::table(std::slice::from_ref(&self.0)), |_| Ok(()))
    }

    /// Samples.
    fn __len__(&self) -> usize {
        self.0.samples.len()
    }

    fn __repr__(&self) -> String {
        let mut angles: Vec<f64> = self.0.samples.iter().map(|sample| sample.theta_i).collect();
        angles.sort_by(f64::total_cmp);
        angles.dedup();
        let shown = angles
            .iter()
            .take(ANGLES)
            .map(|&angle| shortest(degrees(angle, f64::to_radians)));
        let mut shown: Vec<String> = shown.collect();
        shown.extend((angles.len() > ANGLES).then(|| "...".to_string()));
        let (label, samples) = (self.0.label(), self.0.samples.len());
        format!(
            "brdfit.Scan: {label}, {samples} samples at theta_i = {} deg",
            shown.join(", ")
        )
    }
}
