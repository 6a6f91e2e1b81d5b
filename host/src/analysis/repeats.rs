//! Runs of one sample, each fitted alone, and the budget of uncertainty over them (JCGM 100:2008, the GUM).
//!
//! A single run does not know what changes between runs: the spot, the alignment, the lamp.
//! The spread of the runs' values holds that and the noise within them, and is evaluated as type A; what is the same for all runs, a calibration and priors, is type B.

mod priors;

use brdfit_core::uncertainty::Place;

use super::chance::{above_f, within_t};
use super::derived::{Derived, Value};
use super::fit::FittedScan;
use super::undetermined::undetermined;
use crate::engine::threads;
use crate::input::Measurement;
use priors::Displaced;

/// Confidence of the expanded uncertainty.
pub const LEVEL: f64 = 0.95;
/// From so many degrees of freedom on t is normal in all its digits that are printed.
const MANY: f64 = 1e6;
/// A spread or a run is out of the ordinary at this probability, for all quantities of a budget together (Bonferroni).
const UNLIKELY: f64 = 0.05;

/// One quantity over all runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// What it is.
    pub name: String,
    /// Its unit; empty where it is dimensionless.
    pub unit: &'static str,
    /// The angle of incidence that it belongs to, degrees; none for a parameter.
    pub theta_i: Option<f64>,
    /// Its value in each run with the standard error from within the run; none where the run does not tell it.
    pub runs: Vec<Option<Value>>,
    /// Its budget; none if a run does not tell it.
    pub budget: Option<Budget>,
    /// The runs that do not agree with most others within their own expanded errors ([`disagreeing`]).
    pub disagree: Vec<usize>,
}

/// The budget of one quantity, in its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Mean of the runs.
    pub mean: f64,
    /// Standard deviation of the runs' values.
    pub between: f64,
    /// Root of the mean square of the standard errors from within the runs.
    pub within: f64,
    /// Probability of such a spread of this quantity by chance, if nothing changed between runs.
    pub by_chance: f64,
    /// Standard uncertainty of the mean by statistics (type A), over one degree of freedom less than runs.
    pub type_a: f64,
    /// That of what all runs have in common (type B): the calibration, priors, and what the lobe that the samples show has of another shape than the model's.
    pub type_b: f64,
    /// Combined standard uncertainty.
    pub combined: f64,
    /// Its effective degrees of freedom (Welch and Satterthwaite).
    pub degrees_of_freedom: f64,
    /// Coverage factor for [`LEVEL`]: Student's t.
    pub coverage: f64,
    /// Expanded uncertainty.
    pub expanded: f64,
    /// The run that stands apart from the others, by Grubbs's test; never one of two.
    pub apart: Option<usize>,
    /// Quantities of the budget, for all of which the level of the tests holds together.
    pub quantities: usize,
}

/// What one run gives, and how well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Told {
    /// The value with the standard error from within the run.
    pub value: Value,
    /// The degrees of freedom of that error: fewer than samples where residuals are correlated.
    pub degrees_of_freedom: f64,
}

impl Budget {
    /// Is the spread of the runs more than their own errors explain?
    pub fn differs(&self) -> bool {
        self.by_chance < UNLIKELY / self.quantities as f64
    }
}

/// Over two runs or more, as they were read and fitted; `calibration` is the relative standard uncertainty of a factor that all runs have in common, and which `fits` do not count.
pub fn quantities(measurements: &[Measurement], fits: &[FittedScan], calibration: f64) -> Vec<Quantity> {
    let runs: Vec<(&Measurement, &FittedScan)> = measurements.iter().zip(fits).collect();
    let displaced: Vec<Displaced> = threads::map(&runs, &|(measurement, fit)| Displaced::of(measurement, fit));
    let open: Vec<Vec<&str>> = fits.iter().map(open).collect();
    let Some(first) = fits.first() else { return Vec::new() };
    let model = first.outcome.model;
    let parameters = first.options.free().map(|place| {
        let parameter = &model.parameters[place];
        let moved: Vec<Vec<f64>> = displaced.iter().map(|run| run.parameter(place)).collect();
        let value = |((fit, open), moved): ((&FittedScan, &Vec<&str>), &Vec<f64>)| {
            let known = &fit.outcome.uncertainty;
            let inside = known.places[place] == Some(Place::Inside) && !open.contains(&parameter.name);
            inside.then(|| Value {
                value: fit.outcome.params[place],
                stderr: priors::without(known.stderr[place], moved),
            })
        };
        let common = Common {
            relative: if parameter.is_weight() { calibration } else { 0.0 },
            absolute: priors::of_mean(&moved),
        };
        let runs = fits.iter().zip(&open).zip(&moved).map(value).collect();
        Seen {
            name: parameter.name,
            unit: parameter.unit,
            theta_i: None,
            runs,
            common,
        }
    });
    let mut seen: Vec<Seen> = parameters.collect();
    seen.extend(derived(fits, &displaced, calibration));
    let count = seen.len();
    seen.into_iter().map(|one| quantity(fits, one, count)).collect()
}

