//! `brdfit joint`: several scans of one material, of which chosen parameters are the same.

use std::ffi::OsString;
use std::path::PathBuf;

use brdfit_core::geometry::Sample;
use clap::{Args, ValueEnum};
use rayon::ThreadPool;
use serde_json::{Value, json};

use crate::analysis::choose::Wanted;
use crate::analysis::deviations::{self, Verdict};
use crate::analysis::fit::{FittedScan, Told, fit, fit_telling};
use crate::analysis::joint::weights::{self, By};
use crate::analysis::joint::{self, Candidate, Fits};
use crate::analysis::repeats::quantities;
use crate::document;
use crate::engine::joint::SCANS;
use crate::engine::threads;
use crate::engine::{FitOptions, Model, robust};
use crate::error::{Error, shown};
use crate::input::{self, Measurement, ReadOptions, left_out, measurement};
use crate::number::{four, two};
use crate::options::SearchArguments;
use crate::output::{OutputArguments, deliver};
use crate::page::{budget, provenance};
use crate::parameters::parameter;
use crate::result::json::provenance::provenance as of_input;
use crate::result::json::{ByName, Correlated};
use crate::result::{beside, repeats, words};
use crate::streams::Streams;
use crate::terms::term_names;

/// Fits several scans of one material together: wavelengths that share m, or repeats that share all but the weights
#[derive(Args, Debug)]
#[command(
    after_help = "With --repeats the scans are runs of one sample: each is fitted alone, and the budget of uncertainty over them is printed.\n\nExample:\n  brdfit joint red.csv green.csv blue.csv --share m\n  brdfit joint run1.csv run2.csv run3.csv --repeats --scale-uncertainty 3%\n  brdfit joint run1.csv run2.csv run3.csv --repeats --format html -o budget.html"
)]
pub struct Arguments {
    /// Two to eight scans (with --repeats more), as `brdfit fit` reads them; a file may hold several
    #[arg(value_name = "SCAN", required = true)]
    scans: Vec<PathBuf>,
    /// The parameters that are the same in all scans, with commas between [default: m]
    #[arg(long, value_name = "LIST")]
    share: Option<String>,
    #[command(flatten)]
    search: SearchArguments,
    #[command(flatten)]
    output: OutputArguments<JointFormat>,
    #[command(flatten)]
    read: ReadOptions,
}

/// The forms of a joint fit, and of the budget over repeats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum JointFormat {
    /// A page for people
    Text,
    /// JSON
    Json,
    /// With --repeats, a page for people and for print, as one HTML file
    Html,
}

fn no_page() -> Error {
    Error::new("--format html is the page of --repeats")
        .help("take text or json, or brdfit report for a page on each scan")
}

/// Runs the subcommand; `given` are all arguments of the program, which a page shows.
///
/// # Errors
/// An unknown parameter, too few or too many scans, a scan that cannot be read or fitted, or an output that cannot be written.
pub fn run(arguments: &Arguments, given: &[OsString], streams: &mut Streams) -> Result<(), Error> {
    if arguments.read.repeats {
        return run_repeats(arguments, given, streams);
    }
    if arguments.output.format == JointFormat::Html {
        return Err(no_page());
    }
    arguments.search.instrument.refuse_offset("joint")?;
    let wanted = arguments.search.wanted()?;
    let candidates = with_shared(&wanted, arguments.share.as_deref().unwrap_or("m"))?;
    let compared = |model: &&Model| candidates.iter().any(|(options, _)| options.model == *model);
    let absent = wanted.models().into_iter().filter(|model| !compared(model));
    let absent: Vec<&str> = absent.map(|model| model.name).collect();
    let target = arguments.output.target(&arguments.scans)?;
    let measurements = input::read(&arguments.scans, &arguments.read, streams.input)?;
    if !(2..=SCANS).contains(&measurements.len()) {
        return Err(
            Error::new(format!("{} scans cannot be fitted together", measurements.len()))
                .help(format!("give 2 to {SCANS} scans")),
        );
    }
    let pool = arguments.search.pool()?;
    let mut measurements = settled(measurements, &wanted, &pool);
    if arguments.search.robust {
        measurements = without_outliers(measurements, &wanted, &pool)?;
    }
    let (measurements, by) = weights::weighed(measurements);
    let samples: Vec<&[Sample<f64>]> = measurements.iter().map(|one| &one.samples[..]).collect();
    let fits = pool
        .install(|| joint::fit(&samples, &candidates, by.stated()))
        .map_err(|(place, error)| match measurements.get(place) {
            Some(measurement) => input::explain(measurement, error),
            None => Error::new(format!("all scans together: {error}")).help("share more parameters, or --fix some"),
        })?;
    let text = match arguments.output.format {
        JointFormat::Text => text(&fits, &measurements, by, &absent),
        JointFormat::Json => json(&fits, &measurements, by, &absent),
        JointFormat::Html => return Err(no_page()),
    };
    deliver(text.as_bytes(), target.as_ref(), streams.output)?;
    measurement::note(&measurements, streams.errors);
    Ok(())
}

