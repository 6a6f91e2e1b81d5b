//! The fit of a scan, the profiles of its parameters, and copies of it.

use super::{Profile, Profiles, profiles};
use crate::analysis::bootstrap::bootstrap;
use crate::analysis::choose::{self, Choice, Wanted};
use crate::analysis::deviations::{self, Stated};
use crate::engine::{FitError, FitOptions, Outcome, Values, robust};
use crate::error::{Error, shown};
use crate::input::{self, About, Measurement};
use crate::terms::term_names;

/// What is asked beside the fit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Asked<'a> {
    /// Names of the parameters to profile; all that are free if there are none.
    pub parameters: &'a [String],
    /// Copies of the scan at each end of an interval, from which thresholds are taken in place of those of the F test; 0 for none.
    pub calibrate: u32,
    /// Copies of the scan with new noise, for percentiles; 0 for none.
    pub bootstrap: u32,
}

/// Profiles and copies of one scan.
#[derive(Clone, Debug, PartialEq)]
pub struct Findings {
    /// The scan's name.
    pub name: String,
    /// Its best fit.
    pub outcome: Outcome,
    /// Why that model and those terms, if the scan chose them.
    pub choice: Option<Choice>,
    /// The cost that the search had found, if a profile met a better fit.
    pub improved_from: Option<f64>,
    /// One for each parameter asked for.
    pub profiles: Vec<Profile>,
    /// The parameters of each copy; empty without bootstrap.
    pub copies: Vec<Values>,
    /// The number of copies at each end of an interval whose thresholds are measured; 0 for those of the F test.
    pub calibrated: u32,
    /// How the scan was fitted; the seed is that of the copies too.
    pub options: FitOptions,
    /// How it was read.
    pub about: About,
}

/// Fits a scan with what is wanted, and profiles its parameters.
///
/// # Errors
/// The scan cannot be fitted, or a name is not that of a free parameter.
///
/// ```
/// use brdfit::analysis::choose::Wanted;
/// use brdfit::analysis::profile::findings::{Asked, find};
/// use brdfit::engine::FitOptions;
/// use brdfit::input::{ReadOptions, parse};
///
/// let table = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/testdata3_sym_seed1.csv"));
/// let scan = &parse("paint.csv", table, &ReadOptions::default())?[0];
/// let asked = Asked { parameters: &["rho_d".into()], ..Asked::default() };
/// let found = find(scan, &Wanted::One(FitOptions::default()), &asked)?;
/// let [_, at_95_percent] = found.profiles[0].intervals;
/// assert!(at_95_percent.low.value < at_95_percent.high.value);
/// # Ok::<(), brdfit::error::Error>(())
/// ```
pub fn find(measurement: &Measurement, wanted: &Wanted, asked: &Asked) -> Result<Findings, Error> {
    choose::refuse_two_senses(measurement, wanted)?;
    let measurement = &deviations::settled(measurement.clone(), wanted);
    let (samples, stated) = (&measurement.samples, Stated::of(measurement));
    let found = || -> Result<_, FitError> {
        let (options, outcome, choice) = choose::fit(samples, wanted)?;
        let samples = &robust::kept(samples, &outcome)[..];
        let plain = options.settled(&outcome);
        let parameters = match parameters(asked.parameters, &plain) {
            Ok(parameters) => parameters,
            Err(error) => return Ok(Err(error)),
        };
        let found = profiles(samples, &plain, outcome, &parameters, asked.calibrate, stated)?;
        let mut known = found.outcome.clone();
        known.uncertainty = deviations::uncertainty(samples, &plain, &known, stated).0;
        let copies = bootstrap(samples, &plain, &known, asked.bootstrap)?;
        Ok(Ok((options, choice, found, copies)))
    };
    let (options, choice, found, copies) = found().map_err(|error| input::explain(measurement, error))??;
    let fail = |what: &str| Error::new(what).in_file(measurement.label());
    let Profiles {
        mut outcome,
        improved_from,
        list: profiles,
    } = found;
    outcome.uncertainty = deviations::uncertainty(&robust::kept(samples, &outcome), &options, &outcome, stated).0;
    if !outcome.cost.is_finite() {
        return Err(fail("no start gives a finite model").help("take less extreme --bounds or --precision f64"));
    }
    if outcome.uncertainty.degrees_of_freedom == 0 {
        return Err(
            fail("as many parameters as samples: every value may fit").help("measure more, or --fix parameters")
        );
    }
    Ok(Findings {
        name: measurement.label(),
        outcome,
        choice,
        improved_from,
        profiles,
        copies,
        calibrated: asked.calibrate,
        options,
        about: measurement.about.clone(),
    })
}

/// The places of the parameters asked for.
fn parameters(names: &[String], options: &FitOptions) -> Result<Vec<usize>, Error> {
    let name = |index: usize| options.model.parameters[index].name;
    let all: Vec<usize> = options.free().collect();
    let known = || all.iter().map(|&index| name(index)).collect::<Vec<_>>().join(", ");
    if names.is_empty() {
        return Ok(all);
    }
    let one = |asked: &String| {
        let index = all.iter().copied().find(|&index| name(index) == asked.trim());
        index.ok_or_else(|| {
            let of = match options.model.terms {
                0 => format!("model {}", options.model.name),
                _ => format!("terms {}", term_names(options.terms).join(",")),
            };
            Error::new(format!("'{}' is not a free parameter of the {of}", shown(asked)))
                .help(format!("the free parameters are {}", known()))
        })
    };
    names.iter().map(one).collect()
}
