//! Fits the files of a part and keeps each as it is finished.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::journal::Journal;
use super::record::{Fitted, Line, Record, Row, Rows, fingerprint};
use crate::analysis::fit::{FittedScan, fit};
use crate::engine::FitOptions;
use crate::error::Error;
use crate::input::{self, Measurement, ReadOptions, bytes};
use crate::result;

/// What is the same for every file.
pub struct Job<'a> {
    /// All files of the batch.
    pub files: &'a [PathBuf],
    /// How they are fitted.
    pub options: FitOptions,
    /// How they are read.
    pub read: &'a ReadOptions,
    /// What is kept.
    pub rows: Rows,
    /// Stops before the next file once it is set.
    pub interrupt: &'a AtomicBool,
}

/// Fits the files at `places` that the journal does not have as they are now, on the threads of the current pool; the result is how many are done, which are all but after an interrupt.
///
/// # Errors
/// A result cannot be kept; what is wrong with a scan is kept as its result.
pub fn run(job: &Job, places: &[usize], journal: &Mutex<Journal>, done: &(dyn Fn() + Sync)) -> Result<usize, Error> {
    let one = |&index: &usize| {
        if job.interrupt.load(Ordering::Relaxed) {
            return Ok(0);
        }
        let bytes = bytes::of_file(&job.files[index]);
        let contents = bytes.as_ref().map_or(0, |bytes| fingerprint(bytes));
        let known = lock(journal).place(index);
        if !known.is_some_and(|place| !place.failed && place.contents == contents) {
            let Some(scans) = scans(job, &job.files[index], bytes) else {
                return Ok(0);
            };
            lock(journal).keep(&Record { index, contents, scans })?;
        }
        done();
        Ok(1)
    };
    places.par_iter().map(one).try_reduce(|| 0, |a, b| Ok(a + b))
}

fn lock(journal: &Mutex<Journal>) -> std::sync::MutexGuard<'_, Journal> {
    journal.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// The scans of a file, fitted; `None` after an interrupt.
fn scans(job: &Job, path: &Path, bytes: Result<Vec<u8>, Error>) -> Option<Vec<Fitted>> {
    let name = path.display().to_string();
    let one = |measurement: Measurement| {
        if job.interrupt.load(Ordering::Relaxed) {
            return None;
        }
        Some(match fit(&measurement, &job.options) {
            Ok(report) => fitted(job, report, &measurement),
            Err(error) => failed(job, &name, measurement.name.as_deref(), &error),
        })
    };
    match bytes.and_then(|bytes| input::parse(&name, &bytes, job.read)) {
        // Spectral files hold many scans, so these are shared among the threads too.
        Ok(measurements) => measurements.into_par_iter().map(one).collect(),
        Err(error) => Some(vec![failed(job, &name, None, &error)]),
    }
}

fn fitted(job: &Job, mut report: FittedScan, measurement: &Measurement) -> Fitted {
    // Results have the same bits each time, so no time is part of them.
    report.elapsed = None;
    let line = line(&report, measurement);
    let row = match job.rows {
        Rows::Objects => Row::Object(result::json(std::slice::from_ref(&report)).trim_end().to_string()),
        Rows::Cells => {
            let mut cells = table(std::slice::from_ref(&report)).pop().unwrap_or_default();
            let angles: Vec<String> = line
                .theta_i
                .iter()
                .map(|&angle| crate::output::shortest(angle))
                .collect();
            cells.extend([
                angles.join("+"),
                crate::output::shortest(line.high),
                crate::output::shortest(line.improvement_potential),
                String::new(),
            ]);
            Row::Cells(cells)
        }
    };
    Fitted { row, line: Ok(line) }
}

fn line(report: &FittedScan, measurement: &Measurement) -> Line {
    let minima = &report.outcome.minima;
    Line {
        scan: measurement.label(),
        theta_i: report
            .angles
            .iter()
            .map(|angle| rounded(angle.theta_i.to_degrees()))
            .collect(),
        minima: minima.len(),
        high: minima.last().map_or(report.outcome.mse2, |worst| worst.mse2),
        low: report.outcome.mse2,
        improvement_potential: report.outcome.improvement_potential,
    }
}

/// Degrees as they were measured, without what the way through radians adds.
fn rounded(degrees: f64) -> f64 {
    (degrees * 1e9).round() / 1e9
}

/// The row of a scan that can not be read or fitted.
fn failed(job: &Job, file: &str, scan: Option<&str>, error: &Error) -> Fitted {
    let row = match job.rows {
        Rows::Objects => {
            Row::Object(serde_json::json!({ "file": file, "scan": scan, "error": error.to_string() }).to_string())
        }
        Rows::Cells => {
            let mut cells = vec![String::new(); columns().len()];
            for (cell, name) in cells.iter_mut().zip([file, scan.unwrap_or_default()]) {
                cell.push_str(name);
            }
            *cells.last_mut().expect("there are columns") = error.to_string();
            Row::Cells(cells)
        }
    };
    Fitted {
        row,
        line: Err(error.to_string()),
    }
}

/// The columns of a table of results: those of `brdfit fit --format csv` without the time, and those of Table 3.
pub fn columns() -> Vec<String> {
    let mut head = table(&[]).remove(0);
    head.extend(["theta_i_deg", "mse2_high", "improvement_potential", "error"].map(String::from));
    head
}

/// The rows that `brdfit fit --format csv` prints, with the head.
fn table(reports: &[FittedScan]) -> Vec<Vec<String>> {
    let text = result::csv(reports, false);
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(text.as_bytes());
    let rows = reader.records().map_while(Result::ok);
    rows.map(|row| row.iter().map(String::from).collect()).collect()
}