/// Each scan with weights from its own fit, where its file gives standard deviations.
fn settled(measurements: Vec<Measurement>, wanted: &Wanted, pool: &ThreadPool) -> Vec<Measurement> {
    let one = |measurement| deviations::settled(measurement, wanted);
    pool.install(|| threads::into(measurements, &one))
}

/// Each scan without the outliers that the robust fit of it alone leaves out.
fn without_outliers(
    measurements: Vec<Measurement>,
    wanted: &Wanted,
    pool: &ThreadPool,
) -> Result<Vec<Measurement>, Error> {
    let one = |measurement: Measurement| {
        let alone = fit_telling(Told::Columns, &measurement, wanted)?;
        Ok(Measurement {
            samples: robust::kept(&measurement.samples, &alone.outcome),
            left_out: alone.left_out,
            ..measurement
        })
    };
    let alone = pool.install(|| threads::into(measurements, &one));
    alone.into_iter().collect()
}

/// The budget over runs of one sample.
fn run_repeats(arguments: &Arguments, given: &[OsString], streams: &mut Streams) -> Result<(), Error> {
    if arguments.share.is_some() {
        return Err(
            Error::new("--repeats fits each run alone, so that nothing is left to --share").help("keep one of them"),
        );
    }
    let Wanted::One(options) = arguments.search.wanted()? else {
        return Err(Error::new("--repeats compares fits of one model with the same terms")
            .help("name one --model and its --terms"));
    };
    let target = arguments.output.target(&arguments.scans)?;
    // Directions may repeat within a file too; formats that are not tables know no such option.
    let plain = ReadOptions {
        repeats: false,
        ..arguments.read.clone()
    };
    let measurements = input::read(&arguments.scans, &plain, streams.input)
        .or_else(|_| input::read(&arguments.scans, &arguments.read, streams.input))?;
    if measurements.len() < 2 {
        return Err(Error::new("one run has no repeats").help("give two or more"));
    }
    for (place, run) in measurements.iter().enumerate() {
        let same = |other: &Measurement| other.samples == run.samples;
        if let Some(before) = measurements[..place].iter().position(same) {
            let what = format!("run {} has the same samples as run {}", place + 1, before + 1);
            return Err(Error::new(what)
                .in_file(run.label())
                .help("give each run once: a copy tells nothing of what changes between runs"));
        }
    }
    // The calibration is the same for all runs, and enters once.
    let mut alone = options;
    alone.instrument.scale_uncertainty = 0.0;
    let alone = Wanted::One(alone);
    let pool = arguments.search.pool()?;
    let measurements = settled(measurements, &alone, &pool);
    let fits = pool.install(|| threads::map(&measurements, &|one| fit(one, &alone)));
    let fits: Vec<FittedScan> = fits.into_iter().collect::<Result<_, _>>()?;
    let calibration = options.instrument.scale_uncertainty;
    let found = repeats::Found {
        options: &options,
        measurements: &measurements,
        quantities: pool.install(|| quantities(&measurements, &fits, calibration)),
        fits: &fits,
        calibration,
    };
    let text = match arguments.output.format {
        JointFormat::Text => repeats::text(&found),
        JointFormat::Json => repeats::json(&found),
        JointFormat::Html => budget::page(&found, &provenance::command(given)),
    };
    deliver(text.as_bytes(), target.as_ref(), streams.output)?;
    measurement::note(&measurements, streams.errors);
    Ok(())
}

