//! `brdfit profile`: which values of a parameter a scan allows.

mod findings;
mod json;
mod text;

use std::path::PathBuf;

use clap::Args;

use crate::analysis::bootstrap::bootstrap;
use crate::analysis::choose;
use crate::analysis::deviations;
use crate::analysis::misfit;
use crate::analysis::profile::calibrate::LEVELS;
use crate::analysis::profile::{End, Profile, Profiles, profiles};
use crate::engine::{FitError, FitOptions, robust};
use crate::error::{Error, shown};
use crate::input::{self, ReadOptions, left_out};
use crate::options::SearchArguments;
use crate::output::{Format, OutputArguments, deliver};
use crate::plot::{self, picture};
use crate::streams::Streams;
use crate::terms::term_names;
use findings::Findings;

/// Shows which values of a parameter a scan allows: the cost over it, minimised over the others
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  brdfit profile paint.csv --parameter n --plot n.svg")]
pub struct Arguments {
    /// A scan, as `brdfit fit` reads it; - is standard input
    #[arg(value_name = "SCAN")]
    scan: PathBuf,
    /// Parameter to profile; repeatable [default: all that are not fixed]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    parameter: Vec<String>,
    /// Adds percentiles over N copies of the fitted scan with new noise
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(20..=1_000_000))]
    bootstrap: Option<u32>,
    /// Takes the thresholds of the intervals from N copies of the scan at each end, in place of the F test's
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(20..=1_000_000))]
    calibrate: Option<u32>,
    #[command(flatten)]
    search: SearchArguments,
    #[command(flatten)]
    output: OutputArguments,
    /// Draws the profiles, as SVG, or as PNG if brdfit is built with it
    #[arg(long, value_name = "FILE", value_parser = picture::name)]
    plot: Option<PathBuf>,
    #[command(flatten)]
    read: ReadOptions,
}

/// Runs the subcommand.
///
/// # Errors
/// The first thing that is wrong with options, file or scan.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    let wanted = arguments.search.wanted()?;
    if arguments.calibrate.is_some() {
        arguments.search.instrument.refuse_offset("profile --calibrate")?;
    }
    let inputs = std::slice::from_ref(&arguments.scan);
    let (target, picture) = arguments.output.targets(arguments.plot.as_deref(), inputs)?;
    let measurement = input::read_one(&arguments.scan, &arguments.read, streams.input)?;
    let pool = arguments.search.pool()?;
    let measurement = pool.install(|| deviations::settled(measurement, &wanted));
    let samples = &measurement.samples;
    let found = pool.install(|| -> Result<_, FitError> {
        let (options, outcome, choice) = choose::fit(samples, &wanted)?;
        let samples = &robust::kept(samples, &outcome)[..];
        let plain = options.settled(&outcome);
        let parameters = match parameters(&arguments.parameter, &plain) {
            Ok(parameters) => parameters,
            Err(error) => return Ok(Err(error)),
        };
        let calibrated = arguments.calibrate.unwrap_or(0);
        let found = profiles(samples, &plain, outcome, &parameters, calibrated)?;
        let copies = bootstrap(samples, &plain, &found.outcome, arguments.bootstrap.unwrap_or(0))?;
        Ok(Ok((options, choice, found, copies)))
    });
    let (options, choice, found, copies) = found.map_err(|error| input::explain(&measurement, error))??;
    let fail = |what: &str| Error::new(what).in_file(measurement.label());
    let Profiles {
        mut outcome,
        improved_from,
        list: profiles,
    } = found;
    outcome.uncertainty = misfit::uncertainty(&robust::kept(samples, &outcome), &outcome);
    if !outcome.cost.is_finite() {
        return Err(fail("no start gives a finite model").help("take less extreme --bounds or --precision f64"));
    }
    if outcome.uncertainty.degrees_of_freedom == 0 {
        return Err(
            fail("as many parameters as samples: every value may fit").help("measure more, or --fix parameters")
        );
    }
    let findings = Findings {
        name: measurement.label(),
        outcome,
        choice,
        improved_from,
        profiles,
        copies,
        calibrated: arguments.calibrate.unwrap_or(0),
        options,
        about: measurement.about.clone(),
    };
    let written = match arguments.output.format {
        Format::Text => text::write(&findings),
        Format::Json => json::write(&findings),
    };
    if let Some(picture) = &picture {
        picture::save(
            picture,
            &plot::profile_svg(&findings.name, &findings.profiles.iter().map(panel).collect::<Vec<_>>()),
        )?;
    }
    deliver(written.as_bytes(), target.as_ref(), streams.output)?;
    left_out::note(&[measurement], streams.errors);
    Ok(())
}

/// A profile as it is drawn.
fn panel(profile: &Profile) -> plot::ProfilePanel {
    let end = |end: End| (!end.at_bound).then_some(end.value);
    plot::ProfilePanel {
        name: profile.name,
        best: profile.best.value,
        points: profile
            .points
            .iter()
            .map(|point| (point.value, profile.rise(point)))
            .collect(),
        levels: [0, 1].map(|k| (LEVELS[k], profile.limits[k])),
        ends: profile
            .intervals
            .map(|interval| [end(interval.low), end(interval.high)]),
    }
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
