//! The model, and the set of its terms, that a scan supports: the least BIC of several candidates.

use std::collections::BTreeSet;

use brdfit_core::brdf::DIFFUSE;
use brdfit_core::geometry::Sample;

use super::criteria::{Criteria, counted};
use super::misfit::{self, Inflation};
use super::weighed;
use crate::engine::robust::{self, Robust};
use crate::engine::threads;
use crate::engine::{self, FitError, FitOptions, Model, Outcome, TERM_SETS, Until, Values};
use crate::error::Error;
use crate::input::Measurement;
use crate::input::about::Counts;

/// The compiled sets with a diffuse term, in order of size, each with the one that it is tested against.
pub const SETS: [(u8, Option<u8>); 5] = {
    let mut sets = [(0, None); 5];
    let (mut found, mut k) = (0, 0);
    while k < TERM_SETS.len() {
        if TERM_SETS[k] & DIFFUSE != 0 {
            sets[found] = (TERM_SETS[k], tested_against(TERM_SETS[k]));
            found += 1;
        }
        k += 1;
    }
    assert!(found == sets.len());
    sets
};

/// The set without the last term of a set, if it has a diffuse one.
const fn tested_against(terms: u8) -> Option<u8> {
    let set = terms & !(1 << terms.ilog2());
    if set & DIFFUSE != 0 { Some(set) } else { None }
}

/// What a scan is to be fitted with.
#[allow(clippy::large_enum_variant, reason = "there is one of it a command")]
#[derive(Clone, Debug, PartialEq)]
pub enum Wanted {
    /// One model.
    One(FitOptions),
    /// The best of these, at least one, which differ in model, terms and bounds alone.
    Best(Vec<FitOptions>),
}

/// Refuses an offset of theta_s where that counts from one side in some rows and from the other in the rest: an axis that is off in one sense is off in the other sense there.
///
/// # Errors
/// An offset is wanted of such a scan.
pub fn refuse_two_senses(measurement: &Measurement, wanted: &Wanted) -> Result<(), Error> {
    let offset = |options: &FitOptions| options.instrument.offsets.is_some();
    if measurement.about.counts != Counts::Both || !wanted.candidates().iter().any(offset) {
        return Ok(());
    }
    let what = "theta_s counts from the one side in some rows and from the other in the rest, as where theta_i has both signs: one offset cannot be both";
    Err(Error::new(what)
        .in_file(measurement.label())
        .help("fit each side alone with --fit-offset, or leave that out"))
}

impl Wanted {
    /// All that may be fitted.
    pub fn candidates(&self) -> &[FitOptions] {
        match self {
            Wanted::One(options) => std::slice::from_ref(options),
            Wanted::Best(list) => list,
        }
    }

    /// The models of the candidates, each once.
    pub fn models(&self) -> Vec<&'static Model> {
        models(self.candidates())
    }

    /// The same, given up when `until` says so.
    pub fn until(&self, until: Until) -> Wanted {
        let with = |options: &FitOptions| FitOptions { until, ..*options };
        match self {
            Wanted::One(options) => Wanted::One(with(options)),
            Wanted::Best(list) => Wanted::Best(list.iter().map(with).collect()),
        }
    }
}

/// The models of some candidates, each once.
fn models(candidates: &[FitOptions]) -> Vec<&'static Model> {
    let mut models: Vec<_> = candidates.iter().map(|options| options.model).collect();
    models.dedup();
    models
}

/// The same options with each set of terms that the model has and their bounds permit; one if it has none.
pub fn sets(options: &FitOptions) -> Vec<FitOptions> {
    let all = options.model.terms;
    if all == 0 {
        return vec![*options];
    }
    let sets = SETS.iter().filter(|&&(terms, _)| terms & !all == 0);
    let sets = sets.map(|&(terms, _)| FitOptions { terms, ..*options });
    sets.filter(allowed).collect()
}

/// The terms of these options that the fewest which the scan supports would leave out, for a fit of the same samples; 0 if none, or if that cannot be told.
pub fn left_out_by_auto(samples: &[Sample<f64>], options: &FitOptions) -> u8 {
    let mut within = sets(options);
    within.retain(|set| set.terms & !options.terms == 0);
    if within.len() < 2 {
        return 0;
    }
    choose(samples, &within).map_or(0, |choice| {
        options.terms & options.model.terms & !choice.chosen().options.terms
    })
}

/// Do the bounds and the priors permit what the terms leave out? A prior tells of a parameter, so that a fit without it would be judged by other residuals.
fn allowed(options: &FitOptions) -> bool {
    (0..options.lower.len()).all(|place| {
        let bound = options.model.absent(place) == 0.0 && options.lower[place] > 0.0;
        let told = bound || options.instrument.priors[place].is_some();
        !(options.model.left_out(options.terms, place) && told)
    })
}

/// One candidate, fitted.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Candidate {
    /// How it was fitted.
    pub options: FitOptions,
    /// Its fit.
    pub outcome: Outcome,
    /// What it is judged by.
    pub criteria: Criteria,
    /// Probability of at least this fall of the cost by chance, by the F test against the smaller set of [`SETS`]; `None` if that was not fitted or has as many parameters.
    pub p_value: Option<f64>,
}