/// Parameters that a run does not determine.
fn open(fit: &FittedScan) -> Vec<&'static str> {
    let all = undetermined(&fit.outcome.material(), &fit.outcome.uncertainty, &fit.derived);
    all.into_iter().flat_map(|what| what.parameters).collect()
}

/// What is derived at the angles of incidence that all runs have.
fn derived(fits: &[FittedScan], displaced: &[Displaced], calibration: f64) -> Vec<Seen> {
    // With what of the error is the model's, the same in all runs.
    type Of = fn(&Derived) -> Option<(Value, f64)>;
    let kinds: [(&str, &'static str, Of, f64); 5] = [
        ("rho_s F", "", |at| Some((at.rho_s_f?, 0.0)), calibration),
        ("rho_v F", "", |at| Some((at.rho_v_f?, 0.0)), calibration),
        (
            "peak",
            "1/sr",
            |at| at.peak.map(|peak| peak.of_model(peak.f, |read| Some(read.f))),
            calibration,
        ),
        (
            "width",
            "deg",
            |at| {
                at.peak
                    .and_then(|peak| Some(peak.of_model(peak.width?, |read| read.width)))
            },
            0.0,
        ),
        ("reflectance", "", |at| Some((at.reflectance, 0.0)), calibration),
    ];
    let mut all = Vec::new();
    for at in &fits[0].derived {
        let same = |other: &&Derived| (other.theta_i - at.theta_i).abs() < 0.01f64.to_radians();
        let everywhere: Option<Vec<&Derived>> = fits.iter().map(|fit| fit.derived.iter().find(same)).collect();
        let Some(everywhere) = everywhere else { continue };
        for (name, unit, of, scaled) in kinds {
            let in_unit = |of_angle: f64| if unit == "deg" { of_angle.to_degrees() } else { of_angle };
            let moves = |run: &Displaced| run.derived(at.theta_i, |at| Some(in_unit(of(at)?.0.value)));
            let moved: Vec<Vec<f64>> = displaced.iter().map(moves).collect();
            let value = |(at, moved): (&&Derived, &Vec<f64>)| {
                let (value, of_model) = of(at)?;
                let told = value.stderr.is_finite() && value.stderr < value.value;
                let statistical = (value.stderr * value.stderr - of_model * of_model).max(0.0).sqrt();
                let statistical = Value {
                    value: in_unit(value.value),
                    stderr: priors::without(in_unit(statistical), moved),
                };
                told.then_some((statistical, in_unit(of_model)))
            };
            let told: Vec<Option<(Value, f64)>> = everywhere.iter().zip(&moved).map(value).collect();
            let of_model: Vec<f64> = told.iter().flatten().map(|told| told.1).collect();
            if !of_model.is_empty() {
                let theta_i = (at.theta_i.to_degrees() * 1e9).round() / 1e9;
                let common = Common {
                    relative: scaled,
                    absolute: libm::hypot(
                        of_model.iter().sum::<f64>() / of_model.len() as f64,
                        priors::of_mean(&moved),
                    ),
                };
                let runs = told.into_iter().map(|told| Some(told?.0)).collect();
                all.push(Seen {
                    name,
                    unit,
                    theta_i: Some(theta_i),
                    runs,
                    common,
                });
            }
        }
    }
    all
}

/// What the runs tell of one quantity.
struct Seen {
    name: &'static str,
    unit: &'static str,
    theta_i: Option<f64>,
    runs: Vec<Option<Value>>,
    common: Common,
}

/// One of so many in the budget.
fn quantity(fits: &[FittedScan], seen: Seen, quantities: usize) -> Quantity {
    let Seen {
        name,
        unit,
        theta_i,
        runs,
        common,
    } = seen;
    let told = runs.iter().zip(fits).map(|(run, fit)| {
        Some(Told {
            value: (*run)?,
            degrees_of_freedom: fit.outcome.uncertainty.effective,
        })
    });
    let told: Vec<Option<Told>> = told.collect();
    let all: Option<Vec<Told>> = told.iter().copied().collect();
    Quantity {
        budget: all.and_then(|values| budget(&values, common, quantities)),
        disagree: disagreeing(&told, quantities),
        name: name.into(),
        unit,
        theta_i,
        runs,
    }
}

/// The runs that do not agree with most others; all of two that do not agree with each other.
///
/// Two runs agree if their difference is within the root of the sum of their squared expanded errors (E_n of ISO 13528 at most 1), of 95 % for all pairs of runs and all of so many quantities together.
/// The runs that most others agree with are kept, one by one, as long as they agree with those kept.
pub fn disagreeing(runs: &[Option<Told>], quantities: usize) -> Vec<usize> {
    let told: Vec<(usize, Told)> = (0..runs.len())
        .filter_map(|place| Some((place, runs[place]?)))
        .collect();
    let tests = 0.5 * told.len() as f64 * (told.len() as f64 - 1.0) * quantities as f64;
    let expanded = |run: &Told| student(1.0 - UNLIKELY / tests, run.degrees_of_freedom) * run.value.stderr;
    let agree = |a: &Told, b: &Told| {
        let away = (a.value.value - b.value.value).abs();
        !(away > libm::hypot(expanded(a), expanded(b)))
    };
    let friends = |run: &(usize, Told)| told.iter().filter(|other| agree(&run.1, &other.1)).count();
    let mut order: Vec<(usize, Told)> = told.clone();
    order.sort_by_key(|run| std::cmp::Reverse(friends(run)));
    let mut kept: Vec<Told> = Vec::new();
    let mut apart = Vec::new();
    for (place, run) in order {
        if kept.iter().all(|other| agree(&run, other)) {
            kept.push(run);
        } else {
            apart.push(place);
        }
    }
    // Nobody knows which of two is right.
    if kept.len() == 1 && !apart.is_empty() {
        return told.into_iter().map(|(place, _)| place).collect();
    }
    apart.sort_unstable();
    apart
}

/// The standard uncertainty of what all runs have in common.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Common {
    /// Of a factor.
    pub relative: f64,
    /// Of a summand, in the quantity's unit.
    pub absolute: f64,
}

