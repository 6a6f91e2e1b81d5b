//! What the commands share that prove the optimum: options, progress, and how they end.

use std::time::Duration;

use clap::Args;
use indicatif::ProgressBar;

use crate::analysis::fit::FittedScan;
use crate::analysis::proof::{Goal, NOTHING};
use crate::engine::certify::Certificate;
use crate::error::Error;
use crate::interrupt;
use crate::number::percent_up;
use crate::streams::Ended;

/// What a proof of the optimum may take.
#[derive(Args, Debug)]
pub(crate) struct ProofArguments {
    /// Ends each proof after so many seconds, with what is proved so far
    #[arg(long, value_name = "S", value_parser = seconds)]
    proof_seconds: Option<Duration>,
    /// Ends each proof after so many boxes, at the same place in each run
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    proof_boxes: Option<u64>,
}

impl ProofArguments {
    /// Refuses limits of a proof that nobody asked for.
    ///
    /// # Errors
    /// One of them is given, and `certify` is not.
    pub(crate) fn refuse_without(&self, certify: Option<f64>) -> Result<(), Error> {
        let given = [
            ("--proof-seconds", self.proof_seconds.is_some()),
            ("--proof-boxes", self.proof_boxes.is_some()),
        ];
        match given.iter().find(|(_, given)| *given && certify.is_none()) {
            Some((option, _)) => Err(Error::new(format!("{option} limits a proof, and none is asked for"))
                .help(format!("add --certify 5%, or leave out {option}"))),
            None => Ok(()),
        }
    }

    /// To prove this within what it may take; `interrupted` ends it too, and `progress` is told.
    pub(crate) fn goal<'a>(
        &self,
        eps: f64,
        interrupted: &'a (dyn Fn() -> bool + Sync),
        progress: &'a (dyn Fn(&Certificate) + Sync),
    ) -> Goal<'a> {
        Goal {
            eps,
            boxes: self.proof_boxes.unwrap_or(u64::MAX),
            limit: self.proof_seconds,
            alone: false,
            interrupted,
            progress,
        }
    }
}

/// Reads a part such as `5%` or `0.05`, above 0 and below 1.
///
/// # Errors
/// The text is no such part.
pub(crate) fn part(text: &str) -> Result<f64, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let part = match text.trim().strip_suffix('%') {
        Some(percent) => number(percent).map(|percent| percent / 100.0),
        None => number(text),
    };
    let part = part.filter(|part| *part > 0.0 && *part < 1.0);
    part.ok_or_else(|| "write a part between 0 and 100 %, such as 5%".into())
}

/// Reads a time such as `600`, above 0.
fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.trim().parse().ok().filter(|seconds: &f64| *seconds > 0.0);
    let time = seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    time.ok_or_else(|| "write a number of seconds above 0, such as 600".into())
}

/// A clock that tells how far proofs are.
pub(crate) fn proving(shown: bool) -> ProgressBar {
    if !shown {
        return ProgressBar::hidden();
    }
    let clock = ProgressBar::new_spinner();
    clock.enable_steady_tick(Duration::from_millis(100));
    clock
}

/// How far a proof is.
pub(crate) fn so_far(certificate: &Certificate) -> String {
    let boxes = format!("{} boxes, {} to go", certificate.boxes, certificate.open);
    match certificate.eps {
        eps if eps < NOTHING => format!("proved within {} so far, {boxes}", percent_up(eps)),
        _ => boxes,
    }
}

/// How a command ended whose scans were to be fitted, and some to be proved.
pub(crate) fn ended(reports: &[FittedScan], scans: usize) -> Ended {
    let stopped = interrupt::asked()
        && reports
            .iter()
            .any(|report| report.proof.is_some_and(|proof| !proof.complete));
    let why = match (reports.len() < scans, stopped) {
        (false, false) => return Ended::default(),
        (false, true) => "interrupted: what is proved so far is written\n".into(),
        (true, _) => format!(
            "interrupted: {} of {scans} scans are fitted and written\n",
            reports.len()
        ),
    };
    Ended {
        code: interrupt::EXIT_CODE,
        why,
    }
}