/// How a fit was chosen: the least BIC of those with at least three samples more than parameters, or of all if none has.
///
/// AICc lets in a parameter that nothing needs in one case of six however many samples there are; BIC in one of forty with 170, and in fewer with more.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Choice {
    /// Every candidate that was fitted, in the order given; those with more parameters than samples are not.
    pub candidates: Vec<Candidate>,
    /// Place of the chosen one.
    pub place: usize,
    /// The correlation of residuals along the angle by which all are judged, that of the best fit; `None` where it is not seen.
    pub inflation: Option<Inflation>,
}

impl Choice {
    /// The chosen one.
    pub fn chosen(&self) -> &Candidate {
        &self.candidates[self.place]
    }

    /// The choice anew, with a better fit of the chosen candidate: those that contain it are fitted from there too, and another may be the choice now.
    ///
    /// # Errors
    /// [`FitError`].
    pub fn improved(&self, samples: &[Sample<f64>], better: &Outcome) -> Result<Self, FitError> {
        let list: Vec<FitOptions> = self.candidates.iter().map(|one| one.options).collect();
        let mut fitted = fit_each(samples, &list, Some(&(self.chosen().options, better.params)))?;
        if let Some((_, outcome)) = fitted.get_mut(self.place) {
            *outcome = Outcome {
                robust: None,
                ..better.clone()
            };
        }
        judged(samples, fitted)
    }

    /// The models of the candidates, each once.
    pub fn models(&self) -> Vec<&'static Model> {
        let options: Vec<_> = self.candidates.iter().map(|one| one.options).collect();
        models(&options)
    }

    /// Were sets of terms of this model compared?
    pub fn chose_terms(&self, model: &Model) -> bool {
        self.candidates.iter().filter(|one| one.options.model == model).count() > 1
    }

    /// The least of a number of the candidates; 0 if it is finite for none.
    pub fn least(&self, of: fn(&Candidate) -> f64) -> f64 {
        let finite = self.candidates.iter().map(of).filter(|number| number.is_finite());
        finite.min_by(f64::total_cmp).unwrap_or(0.0)
    }
}

/// A fit with what is wanted, or with what the scan supports of it; with the options of that fit, and why.
///
/// # Errors
/// [`FitError`]; of several candidates that of the one with the fewest parameters, if none can be fitted.
pub fn fit(samples: &[Sample<f64>], wanted: &Wanted) -> Result<(FitOptions, Outcome, Option<Choice>), FitError> {
    match wanted {
        Wanted::One(options) => {
            let outcome = weighed::fit(samples, options, engine::fit(samples, options)?)?;
            Ok((*options, outcome, None))
        }
        Wanted::Best(list) => {
            let (samples, robust) = without_outliers(samples, list)?;
            let choice = choose(&samples, list)?;
            let Candidate { options, outcome, .. } = choice.chosen();
            let (mut options, mut outcome) = (*options, outcome.clone());
            (options.robust, outcome.robust) = (robust.is_some(), robust);
            Ok((options, outcome, Some(choice)))
        }
    }
}

/// The samples that every candidate is judged by: if outliers are left out, those kept by the richest set of the model whose robust scale is the least.
fn without_outliers(
    samples: &[Sample<f64>],
    list: &[FitOptions],
) -> Result<(Vec<Sample<f64>>, Option<Robust>), FitError> {
    let by_model = list.chunk_by(|a, b| a.model == b.model);
    let richest = by_model.filter_map(|sets| sets.last().filter(|options| options.robust));
    let richest: Vec<FitOptions> = richest.copied().collect();
    if richest.is_empty() {
        return Ok((samples.to_vec(), None));
    }
    let fitted = fit_each(samples, &richest, None)?;
    let scale = |outcome: &Outcome| outcome.robust.as_ref().map_or(f64::INFINITY, |robust| robust.scale);
    let best = fitted.iter().min_by(|(_, a), (_, b)| scale(a).total_cmp(&scale(b)));
    Ok(best.map_or((samples.to_vec(), None), |(_, best)| {
        (robust::kept(samples, best), best.robust.clone())
    }))
}

