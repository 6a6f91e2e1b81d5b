//! Good starts for a scan: (m, n, kappa) spread evenly, and the weights that fit best there.

use crate::boxqp;
use crate::brdf::{Brdf, has, lobes, slot};
use crate::geometry::LANES;
use crate::lm::Bounds;
use crate::real::Real;
use crate::residuals::{GROUP, SUMS, Scan, accumulate, total};
use crate::search::{Candidate, Scene};
use crate::start;

impl<R: Real, const TERMS: u8, const P: usize> Scene<R, P> for Scan<'_, R, TERMS, P> {
    /// Candidate `i`: m, n and kappa spread evenly over the logarithm of their ranges, then the weights that fit best.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn candidate(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, like: Option<&[R; P]>) -> Candidate<R, P> {
        let mut x = bounds.lower;
        let u = start::even::<R, 3>(seed, i);
        if has(TERMS, 3) {
            let k = slot(TERMS, 3);
            if let Some(like) = like {
                x[k] = like[k];
            } else {
                x[k] = log_between(
                    bounds.lower[k].max(self.finest).min(bounds.upper[k]),
                    bounds.upper[k].min(R::of(3.0)).max(bounds.lower[k]),
                    u[0],
                );
            }
        }
        if has(TERMS, 4) {
            let k = slot(TERMS, 4);
            x[k] = log_between(
                bounds.lower[k],
                bounds.upper[k].min(R::of(10.0)).max(bounds.lower[k]),
                u[1],
            );
        }
        if has(TERMS, 5) {
            let k = slot(TERMS, 5);
            // A third of them without absorption, the others with kappa from 0.03 to 10.
            let third = R::of(1.0 / 3.0);
            x[k] = if u[2] < third {
                bounds.lower[k]
            } else {
                let u = (u[2] - third) * R::of(1.5);
                log_between(
                    bounds.lower[k].max(R::of(1e-3)),
                    bounds.upper[k].min(R::of(100.0)).max(R::of(1e-3)),
                    u,
                )
            };
        }
        let rank = match lobes(TERMS) {
            0 => self.set_weights::<0>(&mut x, bounds),
            1 => self.set_weights::<GROUP>(&mut x, bounds),
            _ => self.set_weights::<{ 2 * GROUP }>(&mut x, bounds),
        };
        Candidate {
            x: bounds.clamp(x),
            rank,
        }
    }
}

impl<R: Real, const TERMS: u8, const P: usize> Scan<'_, R, TERMS, P> {
    /// Sets rho_d, rho_s and rho_v to the least squares of f / f_measured - 1 within their bounds, and returns its sum, less what it is at the lower bounds; one pass.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn set_weights<const K: usize>(&self, x: &mut [R; P], bounds: &Bounds<R, P>) -> R {
        let brdf = Brdf::<R, TERMS>::with_kappa2(&Self::expand(x));
        let mut normal = [[[R::ZERO; SUMS]; 3]; 3];
        let mut gradient = [[R::ZERO; SUMS]; 3];
        for block in self.blocks() {
            let mut columns = [[[R::ZERO; SUMS]; GROUP]; 3];
            let mut weight = [[R::ZERO; SUMS]; GROUP];
            for lane in 0..SUMS {
                let model = brdf.relative_columns::<K, GROUP, LANES>(block, lane);
                for half in 0..GROUP {
                    weight[half][lane] = block.weight[lane + half * SUMS];
                    for i in 0..3 {
                        columns[i][half][lane] = model[i].0[half];
                    }
                }
            }
            for i in 0..3 {
                if has(TERMS, i) {
                    accumulate(&mut gradient[i], &columns[i], &weight);
                    for j in 0..=i {
                        if has(TERMS, j) {
                            accumulate(&mut normal[i][j], &columns[i], &columns[j]);
                        }
                    }
                }
            }
        }
        let mut a = [[R::ZERO; 3]; 3];
        let mut g = [R::ZERO; 3];
        let (mut lower, mut room) = ([R::ZERO; 3], [R::ZERO; 3]);
        for i in 0..3 {
            a[i][i] = R::ONE;
            if has(TERMS, i) {
                lower[i] = Self::get(&bounds.lower, i, R::ZERO);
                room[i] = Self::get(&bounds.upper, i, R::ZERO) - lower[i];
                for j in 0..=i {
                    a[i][j] = total(&normal[i][j]);
                    a[j][i] = a[i][j];
                }
                a[i][i] = a[i][i] * R::of(1.0 + 1e-6) + R::MIN_POSITIVE;
                g[i] = -total(&gradient[i]);
            }
        }
        // The box is seen from its lower corner.
        for i in 0..3 {
            for j in 0..3 {
                g[i] += a[i][j] * lower[j];
            }
        }
        let step = boxqp::minimize(&a, &g, &[R::ZERO; 3], &room);
        let mut rank = R::ZERO;
        for i in 0..3 {
            rank += step[i] * (g[i] + g[i]);
            for j in 0..3 {
                rank += step[i] * a[i][j] * step[j];
            }
            if let Some(weight) = x.get_mut(slot(TERMS, i)).filter(|_| has(TERMS, i)) {
                *weight = lower[i] + step[i];
            }
        }
        rank
    }
}

/// Between two positive numbers, evenly in the logarithm.
fn log_between<R: Real>(lower: R, upper: R, u: R) -> R {
    if !(lower < upper) {
        return lower;
    }
    let lower = lower.max(R::MIN_POSITIVE);
    let (a, b) = (lower.ln(), upper.ln());
    (a + (b - a) * u).exp()
}
