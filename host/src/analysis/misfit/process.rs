//! The likelihood of a process with exponential correlation, and what it makes of a least-squares fit.

use std::ops::Range;

use brdfit_core::real::Real;
use rayon::prelude::*;

use crate::until::until;

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

/// One process that the residuals may be of.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The process.
    pub process: Process,
    /// Its share of the likelihood of all.
    pub weight: f64,
    /// ln of its likelihood over that of independence.
    pub evidence: f64,
    /// Its variance, in units of that of the residuals.
    pub variance: f64,
    /// Covariance of the fit, in the coordinates of the rows: 1 for independent residuals.
    pub covariance: Vec<Vec<f64>>,
}

/// Parts of the variance that are correlated.
const PARTS: [f64; 9] = [0.1, 0.25, 0.45, 0.65, 0.8, 0.9, 0.96, 0.99, 0.999];
/// Those that are looked at first, with every second length.
const FIRST: [f64; 3] = [0.25, 0.65, 0.96];
/// Before the scan is seen a length x times another is likelier by x to this power: short scans tell less of long ones than there is.
const LONGER: f64 = 0.25;
/// A correlation between lines below this is none.
const LEAST_COMMON: f64 = 0.1;
/// No process is longer than this part of a line: beyond, it is a factor of all values, of which residuals say nothing.
const LONGEST: f64 = 0.34;
/// From so many residuals on the threads of the pool share the processes.
const MANY: usize = 4096;
/// (1 + x) exp(-x) is 1/e here.
const SMOOTH: f64 = 2.146_193_220_620_582_6;

/// A process with ln of its likelihood and the variance that fits best.
type Judged = (Process, (f64, f64));

/// The likeliest process; `None` if none is more likely than independence by a factor of e^`evidence`.
pub fn likeliest(all: &Residuals, degrees_of_freedom: usize, evidence: f64) -> Option<Process> {
    let list = judged(all, &lengths(all)?, degrees_of_freedom, evidence)?;
    let best = list.iter().max_by(|(_, (a, _)), (_, (b, _))| a.total_cmp(b))?;
    Some(best.0)
}

/// All processes of these lengths, and independence at their end; `None` if none of a few is more likely than that by a factor of e^`evidence`.
fn judged(all: &Residuals, lengths: &[f64], degrees_of_freedom: usize, evidence: f64) -> Option<Vec<Judged>> {
    let degrees = degrees_of_freedom as f64;
    let independent = Process {
        length: f64::MIN_POSITIVE,
        part: 0.0,
        smooth: false,
    };
    let processes = |step: usize, parts: &[f64]| -> Vec<Process> {
        let of = |length: f64| parts.iter().map(move |&part| (length, part));
        let pairs = lengths.iter().step_by(step).flat_map(|&length| of(length));
        let both = pairs.flat_map(|(length, part)| [false, true].map(|smooth| Process { length, part, smooth }));
        both.collect()
    };
    // Of a long scan this takes seconds; what it says once it is not wanted is thrown away.
    let until = until();
    let one = |process: Process| match until.is_over() {
        true => (process, (f64::NEG_INFINITY, f64::NAN)),
        false => (process, likelihood(all, process, degrees)),
    };
    let judged_all = |processes: Vec<Process>| -> Vec<Judged> {
        match all.values.len() < MANY {
            true => processes.into_iter().map(one).collect(),
            false => processes.into_par_iter().map(one).collect(),
        }
    };
    let null = one(independent);
    let first = judged_all(processes(2, &FIRST));
    let most = first.iter().map(|(_, (ln, _))| *ln).fold(f64::NEG_INFINITY, f64::max);
    if !(most > null.1.0 + evidence) {
        return None;
    }
    let mut list = judged_all(processes(1, &PARTS));
    list.push(null);
    Some(list)
}

/// The processes that count, of shares above 1e-4; `None` if none is more likely than independence by a factor of e^`evidence`, or if nobody waits for them any more.
pub fn nodes(all: &Residuals, degrees_of_freedom: usize, evidence: f64) -> Option<Vec<Node>> {
    let lengths = lengths(all)?;
    let list = judged(all, &lengths, degrees_of_freedom, evidence)?;
    // Independence counts as much as all else together.
    let others = Real::portable_ln(list.len() as f64 - 1.0);
    let best = list.iter().map(|(_, (ln, _))| *ln).fold(f64::NEG_INFINITY, f64::max);
    let independent = list.last()?.1.0;
    let share = |(process, (ln, _)): &Judged| {
        let more = match process.part {
            0.0 => others,
            _ => LONGER * Real::portable_ln(process.length / lengths[0]),
        };
        Real::portable_exp(ln - best + more)
    };
    let total: f64 = list.iter().map(share).sum();
    let kept: Vec<_> = list.iter().filter(|one| share(one) > 1e-4 * total).collect();
    let until = until();
    if until.is_over() {
        return None;
    }
    let common = Common::new(all);
    let total: f64 = kept.iter().map(|one| share(one)).sum();
    let node = |one: &&Judged| Node {
        process: one.0,
        weight: share(one) / total,
        evidence: one.1.0 - independent,
        variance: one.1.1,
        covariance: common.covariance(all, one.0, one.1.1),
    };
    kept.iter().map(|one| (!until.is_over()).then(|| node(one))).collect()
}

