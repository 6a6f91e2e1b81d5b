//! `brdfit export`: a fitted model for the programs that use it, one file a form.

mod bird;
mod constants;
mod glsl;
mod mitsuba;
pub mod model;
pub mod native;
mod zemax;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use crate::error::Error;
use crate::input::{STDIN, bytes};
use crate::output::{deliver, target};
use crate::streams::Streams;
use model::Model;

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
    /// All six parameters, in place of a result
    #[arg(long, value_name = "NAME=X,...")]
    params: Option<String>,
    /// Which result, if there are several; the first is 1
    #[arg(long, value_name = "N", requires = "result")]
    index: Option<usize>,
    /// For which program
    #[arg(long, value_enum)]
    to: Form,
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
    /// BRDF Explorer, .brdf
    Glsl,
    /// Mitsuba 3, the exact model in Python
    Mitsuba,
    /// Mitsuba 3, the nearest of its own models
    MitsubaNative,
    /// Constants for C
    C,
    /// Constants for Rust with brdfit-core
    Rust,
    /// EURAMET BiRD JSON, the model with its uncertainties
    Bird,
}

/// Runs the subcommand.
///
/// # Errors
/// There is no such result, or its parameters have no BRDF.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    let target = target(arguments.output.as_deref(), arguments.result.as_slice())?;
    let mut model = match (&arguments.result, &arguments.params) {
        (Some(path), _) => {
            let bytes = if path.as_os_str() == STDIN {
                bytes::of_stdin(streams.input)?
            } else {
                bytes::of_file(path)?
            };
            let fail = |error: Error| error.in_file(path.display().to_string());
            Model::of_json(&bytes, arguments.index).map_err(fail)?
        }
        (None, params) => Model::of_params(params.as_deref().unwrap_or_default())?,
    };
    if let Some(name) = &arguments.name {
        model.name.clone_from(name);
    }
    let text = match arguments.to {
        Form::Zemax => zemax::write(&model),
        Form::Glsl => glsl::write(&model),
        Form::Mitsuba => mitsuba::write(&model),
        Form::MitsubaNative => {
            let (text, deviation) = native::write(&model);
            let _ = writeln!(streams.errors, "{deviation}");
            text
        }
        Form::C => constants::c(&model),
        Form::Rust => constants::rust(&model),
        Form::Bird => bird::write(&model),
    };
    deliver(text.as_bytes(), target.as_ref(), streams.output)
}

/// Words that mean something else to Python, C, C++ or Rust, or are models of Mitsuba's own.
const RESERVED: &str = "abstract alignas alignof and as asm assert async auto await become bitand bitor blendbsdf bool box break bumpmap \
    case catch char class compl concept conductor const consteval constexpr constinit continue crate decltype def default del delete \
    dielectric diffuse do double dr dyn elif else enum except explicit export extern false final finally float fn for friend from \
    gen global goto hair hide if impl import in inline int is lambda let loop long macro mask match measured mi mod move mut mutable \
    namespace new noexcept none nonlocal normalmap not null nullptr operator or override pass plastic pplastic principled \
    principledthin private protected pub raise ref register requires restrict retarder return roughconductor roughdielectric \
    roughplastic self short signed sizeof static struct super switch template thindielectric this throw trait true try twosided \
    type typedef typeid typename typeof union unsafe unsigned unsized use using virtual void volatile where while with xor yield";

/// The model's name as a word of a program: letters, digits and underscores, and no word of a language.
fn word(name: &str) -> String {
    let stem = Path::new(name)
        .file_stem()
        .map_or(String::new(), |stem| stem.to_string_lossy().into_owned());
    let word: String = stem
        .chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() {
                c.to_ascii_lowercase()
            } else {
                '_'
            }
        })
        .collect();
    let reserved = RESERVED.split_whitespace().any(|reserved| reserved == word);
    if word.starts_with(|c: char| c.is_ascii_alphabetic()) && !reserved {
        word
    } else {
        format!("brdf_{word}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_identifiers() {
        for (name, expected) in [
            ("scans/Black Paint-2.csv", "black_paint_2"),
            ("class", "brdf_class"),
            ("mi.csv", "brdf_mi"),
            ("diffuse", "brdf_diffuse"),
            ("a\0b\u{202e}c", "a_b_c"),
            ("2024", "brdf_2024"),
            ("_x", "brdf__x"),
            ("", "brdf_"),
            ("\"\nimport os\n", "brdf___import_os_"),
        ] {
            assert_eq!(word(name), expected, "{name:?}");
        }
    }
}
