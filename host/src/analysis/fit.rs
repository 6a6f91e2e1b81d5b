//! The fit of one measured scan, with all that follows from it.

use std::borrow::Cow;
use std::time::Duration;

use brdfit_core::geometry::Sample;

use super::choose::{self, Choice, Wanted};
use super::derived::{self, Derived};
use super::deviations::{self, Stated, Verdict};
use super::hints::{self, Hint};
use super::proof::{Goal, Proof, of_outcome};
use super::{curved, range, unseen};
use crate::engine::clock::Stopwatch;
use crate::engine::threads;
use crate::engine::{self, FitError, FitOptions, Outcome, Values, View, robust};
use crate::error::Error;
use crate::input::{self, About, LeftOut, Measurement, ReadAs, left_out};
use crate::until::until;

/// Samples that a thread takes at least.
const SHARE: usize = 4096;

/// How much is told of a fitted scan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Told {
    /// All of it.
    All,
    /// What the columns of a table tell; [`FittedScan::derived`] is empty.
    Columns,
}

/// One fitted scan.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FittedScan {
    /// The scan's file.
    pub file: String,
    /// Which scan of the file it is, if that has a name.
    pub scan: Option<String>,
    /// What the numbers of the file were taken for.
    pub read_as: ReadAs,
    /// What the reader understood of the file.
    pub about: About,
    /// What was left out of the scan.
    pub left_out: Vec<LeftOut>,
    /// The part of each angle of incidence, in order of that angle.
    pub angles: Vec<AngleOfIncidence>,
    /// What was asked for.
    pub options: FitOptions,
    /// What came out.
    pub outcome: Outcome,
    /// Sum of squared residuals of ln f over their variances, if the file gives standard deviations; that of a right model is near the degrees of freedom.
    pub chi2: Option<f64>,
    /// What became of the standard deviations of the file, if it gives them.
    pub deviations: Option<Verdict>,
    /// Terms that the fewest which the scan supports would leave out of these, if that was asked; 0 for none.
    pub left_out_by_auto: u8,
    /// Why this model and these terms, if the scan chose them.
    pub choice: Option<Choice>,
    /// Directional-hemispherical reflectance at each angle of incidence in ascending order, dimensionless; above 1 the model makes energy, and none where the scan does not determine it.
    pub reflectances: Vec<Option<f64>>,
    /// What follows from it at each angle of incidence, if all is told.
    pub derived: Vec<Derived>,
    /// The cost that the search had found, if another fit then led lower.
    pub improved_from: Option<f64>,
    /// What was proved of it, if that was asked for.
    pub proof: Option<Proof>,
    /// What a person would say of it.
    pub hints: Vec<Hint>,
    /// Time of the search, without reading the file; none where every run is to give the same bits.
    pub elapsed: Option<Duration>,
    /// How much of all this was wanted.
    told: Told,
}

/// How well the samples of one angle of incidence are fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleOfIncidence {
    /// The angle in radians.
    pub theta_i: f64,
    /// Number of its samples.
    pub samples: usize,
    /// Root of the mean squared residual of ln f, dimensionless.
    pub rms_ln: f64,
}

impl AngleOfIncidence {
    /// The angle in degrees as it was measured, without what the way through radians adds.
    pub fn degrees(&self) -> f64 {
        rounded(self.theta_i.to_degrees())
    }
}

/// Degrees as they stand in files have few decimals.
fn rounded(degrees: f64) -> f64 {
    (degrees * 1e9).round() / 1e9
}

impl FittedScan {
    /// Puts together what the engine found.
    ///
    /// Lobes that no sample sees are left out, and the uncertainty accounts for the correlation of the residuals.
    pub fn new(measurement: &Measurement, options: &FitOptions, outcome: Outcome, elapsed: Duration) -> Self {
        FittedScan::telling(Told::All, measurement, options, outcome, elapsed)
    }

    fn telling(
        told: Told,
        measurement: &Measurement,
        options: &FitOptions,
        outcome: Outcome,
        elapsed: Duration,
    ) -> Self {
        let (samples, left_out) = without_outliers(measurement, &outcome);
        let (outcome, verdict) = known(measurement, &samples, options, outcome);
        // What nobody waits for any more is thrown away, and of a long scan it takes its time.
        let over = until().is_over();
        let samples = if over { Cow::Owned(Vec::new()) } else { samples };
        let derived = match told {
            Told::All => derived::at_each_angle(&samples, outcome.view(), &outcome.uncertainty),
            Told::Columns => Vec::new(),
        };
        let reflectances: Vec<derived::Value> = match told {
            Told::All => derived.iter().map(|at| at.reflectance).collect(),
            Told::Columns => derived::reflectances(&samples, &outcome.material(), &outcome.uncertainty),
        };
        let determined = reflectances
            .iter()
            .map(|&value| derived::determined(value, &outcome.uncertainty));
        let determined = determined.collect();
        let reflectances: Vec<f64> = reflectances.iter().map(|reflectance| reflectance.value).collect();
        FittedScan {
            file: measurement.file.clone(),
            scan: measurement.name.clone(),
            read_as: measurement.read_as,
            about: measurement.about.clone(),
            left_out,
            angles: by_angle(&samples, &outcome.view()),
            hints: match over {
                true => Vec::new(),
                false => hints::of_fit(measurement, options, &outcome, &reflectances),
            },
            reflectances: determined,
            derived,
            options: *options,
            chi2: measurement
                .sigma_ln
                .map(|sigma| (outcome.cost - outcome.prior_cost) / (sigma * sigma)),
            outcome,
            deviations: verdict,
            left_out_by_auto: 0,
            choice: None,
            improved_from: None,
            proof: None,
            elapsed: Some(elapsed),
            told,
        }
    }

