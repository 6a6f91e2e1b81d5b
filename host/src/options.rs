//! What the options of the command line mean to the engine.

use brdfit_core::brdf::{ALL, DIFFUSE};
#[cfg(feature = "cli")]
use clap::builder::{PossibleValuesParser, TypedValueParser};
#[cfg(feature = "cli")]
use rayon::{ThreadPool, ThreadPoolBuilder};
use serde::{Deserialize, Deserializer};

use crate::analysis::choose::{Wanted, sets};
use crate::engine::{FitOptions, Material, Method, Model, Precision};
use crate::error::{Error, shown};
use crate::instrument::InstrumentArguments;
use crate::names::{METHODS, PRECISIONS};
use crate::parameters::{AUTO, Range, apply, check, models, names_of, parameter};
use crate::terms::{term_names, terms_of};
use crate::until::until;

/// How to search, with which model and within which bounds: the options that every command that fits has.
///
/// From JSON it has the names and words of the command line, such as `{"method": "paper", "fix": ["n=1.5"]}`.
#[cfg_attr(feature = "cli", derive(clap::Args))]
#[derive(Clone, Debug, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct SearchArguments {
    /// How to search: candidates and short fits, or the paper's full fits from uniform starts
    #[cfg_attr(feature = "cli", arg(long, value_name = "METHOD", value_parser = one_of(&METHODS), default_value = METHODS[0].0))]
    #[serde(deserialize_with = "method")]
    pub method: Method,
    /// Number of starts [default: the paper's method 250; the other as many as the scan needs, 435 at most, and of more than that all are made]
    #[cfg_attr(feature = "cli", arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000)))]
    pub starts: Option<u32>,
    /// Seed of the starts
    #[cfg_attr(feature = "cli", arg(long, value_name = "N", default_value_t = 0))]
    pub seed: u64,
    /// The model; of several with commas between, or of all with auto, that of least BIC
    #[cfg_attr(
        feature = "cli",
        arg(long, value_name = "NAME|LIST|auto", default_value = "beckmann")
    )]
    pub model: String,
    /// Terms of the model, of diffuse,surface,volume,absorbing, or auto: the fewest that the scan supports
    #[cfg_attr(feature = "cli", arg(long, value_name = "LIST", default_value = "all"))]
    pub terms: String,
    /// Bounds of a parameter, in place of Table 1 of the paper, in every model that has it; repeatable
    #[cfg_attr(feature = "cli", arg(long, value_name = "NAME=LO:HI"))]
    pub bounds: Vec<String>,
    /// Holds a parameter fixed, in every model that has it; repeatable
    #[cfg_attr(feature = "cli", arg(long, value_name = "NAME=VALUE"))]
    pub fix: Vec<String>,
    /// Leaves out samples far from the fit (6 robust standard deviations of ln f), and says how many
    #[cfg_attr(feature = "cli", arg(long))]
    pub robust: bool,
    /// What is known beside the samples
    #[cfg_attr(feature = "cli", command(flatten))]
    pub instrument: InstrumentArguments,
    /// Number type of the computation
    #[cfg_attr(feature = "cli", arg(long, value_name = "PRECISION", value_parser = one_of(&PRECISIONS), default_value = PRECISIONS[0].0))]
    #[serde(deserialize_with = "precision")]
    pub precision: Precision,
    /// Number of threads, which changes no bit [default: all]
    #[cfg_attr(feature = "cli", arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024)))]
    pub threads: Option<u16>,
}

impl Default for SearchArguments {
    fn default() -> Self {
        SearchArguments {
            method: Method::Default,
            starts: None,
            seed: 0,
            model: Model::paper().name.into(),
            terms: "all".into(),
            bounds: Vec::new(),
            fix: Vec::new(),
            robust: false,
            instrument: InstrumentArguments::default(),
            precision: Precision::F64,
            threads: None,
        }
    }
}

fn method<'de, D: Deserializer<'de>>(from: D) -> Result<Method, D::Error> {
    named(from, &METHODS)
}

