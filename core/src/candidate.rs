//! Good starts for a scan: what is no weight spread evenly, and the weights that fit best there.

use crate::boxqp;
use crate::geometry::{Block, LANES};
use crate::lm::Bounds;
use crate::model::{GROUP, Model, Parameter, Role, SUMS, WEIGHTS, weights};
use crate::pack::{ALONE, Pack};
use crate::real::Real;
use crate::residuals::{Residuals, accumulate, total};
use crate::search::{Candidate, Scene};
use crate::start;

impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> Scene<R, P> for Residuals<'_, R, M, P, C> {
    /// Candidate `i`: what is no weight spread over the ranges that the model gives, then the weights that fit best.
    fn candidate(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, like: Option<&[R; P]>) -> Candidate<R, P> {
        self.inlined_candidate(bounds, seed, i, like)
    }
}

impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> Residuals<'_, R, M, P, C> {
    /// Places of the weights.
    const WEIGHTS: [Option<usize>; WEIGHTS] = weights(&M::PARAMETERS);
    /// Has the model an index of refraction? Then minima beside each other differ in it alone.
    const HAS_INDEX: bool = has_index(&M::PARAMETERS);

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
        spread(&mut x, &M::PARAMETERS, bounds, seed, i, self.seen.finest);
        if let Some(like) = like {
            near(&mut x, &M::PARAMETERS, like, Self::HAS_INDEX);
        }
        let rank = self.set_weights(&mut x, bounds);
        Candidate {
            x: bounds.clamp(x),
            rank,
        }
    }

    /// Sets the weights to the least squares of f / f_measured - 1 within their bounds, and returns its sum, less what it is at the lower bounds; one pass.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn set_weights(&self, x: &mut [R; P], bounds: &Bounds<R, P>) -> R {
        let pass = M::pass(x);
        let mut normal = [[[R::ZERO; SUMS]; WEIGHTS]; WEIGHTS];
        let mut gradient = [[R::ZERO; SUMS]; WEIGHTS];
        for block in self.blocks() {
            let mut columns = [[[R::ZERO; SUMS]; GROUP]; WEIGHTS];
            let mut weight = [[R::ZERO; SUMS]; GROUP];
            for lane in 0..SUMS {
                let model = Self::relative_columns(&pass, block, lane);
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
    fn relative_columns(pass: &M::Pass, block: &Block<R, LANES, C>, lane: usize) -> [Pack<R, GROUP>; WEIGHTS] {
        let columns = if ALONE {
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

/// Sets what is no weight to point `i` of a sequence that fills the ranges of the parameters evenly; `finest` is the least slope that the scan sees.
fn spread<R: Real, const P: usize>(
    x: &mut [R; P],
    parameters: &[Parameter; P],
    bounds: &Bounds<R, P>,
    seed: u64,
    i: u64,
    finest: R,
) {
    // The first three take an even sequence; points of one in more dimensions would be further apart in these.
    let even = start::even::<R>(seed, i);
    let mut spread = 0;
    let mut random = None;
    for (k, parameter) in parameters.iter().enumerate() {
        if parameter.is_weight() {
            continue;
        }
        let u = match even.get(spread) {
            Some(&u) => u,
            None => random.get_or_insert_with(|| start::unit::<R, P>(seed, i))[k],
        };
        spread += 1;
        let (lower, upper) = (bounds.lower[k], bounds.upper[k]);
        let (least, most) = (R::of(parameter.spread.0), R::of(parameter.spread.1));
        let to = |most: R| upper.min(most).max(lower);
        x[k] = match parameter.role {
            Role::Slope => log_between(lower.max(finest).min(upper), to(most), u),
            Role::Absorption => {
                // A third of them without absorption.
                let third = R::of(1.0 / 3.0);
                if u < third {
                    lower
                } else {
                    log_between(lower.max(least), upper.min(most).max(least), (u - third) * R::of(1.5))
                }
            }
            _ if least > R::ZERO => log_between(lower.max(least).min(upper), to(most), u),
            _ => {
                let from = lower.max(least).min(upper);
                from + (to(most) - from) * u
            }
        };
    }
}

/// What decides between minima beside each other stays spread; the rest becomes that of `like`.
///
/// With an index of refraction that is the index alone; without one, everything stays within a factor of e.
fn near<R: Real, const P: usize>(x: &mut [R; P], parameters: &[Parameter; P], like: &[R; P], has_index: bool) {
    for (k, parameter) in parameters.iter().enumerate() {
        match parameter.role {
            Role::Weight | Role::Index | Role::Absorption => {}
            _ if has_index => x[k] = like[k],
            _ => {
                let ratio = (x[k] / like[k]).max(R::of(0.37)).min(R::of(2.7));
                x[k] = like[k] * ratio;
            }
        }
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
