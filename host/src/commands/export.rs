//! `brdfit export`: a fitted model for the programs that use it, one file a form.

use std::path::PathBuf;

use clap::Args;

use crate::error::Error;
use crate::export::form::{Form, write};
use crate::export::model::Model;
use crate::input::{STDIN, bytes};
use crate::options::all_parameters;
use crate::output::{deliver, target};
use crate::parameters;
use crate::streams::Streams;

/// Writes a fitted model for other programs
#[derive(Args, Debug)]
#[command(
    after_help = "Example:\n  brdfit fit paint.csv --format json --output paint.json\n  brdfit export paint.json --to mitsuba --output paint.py\n  brdfit export --params rho_d=0.1,rho_s=10,rho_v=0,m=0.1,n=3,kappa=1 --to zemax --output paint.bsdf"
)]
pub struct Arguments {
    /// What `brdfit fit --format json` has written; - is standard input
    #[arg(
        value_name = "RESULT.json",
        required_unless_present = "params",
        conflicts_with = "params"
    )]
    result: Option<PathBuf>,
    /// All parameters of the model, in place of a result
    #[arg(long, value_name = "NAME=X,...")]
    params: Option<String>,
    /// The model of --params, one of those that brdfit compare shows
    #[arg(
        long = "model",
        value_name = "NAME",
        default_value = "beckmann",
        conflicts_with = "result"
    )]
    model: String,
    /// Which result, if there are several; the first is 1. Three are red, green and blue of one material
    #[arg(long, value_name = "N,...", requires = "result", value_delimiter = ',')]
    index: Vec<usize>,
    /// For which program
    #[arg(long, value_enum)]
    to: Form,
    /// Wavelength in nm, for openmaterial and rgl [default: that in the name of the scan]
    #[arg(long, value_name = "NM", value_parser = wavelength)]
    wavelength: Option<f64>,
    /// Name of the material [default: that of the scan's file]
    #[arg(long)]
    name: Option<String>,
    /// Writes to a file, or with - to standard output
    #[arg(short, long, visible_alias = "out", value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Runs the subcommand.
///
/// # Errors
/// There is no such result, or its parameters have no BRDF.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    let target = target(arguments.output.as_deref(), arguments.result.as_slice())?;
    let mut models = match (&arguments.result, &arguments.params) {
        (Some(path), _) => {
            let bytes = if path.as_os_str() == STDIN {
                bytes::of_stdin(streams.input)?
            } else {
                bytes::of_file(path)?
            };
            let fail = |error: Error| error.in_file(path.display().to_string());
            Model::of_json(&bytes, &arguments.index).map_err(fail)?
        }
        (None, params) => {
            let of = parameters::model(&arguments.model)?;
            vec![Model::of_params(all_parameters(
                of,
                params.as_deref().unwrap_or_default(),
                "--params",
            )?)]
        }
    };
    for model in &mut models {
        if let Some(name) = &arguments.name {
            model.name.clone_from(name);
        }
    }
    let (text, deviation) = write(arguments.to, &models, arguments.wavelength)?;
    if let Some(deviation) = deviation {
        let _ = writeln!(streams.errors, "{deviation}");
    }
    deliver(&text, target.as_ref(), streams.output)
}

/// A wavelength that the format admits: 1 nm to 17.16 mm.
fn wavelength(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(length) if (1.0..=17.16e6).contains(&length) => Ok(length),
        _ => Err("it must be a wavelength in nm, from 1 to 17160000".to_string()),
    }
}
