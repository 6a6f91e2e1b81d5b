//! A scan as a least-squares problem: the residual of ln f and its gradient, by blocks of sixteen rows (Eq. 15-17).

use crate::brdf::{Brdf, Params, has, lobes, parameters, slot};
use crate::fresnel::Index;
use crate::geometry::{Block, LANES};
use crate::lm::{Bounds, Linearization, Problem};
use crate::pack::{ALONE, Pack};
use crate::real::Real;

/// The blocks of one scan, for a model of `TERMS` with its `P` parameters.
///
/// The solver's coordinates are those parameters in the order of [`crate::brdf::NAMES`], with kappa^2 in place of kappa: F is even in kappa, so a search in kappa can not leave 0.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Scan<'a, R, const TERMS: u8, const P: usize> {
    blocks: &'a [Block<R>],
    /// cos theta_d nearest to the peak of each lobe.
    peaks: Pack<R, 2>,
    /// The least m that a few samples still see; dimensionless.
    pub(crate) finest: R,
}

impl<'a, R: Real, const TERMS: u8, const P: usize> Scan<'a, R, TERMS, P> {
    const MATCHES: () = assert!(P == parameters(TERMS), "P must be parameters(TERMS)");

    /// The scan whose observations are in `blocks`.
    pub fn new(blocks: &'a [Block<R>]) -> Self {
        let () = Self::MATCHES;
        let (finest, peaks) = finest_slope(blocks.len() * LANES, |lobe, i| {
            let block = blocks.get(i / LANES)?;
            // So the compiler sees that no index is out of range.
            let (lobe, lane) = (lobe % 2, i % LANES);
            (block.weight[lane] > R::ZERO).then(|| (block.tan2_theta_h[lobe][lane], block.cos_theta_d[lobe][lane]))
        });
        Scan { blocks, peaks, finest }
    }

    /// Its observations.
    pub fn blocks(&self) -> &'a [Block<R>] {
        self.blocks
    }

    /// Solver coordinates of `params`.
    pub fn coordinates(params: &Params<R>) -> [R; P] {
        let mut x = [R::ZERO; P];
        let mut all = params.to_array();
        all[5] *= all[5];
        for (index, value) in all.into_iter().enumerate() {
            if has(TERMS, index)
                && let Some(place) = x.get_mut(slot(TERMS, index))
            {
                *place = value;
            }
        }
        x
    }

    /// Parameters at solver coordinates; those of absent terms are 0, and n is 1.
    pub fn params(x: &[R; P]) -> Params<R> {
        let mut params = Self::expand(x);
        params.kappa = params.kappa.sqrt();
        params
    }

    /// Derivatives of the parameters by the solver's coordinates at `x`: 1, and for kappa 1 / (2 kappa), or 0 at kappa = 0, where there is none.
    pub fn slopes(x: &[R; P]) -> [R; P] {
        let mut slopes = [R::ONE; P];
        if has(TERMS, 5)
            && let (Some(slope), Some(&kappa2)) = (slopes.get_mut(slot(TERMS, 5)), x.get(slot(TERMS, 5)))
        {
            *slope = if kappa2 > R::ZERO {
                R::of(0.5) / kappa2.sqrt()
            } else {
                R::ZERO
            };
        }
        slopes
    }

    /// The bounds on the solver's coordinates.
    pub fn bounds(lower: &Params<R>, upper: &Params<R>) -> Bounds<R, P> {
        Bounds {
            lower: Self::coordinates(lower),
            upper: Self::coordinates(upper),
        }
    }

    /// Parameter `index` of [`crate::brdf::NAMES`], or `absent`.
    #[inline(always)]
    pub(crate) fn get(x: &[R; P], index: usize, absent: R) -> R {
        if has(TERMS, index) {
            x.get(slot(TERMS, index)).copied().unwrap_or(absent)
        } else {
            absent
        }
    }

    #[inline(always)]
    pub(crate) fn expand(x: &[R; P]) -> Params<R> {
        Params {
            rho_d: Self::get(x, 0, R::ZERO),
            rho_s: Self::get(x, 1, R::ZERO),
            rho_v: Self::get(x, 2, R::ZERO),
            m: Self::get(x, 3, R::ONE),
            n: Self::get(x, 4, R::ONE),
            kappa: Self::get(x, 5, R::ZERO),
        }
    }
}

