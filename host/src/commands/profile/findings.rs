//! What the command found about one scan.

use crate::analysis::choose::Choice;
use crate::analysis::profile::Profile;
use crate::engine::{FitOptions, Outcome, Values};
use crate::input::About;

/// Profiles and copies of one scan.
#[derive(Clone, Debug, PartialEq)]
pub struct Findings {
    /// The scan's name.
    pub name: String,
    /// Its best fit.
    pub outcome: Outcome,
    /// Why that model and those terms, if the scan chose them.
    pub choice: Option<Choice>,
    /// The cost that the search had found, if a profile met a better fit.
    pub improved_from: Option<f64>,
    /// One for each parameter asked for.
    pub profiles: Vec<Profile>,
    /// The parameters of each copy; empty without bootstrap.
    pub copies: Vec<Values>,
    /// The number of copies at each end of an interval whose thresholds are measured; 0 for those of the F test.
    pub calibrated: u32,
    /// How the scan was fitted; the seed is that of the copies too.
    pub options: FitOptions,
    /// How it was read.
    pub about: About,
}
