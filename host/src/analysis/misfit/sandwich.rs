//! What a process makes of the covariance of a least-squares fit.

use brdfit_core::real::Real;

use super::crossed::crossed;
use super::lanes::TOGETHER;
use super::process::{Process, Residuals};
use crate::engine::Values;
use crate::until::until;

/// A correlation between lines below this is none.
const LEAST_COMMON: f64 = 0.1;

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
        let near = 0.5 * all.step().unwrap_or(0.0) + 1e-9;
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

    /// The sandwiches of the least-squares fit for these processes and their variances, each row by row; `None` if nobody waits for them any more.
    pub fn covariances(&self, all: &Residuals, processes: &[(Process, f64)]) -> Option<Vec<Vec<f64>>> {
        let mut list = Vec::with_capacity(processes.len());
        self.each(all, processes, |covariance| list.push(covariance.to_vec()))?;
        Some(list)
    }

    /// Calls `take` with each of them in turn.
    pub fn each(&self, all: &Residuals, processes: &[(Process, f64)], mut take: impl FnMut(&[f64])) -> Option<()> {
        let until = until();
        let own = squared(all);
        // Of processes that differ in their part alone the sums are the same.
        let alike = |a: &Process, b: &Process| (a.length, a.smooth) == (b.length, b.smooth);
        let mut shapes: Vec<Process> = Vec::new();
        for (process, _) in processes.iter().filter(|(process, _)| process.part != 0.0) {
            // They come length by length.
            if !shapes.iter().rev().any(|shape| alike(shape, process)) {
                shapes.push(*process);
            }
        }
        let mut sums = Vec::with_capacity(shapes.len().div_ceil(TOGETHER));
        for shapes in shapes.chunks(TOGETHER) {
            if until.is_over() {
                return None;
            }
            let among = (self.correlation != 0.0).then(|| crossed(all, &all.offsets, Some(&self.merged), shapes));
            sums.push((crossed(all, &all.angles, None, shapes), among));
        }
        let columns = all.columns;
        let mut covariance = own.clone();
        for &(process, variance) in processes {
            if until.is_over() {
                return None;
            }
            if process.part == 0.0 {
                for (to, own) in covariance.iter_mut().zip(&own) {
                    *to = variance * own;
                }
                take(&covariance);
                continue;
            }
            let place = shapes.iter().position(|shape| alike(shape, &process))?;
            let ((within, among), lane) = (&sums[place / TOGETHER], place % TOGETHER);
            // The noise of each sample is in no other line.
            let part = (self.correlation / process.part).min(1.0);
            for i in 0..columns {
                for j in 0..=i {
                    let at = i * (i + 1) / 2 + j;
                    let within = within[at].0[lane];
                    let among = among.as_ref().map_or(0.0, |among| part * (among[at].0[lane] - within));
                    let entry = variance * (own[i * columns + j] + process.part * (within + among));
                    (covariance[i * columns + j], covariance[j * columns + i]) = (entry, entry);
                }
            }
            take(&covariance);
        }
        Some(())
    }
}

/// The sandwich of the least-squares fit where lines have nothing in common, row by row.
pub fn covariance(all: &Residuals, process: Process, variance: f64) -> Vec<f64> {
    let crossed = crossed(all, &all.angles, None, &[process]);
    let (columns, mut sums) = (all.columns, squared(all));
    for (place, sum) in sums.iter_mut().enumerate() {
        let (i, j) = (place / columns, place % columns);
        let (i, j) = (i.max(j), i.min(j));
        *sum = variance * (*sum + process.part * crossed[i * (i + 1) / 2 + j].0[0]);
    }
    sums
}

/// J'J, row by row.
fn squared(all: &Residuals) -> Vec<f64> {
    let columns = all.columns;
    let mut sums = vec![0.0; columns * columns];
    for row in all.rows.chunks_exact(columns) {
        for (sums, x) in sums.chunks_exact_mut(columns).zip(row) {
            sums.iter_mut().zip(row).for_each(|(sum, y)| *sum += x * y);
        }
    }
    sums
}

/// The axes in these places become those of this covariance, which is in coordinates along them.
pub fn turn(axes: &mut [Values], places: &[usize], covariance: &[Vec<f64>]) {
    let root = cholesky(covariance);
    let old: Vec<Values> = places.iter().map(|&place| axes[place]).collect();
    for (i, &place) in places.iter().enumerate() {
        axes[place] = Values::from_fn(axes[place].len(), |k| {
            // Columns of the root: the covariance is root root'.
            (i..old.len()).map(|j| root[j][i] * old[j][k]).sum()
        });
    }
}

/// The lower triangle whose product with its transpose is a symmetric matrix without negative eigenvalues; a pivot that rounding takes below 0 is a small one.
fn cholesky(a: &[Vec<f64>]) -> Vec<Vec<f64>> {
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