/// Number of partial sums that run side by side.
pub(crate) const SUMS: usize = 8;
/// Lanes of a block for each of them, which go through the model's formulas side by side.
pub(crate) const GROUP: usize = LANES / SUMS;

/// Vector registers of 64 bytes are stored twice as fast where they do not straddle cache lines.
#[repr(align(64))]
struct Aligned<T>(T);

/// Adds the products of two columns of a block to the partial sums: lane k and lane k + 8 go to sum k.
#[inline(always)]
pub(crate) fn accumulate<R: Real>(sums: &mut [R; SUMS], x: &[[R; SUMS]; GROUP], y: &[[R; SUMS]; GROUP]) {
    for k in 0..SUMS {
        sums[k] += x[0][k] * y[0][k] + x[1][k] * y[1][k];
    }
}

/// The total, in an order that every target keeps.
#[inline(always)]
pub(crate) fn total<R: Real>(x: &[R; SUMS]) -> R {
    ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]))
}

impl<R: Real, const TERMS: u8, const P: usize> Problem<R, P> for Scan<'_, R, TERMS, P> {
    fn cost(&self, x: &[R; P]) -> R {
        self.inlined_cost(x)
    }

    fn bend(&self, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P] {
        let place = |index: usize| has(TERMS, index).then(|| slot(TERMS, index));
        let weights = [(place(1), 0), (place(2), 1)];
        bend(x, step, to, place(4), place(5), weights, self.peaks)
    }

    fn linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        self.inlined_linearize(x)
    }
}

impl<R: Real, const TERMS: u8, const P: usize> Scan<'_, R, TERMS, P> {
    /// [`Problem::cost`], compiled into its caller, for the vector instructions that the caller may use.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    pub fn inlined_cost(&self, x: &[R; P]) -> R {
        if ALONE {
            return self.cost_alone(x);
        }
        match lobes(TERMS) {
            0 => self.cost_of::<0>(x),
            1 => self.cost_of::<GROUP>(x),
            _ => self.cost_of::<{ 2 * GROUP }>(x),
        }
    }

    /// [`Problem::linearize`], compiled into its caller.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    pub fn inlined_linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        if ALONE {
            return self.linearize_alone(x);
        }
        match lobes(TERMS) {
            0 => self.linearize_of::<0>(x),
            1 => self.linearize_of::<GROUP>(x),
            _ => self.linearize_of::<{ 2 * GROUP }>(x),
        }
    }

    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn cost_of<const K: usize>(&self, x: &[R; P]) -> R {
        let brdf = Brdf::<R, TERMS>::with_kappa2(&Self::expand(x));
        let mut squares = [R::ZERO; SUMS];
        for block in self.blocks {
            let lift = brdf.lift(block);
            for lane in 0..SUMS {
                let model = brdf.rows::<K, GROUP, LANES, false>(block, &lift, lane);
                let residual = residual(block, lane, model.ln_f);
                squares[lane] += residual.0[0] * residual.0[0] + residual.0[1] * residual.0[1];
            }
        }
        total(&squares)
    }

    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn linearize_of<const K: usize>(&self, x: &[R; P]) -> Linearization<R, P> {
        let brdf = Brdf::<R, TERMS>::with_kappa2(&Self::expand(x));
        let mut squares = Aligned([R::ZERO; SUMS]);
        let mut gradient = Aligned([[R::ZERO; SUMS]; P]);
        let mut hessian = Aligned([[[R::ZERO; SUMS]; P]; P]);
        for block in self.blocks {
            let lift = brdf.lift(block);
            let mut residuals = Aligned([[R::ZERO; SUMS]; GROUP]);
            let mut rows = Aligned([[[R::ZERO; SUMS]; GROUP]; P]);
            for lane in 0..SUMS {
                let model = brdf.rows::<K, GROUP, LANES, true>(block, &lift, lane);
                let residual = residual(block, lane, model.ln_f);
                for half in 0..GROUP {
                    residuals.0[half][lane] = residual.0[half];
                    for i in 0..6 {
                        if has(TERMS, i)
                            && let Some(row) = rows.0.get_mut(slot(TERMS, i))
                        {
                            row[half][lane] = model.gradient[i].0[half];
                        }
                    }
                }
            }
            accumulate(&mut squares.0, &residuals.0, &residuals.0);
            for i in 0..P {
                accumulate(&mut gradient.0[i], &rows.0[i], &residuals.0);
                for j in 0..=i {
                    accumulate(&mut hessian.0[i][j], &rows.0[i], &rows.0[j]);
                }
            }
        }
        let mut sums = Linearization {
            cost: total(&squares.0),
            gradient: [R::ZERO; P],
            hessian: [[R::ZERO; P]; P],
        };
        for i in 0..P {
            sums.gradient[i] = total(&gradient.0[i]);
            for j in 0..=i {
                let sum = total(&hessian.0[i][j]);
                sums.hessian[i][j] = sum;
                sums.hessian[j][i] = sum;
            }
        }
        sums
    }
}