fn precision<'de, D: Deserializer<'de>>(from: D) -> Result<Precision, D::Error> {
    named(from, &PRECISIONS)
}

fn named<'de, D: Deserializer<'de>, T: Copy>(from: D, known: &[(&str, T)]) -> Result<T, D::Error> {
    let name = String::deserialize(from)?;
    let found = known.iter().find(|(known, _)| *known == name);
    found
        .map(|(_, value)| *value)
        .ok_or_else(|| serde::de::Error::custom(format!("there is no '{name}'")))
}

/// One of these, by its name.
#[cfg(feature = "cli")]
fn one_of<T: Clone + Send + Sync>(known: &'static [(&'static str, T)]) -> impl TypedValueParser<Value = T> {
    let value = |name: String| {
        known
            .iter()
            .find(|(known, _)| *known == name)
            .map(|(_, value)| value.clone())
    };
    // The parser of the names lets no other through.
    PossibleValuesParser::new(known.iter().map(|(name, _)| *name))
        .try_map(move |name| value(name).ok_or("no such name"))
}

impl SearchArguments {
    /// What the arguments ask of the engine.
    ///
    /// # Errors
    /// Terms or bounds that make no sense.
    pub fn wanted(&self) -> Result<Wanted, Error> {
        if self.starts == Some(0) {
            return Err(Error::new("--starts cannot be 0").help("take 1 or more"));
        }
        let models = models(&self.model)?;
        for text in self.bounds.iter().chain(&self.fix).chain(&self.instrument.prior) {
            known(&models, text)?;
        }
        let terms = if self.terms == AUTO {
            // All sets to choose from have a diffuse term.
            terms_of(&models, term_names(DIFFUSE)[0])?;
            ALL
        } else {
            terms_of(&models, &self.terms)?
        };
        let each = models.iter().map(|model| self.of_model(model, terms));
        let list: Vec<FitOptions> = each.collect::<Result<_, _>>()?;
        Ok(match &list[..] {
            _ if self.terms == AUTO => Wanted::Best(list.iter().flat_map(sets).collect()),
            [one] => Wanted::One(*one),
            _ => Wanted::Best(list),
        })
    }

    /// The same of one model, with the bounds of the parameters that it has.
    fn of_model(&self, model: &'static Model, terms: u8) -> Result<FitOptions, Error> {
        let mut options = FitOptions {
            method: self.method,
            precision: self.precision,
            seed: self.seed,
            starts: self.starts,
            robust: self.robust,
            until: until(),
            terms,
            ..FitOptions::of(model)
        };
        let has = |text: &&String| place(model, text).is_some();
        let ranges = self.bounds.iter().filter(has).map(|text| bounds(model, text));
        let fixed = self.fix.iter().filter(has).map(|text| fixed(model, text, "--fix"));
        let ranges: Vec<Range> = ranges.chain(fixed).collect::<Result<_, _>>()?;
        apply(&ranges, &mut options)?;
        self.instrument.apply(&mut options)?;
        Ok(options)
    }

    /// The threads to compute on.
    ///
    /// # Errors
    /// The system gives no threads.
    #[cfg(feature = "cli")]
    pub fn pool(&self) -> Result<ThreadPool, Error> {
        ThreadPoolBuilder::new()
            .num_threads(self.threads.map_or(0, usize::from))
            .build()
            .map_err(|error| Error::new(format!("no threads: {error}")).help("take fewer --threads"))
    }
}

/// The place of the parameter that `NAME=...` is about, if the model has it.
fn place(model: &Model, text: &str) -> Option<usize> {
    model.place(text.split('=').next()?.trim())
}

