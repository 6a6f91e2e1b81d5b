//! From many traces of one scan to medians and bands.

use std::f64::consts::LOG10_E;

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use serde::Serialize;

use crate::engine::trace::{Record, Trace, passes, trace};
use crate::engine::{FitError, FitOptions, Material, Method, Precision};
use crate::names;

/// What is compared.
pub const METHODS: [(Method, Precision); 4] = [
    (Method::Default, Precision::F64),
    (Method::Default, Precision::F32),
    (Method::Paper, Precision::F64),
    (Method::Paper, Precision::F32),
];

/// Relative excess costs at which time and passes are told.
pub const WITHIN: [f64; 3] = [1e-2, 1e-4, 1e-6];

/// Each search runs this often, and the fastest run counts: the others found cold caches, or other programs at work.
pub const REPEATS: u32 = 3;

/// Points of the grid in a decade.
const PER_DECADE: f64 = 16.0;

/// Error against run time for one scan.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScanStudy {
    /// File or set.
    pub name: String,
    /// Number of samples.
    pub samples: usize,
    /// The least MSE^2 (Eq. 17) that any run found.
    pub best_mse2: f64,
    /// The parameters that the scan was made with, if known, in their order.
    pub truth: Option<Vec<f64>>,
    /// In the order of [`METHODS`].
    pub methods: Vec<MethodStudy>,
}

/// One method over all seeds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MethodStudy {
    /// `default` or `paper`.
    pub method: &'static str,
    /// `f64` or `f32`.
    pub precision: &'static str,
    /// All passes with derivatives of a search, median.
    pub linearize: f64,
    /// All passes without them, median.
    pub cost: f64,
    /// All wall time of a search, s, median.
    pub elapsed_s: f64,
    /// In the order of [`WITHIN`].
    pub reached: Vec<Reached>,
    /// Over passes, where one without derivatives counts half; from the first pass to the end of the longest run.
    pub by_passes: Vec<Point>,
    /// Over wall time, s.
    pub by_time: Vec<Point>,
}

/// When a relative excess cost was reached.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Reached {
    /// The excess.
    pub within: f64,
    /// The share of seeds that reached it, 0 to 1.
    pub share: f64,
    /// Passes until then, median over all seeds; infinite (null in JSON) if fewer than half reached it.
    pub passes: f64,
    /// Wall time until then, s, as for `passes`.
    pub elapsed_s: f64,
}

/// The errors after some work.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Point {
    /// Passes or seconds.
    pub at: f64,
    /// (cost - best) / best.
    pub excess: Band,
    /// |rho_d / true - 1|, or |rho_d| if the true one is 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rho_d: Option<Band>,
    /// |m / true - 1|.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub m: Option<Band>,
    /// Root mean square of ln f less the true ln f, over the samples.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curve: Option<Band>,
}

/// Of the seeds; infinite (null in JSON) where too few have begun.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Band {
    /// A tenth is at most this.
    pub p10: f64,
    /// Half is at most this.
    pub median: f64,
    /// Nine tenths are at most this.
    pub p90: f64,
}

/// Traces every method with seeds 0 to `seeds` - 1, and compares them with the best of all; `begin` is called before each seed of each method.
///
/// # Errors
/// [`FitError`].
pub fn study(
    name: &str,
    samples: &[Sample<f64>],
    truth: Option<&Material>,
    asked: &FitOptions,
    seeds: u32,
    mut begin: impl FnMut(),
) -> Result<ScanStudy, FitError> {
    let mut traces: [Vec<Trace>; METHODS.len()] = Default::default();
    for seed in 0..seeds {
        // The methods take turns, so that a slow moment of the machine meets all of them.
        for (list, (method, precision)) in traces.iter_mut().zip(METHODS) {
            begin();
            let options = FitOptions {
                method,
                precision,
                seed: u64::from(seed),
                ..*asked
            };
            let mut fastest = trace(samples, &options)?;
            for _ in 1..REPEATS {
                let again = trace(samples, &options)?;
                if again.elapsed_s < fastest.elapsed_s {
                    fastest = again;
                }
            }
            list.push(fastest);
        }
    }
    let costs = traces.iter().flatten().flat_map(|trace| &trace.records).map(|r| r.cost);
    let best = costs.fold(f64::INFINITY, f64::min);
    let count = samples.len() as f64;
    let errors = Errors {
        best,
        // A scan without noise has an optimum of rounding errors only, to which nothing can be compared.
        unit: best.max(1e-24 * count),
        truth: truth.map(|truth| Truth::new(truth, samples)),
    };
    let methods = METHODS.iter().zip(&traces);
    Ok(ScanStudy {
        name: name.to_string(),
        samples: samples.len(),
        best_mse2: best / (count * count),
        truth: truth.map(|truth| truth.values.to_vec()),
        methods: methods
            .map(|(&method, traces)| summary(method, traces, &errors))
            .collect(),
    })
}

/// The truth with its ln f at each sample.
struct Truth {
    material: Material,
    curve: Vec<(Sample<f64>, f64)>,
}

