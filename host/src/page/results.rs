//! Results of earlier fits, whose scans are to be reported.

use std::collections::HashMap;
use std::path::PathBuf;

use serde::Deserialize;
use serde_json::Value;

use crate::engine::{Material, Model, Values};
use crate::error::Error;
use crate::input::source::Source;
use crate::number::shortest;
use crate::plain::of_cell;
use crate::terms::terms;

/// One scan of the results of `brdfit fit` or `brdfit batch`.
#[derive(Clone, Debug, PartialEq)]
pub struct StoredFit {
    /// Its file, as the fit was given it.
    pub file: PathBuf,
    /// Which scan of the file it is.
    pub scan: Option<String>,
    /// The terms of the model that it was fitted with, if that is told and has any.
    pub terms: Option<u8>,
    /// The SHA-256 of each file that it was read from; empty if that is not told, as in tables of version 0.1.
    pub sha256: Vec<String>,
    /// Number of samples of the fit, and its MSE^2, if they are told.
    pub samples: Option<f64>,
    /// See `samples`.
    pub mse2: Option<f64>,
    /// What JSON tells of the options it was made with; none of a table, and in results of version 0.1.
    pub told: Option<Value>,
    /// Its model with its parameters, or why it has none.
    pub material: Result<Material, String>,
}

/// The results in the bytes of a file of JSON or CSV; `None` if it holds something else, such as a scan.
pub fn parse(bytes: &[u8]) -> Option<Vec<StoredFit>> {
    let text = std::str::from_utf8(bytes).ok()?;
    if text.trim_start().starts_with(['{', '[']) {
        json(text)
    } else {
        csv(text)
    }
}

#[derive(Deserialize)]
struct Object {
    file: PathBuf,
    scan: Option<String>,
    /// That of the paper in results of version 0.1.
    model: Option<String>,
    terms: Option<Vec<String>>,
    parameters: Option<HashMap<String, f64>>,
    error: Option<String>,
    samples: Option<f64>,
    mse2: Option<f64>,
    /// Results of version 0.1 have none.
    provenance: Option<Value>,
}

fn json(text: &str) -> Option<Vec<StoredFit>> {
    let one = serde_json::from_str::<Object>(text).map(|one| vec![one]);
    let objects = one.or_else(|_| serde_json::from_str::<Vec<Object>>(text)).ok()?;
    let fitted = |object: Object| {
        let material = match object.parameters {
            Some(values) => Ok(material(object.model.as_deref(), |name| values.get(name).copied())?),
            None => Err(object.error?),
        };
        Some(StoredFit {
            file: object.file,
            scan: object.scan,
            terms: object.terms.and_then(|names| terms(&names.join(",")).ok()),
            sha256: object.provenance.as_ref().map_or_else(Vec::new, hashes),
            samples: object.samples,
            mse2: object.mse2,
            told: object.provenance,
            material,
        })
    };
    objects.into_iter().map(fitted).collect()
}

/// The SHA-256 of each file that a provenance names.
fn hashes(provenance: &Value) -> Vec<String> {
    let files = provenance["files"].as_array().into_iter().flatten();
    files
        .filter_map(|file| file["sha256"].as_str())
        .map(String::from)
        .collect()
}

fn csv(text: &str) -> Option<Vec<StoredFit>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let head = reader.headers().ok()?.clone();
    let place = |name: &str| head.iter().position(|column| column == name);
    let (file, scan) = (place("file")?, place("scan")?);
    place("rho_d").or(place("A"))?;
    // With --minima a scan has a row for each of them, best first.
    let minimum = place("minimum");
    let mut all = Vec::new();
    for row in reader.into_records() {
        let row = row.ok()?;
        if minimum.is_some_and(|place| row.get(place) != Some("1")) {
            continue;
        }
        let cell = |name: &str| row.get(place(name)?);
        let material = match material(cell("model"), |name| cell(name)?.parse().ok()) {
            Some(material) => Ok(material),
            None => Err(cell("error")?.to_string()),
        };
        all.push(StoredFit {
            file: of_cell(row.get(file)?).into(),
            scan: Some(of_cell(row.get(scan)?).to_string()).filter(|scan| !scan.is_empty()),
            terms: cell("terms").and_then(|names| terms(&names.replace('+', ",")).ok()),
            sha256: cell("sha256").map_or_else(Vec::new, |all| all.split_terminator('+').map(String::from).collect()),
            samples: cell("samples").and_then(|number| number.parse().ok()),
            mse2: cell("mse2").and_then(|number| number.parse().ok()),
            told: None,
            material,
        });
    }
    Some(all)
}

/// The model of this name, or that of the paper, with the values that `number` gives its parameters.
fn material(model: Option<&str>, number: impl Fn(&str) -> Option<f64>) -> Option<Material> {
    let model = match model {
        Some(name) => Model::find(name)?,
        None => Model::paper(),
    };
    let values = model.parameters.iter().map(|parameter| number(parameter.name));
    let values: Option<Values> = values.collect::<Option<Vec<f64>>>().map(Values::from_iter);
    Some(Material { model, values: values? })
}

/// Refuses files that are not those which these results were read from.
///
/// # Errors
/// The first file of another SHA-256, with both; `command` is what the message calls the command.
pub fn same_files(sources: &[Source], stored: &StoredFit, command: &str) -> Result<(), Error> {
    let other = |source: &&Source| !stored.sha256.contains(&source.sha256);
    let (Some(source), Some(before)) = (sources.iter().find(other), stored.sha256.first()) else {
        return Ok(());
    };
    Err(Error::new(format!(
        "its SHA-256 is {} now, and {before} in the results",
        source.sha256
    ))
    .in_file(&source.file)
    .help(format!("give {command} the files as they were, or fit the scan anew")))
}

/// Refuses a fit with another model or other parameters than these results have.
///
/// # Errors
/// The first parameter that differs in any bit, with both values.
pub fn agree(label: &str, found: &Material, stored: &Material) -> Result<(), Error> {
    let help = "give report the options of the fit, the files as they were, and the same version of brdfit";
    if found.model != stored.model {
        let (found, stored) = (found.model.name, stored.model.name);
        return Err(
            Error::new(format!("the model is {found} now, and {stored} in the results"))
                .in_file(label)
                .help(help),
        );
    }
    let pairs = found.model.named(&found.values).zip(stored.values.iter());
    for ((name, found), stored) in pairs {
        if found != *stored {
            return Err(Error::new(format!(
                "{name} is {} now, and {} in the results",
                shortest(found),
                shortest(*stored)
            ))
            .in_file(label)
            .help(help));
        }
    }
    Ok(())
}
