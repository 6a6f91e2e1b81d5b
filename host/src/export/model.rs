//! The model that is exported, from a result or from parameters.

use std::cmp::Ordering;
use std::path::Path;

use brdfit_core::brdf::Params;
use brdfit_core::geometry::Sample;
use brdfit_core::model::Parameter;
use brdfit_core::real::Real;
use serde_json::Value;

use crate::engine::{self, Material};
use crate::error::Error;
use crate::number::six;
use crate::parameters::{check, model};
use crate::plain::plain;
use crate::result::words::listed;

/// A model, and what is known about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// What it is called: the scan's file, by default.
    pub name: String,
    /// Its BRDF.
    pub material: Material,
    /// Their standard errors, as far as they are known.
    pub stderr: Vec<Option<f64>>,
    /// Where it comes from, in one line.
    pub origin: String,
    /// The wavelength in nm, if the scan is named by one.
    pub wavelength: Option<f64>,
}

impl Model {
    /// From parameters alone.
    pub fn of_params(material: Material) -> Model {
        Model {
            name: "material".into(),
            material,
            stderr: vec![None; material.values.len()],
            origin: format!("parameters given to brdfit {}", env!("CARGO_PKG_VERSION")),
            wavelength: None,
        }
    }

    /// From results of `brdfit fit --format json`: those that `index` (from 1) chooses, in its order; without it all, with the longest wavelength first, as red comes before blue.
    ///
    /// # Errors
    /// It is no such result, there are not so many, or their parameters have no BRDF.
    pub fn of_json(bytes: &[u8], index: &[usize]) -> Result<Vec<Model>, Error> {
        let all: Value =
            serde_json::from_slice(bytes).map_err(|error| not_ours("this is no JSON").at_line(error.line() as u64))?;
        let results = match &all {
            Value::Array(results) => results.as_slice(),
            one => std::slice::from_ref(one),
        };
        if index.is_empty() {
            let mut models = results
                .iter()
                .map(Model::of_result)
                .collect::<Result<Vec<_>, Error>>()?;
            if models.iter().all(|model| model.wavelength.is_some()) {
                models.sort_by(|a, b| b.wavelength.partial_cmp(&a.wavelength).unwrap_or(Ordering::Equal));
            }
            return Ok(models);
        }
        let chosen = index.iter().map(|&index| {
            let result = index.checked_sub(1).and_then(|place| results.get(place));
            let none = || {
                Error::new(format!(
                    "there are {} results, so none is number {index}",
                    results.len()
                ))
                .help("count from 1")
            };
            Model::of_result(result.ok_or_else(none)?)
        });
        chosen.collect()
    }

    /// From one result.
    fn of_result(result: &Value) -> Result<Model, Error> {
        // Results of version 0.1 name no model.
        let model = match result["model"].as_str() {
            Some(name) => model(name)?,
            None => engine::Model::paper(),
        };
        let mut values = Vec::new();
        for (place, parameter) in model.parameters.iter().enumerate() {
            let value = result["parameters"][parameter.name].as_f64();
            let value = value.ok_or_else(|| not_ours(&format!("there is no parameters.{}", parameter.name)))?;
            check(model, place, value)?;
            values.push(value);
        }
        let text = |key: &str| result[key].as_str();
        let file = text("file").unwrap_or("material");
        let name = text("scan").map_or(file.to_string(), |scan| format!("{file} {scan}"));
        let mut origin = format!("brdfit {}, fitted to {name}", env!("CARGO_PKG_VERSION"));
        if let Some(rms) = result["rms_ln"].as_f64() {
            origin += &format!(", rms of ln f {rms:.3}");
        }
        for caution in cautions(result) {
            origin += &format!("; {caution}");
        }
        let stderr = |parameter: &Parameter| result["uncertainty"]["stderr"][parameter.name].as_f64();
        Ok(Model {
            name,
            material: Material {
                model,
                values: values.into_iter().collect(),
            },
            stderr: model.parameters.iter().map(stderr).collect(),
            origin: plain(&origin).into_owned(),
            wavelength: text("scan").and_then(wavelength),
        })
    }

    /// f in sr^-1; angles in radians, 0 beyond the horizon.
    pub fn f(&self, theta_i: f64, theta_s: f64, delta_phi: f64) -> f64 {
        let sample = Sample {
            theta_i,
            theta_s,
            delta_phi,
            brdf: 1.0,
            weight: 1.0,
        };
        self.material.ln_f(&sample).map_or(0.0, Real::portable_exp)
    }

    /// The parameters of Eq. 14, for forms that know no other model.
    ///
    /// # Errors
    /// It is another model.
    pub fn eq_14(&self, form: &str) -> Result<Params<f64>, Error> {
        self.material.eq_14().ok_or_else(|| {
            Error::new(format!("{form} cannot hold the model {}", self.material.model.name))
                .help("--to zemax, bird and openmaterial take any model; or fit --model beckmann")
        })
    }

    /// rho_d, A, B and g of ABg, for forms that know no other model.
    ///
    /// # Errors
    /// It is another model.
    pub fn abg(&self, form: &str) -> Result<[f64; 4], Error> {
        let values = <[f64; 4]>::try_from(&self.material.values[..]).ok();
        values.filter(|_| self.material.model.name == "abg").ok_or_else(|| {
            Error::new(format!("{form} cannot hold the model {}", self.material.model.name))
                .help("--to zemax, bird and openmaterial take any model; or fit --model abg")
        })
    }
}

