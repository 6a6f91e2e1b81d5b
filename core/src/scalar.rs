//! Passes where lanes do not go side by side: row after row, and one partial sum after the other, so that few are in memory; the same bits from less code.
//!
//! One code makes all passes, whatever they sum: the row takes most of it.

use crate::geometry::{Block, LANES};
use crate::lm::Linearization;
use crate::model::{GROUP, Model, SUMS, Want};
use crate::real::Real;
use crate::residuals::Residuals;

/// So many parts of a sum wait at most for the one that they are added to.
const PARTS: usize = SUMS.ilog2() as usize + 1;

impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> Residuals<'_, R, M, P, C> {
    /// [`crate::lm::Problem::cost`], one lane after the other.
    pub fn scalar_cost(&self, x: &[R; P]) -> R {
        self.scalar_sums(x, Want::Value).cost
    }

    /// [`Residuals::inlined_totals`], one lane after the other.
    pub fn scalar_totals(&self, x: &[R; P]) -> [R; 3] {
        let sums = self.scalar_sums(x, Want::Value);
        let first = |row: &[R; P]| row.first().copied().unwrap_or(R::ZERO);
        [
            sums.cost,
            first(&sums.gradient),
            sums.hessian.first().map_or(R::ZERO, first),
        ]
    }

    /// [`crate::lm::Problem::linearize`], one lane after the other.
    pub fn scalar_linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        self.scalar_sums(x, Want::Gradient)
    }

    /// The sums over all rows, in the order of [`crate::residuals::total`]: of the squares of the residuals, with the weights as the one column of J; of these with J'r and J'J; or the normal equations of the weights (`candidate.rs`).
    pub(crate) fn scalar_sums(&self, x: &[R; P], want: Want) -> Linearization<R, P> {
        let pass = M::pass(x);
        let columns = match want {
            Want::Value => 1,
            Want::Gradient => P,
            Want::Columns => Self::WEIGHTS_END,
        };
        let mut parts = [Linearization::zero(); PARTS];
        let mut place = 0;
        for lane in 0..SUMS {
            if let Some(part) = parts.get_mut(place) {
                self.partial(&pass, lane, want, columns, part);
            }
            for _ in 0..lane.trailing_ones() {
                place -= 1;
                if let [sum, part, ..] = parts.get_mut(place..).unwrap_or_default() {
                    add(sum, part, columns);
                }
            }
            place += 1;
        }
        let [mut sums, ..] = parts;
        for i in 0..P {
            for j in 0..i {
                sums.hessian[j][i] = sums.hessian[i][j];
            }
        }
        sums
    }

    /// The sums over one of the first eight lanes, and its other half, of all blocks; of J'J the lower half.
    #[inline(never)]
    fn partial(&self, pass: &M::Pass, lane: usize, want: Want, columns: usize, sums: &mut Linearization<R, P>) {
        *sums = Linearization::zero();
        let mut rows = [[R::ZERO; P]; GROUP];
        for block in self.blocks() {
            let mut residuals = [R::ZERO; GROUP];
            for (half, (residual, row)) in residuals.iter_mut().zip(&mut rows).enumerate() {
                *residual = Self::scalar_row(pass, block, (lane + half * SUMS) % LANES, want, row);
            }
            sums.cost += residuals[0] * residuals[0] + residuals[1] * residuals[1];
            add_rows(sums, &rows, &residuals, columns);
        }
    }

    /// Residual of one lane, and its derivatives if they are wanted; or what the weights are fitted by.
    #[inline(always)]
    fn scalar_row(pass: &M::Pass, block: &Block<R, LANES, C>, lane: usize, want: Want, row: &mut [R; P]) -> R {
        let ln_f = M::row(pass, block, lane, want, row);
        let weight = block.weight[lane];
        if want == Want::Columns {
            let unit = weight * (-block.ln_f[lane]).portable_exp();
            for column in row.iter_mut().take(Self::WEIGHTS_END) {
                *column *= unit;
            }
            return weight;
        }
        if want == Want::Value
            && let Some(column) = row.first_mut()
        {
            *column = weight;
        }
        (ln_f - block.ln_f[lane]) * weight
    }
}

/// Adds the products of two rows, of which so many columns count.
#[cfg_attr(target_os = "none", inline(never))]
fn add_rows<R: Real, const P: usize>(
    sums: &mut Linearization<R, P>,
    [a, b]: &[[R; P]; GROUP],
    residuals: &[R; GROUP],
    columns: usize,
) {
    for i in 0..P {
        if i >= columns {
            break;
        }
        let (x, y) = (a[i], b[i]);
        sums.gradient[i] += x * residuals[0] + y * residuals[1];
        if let (Some(line), Some(u), Some(v)) = (sums.hessian[i].get_mut(..=i), a.get(..=i), b.get(..=i)) {
            for (sum, (&u, &v)) in line.iter_mut().zip(u.iter().zip(v)) {
                *sum += x * u + y * v;
            }
        }
    }
}

/// Adds a part of the sums with so many columns.
#[cfg_attr(target_os = "none", inline(never))]
fn add<R: Real, const P: usize>(sums: &mut Linearization<R, P>, part: &Linearization<R, P>, columns: usize) {
    sums.cost += part.cost;
    let lines = sums.gradient.iter_mut().zip(&mut sums.hessian);
    for ((gradient, line), (&of_gradient, of_line)) in lines.zip(part.gradient.iter().zip(&part.hessian)).take(columns)
    {
        *gradient += of_gradient;
        for (sum, &of_sum) in line.iter_mut().zip(of_line) {
            *sum += of_sum;
        }
    }
}
