//! A model put together from [`crate::lobes`], as a least-squares problem like [`crate::residuals::Scan`].
//!
//! With the pieces of Eq. 14 ([`crate::lobes::Beckmann`], [`crate::lobes::VGroove`]) it is the same model; `Scan` is faster, stays right where a lobe underflows and no diffuse term is left, and leaves out terms.

use core::marker::PhantomData;

use crate::candidate::{box_least_squares, log_between, spread};
use crate::fresnel::Index;
use crate::lm::{Bounds, Linearization, Problem};
use crate::lobes::{Distribution, Facets, LANES, Lanes, Masking};
use crate::pack::Pack;
use crate::real::Real;
use crate::residuals::{bend, finest_slope, total};
use crate::search::{Candidate, Scene};
use crate::start;

/// The volume lobe has a slope `m_v` of its own.
pub const OWN_SLOPE: u8 = 1;
/// There is a second surface lobe, of weight `rho_2` and slope `m_2`, with the index of the first.
pub const SECOND: u8 = 2;

/// The parameters' names in their order; a model has the first six and those of its extras.
pub const NAMES: [&str; 9] = ["rho_d", "rho_s", "rho_v", "m", "n", "kappa", "m_v", "rho_2", "m_2"];

/// Place of parameter `index` of [`NAMES`] among those of a model with `extras`, if it has it.
pub const fn slot(extras: u8, index: usize) -> Option<usize> {
    let own = (extras & OWN_SLOPE != 0) as usize;
    match index {
        0..6 => Some(index),
        6 if own == 1 => Some(6),
        7 | 8 if extras & SECOND != 0 => Some(index - 1 + own),
        _ => None,
    }
}

/// Number of parameters of a model with `extras`.
pub const fn parameters(extras: u8) -> usize {
    6 + (extras & OWN_SLOPE != 0) as usize + 2 * (extras & SECOND != 0) as usize
}

/// The lobes: surface, volume, second surface lobe. The geometry of each, and the places of its weight and slope in [`NAMES`].
const GEOMETRY: [usize; 3] = [0, 1, 0];
const WEIGHT: [usize; 3] = [1, 2, 7];
const SLOPE: [usize; 3] = [3, 6, 8];

/// The observations of one scan, for the model of distribution `D`, masking `M` and `EXTRAS`, with its `P` parameters.
///
/// The solver's coordinates are the parameters in the order of [`NAMES`], with kappa^2 in place of kappa.
#[derive(Clone, Copy, Debug)]
pub struct Composed<'a, R, D, M, const EXTRAS: u8, const P: usize> {
    facets: &'a [Facets<R>],
    peaks: Pack<R, 2>,
    finest: R,
    pieces: PhantomData<(D, M)>,
}

/// What a lobe is made of, in each lane.
struct Lobe<R> {
    /// f of the lobe over its rho F, sr^-1.
    beam: Lanes<R>,
    /// m times its derivative by its slope m.
    slope: Lanes<R>,
}

impl<'a, R: Real, D: Distribution, M: Masking<D>, const EXTRAS: u8, const P: usize> Composed<'a, R, D, M, EXTRAS, P> {
    const MATCHES: () = assert!(P == parameters(EXTRAS), "P must be parameters(EXTRAS)");
    const LOBES: usize = if EXTRAS & SECOND != 0 { 3 } else { 2 };

    /// The scan whose observations are in `facets`.
    pub fn new(facets: &'a [Facets<R>]) -> Self {
        let () = Self::MATCHES;
        let (finest, peaks) = finest_slope(facets.len() * LANES, |lobe, i| {
            let (f, lane) = (facets.get(i / LANES)?, i % LANES);
            (f.weight.0[lane] > R::ZERO).then(|| (f.tan2_theta_h[lobe].0[lane], f.cos_theta_d[lobe].0[lane]))
        });
        Composed {
            facets,
            peaks,
            finest,
            pieces: PhantomData,
        }
    }

    /// Parameter `index` of [`NAMES`] at solver coordinates; kappa is squared.
    #[inline(always)]
    fn get(x: &[R; P], index: usize) -> Option<R> {
        slot(EXTRAS, index).and_then(|k| x.get(k).copied())
    }

    /// The slope of a lobe; without one of its own, the volume lobe has that of the first surface lobe.
    #[inline(always)]
    fn slope(x: &[R; P], lobe: usize) -> R {
        Self::get(x, SLOPE[lobe]).unwrap_or(x[3])
    }

