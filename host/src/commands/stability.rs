//! `brdfit stability`: how much of the arithmetic's precision reaches the answer, and whether f32 is enough.

mod text;

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use crate::analysis::stability::assess::{Assessment, assess};
use crate::analysis::stability::built_in;
use crate::document::json;
use crate::engine::FitOptions;
use crate::error::Error;
use crate::input::{self, ReadOptions, measurement};
use crate::output::{Format, OutputArguments, deliver};
use crate::parameters::model;
use crate::result::json::provenance::{Provenance, provenance};
use crate::streams::Streams;
use crate::terms::terms_of;

/// Shows what rounding does to the fit of a scan, or to built-in stiff and extreme cases
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  brdfit stability paint.csv")]
pub struct Arguments {
    /// A scan, as `brdfit fit` reads it; - is standard input [default: the built-in cases]
    #[arg(value_name = "SCAN")]
    scan: Option<PathBuf>,
    /// The model, one of those that brdfit compare shows
    #[arg(long, value_name = "NAME", default_value = "beckmann", requires = "scan")]
    model: String,
    /// Terms of the model, of diffuse,surface,volume,absorbing
    #[arg(long, value_name = "LIST", default_value = "all", requires = "scan")]
    terms: String,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    read: ReadOptions,
}

/// The assessment of a scan, and where that is from.
#[derive(Serialize)]
struct Document<'a> {
    #[serde(flatten)]
    assessment: &'a Assessment,
    provenance: Provenance<'a>,
}

/// Runs the subcommand.
///
/// # Errors
/// The scan cannot be read or fitted, or the output not written.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    let target = arguments.output.target(arguments.scan.as_slice())?;
    let text = match &arguments.scan {
        None => {
            let cases = built_in();
            match arguments.output.format {
                Format::Text => text::write(&cases),
                Format::Json => json(&cases),
            }
        }
        Some(path) => {
            let measurement = input::read_one(path, &arguments.read, streams.input)?;
            let model = model(&arguments.model)?;
            let options = FitOptions {
                terms: terms_of(&[model], &arguments.terms)?,
                ..FitOptions::of(model)
            };
            let case = assess(&measurement.label(), &measurement.samples, &options)
                .map_err(|error| input::explain(&measurement, error))?;
            let provenance = provenance(&measurement.about, Some(&options));
            let text = match arguments.output.format {
                Format::Text => text::write(std::slice::from_ref(&case)) + &text::verdict(&case),
                Format::Json => json(&Document {
                    assessment: &case,
                    provenance,
                }),
            };
            measurement::note(std::slice::from_ref(&measurement), streams.errors);
            text
        }
    };
    deliver(text.as_bytes(), target.as_ref(), streams.output)
}