/// What a user of the model must know of the fit: which parameters it does not determine, which lobes the scan does not see, and where more light leaves than arrives.
fn cautions(result: &Value) -> Vec<String> {
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let words = |value: &Value| -> Vec<String> {
        let all = list(value).into_iter();
        all.filter_map(|one| Some(one.as_str()?.to_string())).collect()
    };
    let known = &result["uncertainty"];
    let open = list(&known["undetermined"]);
    let mut cautions: Vec<String> = open
        .iter()
        .filter_map(|what| Some(format!("this scan determines {}", open_words(what, &words)?)))
        .collect();
    let unseen = words(&known["not_seen"]);
    if !unseen.is_empty() {
        cautions.push(format!(
            "not seen by this scan, and set to the least: {}",
            unseen.join(", ")
        ));
    }
    let above = list(&result["derived"]);
    let above = above.iter().filter(|at| at["energy_conserved"] == false);
    let above: Vec<String> = above.filter_map(|at| Some(six(at["theta_i_deg"].as_f64()?))).collect();
    if !above.is_empty() {
        cautions.push(format!(
            "ENERGY IS NOT CONSERVED: more light leaves than arrives at theta_i = {} deg",
            above.join(", ")
        ));
    }
    cautions
}

/// Such as "rho_s and n only through rho_s F(theta_d)", or "n not at all".
fn open_words(what: &Value, words: &impl Fn(&Value) -> Vec<String>) -> Option<String> {
    let (names, through) = (words(&what["parameters"]), words(&what["through"]));
    let listed = |all: &[String]| listed(&all.iter().map(String::as_str).collect::<Vec<_>>());
    match (names.is_empty(), through.is_empty()) {
        (true, _) => None,
        (false, true) => Some(format!("{} not at all", listed(&names))),
        (false, false) => Some(format!("{} only through {}", listed(&names), listed(&through))),
    }
}

fn not_ours(what: &str) -> Error {
    Error::new(what).help("give what brdfit fit --format json has written")
}

/// The wavelength in a scan's name, such as `R 550 nm` or `550nm`.
fn wavelength(scan: &str) -> Option<f64> {
    let before = scan.trim_end().strip_suffix("nm")?.trim_end();
    let start = before.rfind(|c: char| !(c.is_ascii_digit() || c == '.'));
    let number = &before[start.map_or(0, |start| start + 1)..];
    number.parse().ok().filter(|&length| length > 0.0)
}

/// Words that mean something else to Python, C, C++ or Rust, or are models of Mitsuba's own.
const RESERVED: &str = "abstract alignas alignof and as asm assert async auto await become bitand bitor blendbsdf bool box break bumpmap \
    case catch char class compl concept conductor const consteval constexpr constinit continue crate decltype def default del delete \
    dielectric diffuse do double dr dyn elif else enum except explicit export extern false final finally float fn for friend from \
    gen global goto hair hide if impl import in inline int is lambda let loop long macro mask match measured mi mod move mut mutable \
    namespace new noexcept none nonlocal normalmap not null nullptr operator or override pass plastic pplastic principled \
    principledthin private protected pub raise ref register requires restrict retarder return roughconductor roughdielectric \
    roughplastic self short signed sizeof static struct super switch template thindielectric this throw trait true try twosided \
    type typedef typeid typename typeof union unsafe unsigned unsized use using virtual void volatile where while with xor yield";

/// The model's name as a word of a program: letters, digits and underscores, and no word of a language.
pub(super) fn word(name: &str) -> String {
    let stem = Path::new(name)
        .file_stem()
        .map_or(String::new(), |stem| stem.to_string_lossy().into_owned());
    let word: String = stem
        .chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() {
                c.to_ascii_lowercase()
            } else {
                '_'
            }
        })
        .collect();
    let reserved = RESERVED.split_whitespace().any(|reserved| reserved == word);
    if word.starts_with(|c: char| c.is_ascii_alphabetic()) && !reserved {
        word
    } else {
        format!("brdf_{word}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wavelengths_are_found_in_names() {
        for (name, expected) in [
            ("550 nm", Some(550.0)),
            ("s 632.8nm", Some(632.8)),
            ("brdf_550nm", Some(550.0)),
            ("R", None),
            ("nm", None),
            ("0 nm", None),
        ] {
            assert_eq!(wavelength(name), expected, "{name}");
        }
    }

    #[test]
    fn names_become_identifiers() {
        for (name, expected) in [
            ("scans/Black Paint-2.csv", "black_paint_2"),
            ("class", "brdf_class"),
            ("mi.csv", "brdf_mi"),
            ("diffuse", "brdf_diffuse"),
            ("a\0b\u{202e}c", "a_b_c"),
            ("2024", "brdf_2024"),
            ("_x", "brdf__x"),
            ("", "brdf_"),
            ("\"\nimport os\n", "brdf___import_os_"),
        ] {
            assert_eq!(word(name), expected, "{name:?}");
        }
    }
}
