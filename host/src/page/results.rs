//! Results of earlier fits, whose scans are to be reported.

use std::path::PathBuf;

use brdfit_core::brdf::{NAMES, Params};
use serde::Deserialize;

use crate::error::Error;
use crate::result::json::JsonParameters;

/// One scan of the results of `brdfit fit` or `brdfit batch`.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// Its file, as the fit was given it.
    pub file: PathBuf,
    /// Which scan of the file it is.
    pub scan: Option<String>,
    /// Its parameters, or why it has none.
    pub params: Result<Params<f64>, String>,
}

/// The results in the bytes of a file of JSON or CSV; `None` if it holds something else, such as a scan.
pub fn parse(bytes: &[u8]) -> Option<Vec<Fitted>> {
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
    parameters: Option<JsonParameters>,
    error: Option<String>,
}

fn json(text: &str) -> Option<Vec<Fitted>> {
    let one = serde_json::from_str::<Object>(text).map(|one| vec![one]);
    let objects = one.or_else(|_| serde_json::from_str::<Vec<Object>>(text)).ok()?;
    let fitted = |object: Object| {
        let params = match object.parameters {
            Some(parameters) => Ok(parameters.into()),
            None => Err(object.error?),
        };
        Some(Fitted {
            file: object.file,
            scan: object.scan,
            params,
        })
    };
    objects.into_iter().map(fitted).collect()
}

fn csv(text: &str) -> Option<Vec<Fitted>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let head = reader.headers().ok()?.clone();
    let place = |name: &str| head.iter().position(|column| column == name);
    let (file, scan) = (place("file")?, place("scan")?);
    let places: Vec<usize> = NAMES.iter().map(|name| place(name)).collect::<Option<_>>()?;
    // With --minima a scan has a row for each of them, best first.
    let minimum = place("minimum");
    let mut all = Vec::new();
    for row in reader.into_records() {
        let row = row.ok()?;
        if minimum.is_some_and(|place| row.get(place) != Some("1")) {
            continue;
        }
        let number = |&place: &usize| row.get(place)?.parse().ok();
        let values: Option<Vec<f64>> = places.iter().map(number).collect();
        let params = match values.and_then(|values| <[f64; 6]>::try_from(values).ok()) {
            Some(values) => Ok(Params::from_array(values)),
            None => Err(row.get(place("error")?)?.to_string()),
        };
        all.push(Fitted {
            file: row.get(file)?.into(),
            scan: Some(row.get(scan)?.to_string()).filter(|scan| !scan.is_empty()),
            params,
        });
    }
    Some(all)
}

/// Refuses a fit with other parameters than these results have.
///
/// # Errors
/// The first parameter that differs in any bit, with both values.
pub fn agree(label: &str, found: &Params<f64>, stored: &Params<f64>) -> Result<(), Error> {
    let pairs = found.to_array().into_iter().zip(stored.to_array());
    for ((found, stored), name) in pairs.zip(NAMES) {
        if found != stored {
            return Err(
                Error::new(format!("{name} is {found} now, and {stored} in the results"))
                    .in_file(label)
                    .help("give report the options of the fit, the files as they were, and the same version of brdfit"),
            );
        }
    }
    Ok(())
}
