//! Uncertainties of the BRDF: of each sample, or one for all.

use serde::Deserialize;

use super::file::{Data, number};
use crate::error::{Error, shown};
use crate::input::bytes::Lines;
use crate::input::raw::Weight;
use crate::input::unit::Unit;

#[derive(Deserialize)]
struct Uncertainty {
    value: f64,
    unit: String,
}

/// The uncertainty of sample `k`: its own, or that of all.
pub(super) fn uncertainty<'a>(
    data: &'a Data,
    text: &'a str,
    lines: &'a Lines,
) -> Result<impl Fn(usize) -> Result<Weight, Error> + 'a, Error> {
    let whole: Option<Uncertainty> = match (&data.u_brdf, data.brdf.uncertainty) {
        (None, Some(raw)) => Some(serde_json::from_str(raw.get()).map_err(|error| {
            let (line, _) = lines.place(text, raw.get());
            Error::new(format!("the uncertainty of BRDF: {error}"))
                .at_line(line)
                .help("give value and unit")
        })?),
        _ => None,
    };
    let unit = match (&data.u_brdf, &whole) {
        (Some(variable), _) => variable.unit.as_str(),
        (None, Some(whole)) => whole.unit.as_str(),
        (None, None) => "sr^-1",
    };
    let relative = match Unit::parse(unit) {
        Some(Unit::PerSr) => false,
        Some(Unit::Percent) => true,
        _ => {
            return Err(
                Error::new(format!("the unit of the uncertainty of BRDF is '{}'", shown(unit)))
                    .help("give sr^-1, 1/sr or %"),
            );
        }
    };
    Ok(move |k: usize| {
        let x = match (&data.u_brdf, &whole) {
            (Some(variable), _) => number(variable.values[k], text, lines)?,
            (None, Some(whole)) => whole.value,
            (None, None) => return Ok(Weight::Unknown),
        };
        Ok(if relative {
            Weight::RelativeSigma(x / 100.0)
        } else {
            Weight::Sigma(x)
        })
    })
}