/// The least m that a few samples still see, dimensionless, and cos theta_d nearest to the peak of each lobe; from (tan^2 theta_h, cos theta_d) by lobe and row, for those rows that have any.
pub(crate) fn finest_slope<R: Real>(rows: usize, row: impl Fn(usize, usize) -> Option<(R, R)>) -> (R, Pack<R, 2>) {
    let mut peaks = Pack::splat(R::ONE);
    let mut finest = R::MAX;
    for (lobe, peak) in peaks.0.iter_mut().enumerate() {
        // The three smallest tan^2 theta_h.
        let mut nearest = [R::MAX; 3];
        for (mut tan2, cos_theta_d) in (0..rows).filter_map(|i| row(lobe, i)) {
            if tan2 < nearest[0] {
                *peak = cos_theta_d;
            }
            for place in &mut nearest {
                if tan2 < *place {
                    core::mem::swap(place, &mut tan2);
                }
            }
        }
        finest = finest.min(nearest[2]);
    }
    (R::of(0.3) * finest.sqrt(), peaks)
}

/// What is to be added to n + d n and kappa^2 + d kappa^2 so that Re 1/(n - i kappa) and (Im 1/(n - i kappa))^2 change by what they do to first order; nothing where that would make |n - i kappa| more than four times what it is.
///
/// All of second order, and written so that nothing cancels.
fn straighten<R: Real>([n, kappa2]: [R; 2], [d_n, d_kappa2]: [R; 2]) -> [R; 2] {
    let (one, two, quarter) = (R::ONE, R::of(2.0), R::of(0.25));
    let q = n * n + kappa2;
    // Relative changes of q, of n, and of Re 1/(n - i kappa) = n/q; then the change of 1/q.
    let u = (two * n * d_n + d_kappa2) / q;
    let v = d_n / n;
    let w = v - u;
    let s = (n * w) * (n * w) / q;
    let d = one - u + s;
    if !(w > quarter - one && d > quarter * quarter && kappa2 + d_kappa2 >= two * kappa2 * u) {
        return [R::ZERO; 2];
    }
    let e = u - s;
    [
        n * (u * v - s * (one + v)) / d,
        (two * d_kappa2 * u - (kappa2 + d_kappa2) * (two * s + e * e)) / (d * d),
    ]
}

/// Moves n and kappa where 1/(n - i kappa) goes straight, and then keeps rho F at the peak of each lobe where the linear model puts it.
///
/// F at large |n - i kappa| is a function of that inverse, nearly linear; in n and kappa the way there and back is long and curved.
/// And n and kappa change F at the peak, and hardly anything else that a scan sees.
/// `n`, `kappa2` and the weights are places of coordinates; each weight comes with the geometry of its lobe.
pub(crate) fn bend<R: Real, const P: usize>(
    x: &[R; P],
    step: &[R; P],
    to: [R; P],
    n: Option<usize>,
    kappa2: Option<usize>,
    weights: impl IntoIterator<Item = (Option<usize>, usize)>,
    peaks: Pack<R, 2>,
) -> [R; P] {
    let at = |x: &[R; P], place: Option<usize>, absent: R| place.and_then(|k| x.get(k).copied()).unwrap_or(absent);
    if n.is_none() {
        return to;
    }
    let (old_n, old_kappa2) = (at(x, n, R::ONE), at(x, kappa2, R::ZERO));
    let (d_n, d_kappa2) = (at(step, n, R::ZERO), at(step, kappa2, R::ZERO));
    let mut bent = to;
    for (place, more) in [n, kappa2]
        .into_iter()
        .zip(straighten([old_n, old_kappa2], [d_n, d_kappa2]))
    {
        if let Some(value) = place.and_then(|k| bent.get_mut(k)) {
            *value += more;
        }
    }
    let from = Index::new(old_n, old_kappa2).reflect::<2, true>(peaks);
    let (new_n, new_kappa2) = (
        at(&bent, n, R::ONE).max(R::ONE),
        at(&bent, kappa2, R::ZERO).max(R::ZERO),
    );
    let there = Index::new(new_n, new_kappa2).reflect::<2, false>(peaks);
    let d_n2 = R::of(2.0) * old_n * d_n;
    for (place, lobe) in weights {
        // So the compiler sees that no index is out of range.
        let lobe = lobe % 2;
        let Some(rho) = place.and_then(|k| bent.get_mut(k)) else {
            continue;
        };
        let d_f = from.d_n2.0[lobe] * d_n2 + from.d_kappa2.0[lobe] * d_kappa2;
        let amplitude = from.f.0[lobe] * at(&to, place, R::ZERO) + at(x, place, R::ZERO) * d_f;
        if amplitude > R::ZERO && there.f.0[lobe] > R::TINY {
            *rho = amplitude / there.f.0[lobe];
        }
    }
    bent
}