/// Fits every candidate that has no more parameters than there are samples.
///
/// Those with more parameters begin where those with fewer ended: one that contains another never ends above it.
/// Those that contain a fit that is known begin there too.
fn fit_each(
    samples: &[Sample<f64>],
    list: &[FitOptions],
    known: Option<&(FitOptions, Values)>,
) -> Result<Vec<(FitOptions, Outcome)>, FitError> {
    let size = |options: &FitOptions| options.free().count();
    let sizes: BTreeSet<usize> = list.iter().map(size).collect();
    let mut fitted: Vec<(usize, FitOptions, Outcome)> = Vec::new();
    let mut fewest = None;
    for one in sizes {
        let stage: Vec<(usize, &FitOptions)> = list
            .iter()
            .enumerate()
            .filter(|(_, options)| size(options) == one)
            .collect();
        let fit = |(place, options): &(usize, &FitOptions)| {
            let smaller = fitted.iter().map(|(_, _, smaller)| (smaller.model, &smaller.params));
            let within = known.filter(|(known, _)| known.model == options.model && known.terms & !options.terms == 0);
            let starts = smaller.chain(within.map(|(known, values)| (known.model, values)));
            let known: Vec<Values> = starts
                .map(|(model, values)| options.model.translated(model, values))
                .collect();
            let outcome = weighed::fit(samples, options, engine::fit_from(samples, options, &known)?)?;
            Ok((*place, **options, outcome))
        };
        for fit in threads::map(&stage, &fit) {
            match fit {
                Ok(fit) => fitted.push(fit),
                // The sizes ascend, so the first is that of the fewest parameters.
                Err(error @ FitError::TooFew(..)) => fewest = fewest.or(Some(error)),
                Err(error) => return Err(error),
            }
        }
    }
    fitted.sort_by_key(|(place, ..)| *place);
    match fewest {
        Some(error) if fitted.is_empty() => Err(error),
        _ => Ok(fitted
            .into_iter()
            .map(|(_, options, outcome)| (options, outcome))
            .collect()),
    }
}

/// Fits every candidate to the same samples, and judges them; outliers are not looked for.
///
/// # Errors
/// [`FitError`]; that of the candidate with the fewest parameters if samples suffice for none.
///
/// ```
/// use brdfit::analysis::choose::choose;
/// use brdfit::engine::{FitOptions, Model};
/// use brdfit::input::{ReadOptions, parse};
///
/// let table = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/testdata3_sym_seed1.csv"));
/// let scan = &parse("paint.csv", table, &ReadOptions::default())?[0];
/// let models = ["beckmann", "ggx"].into_iter().filter_map(Model::find);
/// let choice = choose(&scan.samples, &models.map(FitOptions::of).collect::<Vec<_>>())?;
/// assert_eq!(choice.chosen().options.model.name, "beckmann");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn choose(samples: &[Sample<f64>], list: &[FitOptions]) -> Result<Choice, FitError> {
    let plain = |options: &FitOptions| FitOptions {
        robust: false,
        ..*options
    };
    let list: Vec<FitOptions> = list.iter().map(plain).collect();
    judged(samples, fit_each(samples, &list, None)?)
}

/// The choice among fits of the same samples.
fn judged(samples: &[Sample<f64>], fitted: Vec<(FitOptions, Outcome)>) -> Result<Choice, FitError> {
    let mut candidates: Vec<Candidate> = Vec::new();
    let outcomes: Vec<&Outcome> = fitted.iter().map(|(_, outcome)| outcome).collect();
    let inflation = misfit::inflation_of_best(samples, &outcomes);
    let count = counted(samples);
    for (options, outcome) in fitted {
        let free = options.free().count();
        let criteria = Criteria::new(count, inflation, free, outcome.cost, options.precision);
        let tested = SETS.iter().find(|(terms, _)| *terms == options.terms);
        let smaller = candidates.iter().find(|other| {
            other.options.model == options.model && tested.is_some_and(|(_, set)| *set == Some(other.options.terms))
        });
        let p_value = smaller.and_then(|smaller| criteria.p_value(&smaller.criteria));
        candidates.push(Candidate {
            options,
            outcome,
            criteria,
            p_value,
        });
    }
    let criteria = |place: &usize| candidates[*place].criteria;
    let place = (0..candidates.len()).min_by(|a, b| criteria(a).order(&criteria(b)));
    let place = place.ok_or(FitError::Terms(0))?;
    Ok(Choice {
        candidates,
        place,
        inflation,
    })
}

#[cfg(test)]
mod tests {
    use brdfit_core::brdf::{ABSORBING, ALL, SURFACE, VOLUME};

    use super::*;

    #[test]
    fn each_set_is_tested_against_that_without_its_last_term() {
        const METAL: u8 = DIFFUSE | SURFACE | ABSORBING;
        let sets = [
            (DIFFUSE, None),
            (DIFFUSE | SURFACE, Some(DIFFUSE)),
            (METAL, Some(DIFFUSE | SURFACE)),
            (DIFFUSE | SURFACE | VOLUME, Some(DIFFUSE | SURFACE)),
            (ALL, Some(DIFFUSE | SURFACE | VOLUME)),
        ];
        assert_eq!(SETS, sets);
    }

    #[test]
    fn no_set_is_chosen_that_any_samples_would_fit() {
        let sample = |k: u32| Sample::in_plane(0.3, 0.2 * f64::from(k), 0.1 + 0.002 * f64::from(k * k % 3));
        let samples: Vec<Sample<f64>> = (0..4).map(sample).collect();
        let choice = choose(&samples, &sets(&FitOptions::default())).unwrap();
        assert!(choice.candidates.iter().any(|one| one.criteria.saturated));
        assert_eq!(choice.chosen().options.terms, DIFFUSE);
        assert!(choice.least(|one| one.criteria.aicc).is_finite());
    }
}
