//! What someone needs who wants to make the same result again.

use serde::Serialize;
use serde_json::{Map, Value};

use super::by_name::ByName;
use crate::engine::{FitOptions, Instrument};
use crate::input::source::Source;
use crate::input::{About, ReadOptions};
use crate::names;

/// Program, files and options.
#[derive(Serialize)]
pub struct Provenance<'a> {
    /// Version of the program.
    brdfit: &'static str,
    files: &'a [Source],
    /// What the user said about the files: masks, units, weights.
    read_options: Map<String, Value>,
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    search: Option<Search>,
}

/// What was asked of the search and stands nowhere else.
#[derive(Serialize)]
struct Search {
    precision: &'static str,
    robust: bool,
    /// What took part beside the samples; not there if nothing did.
    #[serde(skip_serializing_if = "Option::is_none")]
    instrument: Option<Beside>,
    /// Least and largest value of each parameter.
    bounds: ByName<[f64; 2]>,
}

/// What took part in a fit beside the samples.
#[derive(Serialize)]
struct Beside {
    /// Mean and standard uncertainty of parameters; null where there is none.
    priors: ByName<Option<[f64; 2]>>,
    fit_offset: bool,
    aperture_half_angle_deg: f64,
    scale_uncertainty: f64,
    conserve_energy: bool,
}

fn beside(options: &FitOptions) -> Option<Beside> {
    let instrument = &options.instrument;
    let some = *instrument != Instrument::default();
    some.then(|| Beside {
        priors: ByName::new(options.model, |place| {
            instrument.priors[place].map(|prior| [prior.mean, prior.sigma])
        }),
        fit_offset: instrument.offsets.is_some(),
        aperture_half_angle_deg: instrument.aperture.to_degrees(),
        scale_uncertainty: instrument.scale_uncertainty,
        conserve_energy: instrument.limit.is_some(),
    })
}

/// Of a scan, and of the search for its fit if that took options.
pub fn provenance<'a>(about: &'a About, options: Option<&FitOptions>) -> Provenance<'a> {
    Provenance {
        brdfit: env!("CARGO_PKG_VERSION"),
        files: &about.sources,
        read_options: changed(&about.asked),
        search: options.map(|options| Search {
            precision: names::precision(options.precision),
            robust: options.robust,
            instrument: beside(options),
            bounds: ByName::new(options.model, |place| [options.lower[place], options.upper[place]]),
        }),
    }
}

/// The options that are not as usual.
fn changed(options: &ReadOptions) -> Map<String, Value> {
    let object = |options: &ReadOptions| match serde_json::to_value(options) {
        Ok(Value::Object(members)) => members,
        _ => Map::new(),
    };
    let usual = object(&ReadOptions::default());
    let all = object(options).into_iter();
    all.filter(|(name, value)| usual.get(name) != Some(value)).collect()
}
