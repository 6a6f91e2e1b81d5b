//! From a request to the text of an answer.

use std::collections::HashSet;
use std::time::Duration;

use brdfit::analysis::choose::choose;
use brdfit::analysis::converge::study;
use brdfit::analysis::fit::{FittedScan, prove};
use brdfit::analysis::profile::findings::{Asked, find};
use brdfit::analysis::proof::{Goal, provable};
use brdfit::engine::certify::Certificate;
use brdfit::engine::models::MODELS;
use brdfit::engine::{FitOptions, Model};
use brdfit::error::Error;
use brdfit::export::form;
use brdfit::export::model::Model as Exported;
use brdfit::input::own;
use brdfit::input::{self, Measurement, formats};
use brdfit::page::html;
use brdfit::page::section::Section;
use brdfit::parameters::{model, models};
use brdfit::plot;
use brdfit::result::inspect::{self, Inspected};
use brdfit::result::json::provenance::provenance;
use brdfit::result::{self, compare, converge, profile};
use brdfit::terms::{TERMS, term_names, terms_of};
use serde::Serialize;
use serde_json::value::RawValue;
use serde_json::{Value, json};

use crate::request::{Request, Want};
use crate::session::{Fitted, Session};
use crate::view::{self, Points};

/// Is told how far a proof is.
pub type Told<'a> = &'a (dyn Fn(&Certificate) + Sync);

/// `{"ok": ...}`, or `{"error": {...}}` with the program's own line.
pub fn answer(session: &mut Session, request: &[u8], told: Told) -> String {
    let text = match answered(session, request, told) {
        Ok(value) => serde_json::to_string(&json!({ "ok": value })),
        Err(error) => serde_json::to_string(&json!({ "error": {
            "kind": error.kind.name(),
            "line": error.to_string(),
            "file": error.file,
            "message": error.message(),
        } })),
    };
    text.unwrap_or_default()
}

fn answered(session: &mut Session, request: &[u8], told: Told) -> Result<Value, Error> {
    let request: Request = serde_json::from_slice(request).map_err(|error| Error::new(error.to_string()))?;
    let of = request.of.map_or("{}", RawValue::get);
    Ok(match request.want {
        Want::About => about(),
        Want::Read => {
            let (_, scans) = session.read(of)?;
            value(&scans.iter().map(scan).collect::<Vec<_>>())
        }
        Want::Table => value(&own::table(session.read(of)?.1)),
        Want::Without(places) => without(session.one(of)?.1, &places),
        Want::Fit => fitted(session.fit(of)?.fit),
        Want::Draw(draw) => value(&view::drawn(session.one(of)?.1, &draw)?),
        Want::Csv => value(&result::csv(&[timeless(session.fit(of)?.fit)], false)),
        Want::Export { to, wavelength } => export(session.fit(of)?.fit, to, wavelength)?,
        Want::Figures => figures(session, of)?,
        Want::Report { command } => {
            let fitted = session.fit(of)?;
            value(&html::page(
                &[Section::new(fitted.scan, &fitted.wanted, None)?],
                &command,
            ))
        }
        Want::Profile { parameters } => {
            let fitted = session.fit(of)?;
            let asked = Asked {
                parameters: &parameters,
                ..Asked::default()
            };
            let found = find(fitted.scan, &fitted.wanted, &asked)?;
            json!({ "json": profile::json(&found), "svg": profile::svg(&found), "text": profile::text(&found) })
        }
        Want::Compare { models: list } => {
            let (subject, scan) = session.one(of)?;
            let options = |model: &'static Model| FitOptions {
                seed: subject.search.seed,
                ..FitOptions::of(model)
            };
            let candidates: Vec<FitOptions> = models(&list)?.into_iter().map(options).collect();
            let choice = choose(&scan.samples, &candidates).map_err(|error| input::explain(scan, error))?;
            json!({ "json": compare::json(scan, &choice), "svg": compare::svg(scan, &choice), "text": compare::text(scan, &choice) })
        }
        Want::Certify { within, seconds } => certified(session.fit(of)?, within, seconds, told)?,
        Want::Converge { seeds } => {
            let (subject, scan) = session.one(of)?;
            let model = model(&subject.search.model)?;
            let options = FitOptions {
                terms: terms_of(&[model], &subject.search.terms)?,
                ..FitOptions::of(model)
            };
            let found = study(&scan.label(), &scan.samples, None, &options, seeds, || {});
            let studies = [found.map_err(|error| input::explain(scan, error))?];
            let read = Some(provenance(&scan.about, None));
            json!({
                "json": converge::json(&studies, seeds, read),
                "svg": converge::svg(&studies, seeds),
                "text": converge::text(&studies, seeds),
            })
        }
    })
}

