//! The columns of a result, each once: the tables of `fit` and `batch` (CSV, Parquet), the plain members of JSON, and the tables of the page and of Python are made of these.
//!
//! A further column is one more entry here.

use brdfit_core::model::Parameter;
use brdfit_core::uncertainty::Place;

use super::cell::{Cell, Kind};
use crate::analysis::derived::conserve_energy;
use crate::analysis::fit::FittedScan;
use crate::analysis::misfit::coverage_factor;
use crate::analysis::undetermined::open;
use crate::engine::{FitOptions, Minimum, Model, Outcome, Values};
use crate::names;
use crate::number::shortest;
use crate::terms::term_names;

/// A column of the tables.
pub struct Column {
    /// Its head, and its key in JSON.
    pub name: String,
    /// The unit of its values: `1` where they are dimensionless, empty where they are words or counts.
    pub unit: &'static str,
    /// What it tells.
    pub about: String,
    /// Where it stands in JSON.
    pub json: Json,
    value: Value,
}

/// Where a column stands in the JSON object of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Json {
    /// At the head; null where it is empty.
    Head,
    /// Among what was asked for and found, as all below not there where it is empty.
    Found,
    /// Behind the parameters.
    Bounds,
    /// Behind what is known of them.
    End,
    /// Last. Results that have the same bits each time are without it.
    Time,
    /// JSON tells it in another form.
    Otherwise,
}

/// What a row is about: a fit, or one of its minima.
#[derive(Clone, Copy)]
pub struct FitRow<'a> {
    /// The fitted scan; none where the samples are all that is known of it.
    pub scan: Option<&'a FittedScan>,
    /// What was asked for.
    pub options: &'a FitOptions,
    /// What came out.
    pub outcome: &'a Outcome,
    /// A minimum and its place, if the row is about it and not about the best fit.
    pub minimum: Option<(usize, &'a Minimum)>,
}

impl<'a> From<&'a FittedScan> for FitRow<'a> {
    fn from(scan: &'a FittedScan) -> Self {
        FitRow {
            scan: Some(scan),
            options: &scan.options,
            outcome: &scan.outcome,
            minimum: None,
        }
    }
}

impl FitRow<'_> {
    fn params(&self) -> &Values {
        self.minimum
            .map_or(&self.outcome.params, |(_, minimum)| &minimum.params)
    }
}

