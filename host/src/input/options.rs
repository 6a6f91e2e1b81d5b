//! What the user says about files, and what they were taken for.

mod parse;

use serde::{Deserialize, Serialize};

use super::kind::Kind;
use super::part::Part;
use super::units::{Angles, Forward, Polarisation, Quantity, ValueUnit, WavelengthUnit};
use crate::error::Error;

/// How files are read; all but `input_format` hold for each scan.
///
/// From JSON it has the names and words of the command line, such as `{"mask-retro": 6, "columns": ["theta_s=2"]}`; [`ReadOptions::check`] is for those that do not come through the command line.
#[cfg_attr(feature = "cli", derive(clap::Args))]
#[cfg_attr(feature = "cli", command(next_help_heading = "What the files hold"))]
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all(deserialize = "kebab-case"))]
pub struct ReadOptions {
    /// Format of the files [default: known by their content]
    #[cfg_attr(feature = "cli", arg(long, value_name = "FORMAT"))]
    pub input_format: Option<String>,
    /// Sheets of an Excel workbook to take, by name or number [default: all that have numbers]
    #[cfg_attr(feature = "cli", arg(long, value_name = "NAME,...", value_delimiter = ','))]
    pub sheet: Vec<String>,
    /// Scans to take, by the name of their column, wavelength or polarisation [default: all]
    #[cfg_attr(feature = "cli", arg(long, value_name = "NAME,...", value_delimiter = ','))]
    pub column: Vec<String>,
    /// What the values are [default: what the file says, or brdf]
    #[cfg_attr(feature = "cli", arg(long, value_enum, value_name = "QUANTITY"))]
    pub quantity: Option<Quantity>,
    /// Unit of the angles [default: the format's]
    #[cfg_attr(feature = "cli", arg(long, value_enum, value_name = "UNIT"))]
    pub angles: Option<Angles>,
    /// Sign of theta_s on the side of the specular peak [default: positive, if the scan does not contradict]
    #[cfg_attr(feature = "cli", arg(long, value_enum, value_name = "SIGN"))]
    pub forward: Option<Forward>,
    /// What the values are counted in [default: what their name says, or plain]
    #[cfg_attr(feature = "cli", arg(long, value_enum, value_name = "UNIT"))]
    pub value_unit: Option<ValueUnit>,
    /// Unit of a column of wavelengths [default: what its name says, or by their size]
    #[cfg_attr(feature = "cli", arg(long, value_enum, value_name = "UNIT"))]
    pub wavelength_unit: Option<WavelengthUnit>,
    /// How rows of s and p polarisation are taken
    #[cfg_attr(feature = "cli", arg(long, value_enum, value_name = "HOW", default_value = "apart"))]
    pub polarisation: Polarisation,
    /// What columns hold, by their numbers or names, such as theta_s=2,brdf=3
    #[cfg_attr(feature = "cli", arg(long, value_name = "NAME=COLUMN,...", value_delimiter = ',', value_parser = super::part::parse, help_heading = TABLES))]
    #[serde(deserialize_with = "parse::columns")]
    pub columns: Vec<(Part, String)>,
    /// Makes a scan of each content of these columns
    #[cfg_attr(feature = "cli", arg(long, value_name = "COLUMN,...", value_delimiter = ',', help_heading = TABLES))]
    pub split: Vec<String>,
    /// Leaves columns aside that could matter
    #[cfg_attr(feature = "cli", arg(long, value_name = "COLUMN,...", value_delimiter = ',', help_heading = TABLES))]
    pub ignore: Vec<String>,
    /// Takes rows that repeat a direction at another value as repeated measurements
    #[cfg_attr(feature = "cli", arg(long, help_heading = TABLES))]
    pub repeats: bool,
    /// Angle of incidence of a file without one, degrees; of several files one each [default: from a remark or the file's name]
    #[cfg_attr(feature = "cli", arg(long, value_name = "DEG,...", value_delimiter = ',', allow_hyphen_values = true, value_parser = parse::theta_i, help_heading = TABLES))]
    pub theta_i: Vec<f64>,
    /// Takes all files as parts of one scan, such as one file an angle of incidence
    #[cfg_attr(feature = "cli", arg(long, help_heading = TABLES))]
    pub one_scan: bool,
    /// Takes all directions of a MERL file, one in 97 bins or as --thin says, and not only those in plane
    #[cfg_attr(feature = "cli", arg(long))]
    pub merl_whole: bool,
    /// Leaves out rows without a valid value or angle, and says how many
    #[cfg_attr(feature = "cli", arg(long, help_heading = "What is left out"))]
    pub drop_invalid: bool,
    /// Leaves out directions within this angle of that of incidence, where a detector blocks the beam, degrees
    #[cfg_attr(feature = "cli", arg(long, value_name = "DEG", value_parser = parse::angle, help_heading = "What is left out"))]
    pub mask_retro: Option<f64>,
    /// Leaves out theta_i and theta_s beyond this, degrees
    #[cfg_attr(feature = "cli", arg(long, value_name = "DEG", value_parser = parse::angle, help_heading = "What is left out"))]
    pub max_angle: Option<f64>,
    /// Leaves out values from this on, where the detector saturates, in the unit of the file
    #[cfg_attr(feature = "cli", arg(long, value_name = "X", help_heading = "What is left out"))]
    pub max_value: Option<f64>,
    /// Keeps one in N rows
    #[cfg_attr(feature = "cli", arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "What is left out"))]
    pub thin: Option<u32>,
    /// Coverage factor of uncertainties whose names give none: they are divided by it
    #[cfg_attr(feature = "cli", arg(long, value_name = "K", value_parser = parse::positive, help_heading = "Weights"))]
    pub coverage: Option<f64>,
    /// Where weights come from
    #[cfg_attr(
        feature = "cli",
        arg(
            long,
            value_enum,
            value_name = "KIND",
            default_value = "file",
            help_heading = "Weights"
        )
    )]
    pub weights: Weights,
    /// Relative standard deviation that is added to each in square
    #[cfg_attr(feature = "cli", arg(long, value_name = "X", default_value_t = 0.0, value_parser = parse::not_negative, help_heading = "Weights"))]
    pub sigma_floor: f64,
    /// Factor of the residuals at one angle of incidence, which must be there; repeatable
    #[cfg_attr(feature = "cli", arg(long, value_name = "DEG=FACTOR", value_parser = parse::weight_angle, help_heading = "Weights"))]
    #[serde(deserialize_with = "parse::weights")]
    pub weight_angle: Vec<(f64, f64)>,
    /// Errors are those of the file's standard deviations whatever chi^2 says of them [default: unless chi^2 refutes them]
    #[cfg_attr(feature = "cli", arg(long, help_heading = "Weights"))]
    pub absolute_sigma: bool,
    /// Raises ln BRDF by what symmetric noise takes from it on average where the file gives no standard deviations: sigma^2/2, sigma being that of the residuals of a first fit
    #[cfg_attr(feature = "cli", arg(long, help_heading = "Weights"))]
    pub correct_ln_bias: bool,
}

