//! Fits the files of a part and keeps each as it is finished.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::analysis::choose::Wanted;
use crate::analysis::deviations;
use crate::analysis::fit::{AngleOfIncidence, FittedScan, Told, fit_telling, prove};
use crate::analysis::proof::Goal;
use crate::engine::Model;
use crate::engine::threads;
use crate::error::Error;
use crate::input::{self, Measurement, ReadOptions, bytes};
use crate::records::journal::Journal;
use crate::records::record::{Line, Record, Rows, ScanRecord, Written, fingerprint};
use crate::result;
use crate::result::cell::{Cell, Kind};
use crate::result::columns::{Column, Json, of_fits};

/// What is the same for every file.
pub struct Job<'a> {
    /// All files of the batch.
    pub files: &'a [PathBuf],
    /// What they are fitted with.
    pub wanted: &'a Wanted,
    /// The columns of a row, which are the same for every scan.
    pub columns: Vec<Column>,
    /// How they are read.
    pub read: &'a ReadOptions,
    /// What is kept.
    pub rows: Rows,
    /// What is to be proved of each scan, if anything is.
    pub goal: Option<Goal<'a>>,
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
    // After a result that cannot be kept there is nothing to go on for.
    Ok(threads::try_map(places, &one)?.into_iter().sum())
}

fn lock(journal: &Mutex<Journal>) -> std::sync::MutexGuard<'_, Journal> {
    journal.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// The scans of a file, fitted; `None` after an interrupt.
fn scans(job: &Job, path: &Path, bytes: Result<Vec<u8>, Error>) -> Option<Vec<ScanRecord>> {
    let name = path.display().to_string();
    let told = match job.rows {
        Rows::Objects => Told::All,
        Rows::Cells => Told::Columns,
    };
    let one = |measurement: Measurement| {
        if job.interrupt.load(Ordering::Relaxed) {
            return None;
        }
        let measurement = deviations::settled(measurement, job.wanted);
        let found = fit_telling(told, &measurement, job.wanted).and_then(|scan| match &job.goal {
            Some(goal) => prove(&measurement, scan, goal),
            None => Ok(scan),
        });
        // A proof that an interrupt ended is not what was asked for; --resume makes it again.
        if job.goal.is_some() && job.interrupt.load(Ordering::Relaxed) {
            return None;
        }
        Some(match found {
            Ok(scan) => fitted(job, scan, &measurement),
            Err(_) if job.interrupt.load(Ordering::Relaxed) => return None,
            Err(error) => failed(job, &name, measurement.name.as_deref(), &error),
        })
    };
    match bytes.and_then(|bytes| input::parse(&name, &bytes, job.read)) {
        // Spectral files hold many scans, so these are shared among the threads too.
        Ok(measurements) => threads::into(measurements, &one).into_iter().collect(),
        Err(error) => Some(vec![failed(job, &name, None, &error)]),
    }
}

fn fitted(job: &Job, mut scan: FittedScan, measurement: &Measurement) -> ScanRecord {
    // Results have the same bits each time, so no time is part of them.
    scan.forget_times();
    let row = match job.rows {
        Rows::Objects => Written::Object(result::json(std::slice::from_ref(&scan)).trim_end().to_string()),
        Rows::Cells => Written::Cells(cells(&job.columns, |column| column.cell(&(&scan).into()), Cell::Empty)),
    };
    ScanRecord {
        row,
        line: Ok(line(&scan, measurement)),
    }
}

fn line(scan: &FittedScan, measurement: &Measurement) -> Line {
    let minima = &scan.outcome.minima;
    Line {
        scan: measurement.label(),
        model: scan
            .choice
            .as_ref()
            .filter(|choice| choice.models().len() > 1)
            .map(|_| scan.outcome.model.name.into()),
        theta_i: scan.angles.iter().map(AngleOfIncidence::degrees).collect(),
        minima: minima.len(),
        high: minima.last().map_or(scan.outcome.mse2, |worst| worst.mse2),
        low: scan.outcome.mse2,
        improvement_potential: scan.outcome.improvement_potential,
    }
}

/// The row of a scan that cannot be read or fitted.
fn failed(job: &Job, file: &str, scan: Option<&str>, error: &Error) -> ScanRecord {
    let row = match job.rows {
        Rows::Objects => {
            Written::Object(serde_json::json!({ "file": file, "scan": scan, "error": error.to_string() }).to_string())
        }
        Rows::Cells => {
            let known = |column: &Column| match column.name.as_str() {
                "file" => Cell::Text(file.to_string()),
                "scan" => scan.map_or(Cell::Empty, |scan| Cell::Text(scan.to_string())),
                _ => Cell::Empty,
            };
            Written::Cells(cells(&job.columns, known, Cell::Text(error.to_string())))
        }
    };
    ScanRecord {
        row,
        line: Err(error.to_string()),
    }
}

/// The columns of a table of results: those of a fit without its time, and why there is none.
pub fn columns(models: &[&Model]) -> Vec<(String, Kind)> {
    let columns = timeless(models);
    let mut columns: Vec<_> = columns
        .iter()
        .map(|column| (column.name.clone(), column.kind()))
        .collect();
    columns.push(("error".into(), Kind::Text));
    columns
}

/// A row of these.
fn cells(columns: &[Column], of: impl Fn(&Column) -> Cell, error: Cell) -> Vec<Cell> {
    columns.iter().map(of).chain([error]).collect()
}

/// Those of a fit of one of these models but its time, which differs from run to run.
pub fn timeless(models: &[&Model]) -> Vec<Column> {
    let mut columns = of_fits(models);
    columns.retain(|column| column.json != Json::Time);
    columns
}
