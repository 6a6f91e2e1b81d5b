//! The fit of one scan, with all that follows from it.

use std::time::Duration;

use brdfit::analysis::deviations::settled;
use brdfit::analysis::fit::{FittedScan, fit as fit_scan, prove, residuals};
use brdfit::analysis::proof::{Goal, provable};
use brdfit::engine::{Material, Outcome, Until};
use brdfit::error::Error;
use brdfit::input::Measurement;
use brdfit::page::html;
use brdfit::page::section::Section;
use brdfit::plot::{Drawn, scan_svg};
use brdfit::result;
use brdfit_core::lm::Stop;
use numpy::IntoPyArray;
use numpy::ndarray::Array2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::options::{self, Asked};
use crate::scan::Scan;
use crate::table;
use crate::watch::scoped;

/// Place in `MESSAGES` of `python/brdfit/results.py`.
pub fn status(outcome: &Outcome) -> u8 {
    match outcome.stop {
        _ if !outcome.cost.is_finite() => 3,
        Stop::Cost => 0,
        Stop::Step => 1,
        Stop::Passes => 2,
        Stop::NotFinite => 3,
    }
}

/// What is to be proved of a fit: the part that no cost may be below it, the most boxes, the longest time in seconds.
type Claim = (f64, Option<u64>, Option<f64>);

/// The fit of a scan, as the fields of `Fit` in `python/brdfit/results.py`.
#[pyfunction]
pub fn fit<'py>(
    py: Python<'py>,
    scan: &Scan,
    words: Vec<String>,
    claim: Option<Claim>,
) -> PyResult<Bound<'py, PyDict>> {
    let (fitted, residuals) = fitted(py, scan, &words, claim)?;
    let outcome = &fitted.outcome;
    let model = outcome.model;
    let result = PyDict::new(py);
    result.set_item("model", model.name)?;
    let names: Vec<&str> = model.parameters.iter().map(|parameter| parameter.name).collect();
    result.set_item("names", names)?;
    result.set_item("x", outcome.params.to_vec().into_pyarray(py))?;
    let (cov, count) = (&outcome.uncertainty.cov, outcome.params.len());
    let cov = Array2::from_shape_fn((count, count), |(i, j)| cov[i][j]);
    result.set_item("cov", cov.into_pyarray(py))?;
    result.set_item("stderr", outcome.uncertainty.stderr.to_vec().into_pyarray(py))?;
    result.set_item("fun", outcome.cost)?;
    result.set_item("mse2", outcome.mse2)?;
    result.set_item("samples", outcome.samples)?;
    result.set_item("status", status(outcome))?;
    result.set_item("at_bound", &outcome.at_bound)?;
    result.set_item("residuals", residuals.into_pyarray(py))?;
    result.set_item("aperture_half_angle", outcome.aperture.to_degrees())?;
    let offset = outcome.offset.map_or(0.0, |offset| offset.value);
    result.set_item("offset", offset.to_degrees())?;
    let minima = outcome.minima.iter();
    let minima: Vec<_> = minima
        .map(|it| (it.mse2, it.params.to_vec().into_pyarray(py), it.hits))
        .collect();
    result.set_item("minima", minima)?;
    let outliers = outcome.robust.as_ref().map(|robust| robust.outliers.clone());
    result.set_item("outliers", outliers.unwrap_or_default())?;
    result.set_item("table", table::of_one(py, &fitted)?)?;
    result.set_item("json", result::json(std::slice::from_ref(&fitted)))?;
    Ok(result)
}

/// The page of `brdfit report` on scans.
#[pyfunction]
pub fn report(
    py: Python<'_>,
    scans: Vec<Bound<'_, Scan>>,
    words: Vec<String>,
    claim: Option<Claim>,
    told: &str,
) -> PyResult<String> {
    let asked = provable_if(options::search(&words)?, claim)?;
    let scans: Vec<_> = scans.iter().map(|scan| &scan.get().0).collect();
    let all = |until: Until| {
        let wanted = asked.until(until);
        let over = || until.is_over();
        let goal = claim.map(|claim| goal(claim, &over));
        let section = |scan: &&Measurement| Section::new(&settled((*scan).clone(), &wanted), &wanted, goal.as_ref());
        let sections = || scans.iter().map(section).collect();
        let sections: Result<Vec<Section>, _> = asked.on_threads(sections)?;
        Ok(html::page(&sections?, told))
    };
    let page: Result<String, Error> = scoped(py, all, |_| Ok(()))?;
    page.map_err(|error| options::refuse(&error))
}

/// The picture of `brdfit fit --plot`: a scan with its minima, of which the first is the best, none if there are none; its samples are where an offset of theta_s in degrees leaves them.
#[pyfunction]
pub fn picture(
    scan: &Scan,
    title: &str,
    model: &str,
    minima: Vec<Vec<f64>>,
    outliers: Vec<usize>,
    offset: f64,
) -> PyResult<String> {
    let model = brdfit::parameters::model(model).map_err(|error| options::refuse(&error))?;
    let curves = minima.iter().map(|values| Material {
        model,
        values: values.iter().copied().collect(),
    });
    let curves: Vec<Material> = curves.collect();
    Ok(scan_svg(
        title,
        &Drawn::without(&scan.0, &outliers).moved(offset.to_radians()).data(),
        &curves,
    ))
}

/// Refuses a claim on what has no proof, before anything is fitted.
fn provable_if(asked: Asked, claim: Option<Claim>) -> PyResult<Asked> {
    if claim.is_some() {
        provable(asked.wanted.candidates()).map_err(|error| options::refuse(&error))?;
    }
    Ok(asked)
}

fn goal<'a>((eps, boxes, seconds): Claim, interrupted: &'a (dyn Fn() -> bool + Sync)) -> Goal<'a> {
    Goal {
        eps,
        boxes: boxes.unwrap_or(u64::MAX),
        limit: seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()),
        alone: false,
        interrupted,
        progress: &|_| (),
    }
}

fn fitted(py: Python<'_>, scan: &Scan, words: &[String], claim: Option<Claim>) -> PyResult<(FittedScan, Vec<f64>)> {
    let asked = provable_if(options::search(words)?, claim)?;
    let one = |until: Until| -> Result<(FittedScan, Vec<f64>), Error> {
        let wanted = asked.until(until);
        let (scan, fitted) = asked.for_one(|| {
            let scan = settled(scan.0.clone(), &wanted);
            let fitted = fit_scan(&scan, &wanted);
            let seen = fitted
                .as_ref()
                .map_or(Vec::new(), |fitted| residuals(&scan, &fitted.outcome));
            (scan, fitted.map(|fitted| (fitted, seen)))
        })?;
        let (fitted, seen) = fitted?;
        let Some(claim) = claim else {
            return Ok((fitted, seen));
        };
        let over = || until.is_over();
        let goal = goal(claim, &over);
        asked.on_threads(|| {
            let fitted = prove(&scan, fitted, &goal)?;
            let seen = residuals(&scan, &fitted.outcome);
            Ok((fitted, seen))
        })?
    };
    let (mut fitted, seen) = scoped(py, one, |_| Ok(()))?.map_err(|error| options::refuse(&error))?;
    // Two runs give the same object.
    fitted.elapsed = None;
    if let Some(proof) = &mut fitted.proof {
        proof.elapsed = None;
    }
    Ok((fitted, seen))
}
