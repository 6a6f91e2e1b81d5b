//! Residuals along lines, and a process with exponential correlation that they may be of.

use std::ops::Range;

use brdfit_core::real::Real;

/// Residuals along lines, each with its row of J; one number after the other, for a scan may have a million samples.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Residuals {
    /// Where each is, radians, ascending along its line.
    pub angles: Vec<f64>,
    /// How far each is from the specular direction of its line, radians.
    pub offsets: Vec<f64>,
    /// The residuals over the standard deviation of all.
    pub values: Vec<f64>,
    /// The rows of J, one after the other, in coordinates in which J'J is 1.
    pub rows: Vec<f64>,
    /// Numbers in a row.
    pub columns: usize,
    /// Where the lines end.
    pub ends: Vec<usize>,
}

impl Residuals {
    /// The places of each line.
    pub fn lines(&self) -> impl Iterator<Item = Range<usize>> {
        let begins = std::iter::once(0).chain(self.ends.iter().copied());
        begins.zip(&self.ends).map(|(begin, &end)| begin..end)
    }

    /// The row of J at a place.
    pub fn row(&self, place: usize) -> &[f64] {
        &self.rows[place * self.columns..][..self.columns]
    }

    /// Drops the columns that are not kept.
    pub fn keep(&mut self, kept: &[bool]) {
        let mut place = 0;
        self.rows.retain(|_| {
            let keep = kept[place % kept.len()];
            place += 1;
            keep
        });
        self.columns = kept.iter().filter(|kept| **kept).count();
    }
    /// The median angle between neighbours; none without lines of two.
    pub fn step(&self) -> Option<f64> {
        let pairs = self.lines().flat_map(|line| self.angles[line].windows(2));
        let mut steps: Vec<f64> = pairs.map(|pair| pair[1] - pair[0]).filter(|&step| step > 0.0).collect();
        let middle = steps.len() / 2;
        (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
    }
}

/// A stationary process beside noise of each sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Process {
    /// Angle over which the correlation falls to 1/e, radians.
    pub length: f64,
    /// Part of the variance that is correlated; 0 for independent residuals.
    pub part: f64,
    /// Has it a slope? Then its correlation over x lengths is that of Matern with 3/2, else exponential.
    pub smooth: bool,
}

/// (1 + x) exp(-x) is 1/e here.
pub const SMOOTH: f64 = 2.146_193_220_620_582_6;

/// What the state is expected to be after `angle`, per state before.
pub fn step(angle: f64, process: Process) -> [[f64; 2]; 2] {
    if process.smooth {
        let x = SMOOTH * angle / process.length;
        let e = Real::portable_exp(-x.min(700.0));
        [[e * (1.0 + x), e * x], [-e * x, e * (1.0 - x)]]
    } else {
        [
            [Real::portable_exp(-(angle / process.length).min(700.0)), 0.0],
            [0.0; 2],
        ]
    }
}
