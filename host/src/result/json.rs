//! Fitted scans for programs: one object a scan.

mod by_name;
mod choice;
pub mod provenance;
mod uncertainty;

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use super::cell::Cell;
use super::columns::{FitRow, Json, of_fits};
use crate::analysis::fit::FittedScan;
use crate::analysis::hints::Hint;
use crate::analysis::proof::Proof;
use crate::document;
use crate::engine::{Minimum, Values};
use crate::input::{LeftOut, ReadAs};
pub use by_name::ByName;
pub use choice::{Selection, selection};
use provenance::{Provenance, provenance};
pub use uncertainty::Correlated;
use uncertainty::{AtAngle, Known, at_angle, known};

#[derive(Serialize)]
struct Document<'a> {
    #[serde(flatten)]
    head: Columns<'a>,
    input: ReadAs,
    /// Columns of the table that are not used.
    #[serde(skip_serializing_if = "<[String]>::is_empty")]
    not_used: &'a [String],
    /// What was done to the numbers of the file.
    #[serde(skip_serializing_if = "<[String]>::is_empty")]
    notes: &'a [String],
    left_out: &'a [LeftOut],
    #[serde(flatten)]
    found: Columns<'a>,
    parameters: ByName<f64>,
    #[serde(flatten)]
    bounds: Columns<'a>,
    selection: Option<Selection>,
    uncertainty: Known,
    derived: Vec<AtAngle>,
    #[serde(flatten)]
    end: Columns<'a>,
    minima: Vec<JsonMinimum>,
    /// Null where nothing is proved.
    certificate: Option<Certificate>,
    evaluations: Evaluations,
    /// What a person would say.
    #[serde(skip_serializing_if = "<[Hint]>::is_empty")]
    hints: &'a [Hint],
    provenance: Provenance<'a>,
    #[serde(flatten)]
    time: Columns<'a>,
}

/// The columns of the table that stand in one place of the object.
struct Columns<'a>(&'a FittedScan, Json);

impl Serialize for Columns<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Columns(scan, place) = self;
        let mut map = serializer.serialize_map(None)?;
        for column in of_fits(&[scan.outcome.model])
            .iter()
            .filter(|column| column.json == *place)
        {
            let cell = column.cell(&FitRow::from(*scan));
            if *place == Json::Head || cell != Cell::Empty {
                map.serialize_entry(&column.name, &cell)?;
            }
        }
        map.end()
    }
}

#[derive(Serialize)]
struct JsonMinimum {
    mse2: f64,
    parameters: ByName<f64>,
    hits: u32,
    first_start: u64,
}

/// No parameters within the bounds have an MSE^2 below `1 - eps` of that of the fit.
#[derive(Serialize)]
struct Certificate {
    eps: f64,
    /// What was to be proved.
    asked: f64,
    complete: bool,
    boxes: u64,
    /// The proof found a better minimum than the search.
    better: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    elapsed_s: Option<f64>,
}

#[derive(Serialize)]
struct Evaluations {
    cost: u32,
    linearize: u32,
}

fn document(scan: &FittedScan) -> Document<'_> {
    let outcome = &scan.outcome;
    let parameters = |values: &Values| ByName::new(outcome.model, |place| values[place]);
    let minimum = |minimum: &Minimum| JsonMinimum {
        mse2: minimum.mse2,
        parameters: parameters(&minimum.params),
        hits: minimum.hits,
        first_start: minimum.first_start,
    };
    Document {
        head: Columns(scan, Json::Head),
        input: scan.read_as,
        not_used: &scan.about.unused,
        notes: &scan.about.notes,
        left_out: &scan.left_out,
        found: Columns(scan, Json::Found),
        parameters: parameters(&outcome.params),
        bounds: Columns(scan, Json::Bounds),
        selection: scan.choice.as_ref().map(selection),
        uncertainty: known(outcome, &scan.derived),
        derived: scan
            .derived
            .iter()
            .map(|at| at_angle(at, &outcome.uncertainty))
            .collect(),
        end: Columns(scan, Json::End),
        minima: outcome.minima.iter().map(minimum).collect(),
        certificate: scan.proof.as_ref().and_then(certificate),
        evaluations: Evaluations {
            cost: outcome.evaluations.cost,
            linearize: outcome.evaluations.linearize,
        },
        hints: &scan.hints,
        provenance: provenance(&scan.about, Some(&scan.options)),
        time: Columns(scan, Json::Time),
    }
}

fn certificate(proof: &Proof) -> Option<Certificate> {
    Some(Certificate {
        eps: proof.within()?,
        asked: proof.asked,
        complete: proof.complete,
        boxes: proof.boxes,
        better: proof.better,
        elapsed_s: proof.elapsed.map(|time| time.as_secs_f64()),
    })
}

/// One object for one scan, an array for several.
pub fn json(scans: &[FittedScan]) -> String {
    let documents: Vec<_> = scans.iter().map(document).collect();
    match documents.as_slice() {
        [one] => document::json(one),
        several => document::json(&several),
    }
}