/// The same where lanes do not go side by side: one partial sum after the other, so that few are in memory.
impl<R: Real, const TERMS: u8, const P: usize> Scan<'_, R, TERMS, P> {
    fn cost_alone(&self, x: &[R; P]) -> R {
        let brdf = Brdf::<R, TERMS>::with_kappa2(&Self::expand(x));
        let mut squares = [R::ZERO; SUMS];
        for block in self.blocks {
            for (lane, sum) in squares.iter_mut().enumerate() {
                let [(a, _), (b, _)] = [lane, lane + SUMS].map(|lane| row::<R, TERMS, P>(&brdf, block, lane));
                *sum += a * a + b * b;
            }
        }
        total(&squares)
    }

    fn linearize_alone(&self, x: &[R; P]) -> Linearization<R, P> {
        let brdf = Brdf::<R, TERMS>::with_kappa2(&Self::expand(x));
        // In the order of `total`.
        let two = |lane| add(self.partial(&brdf, lane), &self.partial(&brdf, lane + 1));
        let four = |lane| add(two(lane), &two(lane + 2));
        let mut sums = add(four(0), &four(4));
        for i in 0..P {
            for j in 0..i {
                sums.hessian[j][i] = sums.hessian[i][j];
            }
        }
        sums
    }

    /// The sums over one of the first eight lanes, and its other half, of all blocks; of J'J the lower half.
    #[inline(never)]
    fn partial(&self, brdf: &Brdf<R, TERMS>, lane: usize) -> Linearization<R, P> {
        let mut sums = Linearization {
            cost: R::ZERO,
            gradient: [R::ZERO; P],
            hessian: [[R::ZERO; P]; P],
        };
        for block in self.blocks {
            let [(a, a_row), (b, b_row)] = [lane, lane + SUMS].map(|lane| row::<R, TERMS, P>(brdf, block, lane));
            sums.cost += a * a + b * b;
            for i in 0..P {
                sums.gradient[i] += a_row[i] * a + b_row[i] * b;
                for j in 0..=i {
                    sums.hessian[i][j] += a_row[i] * a_row[j] + b_row[i] * b_row[j];
                }
            }
        }
        sums
    }
}

fn add<R: Real, const P: usize>(mut x: Linearization<R, P>, y: &Linearization<R, P>) -> Linearization<R, P> {
    x.cost += y.cost;
    for i in 0..P {
        x.gradient[i] += y.gradient[i];
        for j in 0..=i {
            x.hessian[i][j] += y.hessian[i][j];
        }
    }
    x
}

/// Residual and row of J of one lane.
fn row<R: Real, const TERMS: u8, const P: usize>(brdf: &Brdf<R, TERMS>, block: &Block<R>, lane: usize) -> (R, [R; P]) {
    let one = block.lane(lane);
    let model = brdf.row::<true>(&one);
    let mut row = [R::ZERO; P];
    for i in 0..6 {
        if has(TERMS, i)
            && let Some(place) = row.get_mut(slot(TERMS, i))
        {
            *place = model.gradient[i].0[0];
        }
    }
    ((model.ln_f.0[0] - one.ln_f[0]) * one.weight[0], row)
}

#[inline(always)]
fn residual<R: Real>(block: &Block<R>, lane: usize, ln_f: Pack<R, GROUP>) -> Pack<R, GROUP> {
    (ln_f - Pack::gather(&block.ln_f, lane)) * Pack::gather(&block.weight, lane)
}
