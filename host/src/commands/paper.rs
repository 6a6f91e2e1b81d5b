//! `brdfit paper`: section 4 of the paper, from the synthetic sets that the program carries.

mod text;

use clap::{Args, ValueEnum};

use crate::analysis::paper::study;
use crate::analysis::paper_sets::Noise;
use crate::error::Error;
use crate::output::{Format, deliver, target};
use crate::streams::Streams;
use crate::target::NO_INPUTS;

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
enum NoiseName {
    /// Uniform within +-10 %: the reading that agrees with the paper's fitted rho_d
    Sym,
    /// Uniform within 0 to 10 %
    Pos,
}

/// Fits the paper's three synthetic sets, which are built in, as its section 4 does
#[derive(Args, Clone, Copy, Debug, PartialEq)]
#[command(after_help = "Example:\n  brdfit paper --noise pos --format json")]
pub struct Arguments {
    /// Noise of the sets
    #[arg(long, value_enum, default_value = "sym")]
    noise: NoiseName,
    /// Form of the result
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
    /// Seed of the starts of both methods (not of the noise)
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Number of starts of the paper's method
    #[arg(long, value_name = "N", default_value_t = 250, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    starts: u32,
}

/// Runs the subcommand.
///
/// # Errors
/// The stream breaks.
pub fn run(arguments: &Arguments, streams: &mut Streams) -> Result<(), Error> {
    let target = target(None, &NO_INPUTS)?;
    deliver(&write(arguments), target.as_ref(), streams.output)
}

/// The study as text or JSON.
fn write(arguments: &Arguments) -> Vec<u8> {
    let noise = match arguments.noise {
        NoiseName::Sym => Noise::Sym,
        NoiseName::Pos => Noise::Pos,
    };
    let study = study(noise, arguments.seed, arguments.starts);
    let mut out = Vec::new();
    match arguments.format {
        Format::Text => text::write(&mut out, &study).expect("a Vec takes all"),
        Format::Json => {
            out = serde_json::to_vec_pretty(&study).expect("numbers and names have a JSON form");
            out.push(b'\n');
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use brdfit_core::brdf::NAMES;

    use super::*;

    fn written(format: Format, noise: NoiseName) -> String {
        let arguments = Arguments {
            noise,
            format,
            seed: 0,
            starts: 12,
        };
        String::from_utf8(write(&arguments)).expect("the text is UTF-8")
    }

    #[test]
    fn text_fits_100_columns() {
        for noise in [NoiseName::Sym, NoiseName::Pos] {
            let text = written(Format::Text, noise);
            let widest = text.lines().map(|line| line.chars().count()).max();
            assert!(widest <= Some(100), "{widest:?}");
            for name in NAMES {
                assert_eq!(
                    text.lines()
                        .filter(|line| line.starts_with(&format!("{name} ")))
                        .count(),
                    3
                );
            }
            assert!(!text.contains("NaN") && !text.contains("inf"));
        }
    }

    #[test]
    fn json_has_every_draw() {
        let json: serde_json::Value = serde_json::from_str(&written(Format::Json, NoiseName::Sym)).expect("JSON");
        assert_eq!(json["starts"], 12);
        assert_eq!(json["sets"][2]["parameters"][3]["actual"], 0.005);
        for set in 0..3 {
            for draw in 0..3 {
                let draw = &json["sets"][set]["draws"][draw];
                assert_eq!(draw["samples"], 171);
                let minima = draw["minima"].as_u64().expect("a count");
                assert!((1..=12).contains(&minima));
                let (low, high) = (draw["mse2_low"].as_f64(), draw["mse2_high"].as_f64());
                assert!(low <= high && low > Some(0.0));
            }
        }
    }
}
