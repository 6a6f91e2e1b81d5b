//! Good starts for a scan: what is no weight spread evenly, and the weights that fit best there.

use crate::boxqp;
use crate::geometry::{Block, LANES};
use crate::lm::Bounds;
use crate::model::{GROUP, Model, Parameter, Role, SUMS, WEIGHTS, weights};
use crate::pack::{ALONE, Pack};
use crate::propose;
use crate::real::Real;
use crate::residuals::{Residuals, accumulate, total};
use crate::search::{Candidate, Region, Scene};

impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> Scene<R, P> for Residuals<'_, R, M, P, C> {
    /// Candidate `i`: what is no weight spread over the ranges that the model gives, then the weights that fit best.
    fn candidate(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, region: Region<R, P>) -> Candidate<R, P> {
        self.inlined_candidate(bounds, seed, i, region)
    }

    fn level(&self, bounds: &Bounds<R, P>, x: &[R; P]) -> ([R; P], R) {
        Self::levelled(bounds, x, self.inlined_sums(x))
    }

    fn apart(&self, x: &[R; P], y: &[R; P], factor: R) -> bool {
        let slopes = M::PARAMETERS.iter().zip(x.iter().zip(y));
        let mut slopes = slopes.filter(|(parameter, _)| matches!(parameter.role, Role::Slope));
        slopes.any(|(_, (&x, &y))| x > y * factor || y > x * factor)
    }
}

impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> Residuals<'_, R, M, P, C> {
    /// Places of the weights.
    const WEIGHTS: [Option<usize>; WEIGHTS] = weights(&M::PARAMETERS);
    /// Has the model an index of refraction? Then minima beside each other differ in it alone.
    const HAS_INDEX: bool = has_index(&M::PARAMETERS);

    /// [`Scene::candidate`], compiled into its caller, for the vector instructions that the caller may use.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    pub fn inlined_candidate(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, region: Region<R, P>) -> Candidate<R, P> {
        self.propose::<ALONE>(bounds, seed, i, region)
    }

    /// [`Scene::candidate`], one lane after the other: the same bits from less code.
    pub fn scalar_candidate(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, region: Region<R, P>) -> Candidate<R, P> {
        self.propose::<true>(bounds, seed, i, region)
    }

    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn propose<const SCALAR: bool>(
        &self,
        bounds: &Bounds<R, P>,
        seed: u64,
        i: u64,
        region: Region<R, P>,
    ) -> Candidate<R, P> {
        let mut x = bounds.lower;
        let fades = propose::shapes(&mut x, &M::PARAMETERS, bounds, (seed, i), &self.seen, region);
        if let Region::Index(like) = region
            && Self::HAS_INDEX
        {
            // Where the model misfits, least squares of f would take the lobes away.
            M::keep_heights(&self.seen, like, &mut x);
            if fades {
                M::fade(&mut x, bounds);
            }
            return Candidate {
                x: bounds.clamp(x),
                rank: R::ZERO,
                passes: 0,
            };
        }
        let mut passes = 0;
        loop {
            let rank = self.set_weights::<SCALAR>(&mut x, bounds);
            passes += 1;
            if !(fades && passes == 1 && M::fade(&mut x, bounds)) {
                let x = bounds.clamp(x);
                return Candidate { x, rank, passes };
            }
            x = bounds.clamp(x);
        }
    }

    /// [`Scene::level`], given what [`Residuals::inlined_sums`] are at `x`.
    ///
    /// f in proportion to c has the residuals r + w ln c of ln f, so the best c and its cost follow from the sums of r^2, w r and w^2.
    pub fn levelled(bounds: &Bounds<R, P>, x: &[R; P], [squares, residuals, weights]: [R; 3]) -> ([R; P], R) {
        let (mut least, mut most) = (R::ZERO, R::MAX);
        for k in Self::WEIGHTS.into_iter().flatten() {
            if x[k] > R::ZERO {
                least = least.max(bounds.lower[k] / x[k]);
                most = most.min(bounds.upper[k] / x[k]);
            }
        }
        let scale = (-residuals / weights).exp().max(least).min(most);
        let ln_scale = scale.ln();
        let cost = squares + ln_scale * (residuals + residuals + ln_scale * weights);
        if !(least < most && cost < squares) {
            return (*x, squares);
        }
        let mut levelled = *x;
        for k in Self::WEIGHTS.into_iter().flatten() {
            levelled[k] *= scale;
        }
        (bounds.clamp(levelled), cost)
    }

    /// Sets the weights to the least squares of f / f_measured - 1 within their bounds, and returns its sum, less what it is at the lower bounds; one pass.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn set_weights<const SCALAR: bool>(&self, x: &mut [R; P], bounds: &Bounds<R, P>) -> R {
        let pass = M::pass(x);
        let mut normal = [[[R::ZERO; SUMS]; WEIGHTS]; WEIGHTS];
        let mut gradient = [[R::ZERO; SUMS]; WEIGHTS];
        for block in self.blocks() {
            let mut columns = [[[R::ZERO; SUMS]; GROUP]; WEIGHTS];
            let mut weight = [[R::ZERO; SUMS]; GROUP];
            for lane in 0..SUMS {
                let model = Self::relative_columns::<SCALAR>(&pass, block, lane);
                for half in 0..GROUP {
                    weight[half][lane] = block.weight[lane + half * SUMS];
                    for w in 0..WEIGHTS {
                        columns[w][half][lane] = model[w].0[half];
                    }
                }
            }
            for w in 0..WEIGHTS {
                if Self::WEIGHTS[w].is_some() {
                    accumulate(&mut gradient[w], &columns[w], &weight);
                    for v in 0..=w {
                        accumulate(&mut normal[w][v], &columns[w], &columns[v]);
                    }
                }
            }
        }
        let sums = core::array::from_fn(|i| core::array::from_fn(|j| total(&normal[i.max(j)][i.min(j)])));
        let within = |side: &[R; P]| Self::WEIGHTS.map(|k| k.and_then(|k| side.get(k).copied()).unwrap_or(R::ZERO));
        let (best, rank) = box_least_squares(
            &sums,
            &core::array::from_fn(|w| total(&gradient[w])),
            Self::WEIGHTS.map(|k| k.is_some()),
            within(&bounds.lower),
            within(&bounds.upper),
        );
        for (k, value) in Self::WEIGHTS.into_iter().zip(best) {
            if let Some(weight) = k.and_then(|k| x.get_mut(k)) {
                *weight = value;
            }
        }
        rank
    }

    /// f / f_measured of each weight at 1, times the block's weights.
    #[inline(always)]
    fn relative_columns<const SCALAR: bool>(
        pass: &M::Pass,
        block: &Block<R, LANES, C>,
        lane: usize,
    ) -> [Pack<R, GROUP>; WEIGHTS] {
        let columns = if SCALAR {
            let mut columns = [Pack::splat(R::ZERO); WEIGHTS];
            for k in 0..GROUP {
                let one = M::column(pass, &block.lane(lane + k * SUMS));
                for (column, value) in columns.iter_mut().zip(one) {
                    column.0[k] = value.0[0];
                }
            }
            columns
        } else {
            M::columns(pass, block, lane)
        };
        let unit = Pack::gather(&block.weight, lane) * Pack::gather(&block.ln_f, lane).map(|x| -x).exp();
        columns.map(|column| column * unit)
    }
}

const fn has_index<const P: usize>(parameters: &[Parameter; P]) -> bool {
    let mut k = 0;
    while k < P {
        if matches!(parameters[k].role, Role::Index) {
            return true;
        }
        k += 1;
    }
    false
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
