//! The sums that a sandwich is made of, for several processes side by side.

use super::lanes::{Falls, Lanes};
use super::process::{Process, Residuals};
use crate::engine::simd::{NullaryFnOnce, Simd};

/// J'(C - 1)J with the correlations C of each of up to as many processes as [`Lanes`] has, without noise of samples, whose part does not count: its lower triangle, row by row.
///
/// Angles ascend along each line; the lines are those of the residuals, or all in one, in the order of `merged`.
pub fn crossed(all: &Residuals, angles: &[f64], merged: Option<&[usize]>, processes: &[Process]) -> Vec<Lanes> {
    Simd::best().run(Crossed {
        all,
        angles,
        merged,
        falls: Falls::of(processes),
    })
}

/// The sum of both orders of each two rows of a line times their correlation.
struct Crossed<'a> {
    all: &'a Residuals,
    angles: &'a [f64],
    merged: Option<&'a [usize]>,
    falls: Falls,
}

impl NullaryFnOnce for Crossed<'_> {
    type Output = Vec<Lanes>;

    #[inline(always)]
    fn call(self) -> Vec<Lanes> {
        let zero = Lanes::splat(0.0);
        let columns = self.all.columns;
        let mut sums = vec![zero; columns * (columns + 1) / 2];
        // The rows before, by their correlation with the next, and by its change.
        let mut before = vec![[zero; 2]; columns];
        match self.merged {
            Some(merged) => self.add(merged.iter().copied(), &mut before, &mut sums),
            None => {
                for line in self.all.lines() {
                    before.fill([zero; 2]);
                    self.add(line, &mut before, &mut sums);
                }
            }
        }
        sums
    }
}

impl Crossed<'_> {
    /// Adds those of a line.
    #[inline(always)]
    fn add(&self, line: impl Iterator<Item = usize>, before: &mut [[Lanes; 2]], sums: &mut [Lanes]) {
        let mut last: Option<usize> = None;
        for place in line {
            if let Some(last) = last {
                // The correlation over x is the first row of the step; with a row more it is that of the sum.
                let [[a, b], [c, d]] = self.step(self.angles[place] - self.angles[last]);
                let row = self.all.row(last);
                for k in 0..self.all.columns {
                    let [sum, slope] = before[k];
                    let value = sum + row[k];
                    before[k] = [a * value + b * slope, c * value + d * slope];
                }
            }
            last = Some(place);
            let row = self.all.row(place);
            let mut place = 0;
            for i in 0..self.all.columns {
                for k in 0..=i {
                    sums[place] = sums[place] + (before[k][0] * row[i] + before[i][0] * row[k]);
                    place += 1;
                }
            }
        }
    }

    /// [`super::process::step`] of each, with its bits.
    #[inline(always)]
    fn step(&self, angle: f64) -> [[Lanes; 2]; 2] {
        let (x, e) = self.falls.over(angle);
        let pick = |smooth, rough| self.falls.pick(smooth, rough);
        let zero = Lanes::splat(0.0);
        let [more, less] = [x.map(|x| 1.0 + x), x.map(|x| 1.0 - x)];
        [
            [pick(e * more, e), pick(e * x, zero)],
            [pick((e * x).map(|x| -x), zero), pick(e * less, zero)],
        ]
    }
}