/// The value of a row; one that is absent, NaN or infinite is an empty cell.
#[derive(Clone, Copy)]
enum Value {
    Text(fn(&FitRow) -> Option<String>),
    Words(fn(&FitRow) -> Vec<&'static str>),
    Whole(fn(&FitRow) -> Option<u64>),
    Number(fn(&FitRow) -> Option<f64>),
    Flag(fn(&FitRow) -> Option<bool>),
    /// Of the parameter of this name, by its place; one that the row's model has not is empty.
    OfParameter(fn(&FitRow, usize) -> Option<f64>, &'static str),
}

impl Column {
    fn new(name: impl Into<String>, unit: &'static str, about: impl Into<String>, json: Json, value: Value) -> Self {
        Column {
            name: name.into(),
            unit,
            about: about.into(),
            json,
            value,
        }
    }

    /// What it holds.
    pub fn kind(&self) -> Kind {
        match self.value {
            Value::Text(_) | Value::Words(_) => Kind::Text,
            Value::Whole(_) => Kind::Whole,
            Value::Flag(_) => Kind::Flag,
            Value::Number(_) | Value::OfParameter(..) => Kind::Number,
        }
    }

    /// Its value in a row.
    pub fn cell(&self, row: &FitRow) -> Cell {
        let number = |value: Option<f64>| value.filter(|x| x.is_finite()).map(Cell::Number);
        let cell = match self.value {
            Value::Text(of) => of(row).map(Cell::Text),
            Value::Words(of) => Some(Cell::Words(of(row).into_iter().map(String::from).collect())),
            Value::Whole(of) => of(row).map(Cell::Whole),
            Value::Number(of) => number(of(row)),
            Value::Flag(of) => of(row).map(Cell::Flag),
            Value::OfParameter(of, name) => number(row.outcome.model.place(name).and_then(|place| of(row, place))),
        };
        cell.unwrap_or(Cell::Empty)
    }
}

/// The columns of a table with one row a fitted scan, of these models.
pub fn of_fits(models: &[&Model]) -> Vec<Column> {
    [scan(), asked(), parameters(models), found(), known(models), of_scan()]
        .into_iter()
        .flatten()
        .collect()
}

/// The columns of a table with one row a distinct minimum.
pub fn of_minima(models: &[&Model]) -> Vec<Column> {
    [scan(), asked(), parameters(models), minimum()]
        .into_iter()
        .flatten()
        .chain([sha256()])
        .collect()
}

/// The columns of a table with one row a fit, of whose scan nothing is known but the samples.
pub fn of_outcomes(models: &[&Model]) -> Vec<Column> {
    [asked(), parameters(models), found(), known(models)]
        .into_iter()
        .flatten()
        .collect()
}

/// What was fitted.
fn scan() -> Vec<Column> {
    vec![
        text("file", "file of the scan", Json::Head, |row| {
            Some(row.scan?.file.clone())
        }),
        text("scan", "which scan of the file", Json::Head, |row| {
            row.scan?.scan.clone()
        }),
    ]
}

/// How it was fitted, and how well.
fn asked() -> Vec<Column> {
    use Json::Found;
    let mse2 = |row: &FitRow| Some(row.minimum.map_or(row.outcome.mse2, |(_, minimum)| minimum.mse2));
    let eq_17 = "sum of squared residuals of ln f over samples squared (Eq. 17)";
    vec![
        whole("samples", "samples that were fitted", Found, |row| {
            Some(row.outcome.samples as u64)
        }),
        text("method", "method of the search", Found, |row| {
            Some(names::method(row.options.method).into())
        }),
        whole("seed", "seed of the starts", Found, |row| Some(row.options.seed)),
        whole("starts", "starts of the search", Found, |row| {
            Some(row.options.starts().into())
        }),
        text("model", "the model", Found, |row| Some(row.outcome.model.name.into())),
        words("terms", "terms of the model", Found, |row| {
            term_names(row.outcome.terms)
        }),
        number("mse2", "1", eq_17, Found, mse2),
    ]
}

/// The parameters of all models, each once.
pub fn every(models: &[&Model]) -> Vec<&'static Parameter> {
    let mut all: Vec<&Parameter> = Vec::new();
    for parameter in models.iter().flat_map(|model| model.parameters) {
        if all.iter().all(|known| known.name != parameter.name) {
            all.push(parameter);
        }
    }
    all
}

fn parameters(models: &[&Model]) -> Vec<Column> {
    let value = |row: &FitRow, place: usize| Some(row.params()[place]);
    let one = |of| parameter("", "", of, value);
    every(models).into_iter().map(one).collect()
}

/// What distinguishes a minimum.
fn minimum() -> Vec<Column> {
    use Json::Otherwise;
    vec![
        whole("minimum", "place of the minimum, from 1", Otherwise, |row| {
            Some(row.minimum?.0 as u64 + 1)
        }),
        whole("hits", "fits that ended in it", Otherwise, |row| {
            Some(row.minimum?.1.hits.into())
        }),
        whole("first_start", "first start that led there", Otherwise, |row| {
            Some(row.minimum?.1.first_start)
        }),
    ]
}

/// What is known of the best fit.
fn found() -> Vec<Column> {
    use Json::{Bounds, End, Found, Otherwise};
    let worst = |row: &FitRow| Some(row.outcome.minima.last().map_or(row.outcome.mse2, |worst| worst.mse2));
    let potential = "(high - low) / high of the MSE^2 of the minima (Table 3)";
    let scale = "robust standard deviation of a residual of ln f";
    let offset =
        "what the instrument reads for theta_s = 0, in the sign of the file, if that was fitted and is determined";
    let priors = "standard deviation of ln f by which priors were weighed: that of the residuals, the larger the more they are correlated";
    vec![
        number(
            "rms_ln",
            "1",
            "root of the mean squared residual of ln f",
            Found,
            |row| Some(row.outcome.rms_ln),
        ),
        words("at_bound", "parameters on a bound", Bounds, |row| {
            row.outcome.at_bound.clone()
        }),
        text("stop", "how the best fit ended", End, |row| {
            Some(names::stop(row.outcome.stop).into())
        }),
        whole("minima", "distinct minima", Otherwise, |row| {
            Some(row.outcome.minima.len() as u64)
        }),
        whole("cost", "passes without derivatives", Otherwise, |row| {
            Some(row.outcome.evaluations.cost.into())
        }),
        whole("linearize", "passes with derivatives", Otherwise, |row| {
            Some(row.outcome.evaluations.linearize.into())
        }),
        number("mse2_high", "1", "MSE^2 of the worst minimum", Otherwise, worst),
        number("improvement_potential", "1", potential, Otherwise, |row| {
            Some(row.outcome.improvement_potential)
        }),
        number("robust_scale", "1", scale, Found, |row| {
            Some(row.outcome.robust.as_ref()?.scale)
        }),
        number("offset_deg", "deg", offset, Found, |row| {
            let offset = row.outcome.offset.filter(|offset| offset.stderr.is_finite());
            let offset = offset?.value.to_degrees();
            Some(row.scan.map_or(offset, |scan| scan.about.counts.of_file(offset)))
        }),
        number("offset_stderr_deg", "deg", "its standard error", Found, |row| {
            Some(row.outcome.offset?.stderr.to_degrees())
        }),
        number("prior_scale", "1", priors, Found, |row| row.outcome.sigma),
    ]
}

/// How well the parameters are known.
fn known(models: &[&Model]) -> Vec<Column> {
    let degrees = whole(
        "degrees_of_freedom",
        "samples less parameters inside their bounds",
        Json::Otherwise,
        |row| Some(row.outcome.uncertainty.degrees_of_freedom as u64),
    );
    let stderr = |row: &FitRow, index: usize| {
        let known = &row.outcome.uncertainty;
        (known.places[index] == Some(Place::Inside)).then_some(known.stderr[index])
    };
    let one = |of| parameter("stderr_", "standard error of the ", of, stderr);
    let factor = number(
        "coverage_factor_95",
        "1",
        "standard errors that are the half of a 95 % interval",
        Json::Otherwise,
        |row| Some(coverage_factor(&row.outcome.uncertainty)),
    );
    let over = number(
        "correlated_over_deg",
        "deg",
        "angle over which residuals are correlated",
        Json::Otherwise,
        |row| Some(row.outcome.uncertainty.misfit?.length.to_degrees()),
    );
    let times = number(
        "error_factor",
        "1",
        "largest standard error over that of independent residuals",
        Json::Otherwise,
        |row| Some(row.outcome.uncertainty.misfit?.factor.1),
    );
    let open = words(
        "undetermined",
        "parameters that are not determined, or only through a product",
        Json::Otherwise,
        |row| open(&row.outcome.material(), &row.outcome.uncertainty).collect(),
    );
    [degrees, factor, over, times, open]
        .into_iter()
        .chain(every(models).into_iter().map(one))
        .collect()
}

/// What is known by the scan.
fn of_scan() -> Vec<Column> {
    use Json::{Found, Otherwise, Time};
    let proved = "proved: no parameters within the bounds have an MSE^2 below 1 less this of that of the fit";
    let conserved = "reflectance of at most 1 at each angle of incidence, if that is determined";
    let worst = "angle of incidence where the residual is largest";
    let least = "directional-hemispherical reflectance at the least angle of incidence";
    vec![
        text("theta_i_deg", "angles of incidence, degrees", Otherwise, |row| {
            let angles = row.scan?.angles.iter().map(|angle| shortest(angle.degrees()));
            Some(angles.collect::<Vec<_>>().join("+"))
        }),
        number("worst_theta_i_deg", "deg", worst, Otherwise, |row| {
            let angles = row.scan?.angles.iter();
            let worst = angles.max_by(|a, b| a.rms_ln.total_cmp(&b.rms_ln))?;
            Some(worst.degrees())
        }),
        number("reflectance_least_theta_i", "1", least, Otherwise, |row| {
            row.scan?.reflectances.first().copied().flatten()
        }),
        number(
            "chi2",
            "1",
            "sum of squared residuals over their variances in the file",
            Found,
            |row| row.scan?.chi2,
        ),
        text(
            "deviations",
            "what became of the standard deviations of the file: used for errors, refuted by chi2, absolute, as asked, or exact: residuals are rounding",
            Found,
            |row| Some(row.scan?.deviations?.name().into()),
        ),
        whole("left_out", "rows of the scan that were left out", Otherwise, |row| {
            Some(row.scan?.left_out.iter().map(|one| one.samples as u64).sum())
        }),
        flag("energy_conserved", conserved, Otherwise, |row| {
            conserve_energy(&row.scan?.reflectances)
        }),
        number("certified_eps", "1", proved, Otherwise, |row| row.scan?.proof?.within()),
        whole("certificate_boxes", "boxes of the proof", Otherwise, |row| {
            Some(row.scan?.proof?.boxes)
        }),
        text("not_used", "columns of the file that are not used", Otherwise, |row| {
            Some(row.scan?.about.unused.join("+"))
        }),
        text("hints", "what a person would say of the fit", Otherwise, |row| {
            let hints = row.scan?.hints.iter().map(|hint| hint.text.as_str());
            Some(hints.collect::<Vec<_>>().join(" | "))
        }),
        sha256(),
        number("elapsed_s", "s", "time of the search", Time, |row| {
            Some(row.scan?.elapsed?.as_secs_f64())
        }),
    ]
}

/// What tells whether a file is still the one that was fitted.
fn sha256() -> Column {
    let about = "SHA-256 of the file of the scan; of several files one each";
    text("sha256", about, Json::Otherwise, |row| {
        let sources = row.scan?.about.sources.iter();
        let all: Vec<&str> = sources.map(|source| source.sha256.as_str()).collect();
        Some(all.join("+"))
    })
}

fn text(name: &str, about: &str, json: Json, of: fn(&FitRow) -> Option<String>) -> Column {
    Column::new(name, "", about, json, Value::Text(of))
}

fn words(name: &str, about: &str, json: Json, of: fn(&FitRow) -> Vec<&'static str>) -> Column {
    Column::new(name, "", about, json, Value::Words(of))
}

fn whole(name: &str, about: &str, json: Json, of: fn(&FitRow) -> Option<u64>) -> Column {
    Column::new(name, "", about, json, Value::Whole(of))
}

fn number(name: &str, unit: &'static str, about: &str, json: Json, of: fn(&FitRow) -> Option<f64>) -> Column {
    Column::new(name, unit, about, json, Value::Number(of))
}

fn flag(name: &str, about: &str, json: Json, of: fn(&FitRow) -> Option<bool>) -> Column {
    Column::new(name, "", about, json, Value::Flag(of))
}

/// The column of one parameter; `before` stands before its name and `about` before what it means.
fn parameter(before: &str, about: &str, of: &'static Parameter, value: fn(&FitRow, usize) -> Option<f64>) -> Column {
    Column::new(
        format!("{before}{}", of.name),
        if of.unit.is_empty() { "1" } else { of.unit },
        format!("{about}{}", of.what),
        Json::Otherwise,
        Value::OfParameter(value, of.name),
    )
}