/// Of two values or more of one of so many quantities.
pub fn budget(told: &[Told], common: Common, quantities: usize) -> Option<Budget> {
    if told.len() < 2 {
        return None;
    }
    let values: Vec<Value> = told.iter().map(|run| run.value).collect();
    let values = &values[..];
    let degrees_within: f64 = told.iter().map(|run| run.degrees_of_freedom.min(MANY)).sum();
    let count = values.len() as f64;
    let mean = values.iter().map(|value| value.value).sum::<f64>() / count;
    let squares = values.iter().map(|value| (value.value - mean) * (value.value - mean));
    let between = (squares.sum::<f64>() / (count - 1.0)).sqrt();
    let within = (values.iter().map(|value| value.stderr * value.stderr).sum::<f64>() / count).sqrt();
    let ratio = (between / within) * (between / within);
    let type_a = between / count.sqrt();
    let type_b = libm::hypot(common.relative * mean, common.absolute);
    let combined = (type_a * type_a + type_b * type_b).sqrt();
    let part = combined / type_a;
    let degrees_of_freedom = (count - 1.0) * part * part * part * part;
    let coverage = student(LEVEL, degrees_of_freedom);
    Some(Budget {
        mean,
        between,
        within,
        by_chance: if ratio.is_finite() {
            above_f(ratio, count - 1.0, degrees_within.max(1.0)).unwrap_or(1.0)
        } else {
            0.0
        },
        type_a,
        type_b,
        combined,
        degrees_of_freedom,
        coverage,
        expanded: coverage * combined,
        apart: grubbs(values, mean, between, quantities),
        quantities,
    })
}

/// The run that is farthest from the mean, if it is farther than one of as many normal ones is in 95 % of cases for all of so many quantities together (Grubbs 1969; ISO 5725-2).
fn grubbs(values: &[Value], mean: f64, deviation: f64, quantities: usize) -> Option<usize> {
    let count = values.len() as f64;
    if values.len() < 3 {
        return None;
    }
    let away = |place: &usize| (values[*place].value - mean).abs();
    let farthest = (0..values.len()).max_by(|a, b| away(a).total_cmp(&away(b)))?;
    let t = student(1.0 - UNLIKELY / (count * quantities as f64), count - 2.0);
    let limit = (count - 1.0) / count.sqrt() * (t * t / (count - 2.0 + t * t)).sqrt();
    (away(&farthest) > limit * deviation).then_some(farthest)
}