    /// Leaves out all times, so that every run gives the same bits.
    pub fn forget_times(&mut self) {
        self.elapsed = None;
        if let Some(proof) = &mut self.proof {
            proof.elapsed = None;
        }
    }

    /// The fit of the same samples, less outliers, from values that are known to be better.
    ///
    /// # Errors
    /// [`FitError`].
    pub fn improved(self, measurement: &Measurement, kept: &[Sample<f64>], values: Values) -> Result<Self, FitError> {
        let options = self.options.settled(&self.outcome);
        let known = [values, self.outcome.params];
        let outcome = Outcome {
            robust: self.outcome.robust.clone(),
            ..engine::fit_from(kept, &options, &known)?
        };
        self.with(measurement, kept, outcome)
    }

    /// The same with a better fit of the same samples, less outliers: where the scan chose the terms, it chooses anew.
    ///
    /// # Errors
    /// [`FitError`].
    pub fn with(self, measurement: &Measurement, kept: &[Sample<f64>], outcome: Outcome) -> Result<Self, FitError> {
        let (mut options, mut outcome) = (self.options, outcome);
        let choice = self.choice.as_ref();
        let choice = choice.map(|choice| choice.improved(kept, &outcome)).transpose()?;
        if let Some(chosen) = choice.as_ref().map(Choice::chosen)
            && chosen.options.terms != options.terms
        {
            options = FitOptions {
                robust: options.robust,
                ..chosen.options
            };
            outcome = Outcome {
                robust: outcome.robust,
                ..chosen.outcome.clone()
            };
        }
        Ok(FittedScan {
            choice,
            improved_from: self.improved_from.or(Some(self.outcome.cost)),
            elapsed: self.elapsed,
            ..FittedScan::telling(
                self.told,
                measurement,
                &options,
                outcome,
                self.elapsed.unwrap_or_default(),
            )
        })
    }
}

/// What the engine found of the samples of a measurement, less outliers: without lobes that none of them sees, and with errors that account for the correlation of the residuals, or are those of the file's standard deviations, say no more than bounds and energy allow, and hold along valleys that are curved; what became of these.
pub fn known(
    measurement: &Measurement,
    samples: &[Sample<f64>],
    options: &FitOptions,
    outcome: Outcome,
) -> (Outcome, Option<Verdict>) {
    let mut outcome = unseen::settled(samples, options, outcome);
    let stated = Stated::of(measurement);
    let (uncertainty, verdict) = deviations::uncertainty(samples, options, &outcome, stated);
    outcome.uncertainty = uncertainty;
    let scale = match (stated, verdict) {
        (Some(stated), Some(Verdict::Used | Verdict::Absolute(_))) => stated.sigma,
        _ => outcome.uncertainty.scale,
    };
    let outcome = range::settled(samples, options, outcome);
    (curved::settled(samples, options, outcome, scale * scale), verdict)
}

/// Fits one scan with what is wanted.
///
/// # Errors
/// The scan has too few samples, or no start gives a finite model.
///
/// ```
/// use brdfit::analysis::choose::Wanted;
/// use brdfit::analysis::fit::fit;
/// use brdfit::engine::FitOptions;
/// use brdfit::input::{ReadOptions, parse};
/// use brdfit::result;
///
/// let table = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/testdata3_sym_seed1.csv"));
/// let scan = &parse("paint.csv", table, &ReadOptions::default())?[0];
/// let fitted = fit(scan, &Wanted::One(FitOptions::default()))?;
/// assert!(fitted.outcome.rms_ln < 0.07);
/// print!("{}", result::text(&[fitted], true));
/// # Ok::<(), brdfit::error::Error>(())
/// ```
pub fn fit(measurement: &Measurement, wanted: &Wanted) -> Result<FittedScan, Error> {
    fit_telling(Told::All, measurement, wanted)
}

/// The same with as much as is wanted: of a small scan all takes as long as the fit.
///
/// # Errors
/// As [`fit`].
pub fn fit_telling(told: Told, measurement: &Measurement, wanted: &Wanted) -> Result<FittedScan, Error> {
    choose::refuse_two_senses(measurement, wanted)?;
    let begun = Stopwatch::start();
    let found = choose::fit(&measurement.samples, wanted);
    let elapsed = begun.elapsed();
    match found {
        Ok((_, outcome, _)) if !outcome.cost.is_finite() => Err(Error::new("no start gives a finite model")
            .in_file(measurement.label())
            .help("take less extreme --bounds or --precision f64")),
        Ok((options, outcome, choice)) => Ok(FittedScan {
            choice,
            ..FittedScan::telling(told, measurement, &options, outcome, elapsed)
        }),
        Err(error) => Err(input::explain(measurement, error)),
    }
}

