//! What someone needs who wants to make the same result again.

use serde::Serialize;
use serde_json::{Map, Value};

use super::by_name::ByName;
use crate::engine::FitOptions;
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
    /// Least and largest value of each parameter.
    bounds: ByName<[f64; 2]>,
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