/// [`within_t`], whose t is normal in all its digits that are printed from a million degrees of freedom on.
fn student(level: f64, degrees_of_freedom: f64) -> f64 {
    within_t(level, degrees_of_freedom.min(MANY))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(list: &[f64], stderr: f64) -> Vec<Told> {
        let one = |&value| Told {
            value: Value { value, stderr },
            degrees_of_freedom: 100.0,
        };
        list.iter().map(one).collect()
    }

    #[test]
    fn runs_that_do_not_agree_are_those_beyond_their_expanded_errors() {
        let of = |list: &[f64], stderr: f64| {
            let told: Vec<Option<Told>> = values(list, stderr).into_iter().map(Some).collect();
            disagreeing(&told, 1)
        };
        // t of 100 degrees of freedom is 1.984 for a pair, and 2.43 of three.
        let edge = 1.984 * f64::sqrt(2.0) * 0.01;
        assert!(of(&[1.0, 1.0 + 0.99 * edge], 0.01).is_empty());
        assert_eq!(of(&[1.0, 1.0 + 1.01 * edge], 0.01), [0, 1]);
        assert_eq!(of(&[1.0, 1.2, 1.001], 0.01), [1]);
        assert_eq!(of(&[1.0, 1.2, 1.001, 1.4, 1.002], 0.01), [1, 3]);
        // None of three that all differ is right.
        assert_eq!(of(&[1.0, 1.2, 1.4], 0.01), [0, 1, 2]);
        // A run that tells nothing is not asked, and one degree of freedom says little.
        let mut told: Vec<Option<Told>> = values(&[1.0, 1.0, 1.05], 0.01).into_iter().map(Some).collect();
        told[0] = None;
        assert_eq!(disagreeing(&told, 1), [1, 2]);
        told.iter_mut().flatten().for_each(|run| run.degrees_of_freedom = 1.0);
        assert!(disagreeing(&told, 1).is_empty());
    }

    #[test]
    fn a_budget_is_that_of_the_guide() {
        // Four runs, and a calibration known to 1 %.
        let all = values(&[10.0, 10.2, 9.9, 10.1], 0.02);
        let calibration = Common {
            relative: 0.01,
            absolute: 0.0,
        };
        let found = budget(&all, calibration, 1).unwrap();
        let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-4, "{a} {b}");
        close(found.mean, 10.05);
        close(found.between, 0.129_099);
        close(found.type_a, 0.064_550);
        close(found.type_b, 0.1005);
        close(found.combined, 0.119_443);
        // (u_c / u_a)^4 times 3; t of 35.17 degrees of freedom.
        close(found.degrees_of_freedom, 35.173);
        close(found.coverage, 2.029_8);
        assert!(found.differs() && found.apart.is_none());
        // What the model has of another shape adds to it.
        let both = Common {
            absolute: 0.2,
            ..calibration
        };
        close(budget(&all, both, 1).unwrap().type_b, 0.223_832);
        // Without a calibration t has one degree of freedom less than there are runs.
        close(budget(&all, Common::default(), 1).unwrap().coverage, 3.182_4);
        close(budget(&all[..2], Common::default(), 1).unwrap().coverage, 12.706_2);
        assert_eq!(budget(&all[..1], Common::default(), 1), None);
    }

    #[test]
    fn one_run_of_many_can_stand_apart() {
        // Grubbs's limit for six values is 1.887.
        let apart = |last: f64| {
            budget(
                &values(&[1.0, 1.01, 0.99, 1.02, 0.98, last], 0.01),
                Common::default(),
                1,
            )
            .unwrap()
        };
        assert_eq!(apart(1.2).apart, Some(5));
        assert_eq!(apart(1.03).apart, None);
        // Of two nobody knows which.
        assert_eq!(
            budget(&values(&[1.0, 2.0], 0.01), Common::default(), 1).unwrap().apart,
            None
        );
        // Of ten quantities together the limit is 1.990, by Student's t of 4 degrees of freedom at 0.05 / 60.
        let of_ten = |last: f64| {
            let all = values(&[1.0, 1.01, 0.99, 1.02, 0.98, last], 0.01);
            budget(&all, Common::default(), 10).unwrap()
        };
        assert_eq!((apart(1.1).apart, of_ten(1.1).apart), (Some(5), None));
        assert_eq!(of_ten(1.2).apart, Some(5));
        // A spread of 2 standard errors of four runs is of a chance of 0.8 %: seldom in one quantity, not in one of ten.
        let wide = values(&[1.0, 1.02, 0.98, 1.037], 0.0125);
        let differs = |quantities| budget(&wide, Common::default(), quantities).unwrap().differs();
        assert!(differs(1) && !differs(10));
        assert!(
            !budget(&values(&[1.0, 1.01], 0.01), Common::default(), 1)
                .unwrap()
                .differs()
        );
    }
}