/// Lengths from a step to a part of the longest line, each 1.6 times the last; `None` without lines of two.
fn lengths(all: &Residuals) -> Option<Vec<f64>> {
    let step = step_of(all)?;
    let span = all.lines().filter(|line| !line.is_empty());
    let span = span.map(|line| all.angles[line.end - 1] - all.angles[line.start]);
    let most = LONGEST * span.fold(0.0, f64::max);
    let grown = std::iter::successors(Some(0.7 * step), |length| Some(1.6 * length));
    Some(grown.take_while(|&length| length <= most).collect())
}

/// The median angle between neighbours.
fn step_of(all: &Residuals) -> Option<f64> {
    let pairs = all.lines().flat_map(|line| all.angles[line].windows(2));
    let mut steps: Vec<f64> = pairs.map(|pair| pair[1] - pair[0]).filter(|&step| step > 0.0).collect();
    let middle = steps.len() / 2;
    (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// ln of the restricted likelihood of the residuals, but for a constant, and the variance that fits best; `degrees` is their number less that of the columns.
///
/// Kalman's filter gives what each sample brings anew, for the residuals and each column of J alike: the state is the process and its slope times its length.
pub fn likelihood(all: &Residuals, process: Process, degrees: f64) -> (f64, f64) {
    let columns = all.columns;
    let part = process.part;
    let mut sums = vec![vec![0.0; columns + 1]; columns + 1];
    let mut ln_determinant = 0.0;
    let mut state = vec![[0.0; 2]; columns + 1];
    let mut fresh = vec![0.0; columns + 1];
    for line in all.lines() {
        state.fill([0.0; 2]);
        // What the variance of the state is less than at rest.
        let mut known = [0.0; 3];
        let mut before: Option<f64> = None;
        for place in line {
            let (angle, row) = (all.angles[place], all.row(place));
            let step = before.map_or([[0.0; 2]; 2], |before| step(angle - before, process));
            before = Some(angle);
            let [[a, b], [c, d]] = step;
            known = [
                a * a * known[0] + 2.0 * a * b * known[1] + b * b * known[2],
                a * c * known[0] + (a * d + b * c) * known[1] + b * d * known[2],
                c * c * known[0] + 2.0 * c * d * known[1] + d * d * known[2],
            ];
            let variance = [part - known[0], -known[1]];
            let total = variance[0] + 1.0 - part;
            ln_determinant += Real::portable_ln(total);
            let gain = variance.map(|x| x / total);
            let column = |k: usize| if k == columns { all.values[place] } else { row[k] };
            for k in 0..=columns {
                let [value, slope] = state[k];
                let (value, slope) = (a * value + b * slope, c * value + d * slope);
                fresh[k] = column(k) - value;
                state[k] = [value + gain[0] * fresh[k], slope + gain[1] * fresh[k]];
            }
            for i in 0..=columns {
                for j in 0..=i {
                    sums[i][j] += fresh[i] * fresh[j] / total;
                }
            }
            known[0] += gain[0] * variance[0];
            known[1] += gain[0] * variance[1];
            known[2] += gain[1] * variance[1];
        }
    }
    for i in 0..=columns {
        for j in 0..i {
            sums[j][i] = sums[i][j];
        }
    }
    // The last row of the root of all sums holds what of the residuals is beyond J.
    let root = cholesky(&sums);
    let ln_columns: f64 = (0..columns).map(|k| 2.0 * Real::portable_ln(root[k][k])).sum();
    let rest = root[columns][columns] * root[columns][columns];
    let ln = -0.5 * (degrees * Real::portable_ln(rest) + ln_determinant + ln_columns);
    (ln, rest / degrees)
}

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

/// What all lines have in common: a misfit of the model is alike at equal angles from the specular direction.
pub struct Common {
    /// All places in order of their offset; none where there is one line.
    merged: Vec<usize>,
    /// Correlation of residuals of different lines at the same offset, at least 0.
    pub correlation: f64,
}

impl Common {
    /// Of these lines.
    pub fn new(all: &Residuals) -> Self {
        let mut common = Common {
            merged: Vec::new(),
            correlation: 0.0,
        };
        if all.ends.len() < 2 {
            return common;
        }
        let mut line_of = vec![0; all.values.len()];
        for (number, line) in all.lines().enumerate() {
            line_of[line].fill(number);
        }
        common.merged.extend(0..all.values.len());
        common
            .merged
            .sort_unstable_by(|&a, &b| all.offsets[a].total_cmp(&all.offsets[b]).then(a.cmp(&b)));
        let near = 0.5 * step_of(all).unwrap_or(0.0) + 1e-9;
        let mut sums = [0.0; 3];
        for (place, &a) in common.merged.iter().enumerate() {
            let others = common.merged[place + 1..].iter();
            let others = others.take_while(|&&b| all.offsets[b] - all.offsets[a] <= near);
            for &b in others.filter(|&&b| line_of[b] != line_of[a]) {
                let (x, y) = (all.values[a], all.values[b]);
                let pairs = [x * y, x * x, y * y];
                sums.iter_mut().zip(pairs).for_each(|(sum, pair)| *sum += pair);
            }
        }
        let correlation = sums[0] / Real::sqrt(sums[1] * sums[2]);
        common.correlation = if correlation > LEAST_COMMON { correlation } else { 0.0 };
        common
    }

    /// The sandwich of the least-squares fit.
    pub fn covariance(&self, all: &Residuals, process: Process, variance: f64) -> Vec<Vec<f64>> {
        let own = covariance(all, process, variance);
        if self.correlation == 0.0 || process.part == 0.0 {
            return own;
        }
        // The noise of each sample is in no other line.
        let part = (self.correlation / process.part).min(1.0);
        let mut sums = Sandwich::new(all, &all.offsets, process);
        sums.add(self.merged.iter().copied());
        let together = sums.times(variance);
        let both = own.iter().zip(&together);
        both.map(|(own, all)| own.iter().zip(all).map(|(own, all)| own + part * (all - own)).collect())
            .collect()
    }
}

/// The sandwich of the least-squares fit where lines have nothing in common.
pub fn covariance(all: &Residuals, process: Process, variance: f64) -> Vec<Vec<f64>> {
    let mut sums = Sandwich::new(all, &all.angles, process);
    all.lines().for_each(|line| sums.add(line));
    sums.times(variance)
}

/// The sum of J'VJ, line by line.
struct Sandwich<'a> {
    all: &'a Residuals,
    angles: &'a [f64],
    process: Process,
    sums: Vec<Vec<f64>>,
}

impl<'a> Sandwich<'a> {
    fn new(all: &'a Residuals, angles: &'a [f64], process: Process) -> Self {
        Sandwich {
            all,
            angles,
            process,
            sums: vec![vec![0.0; all.columns]; all.columns],
        }
    }

    /// Adds a line, whose angles ascend.
    fn add(&mut self, line: impl Iterator<Item = usize>) {
        let columns = self.all.columns;
        // The rows before, by their correlation with the next, and by its change.
        let mut before = vec![[0.0; 2]; columns];
        let mut last: Option<usize> = None;
        for place in line {
            if let Some(last) = last {
                // The correlation over x is the first row of the step; with a row more it is that of the sum.
                let [[a, b], [c, d]] = step(self.angles[place] - self.angles[last], self.process);
                for (sum, row) in before.iter_mut().zip(self.all.row(last)) {
                    let [value, slope] = [sum[0] + row, sum[1]];
                    *sum = [a * value + b * slope, c * value + d * slope];
                }
            }
            last = Some(place);
            let row = self.all.row(place);
            for i in 0..columns {
                for j in 0..columns {
                    let crossed = row[i] * before[j][0] + before[i][0] * row[j];
                    self.sums[i][j] += row[i] * row[j] + self.process.part * crossed;
                }
            }
        }
    }

    fn times(&self, variance: f64) -> Vec<Vec<f64>> {
        let row = |row: &Vec<f64>| row.iter().map(|x| variance * x).collect();
        self.sums.iter().map(row).collect()
    }
}

/// The lower triangle whose product with its transpose is a symmetric matrix without negative eigenvalues; a pivot that rounding takes below 0 is a small one.
pub fn cholesky(a: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let count = a.len();
    let mut root = vec![vec![0.0; count]; count];
    for i in 0..count {
        for j in 0..=i {
            let rest = a[i][j] - (0..j).map(|k| root[i][k] * root[j][k]).sum::<f64>();
            root[i][j] = if i == j {
                Real::sqrt(rest.max(f64::EPSILON * a[i][i]).max(f64::MIN_POSITIVE))
            } else {
                rest / root[j][j]
            };
        }
    }
    root
}