/// Where the help has the options of tables alone.
#[cfg(feature = "cli")]
const TABLES: &str = "Tables";

impl ReadOptions {
    /// Refuses numbers that the command line would refuse.
    ///
    /// # Errors
    /// The first of them.
    pub fn check(&self) -> Result<(), Error> {
        let all: [(&str, &[f64], parse::Allowed); 5] = [
            ("--theta-i", &self.theta_i, parse::within_90),
            ("--mask-retro", self.mask_retro.as_slice(), parse::within_180),
            ("--max-angle", self.max_angle.as_slice(), parse::within_180),
            ("--coverage", self.coverage.as_slice(), parse::above_0),
            ("--sigma-floor", &[self.sigma_floor], parse::from_0),
        ];
        for (option, values, allowed) in all {
            for &value in values {
                allowed(value).map_err(|why| Error::new(format!("{option} cannot be {value}")).help(why))?;
            }
        }
        if self.thin == Some(0) {
            return Err(Error::new("--thin cannot be 0").help("keep one in 1 rows or more"));
        }
        Ok(())
    }

    /// Refuses options that are of several files together.
    ///
    /// # Errors
    /// One of them is given, and `command` reads each file alone.
    pub fn refuse_together(&self, command: &str) -> Result<(), Error> {
        let together = self.one_scan || self.theta_i.len() > 1;
        if !together {
            return Ok(());
        }
        let option = if self.one_scan {
            "--one-scan"
        } else {
            "--theta-i with several angles"
        };
        Err(Error::new(format!(
            "{option} is for several files together, and {command} reads each alone"
        ))
        .help("write them as one file with brdfit inspect --one-scan --output scan.csv"))
    }

    /// Refuses options that only a table has a use for.
    ///
    /// # Errors
    /// One of them is given, and the file is of another format, whose title is in the message.
    pub fn refuse_for(&self, kind: Kind, title: &str) -> Result<(), Error> {
        let given = [
            ("--columns", !self.columns.is_empty()),
            ("--split", !self.split.is_empty()),
            ("--ignore", !self.ignore.is_empty()),
            ("--repeats", self.repeats),
            ("--theta-i", !self.theta_i.is_empty() && kind != Kind::Matrix),
            ("--polarisation mean", self.polarisation == Polarisation::Mean),
            ("--wavelength-unit", self.wavelength_unit.is_some()),
            ("--coverage", self.coverage.is_some()),
        ];
        match given.into_iter().find(|(_, given)| *given) {
            Some((option, _)) if kind != Kind::Table => Err(Error::new(format!(
                "{option} is for tables with columns, and this is {title}"
            ))
            .help(format!("leave {option} out, or call brdfit for this file alone"))),
            _ => Ok(()),
        }
    }
}

/// Where weights come from.
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Weights {
    /// Standard deviations or weights in the file, if it has any
    #[default]
    File,
    /// All samples count the same
    Equal,
}
