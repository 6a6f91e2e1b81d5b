//! The likelihood of a process, given what a least-squares fit leaves.

use brdfit_core::real::Real;

use super::lanes::{Falls, Lanes, TOGETHER, each};
use super::process::{Process, Residuals};
use crate::engine::simd::{NullaryFnOnce, Simd};

/// For each process ln of the restricted likelihood of the residuals, but for a constant, and the variance that fits best; `degrees` is their number less that of the columns.
///
/// Kalman's filter gives what each sample brings anew, for the residuals and each column of J alike: the state is the process and its slope times its length.
pub fn likelihoods(all: &Residuals, processes: &[Process], degrees: f64) -> Vec<(f64, f64)> {
    let simd = Simd::best();
    let one = |processes: &[Process]| {
        let [ln_determinant, ln_columns, rest] = simd.run(Filter {
            all,
            falls: Falls::of(processes),
            part: each(processes, |process| process.part),
        });
        let of = move |k: usize| {
            let ln = -0.5 * (degrees * Real::portable_ln(rest.0[k]) + ln_determinant.0[k] + ln_columns.0[k]);
            (ln, rest.0[k] / degrees)
        };
        (0..processes.len()).map(of)
    };
    processes.chunks(TOGETHER).flat_map(one).collect()
}

/// Gives ln of the determinants of V and of J'V^-1 J, and what of the squares of the residuals is beyond J.
struct Filter<'a> {
    all: &'a Residuals,
    falls: Falls,
    part: Lanes,
}

impl NullaryFnOnce for Filter<'_> {
    type Output = [Lanes; 3];

    #[inline(always)]
    fn call(self) -> [Lanes; 3] {
        let zero = Lanes::splat(0.0);
        let columns = self.all.columns;
        // The lower triangle, row by row.
        let mut sums = vec![zero; (columns + 1) * (columns + 2) / 2];
        let mut ln_determinant = zero;
        let mut state = vec![[zero; 2]; columns + 1];
        let mut fresh = vec![zero; columns + 1];
        for line in self.all.lines() {
            state.fill([zero; 2]);
            // What the variance of the state is less than at rest.
            let mut known = [zero; 3];
            let mut before: Option<f64> = None;
            for place in line {
                let (angle, row) = (self.all.angles[place], self.all.row(place));
                let [[a, b], [c, d]] = match before {
                    Some(before) => self.step(angle - before),
                    None => [[zero; 2]; 2],
                };
                before = Some(angle);
                known = [
                    a * a * known[0] + a * b * known[1] * 2.0 + b * b * known[2],
                    a * c * known[0] + (a * d + b * c) * known[1] + b * d * known[2],
                    c * c * known[0] + c * d * known[1] * 2.0 + d * d * known[2],
                ];
                let variance = [self.part - known[0], zero - known[1]];
                let total = variance[0] + 1.0 - self.part;
                ln_determinant = ln_determinant + total.ln();
                let per_total = total.map(|total| 1.0 / total);
                let gain = [variance[0] * per_total, variance[1] * per_total];
                // Iterators side by side would be calls here, a million for a scan.
                for k in 0..=columns {
                    let measured = if k == columns { self.all.values[place] } else { row[k] };
                    let [value, slope] = state[k];
                    let (at, by) = (a * value + b * slope, c * value + d * slope);
                    fresh[k] = Lanes::splat(measured) - at;
                    state[k] = [at + gain[0] * fresh[k], by + gain[1] * fresh[k]];
                }
                for i in 0..=columns {
                    let x = fresh[i] * per_total;
                    let sums = &mut sums[at(i, 0)..=at(i, i)];
                    for j in 0..=i {
                        sums[j] = sums[j] + x * fresh[j];
                    }
                }
                known[0] = known[0] + gain[0] * variance[0];
                known[1] = known[1] + gain[0] * variance[1];
                known[2] = known[2] + gain[1] * variance[1];
            }
        }
        let (ln_columns, rest) = eliminated(&mut sums, columns);
        [ln_determinant, ln_columns, rest]
    }
}

impl Filter<'_> {
    /// [`super::process::step`] of each.
    #[inline(always)]
    fn step(&self, angle: f64) -> [[Lanes; 2]; 2] {
        let (x, e) = self.falls.over(angle);
        let (zero, slope) = (Lanes::splat(0.0), e * x);
        [
            [self.falls.pick(e + slope, e), self.falls.pick(slope, zero)],
            [self.falls.pick(zero - slope, zero), self.falls.pick(e - slope, zero)],
        ]
    }
}

/// ln of the determinant of all but the last row and column of symmetric matrices, and what elimination leaves of the last; a pivot that rounding takes below 0 is a small one.
#[inline(always)]
fn eliminated(lower: &mut [Lanes], columns: usize) -> (Lanes, Lanes) {
    let mut ln = Lanes::splat(0.0);
    for k in 0..columns {
        let pivot = pivot(lower, k);
        lower[at(k, k)] = pivot;
        ln = ln + pivot.ln();
        for i in k + 1..=columns {
            let mut rest = lower[at(i, k)];
            for j in 0..k {
                rest = rest - lower[at(i, j)] * lower[at(k, j)] / lower[at(j, j)];
            }
            lower[at(i, k)] = rest;
        }
    }
    (ln, pivot(lower, columns))
}

/// What elimination of the rows before leaves of a diagonal.
#[inline(always)]
fn pivot(lower: &[Lanes], k: usize) -> Lanes {
    let whole = lower[at(k, k)];
    let mut rest = whole;
    for j in 0..k {
        rest = rest - lower[at(k, j)] * lower[at(k, j)] / lower[at(j, j)];
    }
    rest.zip(whole, |rest, whole| {
        Real::max(Real::max(rest, f64::EPSILON * whole), f64::MIN_POSITIVE)
    })
}

/// Where an entry of a lower triangle is.
#[inline(always)]
fn at(i: usize, j: usize) -> usize {
    i * (i + 1) / 2 + j
}
