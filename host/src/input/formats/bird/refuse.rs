//! Light that goes through the sample, or comes back at another wavelength.

use serde::Deserialize;
use serde_json::value::RawValue;

use super::file::{Data, Variable};
use crate::error::{Error, shown};
use crate::input::bytes::Lines;
use crate::input::finder;
use crate::input::head::Head;
use crate::input::unit::Unit;
use crate::input::wavelength;

/// Refuses a file whose metadata say that it holds transmission.
pub(super) fn transmission(metadata: Option<&RawValue>, text: &str, lines: &Lines) -> Result<(), Error> {
    #[derive(Deserialize)]
    struct Metadata<'a> {
        #[serde(borrow, rename = "type")]
        kind: &'a RawValue,
    }
    // Metadata of another form, or without a type, say nothing of it.
    let known = metadata.and_then(|raw| serde_json::from_str::<Metadata>(raw.get()).ok());
    let Some(kind) = known.map(|metadata| metadata.kind) else {
        return Ok(());
    };
    let name = kind.get().trim_matches('"');
    if !finder::goes_through(&Head::new(name)) {
        return Ok(());
    }
    let (line, column) = lines.place(text, kind.get());
    let what = format!("metadata say that this is '{}', light that goes through", shown(name));
    Err(Error::new(what)
        .at_line(line)
        .at_column(column)
        .help("measure the BRDF"))
}

/// Refuses light that is scattered at another wavelength than it came with.
pub(super) fn fluorescence(data: &Data, text: &str, lines: &Lines) -> Result<(), Error> {
    let (Some(incident), Some(scattered)) = (&data.wavelength_i, &data.wavelength_r) else {
        return Ok(());
    };
    let of = |variable: &Variable, k: usize| {
        let number = variable.values[k].get().parse().ok()?;
        wavelength::nanometres(number, Unit::parse(&variable.unit)).ok()
    };
    let differs = |&k: &usize| match (of(incident, k), of(scattered, k)) {
        (Some(from), Some(to)) => (from - to).abs() > 1e-6 * from,
        _ => false,
    };
    let Some(k) = (0..incident.values.len()).find(differs) else {
        return Ok(());
    };
    let (line, column) = lines.place(text, scattered.values[k].get());
    let [from, to] = [incident, scattered].map(|variable| format!("{} {}", variable.values[k].get(), variable.unit));
    let what = format!(
        "wavelength_r is {} where wavelength_i is {}: this is fluorescence, and no BRDF",
        shown(&to),
        shown(&from)
    );
    Err(Error::new(what)
        .at_line(line)
        .at_column(column)
        .help("leave such samples out of the file"))
}
