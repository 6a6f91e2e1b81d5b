//! `brdfit export`: a fitted model for the programs that use it, one file a form.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::error::Error;
use crate::export::model::Model;
use crate::export::{abg, bird, constants, glsl, mitsuba, native, openmaterial, renderers, rgl, zemax};
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

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Form {
    /// Zemax tabular BSDF
    Zemax,
    /// Zemax OpticStudio's own ABg, of --model abg
    ZemaxAbg,
    /// FRED's own ABg as a script, of --model abg
    Fred,
    /// BRDF Explorer, .brdf
    Glsl,
    /// Mitsuba 3, the exact model in Python
    Mitsuba,
    /// Mitsuba 3, the nearest rough conductor on a diffuse base
    MitsubaNative,
    /// Mitsuba 3, the nearest principled BSDF
    MitsubaPrincipled,
    /// glTF 2.0, the nearest material
    Gltf,
    /// MaterialX, the nearest gltf_pbr
    Materialx,
    /// RGL tensor file for Mitsuba's measured BSDF, .bsdf
    Rgl,
    /// Constants for C
    C,
    /// Constants for Rust with brdfit-core
    Rust,
    /// EURAMET BiRD JSON, the model with its uncertainties
    Bird,
    /// ASAM OpenMATERIAL 3D BRDF, .xompt
    Openmaterial,
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
    let (text, deviation) = write(arguments, &models)?;
    if let Some(deviation) = deviation {
        let _ = writeln!(streams.errors, "{deviation}");
    }
    deliver(&text, target.as_ref(), streams.output)
}

/// The file, and how far its model is off where that is not the fitted one.
fn write(arguments: &Arguments, models: &[Model]) -> Result<(Vec<u8>, Option<String>), Error> {
    let one = || match models {
        [model] => Ok(model),
        several => {
            Err(Error::new(format!("there are {} results", several.len())).help("choose one with --index N, from 1 on"))
        }
    };
    let (text, deviation) = match arguments.to {
        Form::MitsubaNative => with_deviation(native::write(one()?)?),
        Form::MitsubaPrincipled => with_deviation(renderers::mitsuba_principled(models)?),
        Form::Gltf => with_deviation(renderers::gltf(models)?),
        Form::Materialx => with_deviation(renderers::materialx(models)?),
        Form::Rgl => return Ok((rgl::write(&by_length(arguments, models)?), None)),
        Form::Zemax => {
            let model = one()?;
            (zemax::write(model), zemax::clamped(model))
        }
        Form::ZemaxAbg => (abg::zemax(one()?)?, None),
        Form::Fred => (abg::fred(one()?)?, None),
        Form::Glsl => (glsl::write(one()?)?, None),
        Form::Mitsuba => (mitsuba::write(one()?)?, None),
        Form::C => (constants::c(one()?)?, None),
        Form::Rust => (constants::rust(one()?)?, None),
        Form::Bird => (bird::write(one()?), None),
        Form::Openmaterial => {
            let model = one()?;
            (openmaterial::write(model, length(arguments, model)?), None)
        }
    };
    Ok((text.into_bytes(), deviation))
}

fn with_deviation((text, deviation): (String, String)) -> (String, Option<String>) {
    (text, Some(deviation))
}

/// The models with their wavelengths in nm, rising.
fn by_length<'a>(arguments: &Arguments, models: &'a [Model]) -> Result<Vec<(f64, &'a Model)>, Error> {
    let lengths = models.iter().map(|model| Ok((length(arguments, model)?, model)));
    let mut lengths = lengths.collect::<Result<Vec<_>, Error>>()?;
    lengths.sort_by(|a, b| a.0.total_cmp(&b.0));
    if lengths.windows(2).any(|pair| pair[0].0 == pair[1].0) {
        return Err(Error::new("two results have the same wavelength").help("choose others with --index"));
    }
    Ok(lengths)
}

/// The wavelength of a form that has one, nm.
fn length(arguments: &Arguments, model: &Model) -> Result<f64, Error> {
    arguments.wavelength.or(model.wavelength).ok_or_else(|| {
        Error::new("this form has a wavelength, and the name of the scan does not tell it")
            .help("give --wavelength in nm")
    })
}

/// A wavelength that the format admits: 1 nm to 17.16 mm.
fn wavelength(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(length) if (1.0..=17.16e6).contains(&length) => Ok(length),
        _ => Err("it must be a wavelength in nm, from 1 to 17160000".to_string()),
    }
}