/// What is wanted of the models that have all the parameters to share, with the places of these.
fn with_shared(wanted: &Wanted, list: &str) -> Result<Vec<(FitOptions, Vec<bool>)>, Error> {
    let each = wanted.candidates().iter();
    let each = each.map(|options| shared(options.model, list).map(|shared| (*options, shared)));
    if let Wanted::One(options) = wanted {
        let all: Vec<_> = each.collect::<Result<_, _>>()?;
        let absent = all.iter().flat_map(|(_, shared)| {
            let places = (0..shared.len()).filter(|&place| shared[place]);
            places.filter(|&place| options.model.left_out(options.terms, place))
        });
        if let Some(place) = absent.min() {
            let (name, names) = (
                options.model.parameters[place].name,
                term_names(options.terms).join(","),
            );
            return Err(Error::new(format!(
                "{name} is not a parameter of the terms {names}, and cannot be shared"
            ))
            .help("--share another parameter, or take more --terms"));
        }
        return Ok(all);
    }
    let able: Vec<_> = each.filter_map(Result::ok).collect();
    if able.is_empty() {
        return Err(Error::new(format!(
            "no model of the list has all parameters of --share {}",
            shown(list)
        ))
        .help("share parameters of one model"));
    }
    Ok(able)
}

fn shared(model: &Model, list: &str) -> Result<Vec<bool>, Error> {
    let mut shared = vec![false; model.parameters.len()];
    for name in list.split(',') {
        shared[parameter(model, name)?] = true;
    }
    Ok(shared)
}

fn text(fits: &Fits, measurements: &[Measurement], by: By, absent: &[&str]) -> String {
    let Candidate {
        options, fitted, known, ..
    } = fits.best();
    let name = |k: usize| options.model.parameters[k].name;
    let present = |shared: bool| options.present().filter(move |&k| fitted.shared[k] == shared);
    let names: Vec<&str> = present(true).map(name).collect();
    let value = |scan: usize, k: usize| {
        let value = four(fitted.scans[scan][k]);
        match known.errors[scan][k] {
            Some(error) => format!("{value} ± {}", two(error)),
            None if known.open[scan][k] => format!("{value} ({})", words::NOT_DETERMINED),
            None => value,
        }
    };
    let mut lines = vec![format!(
        "{} scans, {} samples, {} parameters; shared: {}",
        measurements.len(),
        fitted.samples,
        fitted.parameters,
        names.join(", ")
    )];
    for k in present(true) {
        lines.push(format!("  {:<6} {}", name(k), value(0, k)));
    }
    for (scan, measurement) in measurements.iter().enumerate() {
        let own: Vec<_> = present(false)
            .map(|k| format!("{} {}", name(k), value(scan, k)))
            .collect();
        lines.push(format!("  {}: {}", measurement.label(), own.join(", ")));
        lines.extend(left_out::summary(&measurement.left_out).map(|summary| format!("    left out {summary}")));
    }
    let rms = |cost: f64| (cost / fitted.samples as f64).sqrt();
    lines.push(format!(
        "  rms ln residual {:.4} together, {:.4} with each scan on its own",
        rms(fitted.of_samples),
        rms(fitted.separate)
    ));
    lines.extend(counted(by, measurements.len()).map(|line| format!("  {line}")));
    let beside = beside::of_joint(options).into_iter();
    lines.extend(beside.map(|(about, what)| format!("  {about:<9}  {what}")));
    if let Some(chi2) = known.chi2 {
        let verdict = known.verdict.map_or_else(String::new, words::deviations);
        let degrees = fitted.degrees_of_freedom;
        lines.push(format!(
            "  chi^2 {} of {degrees} degrees of freedom{verdict}",
            four(chi2)
        ));
    }
    lines.push(match known.exact {
        true => format!("  {}", words::EXACT),
        false => "  ± is one standard error; none where a parameter is on a bound, or not determined.".to_string(),
    });
    if let Some(misfit) = &known.misfit {
        lines.push(format!("  {}", words::correlated(misfit)));
    }
    if fits.candidates.len() > 1 {
        lines.extend(table(fits));
    }
    if !absent.is_empty() {
        let names = absent.join(", ");
        lines.push(format!("  not compared, without a parameter of --share: {names}"));
    }
    lines.join("\n") + "\n"
}

