//! What the page can ask for.

use brdfit::export::form::Form;
use brdfit::input::ReadOptions;
use brdfit::options::SearchArguments;
use serde::Deserialize;
use serde_json::value::RawValue;

/// A request.
#[derive(Deserialize)]
pub struct Request<'a> {
    /// What is wanted.
    pub want: Want,
    /// Of which scan: a [`Subject`], whose text tells whether it is the one before.
    #[serde(borrow)]
    pub of: Option<&'a RawValue>,
}

/// Which files, how they are read, and how they are fitted; options have the names and words of the command line.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Subject {
    /// Names of the files, in order.
    pub files: Vec<String>,
    /// How they are read.
    pub read: ReadOptions,
    /// How the scan is fitted.
    pub search: SearchArguments,
}

/// What is wanted; of all but the first three the subject must be one scan.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Want {
    /// Models, formats and forms of this build.
    About,
    /// All scans of the files, before any fit.
    Read,
    /// All scans of the files as the program's own table.
    Table,
    /// The table of one scan without the samples of these places, which someone has marked.
    Without(Vec<usize>),
    /// The fit.
    Fit,
    /// Curves and residuals of any parameters, such as those of another minimum.
    Draw(Draw),
    /// The fit as a table.
    Csv,
    /// The fit as `brdfit export` writes it.
    Export {
        /// For which program.
        to: Form,
        /// In nm, where the form has one and the scan does not tell it.
        wavelength: Option<f64>,
    },
    /// The figures of the page of a report.
    Figures,
    /// The page of a report.
    Report {
        /// The line that makes the same page.
        command: String,
    },
    /// Which values of these parameters the scan allows.
    Profile {
        /// Their names.
        parameters: Vec<String>,
    },
    /// A comparison of models.
    Compare {
        /// Their names with commas between, or auto.
        models: String,
    },
    /// A proof that no parameters fit better, or those that do.
    Certify {
        /// The part that no cost is to be lower by than that of the fit.
        within: f64,
        /// The longest time, s.
        seconds: f64,
    },
    /// Error against run time of both methods.
    Converge {
        /// Number of searches by each.
        seeds: u32,
    },
}

/// What is drawn.
#[derive(Clone, Debug, Deserialize)]
pub struct Draw {
    /// Name of the model.
    pub model: String,
    /// All its parameters.
    pub values: Vec<f64>,
    /// The part of the axis of scattering angles that is seen, degrees.
    pub from: f64,
    /// Its end.
    pub to: f64,
}