/// Model less measurement in ln f, times the weight, of every sample of a fitted measurement, as it was fitted ([`deviations::settled`]) and as the instrument sees the model; NaN beyond the horizon, and where nobody waits for them any more.
pub fn residuals(measurement: &Measurement, outcome: &Outcome) -> Vec<f64> {
    let (view, until) = (outcome.view(), until());
    let one = |sample: &Sample<f64>| match until.is_over() {
        true => f64::NAN,
        false => view.residual(sample).unwrap_or(f64::NAN),
    };
    shared(&measurement.samples, &one)
}

/// The samples that were fitted, and all that was left out.
fn without_outliers<'a>(measurement: &'a Measurement, outcome: &Outcome) -> (Cow<'a, [Sample<f64>]>, Vec<LeftOut>) {
    let (all, mut left_out) = (&measurement.samples, measurement.left_out.clone());
    let Some(robust) = &outcome.robust else {
        return (Cow::Borrowed(all), left_out);
    };
    let mut kept = vec![true; all.len()];
    let mut counts = left_out::Counts::default();
    for &outlier in robust.outliers.iter().rev() {
        kept[outlier] = false;
        counts.add(left_out::Reason::Outlier, rounded(all[outlier].theta_i.to_degrees()));
    }
    left_out.extend(counts.list());
    let kept = all.iter().zip(kept).filter(|(_, kept)| *kept);
    (kept.map(|(sample, _)| *sample).collect(), left_out)
}

/// What `one` makes of each item; threads share those of a long scan.
fn shared<T: Sync, S: Send + Sync + Clone>(items: &[T], one: &(dyn Fn(&T) -> S + Sync)) -> Vec<S> {
    let parts: Vec<&[T]> = items.chunks(SHARE).collect();
    threads::map(&parts, &|part| part.iter().map(one).collect::<Vec<S>>()).concat()
}

fn by_angle(samples: &[Sample<f64>], view: &View) -> Vec<AngleOfIncidence> {
    let mut order: Vec<&Sample<f64>> = samples.iter().collect();
    order.sort_by(|a, b| a.theta_i.total_cmp(&b.theta_i));
    let until = until();
    let square = |sample: &&Sample<f64>| {
        let residual = (!until.is_over()).then(|| view.residual(sample)).flatten()?;
        Some(residual * residual)
    };
    let squares = shared(&order, &square);
    let mut rest = &squares[..];
    let one = |group: &[&Sample<f64>]| {
        let (own, after) = rest.split_at(group.len());
        rest = after;
        AngleOfIncidence {
            theta_i: group[0].theta_i,
            samples: group.len(),
            rms_ln: (own.iter().flatten().sum::<f64>() / group.len() as f64).sqrt(),
        }
    };
    order.chunk_by(|a, b| a.theta_i == b.theta_i).map(one).collect()
}

/// Proves that no parameters within the bounds fit a scan better; better ones that are found take the place of the fit.
///
/// # Errors
/// The model is not Eq. 14.
///
/// ```
/// use brdfit::analysis::choose::Wanted;
/// use brdfit::analysis::fit::{fit, prove};
/// use brdfit::analysis::proof::Goal;
/// use brdfit::engine::FitOptions;
/// use brdfit::input::{ReadOptions, parse};
///
/// let table = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/testdata3_sym_seed1.csv"));
/// let scan = &parse("paint.csv", table, &ReadOptions::default())?[0];
/// let fitted = fit(scan, &Wanted::One(FitOptions::default()))?;
/// let goal = Goal { eps: 0.3, boxes: 100_000, limit: None, alone: false, interrupted: &|| false, progress: &|_| () };
/// let proved = prove(scan, fitted, &goal)?;
/// assert!(proved.proof.is_some_and(|proof| proof.complete && proof.eps == 0.3));
/// # Ok::<(), brdfit::error::Error>(())
/// ```
pub fn prove(measurement: &Measurement, fitted: FittedScan, goal: &Goal) -> Result<FittedScan, Error> {
    let explain = |error| input::explain(measurement, error);
    let mut fitted = fitted;
    let mut proved: Option<Proof> = None;
    loop {
        let (options, known) = (fitted.options, fitted.outcome.clone());
        let before = known.cost;
        let (outcome, proof) = of_outcome(&measurement.samples, &options, known, goal).map_err(explain)?;
        let proof = proved.map_or(proof, |earlier| proof.after(&earlier));
        if outcome.cost < before {
            let kept = robust::kept(&measurement.samples, &outcome);
            fitted = fitted.with(measurement, &kept, outcome).map_err(explain)?;
            // Of other terms nothing is proved yet.
            if fitted.options.terms != options.terms {
                proved = Some(proof);
                continue;
            }
        }
        fitted.proof = Some(proof);
        return Ok(fitted);
    }
}