/// By what the scans count, where files state standard deviations.
fn counted(by: By, scans: usize) -> Option<String> {
    match by {
        By::Alike => None,
        By::Deviations(_) => Some("scans count by the standard deviations of their files".into()),
        By::Some(stated) => Some(format!(
            "{stated} of {scans} scans have standard deviations, and the others none: all scans count alike, and errors are those of the residuals"
        )),
    }
}

/// What the best was chosen from.
fn table(fits: &Fits) -> Vec<String> {
    let least = |of: fn(&Candidate) -> f64| fits.candidates.iter().map(of).fold(f64::INFINITY, f64::min);
    let (aicc, bic) = (least(|one| one.criteria.aicc), least(|one| one.criteria.bic));
    let mut lines = vec!["  model                     P  rms ln f    AICc     BIC  terms".to_string()];
    lines.extend(fits.candidates.iter().enumerate().map(|(place, one)| {
        let mark = if place == fits.place { '*' } else { ' ' };
        let line = format!(
            "{mark} {:<22} {:>4}  {:>8.5} {:>7.1} {:>7.1}  {}",
            one.options.model.name,
            one.criteria.parameters,
            (one.fitted.of_samples / one.fitted.samples as f64).sqrt(),
            one.criteria.aicc - aicc,
            one.criteria.bic - bic,
            term_names(one.options.terms & one.options.model.terms).join(", "),
        );
        line.trim_end().to_string()
    }));
    lines.push("  AICc and BIC above their least; * has the least BIC.".to_string());
    lines.extend(
        fits.inflation
            .map(|inflation| format!("  {}", words::judged(&inflation))),
    );
    lines
}

/// The document; `absent` are models that could not be compared.
fn json(fits: &Fits, measurements: &[Measurement], by: By, absent: &[&str]) -> String {
    let best = fits.best();
    let (model, fitted, known) = (best.options.model, &best.fitted, &best.known);
    let open = |scan: usize, shared: bool| -> Vec<&str> {
        let places = (0..fitted.shared.len()).filter(|&k| fitted.shared[k] == shared && known.open[scan][k]);
        places.map(|k| model.parameters[k].name).collect()
    };
    let shared: Vec<&str> = (0..fitted.shared.len())
        .filter(|&k| fitted.shared[k])
        .map(|k| model.parameters[k].name)
        .collect();
    let scans: Vec<Value> = measurements
        .iter()
        .enumerate()
        .map(|(scan, measurement)| {
            json!({
                "scan": measurement.label(),
                "left_out": measurement.left_out,
                "parameters": ByName::new(model, |k| fitted.scans[scan][k]),
                "stderr": ByName::new(model, |k| known.errors[scan][k]),
                "undetermined": open(scan, false),
                "provenance": of_input(&measurement.about, Some(&best.options)),
            })
        })
        .collect();
    let candidate = |one: &Candidate| {
        json!({
            "model": one.options.model.name,
            "terms": term_names(one.options.terms & one.options.model.terms),
            "parameters": one.criteria.parameters,
            "cost": one.fitted.cost,
            "aicc": one.criteria.aicc,
            "bic": one.criteria.bic,
        })
    };
    let candidates: Vec<Value> = fits.candidates.iter().map(candidate).collect();
    let selection = (fits.candidates.len() > 1).then(|| json!({ "criterion": "bic", "candidates": candidates }));
    let value = json!({
        "model": model.name,
        "terms": term_names(best.options.terms & model.terms),
        "selection": selection,
        "not_compared": absent,
        "shared": shared,
        "samples": fitted.samples,
        "cost": fitted.cost,
        "cost_separate": fitted.separate,
        "correlated": known.misfit.as_ref().map(Correlated::from),
        "scans_count": match by {
            By::Deviations(_) => "by standard deviations",
            By::Alike | By::Some(_) => "alike",
        },
        "chi2": known.chi2,
        "degrees_of_freedom": fitted.degrees_of_freedom,
        "deviations": known.verdict.map(Verdict::name),
        "exact": known.exact,
        "undetermined": open(0, true),
        "scans": scans,
    });
    document::json(&value)
}
