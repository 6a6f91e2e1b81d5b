//! A scan as it was read and checked.

use std::io::Write;

use brdfit_core::geometry::Sample;

use super::about::About;
use super::format::SAMPLES;
use super::left_out::{LeftOut, Reason, summary};
use super::read_as::ReadAs;
use super::units::{Angles, Forward, Quantity};
use super::weight::{Deviation, OnDeviations};
use crate::plain::plain;

/// A scan as it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// Where it came from, as the user named it.
    pub file: String,
    /// Which scan of the file it is, such as `R` or `550 nm`; none if the file says nothing of the kind.
    pub name: Option<String>,
    /// The valid samples in order of the file, at least one; the mean of their squared weights is 1.
    pub samples: Vec<Sample<f64>>,
    /// The line of each sample; the first line of a file is 1, and 0 stands for none.
    pub lines: Vec<u64>,
    /// The standard deviation of ln f that a weight of 1 stands for, if the weights come from standard deviations; dimensionless.
    pub sigma_ln: Option<f64>,
    /// The standard deviations that the file gives, one a sample; none if it does not give all.
    pub deviations: Vec<Deviation>,
    /// What is asked of the errors and of the bias of ln f.
    pub on_deviations: OnDeviations,
    /// What the numbers of the file were taken for.
    pub read_as: ReadAs,
    /// What was left out, and why.
    pub left_out: Vec<LeftOut>,
    /// The samples that were left out although they are valid, and why.
    pub masked: Vec<(Reason, Sample<f64>)>,
    /// What the reader understood of the file.
    pub about: About,
}

impl Measurement {
    /// Of samples that are from no file: `file` is what messages call them.
    ///
    /// `sigma_ln` is the standard deviation of ln f that a weight of 1 stands for, if the weights come from standard deviations.
    pub fn of_samples(file: impl Into<String>, samples: Vec<Sample<f64>>, sigma_ln: Option<f64>) -> Measurement {
        Measurement {
            file: file.into(),
            name: None,
            lines: vec![0; samples.len()],
            sigma_ln,
            deviations: Vec::new(),
            on_deviations: OnDeviations::default(),
            read_as: ReadAs {
                format: SAMPLES,
                angles: Angles::Rad,
                quantity: Quantity::Brdf,
                forward: Forward::Positive,
                weighted: samples.iter().any(|sample| sample.weight != samples[0].weight),
            },
            samples,
            left_out: Vec::new(),
            masked: Vec::new(),
            about: About::default(),
        }
    }

    /// The file and the name of the scan in it, for people.
    pub fn label(&self) -> String {
        label(&self.file, self.name.as_deref())
    }
}

/// A file and the name of a scan in it, for people.
pub fn label(file: &str, scan: Option<&str>) -> String {
    let label = match scan {
        Some(scan) => format!("{file} [{scan}]"),
        None => file.to_string(),
    };
    plain(&label).into_owned()
}

/// Says of each scan what was left out of it, and what may be wrong with it.
pub fn note(measurements: &[Measurement], to: &mut dyn Write) {
    for measurement in measurements {
        if let Some(summary) = summary(&measurement.left_out) {
            let (label, kept) = (measurement.label(), measurement.samples.len());
            // If even standard error is closed, the result says it too.
            let _ = writeln!(to, "{label}: kept {kept}, left out {summary}");
        }
        for doubt in &measurement.about.doubts {
            let _ = writeln!(to, "{}: {doubt}", measurement.label());
        }
    }
}
