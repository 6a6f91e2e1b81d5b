//! The proof that no parameters fit a scan better, or the better ones.

use std::time::Duration;

use brdfit_core::geometry::Sample;

use crate::engine::certify::{self, Certificate, Claim, certify};
use crate::engine::clock::Stopwatch;
use crate::engine::{self, FitError, FitOptions, Outcome, Until, Values, robust};
use crate::error::Error;

/// What was proved of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proof {
    /// What was to be proved: no cost below `1 - asked` of that of the fit.
    pub asked: f64,
    /// What was: no cost below `1 - eps` of that of the fit; 1 says nothing.
    pub eps: f64,
    /// Is the cost of the fit but rounding, so that nothing can be proved of what is below it?
    pub exact: bool,
    /// Whether that is what was asked for.
    pub complete: bool,
    /// Number of boxes that were bounded.
    pub boxes: u64,
    /// Did the proof find a better minimum than the search?
    pub better: bool,
    /// Time of the proof; none where every run is to give the same bits.
    pub elapsed: Option<Duration>,
}

impl Proof {
    /// The same, with what an earlier proof of other terms took.
    pub(super) fn after(self, earlier: &Proof) -> Self {
        Proof {
            boxes: self.boxes + earlier.boxes,
            better: self.better || earlier.better,
            elapsed: self.elapsed.zip(earlier.elapsed).map(|(a, b)| a + b),
            ..self
        }
    }

    /// The part that the least cost may be below that of the fit; none where next to nothing is proved.
    pub fn within(&self) -> Option<f64> {
        (self.eps < NOTHING || self.complete && !self.exact).then_some(self.eps)
    }
}

/// What is to be proved, what may end it, and who is told how far it is.
#[derive(Clone, Copy)]
pub struct Goal<'a> {
    /// No cost is to be below `1 - eps` of that of the fit; above 0, below 1.
    pub eps: f64,
    /// The most boxes; the result is the same in each run.
    pub boxes: u64,
    /// The longest time.
    pub limit: Option<Duration>,
    /// On the calling thread alone, as where many proofs run side by side.
    pub alone: bool,
    /// An interrupt.
    pub interrupted: &'a (dyn Fn() -> bool + Sync),
    /// Is told now and then.
    pub progress: &'a (dyn Fn(&Certificate) + Sync),
}

/// Refuses what has no proof, before anything is fitted.
///
/// # Errors
/// A model that is not Eq. 14, or more than the samples takes part in the fit.
pub fn provable(candidates: &[FitOptions]) -> Result<(), Error> {
    if candidates.iter().any(|options| !options.instrument.is_plain()) {
        return Err(
            Error::new("there is no proof of a fit with a prior, an offset, an aperture or a limit on energy")
                .help("leave these options out, or the proof"),
        );
    }
    match candidates.iter().find(|options| !options.model.is_paper()) {
        None => Ok(()),
        Some(options) => Err(Error::new(FitError::NoProof(options.model.name).to_string())
            .help(format!("only --model {} has one", engine::Model::paper().name))),
    }
}

/// Proves that no parameters within the bounds fit samples better than `outcome`, the fit of them with `options`; better ones that are found take its place.
///
/// # Errors
/// [`FitError::NoProof`] if the model is not Eq. 14.
pub fn of_outcome(
    samples: &[Sample<f64>],
    options: &FitOptions,
    outcome: Outcome,
    goal: &Goal,
) -> Result<(Outcome, Proof), FitError> {
    let samples = robust::kept(samples, &outcome);
    let options = FitOptions {
        robust: false,
        until: Until::default(),
        ..*options
    };
    let no_proof = FitError::NoProof(options.model.name);
    let begun = Stopwatch::start();
    let stop = || (goal.interrupted)() || goal.limit.is_some_and(|limit| begun.elapsed() >= limit);
    let claim = Claim {
        eps: goal.eps,
        boxes: goal.boxes,
        alone: goal.alone,
        stop: &stop,
        progress: goal.progress,
        watch: None,
    };
    let cost = |outcome: &Outcome| certify::cost(&samples, &options, &outcome.material().values);
    let best = outcome.material().eq_14().ok_or(no_proof)?;
    let found = certify(&samples, &options, &best, &claim)?;
    let elapsed = begun.elapsed();
    let mut outcome = outcome;
    // What the fit of another precision has left is not worth another search.
    if found.cost < cost(&outcome)?.0 * (1.0 - SAME) {
        let known = [Values::from(found.params.to_array()), outcome.params];
        outcome = Outcome {
            robust: outcome.robust,
            ..engine::fit_from(&samples, &options, &known)?
        };
    }
    let (above, rounding) = cost(&outcome)?;
    let eps = of_fit(&found, above, rounding);
    let proof = Proof {
        asked: goal.eps,
        eps,
        exact: rounding >= above,
        complete: found.complete && eps < goal.eps + SINGLE,
        boxes: found.boxes,
        better: found.better > 0,
        elapsed: Some(elapsed),
    };
    Ok((outcome, proof))
}

/// That no cost is below a hundredth of the fit's tells nothing.
pub const NOTHING: f64 = 0.99;

/// Costs that differ by less than this part are those of one minimum.
const SAME: f64 = 1e-9;

/// A fit in `f32` may leave so much more than the proof's own, and what is asked is proved of it.
const SINGLE: f64 = 1e-3;

/// Rounding below this part of the cost is not told.
const UNTOLD: f64 = 1e-6;

/// What is proved of a fit of this cost, which may be above the least that the proof knows, as in `f32`.
fn of_fit(found: &Certificate, cost: f64, rounding: f64) -> f64 {
    // Costs are proved but for rounding.
    let rounded = if rounding < UNTOLD * cost { 0.0 } else { rounding / cost };
    let eps = if found.cost >= cost - rounding {
        found.eps
    } else {
        1.0 - (1.0 - found.eps) * found.cost / cost
    };
    (eps + rounded).min(1.0)
}
