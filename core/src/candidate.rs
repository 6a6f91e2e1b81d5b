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
    fn candidate(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, like: Option<&[R; P]>) -> Candidate<R, P> {
        self.inlined_candidate(bounds, seed, i, like)
    }
}

impl<R: Real, const TERMS: u8, const P: usize> Scan<'_, R, TERMS, P> {
    /// [`Scene::candidate`], compiled into its caller, for the vector instructions that the caller may use.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    pub fn inlined_candidate(
        &self,
        bounds: &Bounds<R, P>,
        seed: u64,
        i: u64,
        like: Option<&[R; P]>,
    ) -> Candidate<R, P> {
        let mut x = bounds.lower;
        let place = |index: usize| has(TERMS, index).then(|| slot(TERMS, index));
        spread(&mut x, bounds, seed, i, self.finest, [place(3), place(4), place(5)]);
        if let (Some(m), Some(like)) = (place(3).and_then(|k| x.get_mut(k)), like) {
            *m = Self::get(like, 3, R::ONE);
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
        let sums = core::array::from_fn(|i| core::array::from_fn(|j| total(&normal[i.max(j)][i.min(j)])));
        let within = |side: &[R; P]| core::array::from_fn(|i| Self::get(side, i, R::ZERO));
        let present = core::array::from_fn(|i| has(TERMS, i));
        let (best, rank) = box_least_squares::<R, 3>(
            &sums,
            &core::array::from_fn(|i| total(&gradient[i])),
            present,
            within(&bounds.lower),
            within(&bounds.upper),
        );
        for i in 0..3 {
            if let Some(weight) = x.get_mut(slot(TERMS, i)).filter(|_| has(TERMS, i)) {
                *weight = best[i];
            }
        }
        rank
    }
}

/// Sets m, n and kappa^2, at the given places, to point `i` of a sequence that fills the logarithms of their ranges evenly; `finest` is the least m that the scan sees.
pub(crate) fn spread<R: Real, const P: usize>(
    x: &mut [R; P],
    bounds: &Bounds<R, P>,
    seed: u64,
    i: u64,
    finest: R,
    places: [Option<usize>; 3],
) {
    let u = start::even::<R, 3>(seed, i);
    let [m, n, kappa2] = places;
    // So the compiler sees that no index is out of range.
    let within = |place: Option<usize>| place.filter(|&k| k < P);
    if let Some(k) = within(m) {
        x[k] = log_between(
            bounds.lower[k].max(finest).min(bounds.upper[k]),
            bounds.upper[k].min(R::of(3.0)).max(bounds.lower[k]),
            u[0],
        );
    }
    if let Some(k) = within(n) {
        x[k] = log_between(
            bounds.lower[k],
            bounds.upper[k].min(R::of(10.0)).max(bounds.lower[k]),
            u[1],
        );
    }
    if let Some(k) = within(kappa2) {
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
}

/// The weights within bounds that solve `normal weights = rhs` best, and their sum of squares, less what it is at the lower bounds; a weight that is not present is 0.
pub(crate) fn box_least_squares<R: Real, const N: usize>(
    normal: &[[R; N]; N],
    rhs: &[R; N],
    present: [bool; N],
    lower: [R; N],
    upper: [R; N],
) -> ([R; N], R) {
    let mut a = [[R::ZERO; N]; N];
    let mut g = [R::ZERO; N];
    let mut room = [R::ZERO; N];
    for i in 0..N {
        a[i][i] = R::ONE;
        if present[i] {
            room[i] = upper[i] - lower[i];
            for j in 0..N {
                a[i][j] = if present[j] { normal[i][j] } else { R::ZERO };
            }
            a[i][i] = a[i][i] * R::of(1.0 + 1e-6) + R::MIN_POSITIVE;
            g[i] = -rhs[i];
        }
    }
    // The box is seen from its lower corner.
    for i in 0..N {
        for j in 0..N {
            g[i] += a[i][j] * lower[j];
        }
    }
    let step = boxqp::minimize(&a, &g, &[R::ZERO; N], &room);
    let mut rank = R::ZERO;
    for i in 0..N {
        rank += step[i] * (g[i] + g[i]);
        for j in 0..N {
            rank += step[i] * a[i][j] * step[j];
        }
    }
    (core::array::from_fn(|i| lower[i] + step[i]), rank)
}

/// Between two positive numbers, evenly in the logarithm.
pub(crate) fn log_between<R: Real>(lower: R, upper: R, u: R) -> R {
    if !(lower < upper) {
        return lower;
    }
    let lower = lower.max(R::MIN_POSITIVE);
    let (a, b) = (lower.ln(), upper.ln());
    (a + (b - a) * u).exp()
}
