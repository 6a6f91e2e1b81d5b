//! A scan as a least-squares problem: the residual of ln f and its gradient, by blocks of sixteen rows (Eq. 15-17).

use core::marker::PhantomData;

use crate::brdf::{Params, get, places};
use crate::geometry::{Block, LANES, Observation, Sample, SampleError};
use crate::lm::{Bounds, Linearization, Problem};
use crate::microfacet::Microfacet;
use crate::model::{GROUP, Model, Parameter, SUMS, Seen, Want};
use crate::pack::Pack;
use crate::real::ALONE;
use crate::real::Real;

/// The blocks of one scan, for model `M` with its `P` parameters, which needs `C` numbers of each pair of directions.
///
/// The solver's coordinates are the model's parameters in their order, with kappa^2 in place of kappa: see [`crate::model::Parameter::is_squared`].
#[derive(Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Residuals<'a, R, M, const P: usize, const C: usize = 6> {
    blocks: &'a [Block<R, LANES, C>],
    pub(crate) seen: Seen<R>,
    model: PhantomData<M>,
}

/// The blocks of one scan, for `TERMS` of Eq. 14 with their `P` parameters.
pub type Scan<'a, R, const TERMS: u8, const P: usize> = Residuals<'a, R, Microfacet<TERMS>, P>;

impl<R: Copy, M, const P: usize, const C: usize> Clone for Residuals<'_, R, M, P, C> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<R: Copy, M, const P: usize, const C: usize> Copy for Residuals<'_, R, M, P, C> {}

impl<R: Real, const TERMS: u8, const P: usize> Scan<'_, R, TERMS, P> {
    /// Solver coordinates of `params`.
    pub fn coordinates(params: &Params<R>) -> [R; P] {
        let mut x = [R::ZERO; P];
        let mut all = params.to_array();
        all[5] *= all[5];
        for (&place, &value) in const { &places(TERMS) }.iter().zip(&all) {
            if let Some(x) = x.get_mut(place) {
                *x = value;
            }
        }
        x
    }

    /// Parameters at solver coordinates; those of absent terms are 0, and n is 1.
    pub fn params(x: &[R; P]) -> Params<R> {
        Params {
            rho_d: get(TERMS, x, 0, R::ZERO),
            rho_s: get(TERMS, x, 1, R::ZERO),
            rho_v: get(TERMS, x, 2, R::ZERO),
            m: get(TERMS, x, 3, R::ONE),
            n: get(TERMS, x, 4, R::ONE),
            kappa: get(TERMS, x, 5, R::ZERO).sqrt(),
        }
    }

    /// The bounds on the solver's coordinates.
    pub fn bounds(lower: &Params<R>, upper: &Params<R>) -> Bounds<R, P> {
        Bounds {
            lower: Self::coordinates(lower),
            upper: Self::coordinates(upper),
        }
    }
}

/// The observation of a sample for model `M`; the sign of its weight does not count.
///
/// # Errors
/// [`SampleError`] tells what is wrong with the sample.
pub fn observe<R: Real, M: Model<R, P, C>, const P: usize, const C: usize>(
    sample: &Sample<R>,
) -> Result<Observation<R, [R; C]>, SampleError> {
    let geometry = M::geometry(sample.theta_i, sample.theta_s, sample.delta_phi)?;
    Observation::at(geometry, sample.brdf, sample.weight)
}

/// ln f of model `M` at the solver's coordinates `x` in the directions of `geometry` ([`Model::geometry`]), f in sr^-1.
pub fn value<R: Real, M: Model<R, P, C>, const P: usize, const C: usize>(x: &[R; P], geometry: [R; C]) -> R {
    M::row(&M::pass(x), &Block::of(geometry), 0, Want::Value, &mut [R::ZERO; P])
}

/// The same, and its derivatives by the solver's coordinates.
pub fn ln_f<R: Real, M: Model<R, P, C>, const P: usize, const C: usize>(x: &[R; P], geometry: [R; C]) -> (R, [R; P]) {
    let mut gradient = [R::ZERO; P];
    let ln_f = M::row(&M::pass(x), &Block::of(geometry), 0, Want::Gradient, &mut gradient);
    (ln_f, gradient)
}

impl<'a, R: Real, M: Model<R, P, C>, const P: usize, const C: usize> Residuals<'a, R, M, P, C> {
    /// The scan whose observations are in `blocks`.
    #[cfg_attr(target_os = "none", inline(never))]
    pub fn new(blocks: &'a [Block<R, LANES, C>]) -> Self {
        Residuals {
            blocks,
            seen: M::seen(blocks),
            model: PhantomData,
        }
    }

    /// Number of its parts of [`PART`] blocks.
    pub fn parts(&self) -> usize {
        self.blocks.len().div_ceil(PART)
    }

    /// Part `k` of them.
    pub fn part(&self, k: usize) -> Self {
        let end = self.blocks.len().min((k + 1) * PART);
        Residuals {
            blocks: &self.blocks[k * PART..end],
            ..*self
        }
    }

    /// What `of` gives of each part, added in order.
    #[inline(always)]
    pub(crate) fn summed<S>(&self, of: impl Fn(&Self) -> S, add: impl Fn(&mut S, &S)) -> S {
        // No microcontroller has memory for more than one.
        if ALONE || self.blocks.len() <= PART {
            return of(self);
        }
        let mut sum = of(&self.part(0));
        for k in 1..self.parts() {
            add(&mut sum, &of(&self.part(k)));
        }
        sum
    }

