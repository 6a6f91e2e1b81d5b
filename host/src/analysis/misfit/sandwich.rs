//! What a process makes of the covariance of a least-squares fit.

use brdfit_core::real::Real;

use super::process::{Process, Residuals, step};
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

    /// The sandwiches of the least-squares fit for these processes and their variances; `None` if nobody waits for them any more.
    pub fn covariances(&self, all: &Residuals, processes: &[(Process, f64)]) -> Option<Vec<Vec<Vec<f64>>>> {
        let mut list = Vec::with_capacity(processes.len());
        self.each(all, processes, |covariance| list.push(covariance.to_vec()))?;
        Some(list)
    }

    /// Calls `take` with each of them in turn.
    pub fn each(&self, all: &Residuals, processes: &[(Process, f64)], mut take: impl FnMut(&[Vec<f64>])) -> Option<()> {
        let until = until();
        let own = squared(all);
        // Of processes that differ in their part alone the sums are the same.
        let mut known: Vec<(Process, Meat)> = Vec::new();
        let mut covariance = own.clone();
        for &(process, variance) in processes {
            if until.is_over() {
                return None;
            }
            if process.part == 0.0 {
                for (to, own) in covariance.iter_mut().flatten().zip(own.iter().flatten()) {
                    *to = variance * own;
                }
                take(&covariance);
                continue;
            }
            let alike = |(other, _): &(Process, Meat)| (other.length, other.smooth) == (process.length, process.smooth);
            let place = known.iter().position(alike);
            let place = place.unwrap_or_else(|| {
                known.push((process, self.meat(all, process)));
                known.len() - 1
            });
            let meat = &known[place].1;
            // The noise of each sample is in no other line.
            let part = (self.correlation / process.part).min(1.0);
            for (i, row) in covariance.iter_mut().enumerate() {
                for (j, to) in row.iter_mut().enumerate() {
                    let within = meat.within[i][j];
                    let among = meat.among.as_ref().map_or(0.0, |among| part * (among[i][j] - within));
                    *to = variance * (own[i][j] + process.part * (within + among));
                }
            }
            take(&covariance);
        }
        Some(())
    }

    fn meat(&self, all: &Residuals, process: Process) -> Meat {
        Meat {
            within: crossed(all, &all.angles, process, all.lines()),
            among: (self.correlation != 0.0)
                .then(|| crossed(all, &all.offsets, process, [self.merged.iter().copied()])),
        }
    }
}

/// J'(C - 1)J with the correlations C of a process without noise of samples.
struct Meat {
    /// Of lines that have nothing in common.
    within: Vec<Vec<f64>>,
    /// Of lines that are alike at equal offsets.
    among: Option<Vec<Vec<f64>>>,
}

/// The sandwich of the least-squares fit where lines have nothing in common.
pub fn covariance(all: &Residuals, process: Process, variance: f64) -> Vec<Vec<f64>> {
    let crossed = crossed(all, &all.angles, process, all.lines());
    let mut sums = squared(all);
    for (sum, crossed) in sums.iter_mut().flatten().zip(crossed.iter().flatten()) {
        *sum = variance * (*sum + process.part * crossed);
    }
    sums
}

/// J'J.
fn squared(all: &Residuals) -> Vec<Vec<f64>> {
    let mut sums = vec![vec![0.0; all.columns]; all.columns];
    for row in all.rows.chunks_exact(all.columns) {
        for (sums, x) in sums.iter_mut().zip(row) {
            sums.iter_mut().zip(row).for_each(|(sum, y)| *sum += x * y);
        }
    }
    sums
}

/// The sum of both orders of each two rows of a line, whose angles ascend, times their correlation.
fn crossed<L: IntoIterator<Item = usize>>(
    all: &Residuals,
    angles: &[f64],
    process: Process,
    lines: impl IntoIterator<Item = L>,
) -> Vec<Vec<f64>> {
    let columns = all.columns;
    let mut sums = vec![vec![0.0; columns]; columns];
    // The rows before, by their correlation with the next, and by its change.
    let mut before = vec![[0.0; 2]; columns];
    for line in lines {
        before.fill([0.0; 2]);
        let mut last: Option<usize> = None;
        for place in line {
            if let Some(last) = last {
                // The correlation over x is the first row of the step; with a row more it is that of the sum.
                let [[a, b], [c, d]] = step(angles[place] - angles[last], process);
                for (sum, row) in before.iter_mut().zip(all.row(last)) {
                    let [value, slope] = [sum[0] + row, sum[1]];
                    *sum = [a * value + b * slope, c * value + d * slope];
                }
            }
            last = Some(place);
            let row = all.row(place);
            for i in 0..columns {
                for j in 0..=i {
                    sums[i][j] += row[i] * before[j][0] + before[i][0] * row[j];
                }
            }
        }
    }
    mirrored(sums)
}

/// A symmetric matrix of which the lower triangle is known.
fn mirrored(mut matrix: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    for i in 0..matrix.len() {
        for j in 0..i {
            matrix[j][i] = matrix[i][j];
        }
    }
    matrix
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