    #[inline(always)]
    fn lobe(facets: &Facets<R>, lobe: usize, m: R) -> Lobe<R> {
        let inverse_m2 = R::ONE / (m * m);
        let t = facets.tan2_theta_h[GEOMETRY[lobe]] * inverse_m2;
        let (g, d_ln_g) = D::shape(t);
        let (masking, d_masking) = if GEOMETRY[lobe] == 0 {
            M::masking(facets, m)
        } else {
            (Pack::splat(R::ONE), Pack::splat(R::ZERO))
        };
        let bare = facets.factor[GEOMETRY[lobe]] * inverse_m2 * g;
        Lobe {
            beam: bare * masking,
            slope: bare * (d_masking - masking * (t * d_ln_g + R::ONE) * R::of(2.0)),
        }
    }

    /// ln f of each lane, and if `GRADIENT` its derivatives by the solver's coordinates, multiplied by the weights.
    #[inline(always)]
    fn rows<const GRADIENT: bool>(x: &[R; P], facets: &Facets<R>) -> (Lanes<R>, [Lanes<R>; P]) {
        let index = Index::new(x[4], x[5]);
        let reflect = |g: usize| index.reflect::<LANES, GRADIENT>(facets.cos_theta_d[g]);
        let fresnel = [reflect(0), reflect(1)];
        let lobe = |lobe: usize| Self::lobe(facets, lobe, Self::slope(x, lobe));
        let lobes = [lobe(0), lobe(1), lobe(2)];
        let mut f = Pack::splat(x[0] / R::PI);
        for lobe in 0..Self::LOBES {
            let rho = Self::get(x, WEIGHT[lobe]).unwrap_or(R::ZERO);
            f = f + lobes[lobe].beam * fresnel[GEOMETRY[lobe]].f * rho;
        }
        let f = f.map(|f| f.max(R::TINY));
        let mut gradient = [Pack::splat(R::ZERO); P];
        if GRADIENT {
            let share = facets.weight / f;
            let two_n = index.n + index.n;
            let mut add = |index: usize, value: Lanes<R>| {
                if let Some(row) = slot(EXTRAS, index).and_then(|k| gradient.get_mut(k)) {
                    *row = *row + value * share;
                }
            };
            add(0, Pack::splat(R::ONE / R::PI));
            for lobe in 0..Self::LOBES {
                let rho = Self::get(x, WEIGHT[lobe]).unwrap_or(R::ZERO);
                let m = Self::slope(x, lobe);
                let own = slot(EXTRAS, SLOPE[lobe]).map_or(SLOPE[0], |_| SLOPE[lobe]);
                let (of, shine) = (&lobes[lobe], &fresnel[GEOMETRY[lobe]]);
                add(WEIGHT[lobe], of.beam * shine.f);
                add(own, of.slope * shine.f * (rho / m));
                add(4, of.beam * shine.d_n2 * (rho * two_n));
                add(5, of.beam * shine.d_kappa2 * rho);
            }
        }
        (f.ln(), gradient)
    }

    /// ln f of every observation at parameters in the order of [`NAMES`], f in sr^-1, and its derivatives by the solver's coordinates.
    pub fn each(&self, x: &[R; P], mut row: impl FnMut(R, [R; P])) {
        for facets in self.facets {
            let (ln_f, gradient) = Self::rows::<true>(x, facets);
            for lane in 0..LANES {
                if facets.weight.0[lane] > R::ZERO {
                    row(
                        ln_f.0[lane],
                        gradient.map(|column| column.0[lane] / facets.weight.0[lane]),
                    );
                }
            }
        }
    }
}

