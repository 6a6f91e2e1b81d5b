//! Good starts for a scan: parameters that are not weights spread evenly, and the weights that fit best there.

use crate::boxqp;
use crate::lm::{Bounds, Linearization};
use crate::model::{GROUP, Model, Parameter, Role, SUMS, WEIGHTS, Want, weights};
use crate::pack::Pack;
use crate::propose::{self, Shapes};
use crate::real::ALONE;
use crate::real::Real;
use crate::residuals::{Residuals, accumulate, total};
use crate::search::{Candidate, Region, Scene, Waits};

impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> Scene<R, P> for Residuals<'_, R, M, P, C> {
    /// Parameters that are not weights spread over the ranges that the model gives; for variations of the index, the weights that keep the lobes as high.
    fn propose(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, region: Region<R, P>) -> Candidate<R, P> {
        let mut x = bounds.lower;
        let shapes = Shapes {
            roles: const { &propose::roles(&M::PARAMETERS) },
            has_index: Self::HAS_INDEX,
            spread: R::table(
                const { &propose::single(&propose::spreads(&M::PARAMETERS)) },
                const { &propose::double(&propose::spreads(&M::PARAMETERS)) },
            ),
        };
        let fades = propose::shapes(&mut x, &shapes, bounds, (seed, i), &self.seen, region);
        let waits = if let Region::Index(like) = region
            && Self::HAS_INDEX
        {
            // Where the model misfits, least squares of f would take the lobes away.
            M::keep_heights(&self.seen, like, &mut x);
            if fades {
                M::fade(&mut x, bounds);
            }
            bounds.keep(&mut x);
            Waits::No
        } else if fades {
            Waits::Fading
        } else {
            Waits::Weights
        };
        Candidate {
            x,
            rank: R::ZERO,
            passes: 0,
            waits,
        }
    }

    fn weigh(&self, bounds: &Bounds<R, P>, candidate: &mut Candidate<R, P>) {
        self.weigh_by(bounds, candidate, |x| {
            self.summed(|part| part.inlined_weights(x), Linearization::add_part)
        });
    }

    fn level(&self, bounds: &Bounds<R, P>, x: &[R; P]) -> ([R; P], R) {
        let add = |sum: &mut [R; 3], part: &[R; 3]| {
            for (sum, part) in sum.iter_mut().zip(part) {
                *sum += *part;
            }
        };
        Self::levelled(bounds, x, self.summed(|part| part.inlined_totals(x), add))
    }

    #[cfg_attr(target_os = "none", inline(never))]
    fn apart(&self, x: &[R; P], y: &[R; P], factor: R) -> bool {
        let roles = const { propose::roles(&M::PARAMETERS) };
        (0..P).any(|k| roles[k] == Role::Slope && (x[k] > y[k] * factor || y[k] > x[k] * factor))
    }
}

impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> Residuals<'_, R, M, P, C> {
    /// Places of the weights.
    pub(crate) const WEIGHTS: [Option<usize>; WEIGHTS] = weights(&M::PARAMETERS);
    /// Beyond the place of the last of them.
    pub(crate) const WEIGHTS_END: usize = end(&Self::WEIGHTS);
    /// Has the model an index of refraction? Then minima beside each other differ in it alone.
    const HAS_INDEX: bool = has_index(&M::PARAMETERS);

    /// [`Scene::level`], given what [`Residuals::inlined_totals`] are at `x`.
    ///
    /// f in proportion to c has the residuals r + w ln c of ln f, so the best c and its cost follow from the sums of r^2, w r and w^2.
    pub fn levelled(bounds: &Bounds<R, P>, x: &[R; P], sums: [R; 3]) -> ([R; P], R) {
        if Self::WEIGHTS_END == 0 {
            return (*x, sums[0]);
        }
        level(bounds, x, sums, const { &propose::roles(&M::PARAMETERS) })
    }

    /// Sets the weights to the least squares of f / f_measured - 1 within their bounds, and the rank to its sum, less what it is at the lower bounds; given what [`Residuals::inlined_weights`] are, which is one pass.
    #[inline(always)]
    pub fn weigh_by(
        &self,
        bounds: &Bounds<R, P>,
        candidate: &mut Candidate<R, P>,
        sums: impl FnOnce(&[R; P]) -> Linearization<R, P>,
    ) {
        if candidate.waits == Waits::No {
            return;
        }
        let x = &mut candidate.x;
        let mut sums = sums(x);
        candidate.passes += 1;
        if Self::WEIGHTS_END == 0 {
            candidate.rank = sums.cost;
            candidate.waits = Waits::No;
            return;
        }
        let roles = const { propose::roles(&M::PARAMETERS) };
        let rank = box_least_squares(&mut sums, &roles, bounds, x);
        let again = candidate.waits == Waits::Fading && M::fade(x, bounds);
        bounds.keep(x);
        candidate.rank = rank;
        candidate.waits = if again { Waits::Weights } else { Waits::No };
    }

    /// [`Residuals::inlined_weights`], one lane after the other: the same bits from less code.
    pub fn scalar_weights(&self, x: &[R; P]) -> Linearization<R, P> {
        if Self::WEIGHTS_END == 0 {
            return Linearization {
                cost: self.scalar_cost(x),
                ..Linearization::zero()
            };
        }
        self.scalar_sums(x, Want::Columns)
    }

    /// The normal equations of the weights: of f / f_measured of each weight at 1, times the block's weights, and of 1, times these; of a model without weights its cost. Compiled into its caller, for the vector instructions that the caller may use.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    pub fn inlined_weights(&self, x: &[R; P]) -> Linearization<R, P> {
        if ALONE {
            return self.scalar_weights(x);
        }
        if Self::WEIGHTS_END == 0 {
            return Linearization {
                cost: self.inlined_cost(x),
                ..Linearization::zero()
            };
        }
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

/// [`Residuals::levelled`] of a model that has weights.
#[cfg_attr(target_os = "none", inline(always))]
fn level<R: Real, const P: usize>(
    bounds: &Bounds<R, P>,
    x: &[R; P],
    [squares, residuals, weights]: [R; 3],
    roles: &[Role; P],
) -> ([R; P], R) {
    let (mut least, mut most) = (R::ZERO, R::MAX);
    for k in 0..P {
        if roles[k] == Role::Weight && x[k] > R::ZERO {
            least = least.max(bounds.lower[k] / x[k]);
            most = most.min(bounds.upper[k] / x[k]);
        }
    }
    let scale = (-residuals / weights).portable_exp().max(least).min(most);
    let ln_scale = scale.portable_ln();
    let cost = squares + ln_scale * (residuals + residuals + ln_scale * weights);
    if !(least < most && cost < squares) {
        return (*x, squares);
    }
    let mut levelled = *x;
    for k in 0..P {
        if roles[k] == Role::Weight {
            levelled[k] *= scale;
        }
    }
    bounds.keep(&mut levelled);
    (levelled, cost)
}

/// Sets the weights of `x` to those within bounds that solve `hessian weights = gradient` best; their sum of squares, less what it is at the lower bounds. The sums are used up.
fn box_least_squares<R: Real, const P: usize>(
    sums: &mut Linearization<R, P>,
    roles: &[Role; P],
    bounds: &Bounds<R, P>,
    x: &mut [R; P],
) -> R {
    // What is no weight has no room, and zeros in the sums.
    let (a, g) = (&mut sums.hessian, &mut sums.gradient);
    let mut room = [R::ZERO; P];
    for i in 0..P {
        if roles[i] == Role::Weight {
            room[i] = bounds.upper[i] - bounds.lower[i];
            a[i][i] = a[i][i] * R::of(1.0 + 1e-6) + R::MIN_POSITIVE;
            // The box is seen from its lower corner.
            g[i] = -g[i];
            for j in 0..P {
                g[i] += a[i][j] * bounds.lower[j];
            }
        }
    }
    let step = boxqp::minimize(a, g, &[R::ZERO; P], &room);
    let mut rank = R::ZERO;
    for i in 0..P {
        if roles[i] == Role::Weight {
            x[i] = bounds.lower[i] + step[i];
        }
        rank += step[i] * (g[i] + g[i]);
        for j in 0..P {
            rank += step[i] * a[i][j] * step[j];
        }
    }
    rank
}
