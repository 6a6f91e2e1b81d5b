//! The forms of a fitted model by name.

use serde::Deserialize;

use super::model::Model;
use super::{abg, bird, constants, glsl, mitsuba, native, openmaterial, renderers, rgl, zemax};
use crate::error::Error;

/// For which program.
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Form {
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
    /// MaterialX, the nearest OpenPBR surface
    Openpbr,
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

/// The file, and how far its model is off where that is not the fitted one; `wavelength` in nm, if the models do not tell theirs.
///
/// # Errors
/// The form cannot hold the model, or lacks something.
///
/// ```
/// use brdfit::analysis::choose::Wanted;
/// use brdfit::analysis::fit::fit;
/// use brdfit::engine::FitOptions;
/// use brdfit::export::form::{Form, write};
/// use brdfit::export::model::Model;
/// use brdfit::input::{ReadOptions, parse};
/// use brdfit::result;
///
/// let table = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/testdata3_sym_seed1.csv"));
/// let scan = &parse("paint.csv", table, &ReadOptions::default())?[0];
/// let fitted = fit(scan, &Wanted::One(FitOptions::default()))?;
/// let models = Model::of_json(result::json(&[fitted]).as_bytes(), &[])?;
/// let (file, deviation) = write(Form::C, &models, None)?;
/// assert!(String::from_utf8_lossy(&file).contains("#define PAINT_RHO_D ") && deviation.is_none());
/// # Ok::<(), brdfit::error::Error>(())
/// ```
pub fn write(form: Form, models: &[Model], wavelength: Option<f64>) -> Result<(Vec<u8>, Option<String>), Error> {
    let one = || match models {
        [model] => Ok(model),
        several => {
            Err(Error::new(format!("there are {} results", several.len())).help("choose one with --index N, from 1 on"))
        }
    };
    let (text, deviation) = match form {
        Form::MitsubaNative => with_deviation(native::write(one()?)?),
        Form::MitsubaPrincipled => with_deviation(renderers::mitsuba_principled(models)?),
        Form::Gltf => with_deviation(renderers::gltf(models)?),
        Form::Materialx => with_deviation(renderers::materialx(models)?),
        Form::Openpbr => with_deviation(renderers::openpbr(models)?),
        Form::Rgl => return Ok((rgl::write(&by_length(wavelength, models)?), None)),
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
        Form::Openmaterial => (openmaterial::write(&by_length(wavelength, models)?), None),
    };
    Ok((text.into_bytes(), deviation))
}

fn with_deviation((text, deviation): (String, String)) -> (String, Option<String>) {
    (text, Some(deviation))
}

/// The models with their wavelengths in nm, rising.
fn by_length(wavelength: Option<f64>, models: &[Model]) -> Result<Vec<(f64, &Model)>, Error> {
    let lengths = models.iter().map(|model| Ok((length(wavelength, model)?, model)));
    let mut lengths = lengths.collect::<Result<Vec<_>, Error>>()?;
    lengths.sort_by(|a, b| a.0.total_cmp(&b.0));
    if lengths.windows(2).any(|pair| pair[0].0 == pair[1].0) {
        return Err(Error::new("two results have the same wavelength").help("choose others with --index"));
    }
    Ok(lengths)
}

/// The wavelength of a form that has one, nm.
fn length(wavelength: Option<f64>, model: &Model) -> Result<f64, Error> {
    wavelength.or(model.wavelength).ok_or_else(|| {
        Error::new("this form has a wavelength, and the name of the scan does not tell it")
            .help("give --wavelength in nm")
    })
}