    /// Its observations.
    pub fn blocks(&self) -> &'a [Block<R, LANES, C>] {
        self.blocks
    }

    /// The bounds of the model's description on the solver's coordinates: for Eq. 14, Table 1.
    pub fn usual_bounds() -> Bounds<R, P> {
        let side = |of: fn(&Parameter) -> f64| {
            let values = core::array::from_fn(|k| R::of(M::PARAMETERS.get(k).map_or(0.0, of)));
            Self::from_values(&values)
        };
        Bounds {
            lower: side(|parameter| parameter.bounds.0),
            upper: side(|parameter| parameter.bounds.1),
        }
    }

    /// Solver coordinates of the model's parameters.
    pub fn from_values(values: &[R; P]) -> [R; P] {
        let mut x = *values;
        for (value, parameter) in x.iter_mut().zip(M::PARAMETERS) {
            if parameter.is_squared() {
                *value *= *value;
            }
        }
        x
    }

    /// Derivatives of the parameters by the solver's coordinates: see [`Parameter::slope`].
    pub fn slopes(x: &[R; P]) -> [R; P] {
        core::array::from_fn(|k| M::PARAMETERS.get(k).map_or(R::ONE, |parameter| parameter.slope(x[k])))
    }

    /// The model's parameters at solver coordinates.
    pub fn values(x: &[R; P]) -> [R; P] {
        let mut values = *x;
        for (value, parameter) in values.iter_mut().zip(M::PARAMETERS) {
            if parameter.is_squared() {
                *value = value.sqrt();
            }
        }
        values
    }
}

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

impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> Problem<R, P> for Residuals<'_, R, M, P, C> {
    fn cost(&self, x: &[R; P]) -> R {
        self.summed(|part| part.inlined_cost(x), |sum, part| *sum += *part)
    }

    fn bend(&self, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P] {
        M::bend(&self.seen, x, step, to)
    }

    fn linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        self.summed(|part| part.inlined_linearize(x), Linearization::add_part)
    }
}

/// Blocks of which the sums are made in one go: those of a larger scan are the sums of its parts, added in order, so that threads can share the parts and change no bit.
pub const PART: usize = 4096;

impl<R: Real, M: Model<R, P, C>, const P: usize, const C: usize> Residuals<'_, R, M, P, C> {
    /// [`Problem::cost`], compiled into its caller, for the vector instructions that the caller may use.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    pub fn inlined_cost(&self, x: &[R; P]) -> R {
        if ALONE {
            return self.scalar_cost(x);
        }
        self.totals_of::<false>(x)[0]
    }

    /// The sums of r^2, w r and w^2 over the residuals r = w (ln f - measured), of weight w, compiled into its caller.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    pub fn inlined_totals(&self, x: &[R; P]) -> [R; 3] {
        if ALONE {
            return self.scalar_totals(x);
        }
        self.totals_of::<true>(x)
    }

    /// These; the second and the third only if `ALL`.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn totals_of<const ALL: bool>(&self, x: &[R; P]) -> [R; 3] {
        let pass = M::pass(x);
        let mut sums = [[R::ZERO; SUMS]; 3];
        for block in self.blocks {
            let begun = M::begin(&pass, block);
            for lane in 0..SUMS {
                let model = M::rows::<false>(&pass, block, &begun, lane);
                let [a, b] = residual(block, lane, model.ln_f).0;
                sums[0][lane] += a * a + b * b;
                if ALL {
                    let [v, w] = Pack::<R, GROUP>::gather(&block.weight, lane).0;
                    sums[1][lane] += a * v + b * w;
                    sums[2][lane] += v * v + w * w;
                }
            }
        }
        [total(&sums[0]), total(&sums[1]), total(&sums[2])]
    }

    /// [`Problem::linearize`], compiled into its caller.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    pub fn inlined_linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        if ALONE {
            return self.scalar_linearize(x);
        }
        let pass = M::pass(x);
        let mut squares = Aligned([R::ZERO; SUMS]);
        let mut gradient = Aligned([[R::ZERO; SUMS]; P]);
        let mut hessian = Aligned([[[R::ZERO; SUMS]; P]; P]);
        for block in self.blocks {
            let begun = M::begin(&pass, block);
            let mut residuals = Aligned([[R::ZERO; SUMS]; GROUP]);
            let mut rows = Aligned([[[R::ZERO; SUMS]; GROUP]; P]);
            for lane in 0..SUMS {
                let model = M::rows::<true>(&pass, block, &begun, lane);
                let residual = residual(block, lane, model.ln_f);
                for half in 0..GROUP {
                    residuals.0[half][lane] = residual.0[half];
                    for i in 0..P {
                        rows.0[i][half][lane] = model.gradient[i].0[half];
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
        let mut sums = Linearization::zero();
        sums.cost = total(&squares.0);
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

#[inline(always)]
fn residual<R: Real, const C: usize>(block: &Block<R, LANES, C>, lane: usize, ln_f: Pack<R, GROUP>) -> Pack<R, GROUP> {
    (ln_f - Pack::gather(&block.ln_f, lane)) * Pack::gather(&block.weight, lane)
}