impl Truth {
    fn new(material: &Material, samples: &[Sample<f64>]) -> Truth {
        let curve = samples.iter().filter_map(|s| Some((*s, material.ln_f(s)?)));
        Truth {
            material: *material,
            curve: curve.collect(),
        }
    }
}

struct Errors {
    best: f64,
    unit: f64,
    truth: Option<Truth>,
}

impl Errors {
    /// Excess cost, and of rho_d, m and the curve.
    fn of(&self, record: &Record) -> [f64; 4] {
        let excess = (record.cost - self.best) / self.unit;
        let Some(Truth { material, curve }) = &self.truth else {
            return [excess, 0.0, 0.0, 0.0];
        };
        let relative = |x: f64, t: f64| (x - t).abs() / if t == 0.0 { 1.0 } else { t };
        let found = Material {
            values: record.params,
            ..*material
        };
        let squares = curve.iter().filter_map(|(sample, true_ln)| {
            let difference = found.ln_f(sample)? - true_ln;
            Some(difference * difference)
        });
        let rms = (squares.sum::<f64>() / curve.len() as f64).sqrt();
        let of = |name: &str| relative(found.get(name).unwrap_or(0.0), material.get(name).unwrap_or(0.0));
        [excess, of("rho_d"), of("m"), rms]
    }
}

/// A record as passes, seconds and errors.
type Step = (f64, f64, [f64; 4]);
/// The steps of one run.
type Run = Vec<Step>;

fn summary((method, precision): (Method, Precision), traces: &[Trace], errors: &Errors) -> MethodStudy {
    let record = |r: &Record| (passes(r.evaluations), r.elapsed_s, errors.of(r));
    let runs: Vec<Run> = traces.iter().map(|t| t.records.iter().map(record).collect()).collect();
    let median = |value: &dyn Fn(&Trace) -> f64| band(traces.iter().map(value).collect()).median;
    let most = |value: &dyn Fn(&Trace) -> f64| traces.iter().map(value).fold(0.0, f64::max);
    let first_s = runs
        .iter()
        .filter_map(|run| run.first())
        .map(|r| r.1)
        .fold(f64::INFINITY, f64::min);
    let known = errors.truth.is_some();
    let grid_of = |low: f64, high: f64, at: fn(&Step) -> f64| -> Vec<Point> {
        grid(low, high).map(|x| point(x, &runs, at, known)).collect()
    };
    MethodStudy {
        method: names::method(method),
        precision: names::precision(precision),
        linearize: median(&|t| f64::from(t.evaluations.linearize)),
        cost: median(&|t| f64::from(t.evaluations.cost)),
        elapsed_s: median(&|t| t.elapsed_s),
        reached: WITHIN.map(|within| reached(within, &runs)).into(),
        by_passes: grid_of(1.0, most(&|t| passes(t.evaluations)), |r| r.0),
        by_time: grid_of(first_s, most(&|t| t.elapsed_s), |r| r.1),
    }
}

fn reached(within: f64, runs: &[Run]) -> Reached {
    let firsts: Vec<_> = runs.iter().map(|run| run.iter().find(|r| r.2[0] <= within)).collect();
    let median =
        |value: fn(&Step) -> f64| band(firsts.iter().map(|first| first.map_or(f64::INFINITY, value)).collect()).median;
    Reached {
        within,
        share: firsts.iter().flatten().count() as f64 / runs.len() as f64,
        passes: median(|r| r.0),
        elapsed_s: median(|r| r.1),
    }
}

/// What the runs had at `x`.
fn point(x: f64, runs: &[Run], at: fn(&Step) -> f64, known: bool) -> Point {
    let quantity = |k: usize| {
        let had = |run: &Run| match run.partition_point(|record| at(record) <= x) {
            0 => f64::INFINITY,
            after => run[after - 1].2[k],
        };
        band(runs.iter().map(had).collect())
    };
    Point {
        at: x,
        excess: quantity(0),
        rho_d: known.then(|| quantity(1)),
        m: known.then(|| quantity(2)),
        curve: known.then(|| quantity(3)),
    }
}

/// The powers of 10^(1/16) from just above `low` to just above `high`; none without a range.
fn grid(low: f64, high: f64) -> impl Iterator<Item = f64> {
    let place = |x: f64| (PER_DECADE * LOG10_E * Real::portable_ln(x) - 1e-9).ceil() as i32;
    let (first, last) = if 0.0 < low && low <= high {
        (place(low), place(high))
    } else {
        (1, 0)
    };
    (first..=last).map(|k| Real::portable_exp(f64::from(k) / (PER_DECADE * LOG10_E)))
}

/// Percentiles by the nearest rank.
fn band(mut values: Vec<f64>) -> Band {
    values.sort_by(f64::total_cmp);
    let at = |part: f64| {
        let rank = (part * values.len() as f64).ceil() as usize;
        values.get(rank.max(1) - 1).copied().unwrap_or(f64::INFINITY)
    };
    Band {
        p10: at(0.1),
        median: at(0.5),
        p90: at(0.9),
    }
}
