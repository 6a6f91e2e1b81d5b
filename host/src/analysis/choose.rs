//! The smallest set of terms that a scan supports.

use brdfit_core::brdf::DIFFUSE;
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use crate::engine::robust;
use crate::engine::{self, FitError, FitOptions, Outcome, Precision, TERM_SETS};

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

/// The first of the largest sets with a diffuse term that a set adds terms to.
const fn tested_against(terms: u8) -> Option<u8> {
    let (mut best, mut k) = (None, 0);
    while k < TERM_SETS.len() {
        let set = TERM_SETS[k];
        let larger = match best {
            None => true,
            Some(best) => set.count_ones() > u8::count_ones(best),
        };
        if set & DIFFUSE != 0 && set & terms == set && set != terms && larger {
            best = Some(set);
        }
        k += 1;
    }
    best
}

/// One set of terms, fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// The terms.
    pub terms: u8,
    /// Number of its free parameters.
    pub parameters: usize,
    /// Sum of squared residuals of ln f.
    pub cost: f64,
    /// Akaike's criterion with Hurvich and Tsai's correction; infinite with too few samples.
    pub aicc: f64,
    /// Schwarz's criterion.
    pub bic: f64,
    /// Probability of at least this fall of the cost by chance, by the F test against the smaller set of [`SETS`]; `None` if that was not fitted or has as many parameters.
    pub p_value: Option<f64>,
}

/// How the terms were chosen: the least BIC.
///
/// AICc lets in a parameter that nothing needs in one case of six however many samples there are; BIC in one of forty with 170, and in fewer with more.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Every set that was fitted, in the order of [`SETS`].
    pub candidates: Vec<Candidate>,
    /// The chosen set.
    pub terms: u8,
}

/// A fit with the terms that `options` ask for, or with those that the scan supports; with the options that name them, and why.
///
/// # Errors
/// [`FitError`].
pub fn fit(samples: &[Sample<f64>], options: &FitOptions) -> Result<(FitOptions, Outcome, Option<Choice>), FitError> {
    if !options.choose_terms {
        return Ok((*options, engine::fit(samples, options)?, None));
    }
    // Outliers are those of the richest model, so that every set is judged by the same samples.
    let (samples, robust) = if options.robust {
        let outcome = engine::fit(samples, options)?;
        (robust::kept(samples, &outcome), outcome.robust)
    } else {
        (samples.to_vec(), None)
    };
    let samples = &samples[..];
    let mut candidates: Vec<Candidate> = Vec::new();
    let mut best: Option<(FitOptions, Outcome, f64)> = None;
    for (terms, smaller) in SETS.into_iter().filter(|&(terms, _)| allowed(terms, options)) {
        let options = FitOptions {
            terms,
            robust: false,
            ..*options
        };
        let outcome = match engine::fit(samples, &options) {
            Ok(outcome) => outcome,
            // The smallest set tells what is wrong with the scan; a larger one that needs more samples is left out.
            Err(FitError::TooFew(..)) if best.is_some() => continue,
            Err(error) => return Err(error),
        };
        let smaller = candidates.iter().find(|other| Some(other.terms) == smaller).copied();
        let candidate = judge(samples, &options, &outcome, smaller);
        candidates.push(candidate);
        if best.as_ref().is_none_or(|(.., bic)| candidate.bic < *bic) {
            best = Some((options, outcome, candidate.bic));
        }
    }
    let (mut chosen, mut outcome, _) = best.ok_or(FitError::Terms(options.terms))?;
    (chosen.robust, outcome.robust) = (options.robust, robust);
    let choice = Choice {
        candidates,
        terms: chosen.terms,
    };
    Ok((chosen, outcome, Some(choice)))
}

/// Do the bounds permit what the set leaves out?
fn allowed(terms: u8, options: &FitOptions) -> bool {
    (0..options.lower.len()).all(|place| {
        let matters = options.model.absent(place) == 0.0;
        !(options.model.left_out(terms, place) && matters) || options.lower[place] <= 0.0
    })
}

/// What a fit is judged by, beside others of the same samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criteria {
    /// Number of its free parameters.
    pub parameters: usize,
    /// Samples of weight above 0.
    pub samples: f64,
    /// Akaike's criterion with Hurvich and Tsai's correction; infinite with too few samples.
    pub aicc: f64,
    /// Schwarz's criterion.
    pub bic: f64,
}

/// The criteria of a fit of this cost.
pub fn criteria(samples: &[Sample<f64>], options: &FitOptions, cost: f64) -> Criteria {
    let parameters = options.free().count();
    let samples = samples.iter().filter(|sample| sample.weight != 0.0).count() as f64;
    let cost = cost.max(rounding(samples, options));
    // The variance of the residuals is a parameter too.
    let k = parameters as f64 + 1.0;
    let deviance = samples * Real::ln(cost / samples);
    let room = samples - k - 1.0;
    Criteria {
        parameters,
        samples,
        aicc: if room > 0.0 {
            deviance + 2.0 * k + 2.0 * k * (k + 1.0) / room
        } else {
            f64::INFINITY
        },
        bic: deviance + k * Real::ln(samples),
    }
}

/// A cost below this is rounding, of which no criterion may make anything.
fn rounding(samples: f64, options: &FitOptions) -> f64 {
    let residual = match options.precision {
        Precision::F64 => 1e-10,
        Precision::F32 => 1e-5,
    };
    samples * residual * residual
}

fn judge(samples: &[Sample<f64>], options: &FitOptions, outcome: &Outcome, smaller: Option<Candidate>) -> Candidate {
    let criteria = criteria(samples, options, outcome.cost);
    let cost = outcome.cost.max(rounding(criteria.samples, options));
    let p_value = smaller
        .filter(|smaller| smaller.parameters < criteria.parameters)
        .and_then(|smaller| {
            let more = (criteria.parameters - smaller.parameters) as f64;
            let left = criteria.samples - criteria.parameters as f64;
            let f = (smaller.cost.max(cost) - cost) / more / (cost / left);
            FisherSnedecor::new(more, left).ok().map(|chance| chance.sf(f))
        });
    Candidate {
        terms: options.terms,
        parameters: criteria.parameters,
        cost: outcome.cost,
        aicc: criteria.aicc,
        bic: criteria.bic,
        p_value,
    }
}

#[cfg(test)]
mod tests {
    use brdfit_core::brdf::{ABSORBING, ALL, SURFACE, VOLUME};

    use super::*;

    #[test]
    fn each_set_is_tested_against_the_largest_within() {
        const METAL: u8 = DIFFUSE | SURFACE | ABSORBING;
        let sets = [
            (DIFFUSE, None),
            (DIFFUSE | SURFACE, Some(DIFFUSE)),
            (METAL, Some(DIFFUSE | SURFACE)),
            (DIFFUSE | SURFACE | VOLUME, Some(DIFFUSE | SURFACE)),
            (ALL, Some(METAL)),
        ];
        assert_eq!(SETS, sets);
    }
}
