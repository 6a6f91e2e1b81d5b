//! Good starts for a scan: parameters that are not weights spread evenly, and the weights that fit best there.

use crate::boxqp;
use crate::lm::{Bounds, Linearization};
use crate::model::{GROUP, Model, Parameter, Role, SUMS, WEIGHTS, Want, weights};
use crate::pack::{ALONE, Pack};
use crate::real::Real;
use crate::residuals::{Residuals, accumulate, total};
use crate::search::{Candidate, Scene};
use crate::start;

impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> Scene<R, P> for Residuals<'_, R, M, P, C> {
    /// Candidate `i`: parameters that are not weights spread over the ranges that the model gives, then the weights that fit best.
    fn candidate(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, like: Option<&[R; P]>) -> Candidate<R, P> {
        self.inlined_candidate(bounds, seed, i, like)
    }
}

impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> Residuals<'_, R, M, P, C> {
    /// Places of the weights.
    pub(crate) const WEIGHTS: [Option<usize>; WEIGHTS] = weights(&M::PARAMETERS);
    /// Beyond the place of the last of them.
    pub(crate) const WEIGHTS_END: usize = end(&Self::WEIGHTS);
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
        self.propose::<ALONE>(bounds, seed, i, like)
    }

    /// [`Scene::candidate`], one lane after the other: the same bits from less code.
    pub fn scalar_candidate(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, like: Option<&[R; P]>) -> Candidate<R, P> {
        self.propose::<true>(bounds, seed, i, like)
    }

    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn propose<const SCALAR: bool>(
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
        let rank = self.set_weights::<SCALAR>(&mut x, bounds);
        Candidate {
            x: bounds.clamp(x),
            rank,
        }
    }

    /// Sets the weights to the least squares of f / f_measured - 1 within their bounds, and returns its sum, less what it is at the lower bounds; one pass.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn set_weights<const SCALAR: bool>(&self, x: &mut [R; P], bounds: &Bounds<R, P>) -> R {
        let sums = if SCALAR {
            self.scalar_sums(x, Want::Columns)
        } else {
            self.weight_sums(x)
        };
        let is_weight = M::PARAMETERS.map(|parameter| parameter.is_weight());
        let (best, rank) = box_least_squares(&sums, is_weight, bounds);
        for k in 0..P {
            if is_weight[k] {
                x[k] = best[k];
            }
        }
        rank
    }

    /// The normal equations of the weights: of f / f_measured of each weight at 1, times the block's weights, and of 1, times these.
    #[inline(always)]
    fn weight_sums(&self, x: &[R; P]) -> Linearization<R, P> {
        let pass = M::pass(x);
        let mut normal = [[[R::ZERO; SUMS]; WEIGHTS]; WEIGHTS];
        let mut gradient = [[R::ZERO; SUMS]; WEIGHTS];
        for block in self.blocks() {
            let mut columns = [[[R::ZERO; SUMS]; GROUP]; WEIGHTS];
            let mut weight = [[R::ZERO; SUMS]; GROUP];
            for lane in 0..SUMS {
                let unit = Pack::gather(&block.weight, lane) * Pack::gather(&block.ln_f, lane).map(|x| -x).exp();
                let model = M::columns(&pass, block, lane).map(|column| column * unit);
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
        let mut sums = Linearization::zero();
        for (w, i) in Self::WEIGHTS.into_iter().enumerate() {
            let Some(i) = i.filter(|&i| i < P) else { continue };
            sums.gradient[i] = total(&gradient[w]);
            for (v, j) in Self::WEIGHTS.into_iter().enumerate() {
                if let Some(j) = j.filter(|&j| j < P) {
                    sums.hessian[i][j] = total(&normal[w.max(v)][w.min(v)]);
                }
            }
        }
        sums
    }
}

const fn end(places: &[Option<usize>; WEIGHTS]) -> usize {
    let mut end = 0;
    let mut w = 0;
    while w < WEIGHTS {
        if let Some(place) = places[w] {
            end = place + 1;
        }
        w += 1;
    }
    end
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

/// Sets the parameters that are not weights to point `i` of a sequence that fills the ranges of the parameters evenly; `finest` is the least slope that the scan sees.
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
    for k in 0..P {
        let parameter = &parameters[k];
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

/// The weights within bounds that solve `hessian weights = gradient` best, and their sum of squares, less what it is at the lower bounds; what is no weight is 0.
fn box_least_squares<R: Real, const P: usize>(
    sums: &Linearization<R, P>,
    is_weight: [bool; P],
    bounds: &Bounds<R, P>,
) -> ([R; P], R) {
    let mut a = [[R::ZERO; P]; P];
    let mut g = [R::ZERO; P];
    let mut lower = [R::ZERO; P];
    let mut room = [R::ZERO; P];
    for i in 0..P {
        a[i][i] = R::ONE;
        if is_weight[i] {
            lower[i] = bounds.lower[i];
            room[i] = bounds.upper[i] - bounds.lower[i];
            a[i] = sums.hessian[i];
            a[i][i] = a[i][i] * R::of(1.0 + 1e-6) + R::MIN_POSITIVE;
            g[i] = -sums.gradient[i];
        }
    }
    // The box is seen from its lower corner.
    for i in 0..P {
        for j in 0..P {
            g[i] += a[i][j] * lower[j];
        }
    }
    let step = boxqp::minimize(&a, &g, &[R::ZERO; P], &room);
    let mut rank = R::ZERO;
    for i in 0..P {
        rank += step[i] * (g[i] + g[i]);
        for j in 0..P {
            rank += step[i] * a[i][j] * step[j];
        }
    }
    (core::array::from_fn(|i| lower[i] + step[i]), rank)
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