/// Refuses `NAME=...` of a parameter that none of the models has.
fn known(models: &[&'static Model], text: &str) -> Result<(), Error> {
    if models.iter().any(|model| place(model, text).is_some()) {
        return Ok(());
    }
    let name = text.split('=').next().unwrap_or_default();
    match models {
        [one] => parameter(one, name).map(drop),
        several => {
            let each = several
                .iter()
                .map(|model| format!("{} has {}", model.name, names_of(model)));
            Err(
                Error::new(format!("no model of the list has a parameter '{}'", shown(name)))
                    .help(each.collect::<Vec<_>>().join("; ")),
            )
        }
    }
}

/// Reads `NAME=LO:HI`.
///
/// # Errors
/// Another form, an unknown name, the wrong order, or a value outside the parameter's domain.
pub fn bounds(model: &Model, text: &str) -> Result<Range, Error> {
    let form = || Error::new(format!("'{}' gives no bounds", shown(text))).help("write --bounds NAME=LO:HI");
    let (name, range) = text.split_once('=').ok_or_else(form)?;
    let (lower, upper) = range.split_once(':').ok_or_else(form)?;
    let index = parameter(model, name)?;
    let (lower, upper) = (number(lower)?, number(upper)?);
    check(model, index, lower)?;
    check(model, index, upper)?;
    if lower > upper {
        return Err(Error::new(format!("the bounds of {name} are the wrong way round"))
            .help(format!("write --bounds {name}={upper}:{lower}")));
    }
    Ok(Range { index, lower, upper })
}

/// Reads `NAME=VALUE`; `option` is what messages call it.
///
/// # Errors
/// Another form, an unknown name, or a value outside the parameter's domain.
pub fn fixed(model: &Model, text: &str, option: &str) -> Result<Range, Error> {
    let form = || {
        Error::new(format!("'{}' gives no parameter a value", shown(text))).help(format!("write {option} NAME=VALUE"))
    };
    let (name, value) = text.split_once('=').ok_or_else(form)?;
    let index = parameter(model, name)?;
    let value = number(value)?;
    check(model, index, value)?;
    Ok(Range {
        index,
        lower: value,
        upper: value,
    })
}

/// Reads `rho_d=0.1,rho_s=10,...`, each parameter of the model once; `option` is what messages call it.
///
/// # Errors
/// A parameter is unknown, missing, given twice, or outside its domain.
pub fn all_parameters(model: &'static Model, list: &str, option: &str) -> Result<Material, Error> {
    let names: Vec<&str> = model.parameters.iter().map(|parameter| parameter.name).collect();
    let mut values = vec![None; names.len()];
    for member in list.split(',') {
        let one = fixed(model, member, option)?;
        if values[one.index].replace(one.lower).is_some() {
            return Err(Error::new(format!("{option} gives {} twice", names[one.index])).help("give it once"));
        }
    }
    let missing: Vec<&str> = (0..names.len())
        .filter(|&k| values[k].is_none())
        .map(|k| names[k])
        .collect();
    if !missing.is_empty() {
        return Err(
            Error::new(format!("{option} lacks {}", missing.join(", "))).help(format!(
                "give all of {}; a lobe that is not there has rho 0",
                names.join(", ")
            )),
        );
    }
    Ok(Material {
        model,
        values: values.into_iter().map(Option::unwrap_or_default).collect(),
    })
}

fn number(text: &str) -> Result<f64, Error> {
    let parsed = text.trim().parse();
    parsed.map_err(|_| Error::new(format!("'{}' is not a number", shown(text))).help("write it like 0.5 or 1e-3"))
}

#[cfg(test)]
mod tests {
    use brdfit_core::brdf::{DIFFUSE, SURFACE};

    use super::*;

    #[cfg(feature = "cli")]
    #[test]
    fn json_says_what_words_say() {
        use clap::Parser;

        use crate::input::{self, ReadOptions};

        #[derive(Parser)]
        struct Both {
            #[command(flatten)]
            read: ReadOptions,
            #[command(flatten)]
            search: SearchArguments,
        }

        let words = "brdfit --input-format astm --column R --quantity log10-brdf --angles rad --forward negative --value-unit percent \
             --wavelength-unit per-cm --polarisation mean --columns theta_s=2,brdf=3 --split a --ignore b --repeats --theta-i=-5,20 \
             --one-scan --merl-whole --drop-invalid --mask-retro 6 --max-angle 85 --max-value 1e3 --thin 2 --coverage 2 --weights equal \
             --sigma-floor 0.01 --weight-angle 60=0.5 --absolute-sigma --correct-ln-bias --method paper --starts 7 --seed 9 --model ggx --terms auto --bounds n=1:2 \
             --fix kappa=0 --robust --precision f32";
        let read = r#"{"input-format": "astm", "column": ["R"], "quantity": "log10-brdf", "angles": "rad", "forward": "negative",
            "value-unit": "percent", "wavelength-unit": "per-cm", "polarisation": "mean", "columns": ["theta_s=2", "brdf=3"],
            "split": ["a"], "ignore": ["b"], "repeats": true, "theta-i": [-5, 20], "one-scan": true, "merl-whole": true,
            "drop-invalid": true, "mask-retro": 6, "max-angle": 85, "max-value": 1e3, "thin": 2, "coverage": 2, "weights": "equal",
            "sigma-floor": 0.01, "weight-angle": ["60=0.5"], "absolute-sigma": true, "correct-ln-bias": true}"#;
        let search = r#"{"method": "paper", "starts": 7, "seed": 9, "model": "ggx", "terms": "auto", "bounds": ["n=1:2"],
            "fix": ["kappa=0"], "robust": true, "precision": "f32"}"#;
        let both = Both::try_parse_from(words.split_whitespace()).unwrap_or_else(|error| panic!("{error}"));
        let read: ReadOptions = serde_json::from_str(read).unwrap();
        let search: SearchArguments = serde_json::from_str(search).unwrap();
        assert_eq!(read, both.read);
        assert_eq!(format!("{search:?}"), format!("{:?}", both.search));
        read.check().unwrap();

        let usual = Both::try_parse_from(["brdfit"]).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(usual.read, serde_json::from_str("{}").unwrap());
        assert_eq!(
            format!("{:?}", usual.search),
            format!("{:?}", SearchArguments::default())
        );
        for wrong in [
            r#"{"mask-retro": 181}"#,
            r#"{"max-angle": -1}"#,
            r#"{"theta-i": [90]}"#,
            r#"{"coverage": 0}"#,
            r#"{"sigma-floor": -1}"#,
            r#"{"thin": 0}"#,
        ] {
            assert!(
                serde_json::from_str::<ReadOptions>(wrong).unwrap().check().is_err(),
                "{wrong}"
            );
        }
        for wrong in [
            r#"{"colour": 1}"#,
            r#"{"columns": ["x=1"]}"#,
            r#"{"weight-angle": ["60"]}"#,
        ] {
            assert!(serde_json::from_str::<ReadOptions>(wrong).is_err(), "{wrong}");
        }
        assert!(serde_json::from_str::<SearchArguments>(r#"{"method": "mine"}"#).is_err());
        // A format is looked up where the file is read.
        let unknown: ReadOptions = serde_json::from_str(r#"{"input-format": "doc"}"#).unwrap();
        let error = input::parse("file", b"", &unknown).unwrap_err().to_string();
        assert!(error.contains("there is no format 'doc'"), "{error}");
    }

    #[test]
    fn refuses_bad_bounds() {
        let paper = Model::paper();
        assert_eq!(bounds(paper, "n=1:2").unwrap().upper, 2.0);
        for bad in [
            "n",
            "n=1",
            "n=2:1",
            "n=0.5:2",
            "n=1:nan",
            "n=1:inf",
            "m=0:1",
            "kappa=-1:1",
            "x=1:2",
            "n=a:b",
        ] {
            assert!(bounds(paper, bad).is_err(), "{bad}");
        }
        let fixed = |text: &str| fixed(paper, text, "--fix");
        assert!(fixed("rho_d=-0.1").is_err() && fixed("rho_d").is_err());
        let (twice, other) = ([fixed("n=1.5").unwrap(); 2], [fixed("kappa=0").unwrap()]);
        assert!(apply(&twice, &mut FitOptions::default()).is_err());
        let mut options = FitOptions {
            terms: DIFFUSE | SURFACE,
            ..FitOptions::default()
        };
        assert!(apply(&other, &mut options).is_err());
    }
}