impl<R: Real, D: Distribution, M: Masking<D>, const EXTRAS: u8, const P: usize> Problem<R, P>
    for Composed<'_, R, D, M, EXTRAS, P>
{
    fn cost(&self, x: &[R; P]) -> R {
        let mut squares = Pack::splat(R::ZERO);
        for facets in self.facets {
            let residual = (Self::rows::<false>(x, facets).0 - facets.ln_f) * facets.weight;
            squares = squares + residual * residual;
        }
        total(&squares.0)
    }

    fn bend(&self, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P] {
        let weights = WEIGHT.map(|index| slot(EXTRAS, index));
        bend(
            x,
            step,
            to,
            Some(4),
            Some(5),
            weights.into_iter().zip(GEOMETRY),
            self.peaks,
        )
    }

    fn linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        let zero = Pack::splat(R::ZERO);
        let mut squares = zero;
        let mut gradient = [zero; P];
        let mut hessian = [[zero; P]; P];
        for facets in self.facets {
            let (ln_f, rows) = Self::rows::<true>(x, facets);
            let residual = (ln_f - facets.ln_f) * facets.weight;
            squares = squares + residual * residual;
            for i in 0..P {
                gradient[i] = gradient[i] + rows[i] * residual;
                for j in 0..=i {
                    hessian[i][j] = hessian[i][j] + rows[i] * rows[j];
                }
            }
        }
        Linearization {
            cost: total(&squares.0),
            gradient: core::array::from_fn(|i| total(&gradient[i].0)),
            hessian: core::array::from_fn(|i| core::array::from_fn(|j| total(&hessian[i.max(j)][i.min(j)].0))),
        }
    }
}

impl<R: Real, D: Distribution, M: Masking<D>, const EXTRAS: u8, const P: usize> Scene<R, P>
    for Composed<'_, R, D, M, EXTRAS, P>
{
    /// Candidate `i`: slopes, n and kappa spread over the logarithm of their ranges, then the weights that fit best.
    fn candidate(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, like: Option<&[R; P]>) -> Candidate<R, P> {
        let mut x = bounds.lower;
        spread(&mut x, bounds, seed, i, self.finest, [Some(3), Some(4), Some(5)]);
        let unit = Bounds {
            lower: [R::ZERO; P],
            upper: [R::ONE; P],
        };
        let random = start::uniform(seed, i, &unit);
        for index in [SLOPE[1], SLOPE[2]] {
            if let Some(k) = slot(EXTRAS, index) {
                let (lower, upper) = (bounds.lower[k].max(self.finest), bounds.upper[k].min(R::of(3.0)));
                x[k] = log_between(lower.min(bounds.upper[k]), upper.max(bounds.lower[k]), random[k]);
            }
        }
        if let Some(like) = like {
            for k in SLOPE.into_iter().filter_map(|index| slot(EXTRAS, index)) {
                x[k] = like[k];
            }
        }
        let rank = self.set_weights(&mut x, bounds);
        Candidate {
            x: bounds.clamp(x),
            rank,
        }
    }
}

impl<R: Real, D: Distribution, M: Masking<D>, const EXTRAS: u8, const P: usize> Composed<'_, R, D, M, EXTRAS, P> {
    /// Sets the weights to the least squares of f / f_measured - 1 within their bounds, and returns its rank; one pass.
    fn set_weights(&self, x: &mut [R; P], bounds: &Bounds<R, P>) -> R {
        const COLUMNS: [usize; 4] = [0, WEIGHT[0], WEIGHT[1], WEIGHT[2]];
        let zero = Pack::splat(R::ZERO);
        let index = Index::new(x[4], x[5]);
        let mut normal = [[zero; 4]; 4];
        let mut rhs = [zero; 4];
        for facets in self.facets {
            let unit = facets.weight * facets.ln_f.map(|x| -x).exp();
            let mut columns = [unit * (R::ONE / R::PI); 4];
            for lobe in 0..Self::LOBES {
                let fresnel = index.reflect::<LANES, false>(facets.cos_theta_d[GEOMETRY[lobe]]);
                columns[1 + lobe] = Self::lobe(facets, lobe, Self::slope(x, lobe)).beam * fresnel.f * unit;
            }
            for i in 0..4 {
                rhs[i] = rhs[i] + columns[i] * facets.weight;
                for j in 0..=i {
                    normal[i][j] = normal[i][j] + columns[i] * columns[j];
                }
            }
        }
        let within = |side: &[R; P]| COLUMNS.map(|index| Self::get(side, index).unwrap_or(R::ZERO));
        let present = COLUMNS.map(|index| slot(EXTRAS, index).is_some());
        let normal = core::array::from_fn(|i| core::array::from_fn(|j| total(&normal[i.max(j)][i.min(j)].0)));
        let (best, rank) = box_least_squares(
            &normal,
            &rhs.map(|r| total(&r.0)),
            present,
            within(&bounds.lower),
            within(&bounds.upper),
        );
        for (k, value) in COLUMNS.into_iter().zip(best) {
            if let Some(weight) = slot(EXTRAS, k).and_then(|k| x.get_mut(k)) {
                *weight = value;
            }
        }
        rank
    }
}