/// Only maps with other keys than strings can make this fail.
fn value(of: &impl Serialize) -> Value {
    serde_json::to_value(of).unwrap_or_default()
}

fn about() -> Value {
    let model = |model: &Model| {
        let parameter = |at: usize| {
            let parameter = &model.parameters[at];
            json!({
                "name": parameter.name, "what": parameter.what, "unit": parameter.unit,
                "lower": parameter.bounds.0, "upper": parameter.bounds.1,
            })
        };
        json!({
            "name": model.name, "what": model.what, "source": model.source,
            "terms": term_names(model.terms),
            "parameters": (0..model.parameters.len()).map(parameter).collect::<Vec<_>>(),
        })
    };
    let formats = formats::all().iter();
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "models": MODELS.iter().map(model).collect::<Vec<_>>(),
        "terms": TERMS.map(|(name, _)| name),
        "formats": formats.map(|one| json!({ "name": one.name, "title": one.title, "about": one.about })).collect::<Vec<_>>(),
    })
}

#[derive(Serialize)]
struct Scan<'a> {
    label: String,
    file: &'a str,
    /// Its files, of which it may have several.
    files: Vec<&'a str>,
    name: Option<&'a str>,
    read_as: String,
    /// As `brdfit inspect` tells it.
    text: String,
    inspect: Value,
    /// One in so many samples is among the points.
    stride: usize,
    points: Points,
    left_out: Points,
}

fn scan(measurement: &Measurement) -> Scan<'_> {
    let inspected = [Inspected::new(measurement)];
    let (points, left_out) = view::points(measurement);
    Scan {
        label: measurement.label(),
        file: &measurement.file,
        files: measurement
            .about
            .sources
            .iter()
            .map(|source| source.file.as_str())
            .collect(),
        name: measurement.name.as_deref(),
        read_as: measurement.read_as.to_string(),
        text: inspect::text(&inspected),
        inspect: serde_json::from_str(&inspect::json(&inspected)).unwrap_or_default(),
        stride: view::stride(measurement),
        points,
        left_out,
    }
}

/// The scan less some samples, as a file of its own, which reads back to the same bits.
fn without(scan: &Measurement, places: &[usize]) -> Value {
    let places: HashSet<usize> = places.iter().copied().collect();
    let all = scan.samples.iter().enumerate();
    let kept = Measurement {
        samples: all
            .filter(|(place, _)| !places.contains(place))
            .map(|(_, sample)| *sample)
            .collect(),
        ..scan.clone()
    };
    value(&own::table(&[kept]))
}

fn fitted(fit: &FittedScan) -> Value {
    let text = result::json(&[timeless(fit)]);
    json!({
        "json": text,
        "text": result::text(std::slice::from_ref(fit), true),
        "seconds": fit.elapsed.map(|time| time.as_secs_f64()),
    })
}

/// The same without its time, so that every run gives the same bits.
fn timeless(fit: &FittedScan) -> FittedScan {
    let mut fit = fit.clone();
    fit.forget_times();
    fit
}

/// A proof of a fit, with what is proved when its time ends.
fn certified(fitted: Fitted, within: f64, seconds: f64, told: Told) -> Result<Value, Error> {
    provable(fitted.wanted.candidates())?;
    if !(0.0 < within && within < 1.0) {
        return Err(Error::new("write a part between 0 and 100 %"));
    }
    let goal = Goal {
        eps: within,
        boxes: u64::MAX,
        limit: Duration::try_from_secs_f64(seconds).ok(),
        alone: true,
        interrupted: &|| false,
        progress: told,
    };
    let proved = prove(fitted.scan, fitted.fit.clone(), &goal)?;
    Ok(json!({
        "json": result::json(&[timeless(&proved)]),
        "text": result::text(std::slice::from_ref(&proved), false),
    }))
}

fn export(fit: &FittedScan, to: form::Form, wavelength: Option<f64>) -> Result<Value, Error> {
    let models = Exported::of_json(result::json(&[timeless(fit)]).as_bytes(), &[])?;
    let (bytes, deviation) = form::write(to, &models, wavelength)?;
    let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    Ok(json!({ "hex": hex, "note": deviation }))
}

fn figures(session: &mut Session, of: &str) -> Result<Value, Error> {
    let fitted = session.fit(of)?;
    let section = Section::new(fitted.scan, &fitted.wanted, None)?;
    let figures = section.figures.iter();
    let mut all: Vec<Value> = figures
        .map(|figure| json!({ "name": figure.name, "svg": figure.svg, "caption": figure.caption }))
        .collect();
    let scan = plot::scan_svg(&fitted.scan.label(), &plot::Drawn::of_scan(fitted.scan).data(), &[]);
    all.push(json!({ "name": "scan", "svg": scan, "caption": "The scan as it was read." }));
    Ok(value(&all))
}
