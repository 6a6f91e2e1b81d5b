//! Table 3 of the paper for a batch, with Fig. 13 as bars.

use std::fmt::Write;

use crate::error::Error;
use crate::number::shortest;
use crate::records::record::{Line, Record};
use crate::streams::{Ended, Streams};

/// Lines that are printed; means are over all.
const SHOWN: usize = 100;

/// Failures that are told; the results have all.
const TOLD: usize = 20;

/// Exit code where all was done, but some scans could not be fitted.
const SOME_FAILED: u8 = 1;

/// How a batch went, as far as it was written.
#[derive(Default)]
pub struct Summary {
    lines: Vec<Line>,
    scans: usize,
    minima: usize,
    improvement_potential: f64,
    failures: Vec<String>,
    failed: usize,
}

impl Summary {
    /// The same records, which are added up as they pass.
    pub fn of<'a>(
        &'a mut self,
        records: &'a mut dyn Iterator<Item = Result<Record, Error>>,
    ) -> impl Iterator<Item = Result<Record, Error>> + 'a {
        records.inspect(|record| {
            if let Ok(record) = record {
                record.scans.iter().for_each(|scan| self.add(&scan.line));
            }
        })
    }

    fn add(&mut self, line: &Result<Line, String>) {
        match line {
            Ok(line) => {
                self.scans += 1;
                self.minima += line.minima;
                self.improvement_potential += line.improvement_potential;
                if self.lines.len() < SHOWN {
                    self.lines.push(line.clone());
                }
            }
            Err(error) => {
                self.failed += 1;
                if self.failures.len() < TOLD {
                    self.failures.push(error.clone());
                }
            }
        }
    }

    /// Prints the page, if it is `shown`, and gives what failed.
    pub fn tell(&self, shown: bool, streams: &mut Streams) -> Ended {
        // The results are written; it does not matter if nobody reads this.
        if shown && !streams.quiet {
            let _ = streams.output.write_all(self.text().as_bytes());
        }
        if self.failed == 0 {
            return Ended::default();
        }
        let mut why = String::new();
        for failure in &self.failures {
            why += &format!("{failure}\n");
        }
        let all = self.scans + self.failed;
        why += &format!("{} of {all} scans could not be fitted\n", self.failed);
        Ended { code: SOME_FAILED, why }
    }

    /// The page.
    fn text(&self) -> String {
        if self.scans == 0 {
            return String::new();
        }
        let count = self.scans as f64;
        let angles = |line: &Line| {
            line.theta_i
                .iter()
                .map(|&angle| shortest(angle))
                .collect::<Vec<_>>()
                .join(", ")
        };
        let widest =
            |least: usize, width: &dyn Fn(&Line) -> usize| self.lines.iter().map(width).max().unwrap_or(0).max(least);
        let scan = widest(4, &|line| line.scan.chars().count());
        let theta_i = widest(13, &|line| angles(line).len());
        let mut page = format!(
            "{:<scan$}  {:<theta_i$}  minima  high MSE^2   low MSE^2  improvement potential\n",
            "scan", "theta_i, deg"
        );
        for line in &self.lines {
            let _ = writeln!(
                page,
                "{:<scan$}  {:<theta_i$}  {:>6}  {:>10.2e}  {:>10.2e}  {}",
                line.scan,
                angles(line),
                line.minima,
                line.high,
                line.low,
                bar(line.improvement_potential),
            );
        }
        if self.scans > SHOWN {
            let _ = writeln!(page, "... and {} more", self.scans - SHOWN);
        }
        let (minima, potential) = (self.minima as f64 / count, self.improvement_potential / count);
        let _ = writeln!(
            page,
            "{:<scan$}  {:<theta_i$}  {minima:>6.1}  {:>10}  {:>10}  {}",
            "mean",
            "",
            "",
            "",
            bar(potential)
        );
        page
    }
}

/// A number from 0 to 1, and its bar.
fn bar(part: f64) -> String {
    const WIDTH: f64 = 20.0;
    let bar = "#".repeat((part * WIDTH).round() as usize);
    format!("{part:.2} {bar}").trim_end().to_string()
}
