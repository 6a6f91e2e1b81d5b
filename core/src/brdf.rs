//! Microfacet models as ln f with its gradient: the modified Cook-Torrance BRDF of Eq. 14, and what else Eq. 5 gives from other pieces.

mod row;
mod terms;

use core::marker::PhantomData;

use crate::fresnel::{Fresnel, Index};
use crate::geometry::{Block, Geometry};
use crate::lobes::{Beckmann, Distribution, Masking, VGroove};
use crate::model::{Rows, WEIGHTS, Want};
use crate::pack::{Pack, each};
use crate::real::Real;

pub use crate::fresnel::{Reflecting, fresnel};
pub use terms::{
    ABSORBING, ALL, DIFFUSE, MIRRORS, NAMES, OWN_SLOPE, SECOND, SURFACE, TAIL, VOLUME, has, parameters, slot,
};
pub(crate) use terms::{EVERY, get, place, places};
use terms::{M_2, M_V, Q, RHO_2, RHO_M};

/// The six parameters of Eq. 14, all dimensionless; those of absent terms are 0, and n is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Params<R> {
    /// Diffuse reflectance.
    pub rho_d: R,
    /// Weight of the surface lobe.
    pub rho_s: R,
    /// Weight of the volume lobe.
    pub rho_v: R,
    /// Slope of the facets (Eq. 8).
    pub m: R,
    /// Real part of the index of refraction n - i kappa.
    pub n: R,
    /// Its imaginary part, not negative.
    pub kappa: R,
}

impl<R: Real> Params<R> {
    /// In the order of [`NAMES`].
    pub fn to_array(self) -> [R; 6] {
        [self.rho_d, self.rho_s, self.rho_v, self.m, self.n, self.kappa]
    }
    /// From the order of [`NAMES`].
    pub fn from_array([rho_d, rho_s, rho_v, m, n, kappa]: [R; 6]) -> Self {
        Params {
            rho_d,
            rho_s,
            rho_v,
            m,
            n,
            kappa,
        }
    }
}

/// The lobes that a model can have: surface, volume, second surface lobe.
const LOBES: usize = 3;
/// Places of the weight of each, and of its slope where it has one of its own.
pub(crate) const WEIGHT: [usize; LOBES] = [1, 2, RHO_2];
const SLOPE: [usize; LOBES] = [3, M_V, M_2];

/// Which pair of facet angles a lobe has: that of the surface lobe, or that of the volume lobe.
#[inline(always)]
pub(crate) const fn pair(lobe: usize) -> usize {
    lobe % 2
}

/// Number of lobes of `terms`.
#[inline(always)]
pub(crate) const fn lobes(terms: u8) -> usize {
    (terms & (SURFACE | VOLUME | SECOND)).count_ones() as usize
}

/// Which lobe is in place `place` of those of `terms`.
#[inline(always)]
const fn lobe(terms: u8, place: usize) -> usize {
    match (terms & SURFACE != 0, terms & VOLUME != 0) {
        (true, true) => place,
        (true, false) => 2 * place,
        (false, _) => place + 1,
    }
}

/// Place of the slope of a lobe of `terms`: its own, or that of the first.
#[inline(always)]
const fn slope(terms: u8, lobe: usize) -> usize {
    if has(terms, SLOPE[lobe]) { SLOPE[lobe] } else { SLOPE[0] }
}

/// A microfacet model with its parameters, and what follows from them alone: without `D` and `M` that of Eq. 14.
///
/// `TERMS` is what the scene needs, and what is left out costs nothing.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Brdf<R, const TERMS: u8, D = Beckmann, M = VGroove> {
    rho_d_pi: R,
    rho: [R; LOBES],
    /// Weight of the mirrors among the facets of the first lobe.
    rho_m: R,
    inverse_m: [R; LOBES],
    inverse_m2: [R; LOBES],
    q: R,
    index: Index<R>,
    /// No diffuse term keeps the lobes from underflow.
    may_underflow: bool,
    /// Lobes that are not 0 everywhere.
    shining: [bool; LOBES],
    ln_rho_d: R,
    most_shift: R,
    pieces: PhantomData<(D, M)>,
}

/// What keeps the lobes of a block from underflow.
#[derive(Clone, Copy, Debug)]
pub struct Shifts<R, const L: usize> {
    /// Taken out of the exponents.
    shift: [R; L],
    /// exp(-shift), within limits.
    factor: [R; L],
}

impl<R: Real, const TERMS: u8> Brdf<R, TERMS> {
    /// The model of Eq. 14 at `params`, of which those of absent terms are ignored.
    pub fn new(params: &Params<R>) -> Self {
        let Params {
            rho_d,
            rho_s,
            rho_v,
            m,
            n,
            kappa,
        } = *params;
        Self::build(
            rho_d,
            [rho_s, rho_v, R::ZERO],
            R::ZERO,
            [m; LOBES],
            R::ONE,
            Index::new(n, kappa * kappa),
        )
    }

    /// ln f, f in sr^-1; where f vanishes (all weights 0), ln of the smallest sum that counts.
    pub fn ln_f(&self, geometry: &Geometry<R>) -> R {
        self.row(&Block::of((*geometry).into()), 0, Want::Value, &mut [R::ZERO; 0])
    }

    /// ln f, and its derivatives by rho_d, rho_s, rho_v, m, n and kappa (0 for absent terms).
    pub fn gradient(&self, geometry: &Geometry<R>) -> (R, [R; 6]) {
        let mut row = [R::ZERO; NAMES.len()];
        let ln_f = self.row(&Block::of((*geometry).into()), 0, Want::Gradient, &mut row);
        let mut gradient = core::array::from_fn(|index| get(TERMS, &row, index, R::ZERO));
        gradient[5] *= R::of(2.0) * self.index.kappa;
        (ln_f, gradient)
    }
}

impl<R: Real, const TERMS: u8, D: Distribution, M> Brdf<R, TERMS, D, M> {
    /// The model at the solver's coordinates, the last of Eq. 14's being kappa^2.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    pub(crate) fn at<const P: usize>(x: &[R; P]) -> Self {
        let value = |index: usize, absent: R| get(TERMS, x, index, absent);
        let m = |lobe: usize| value(slope(TERMS, lobe), R::ONE);
        Self::build(
            value(0, R::ZERO),
            [value(1, R::ZERO), value(2, R::ZERO), value(RHO_2, R::ZERO)],
            value(RHO_M, R::ZERO),
            [m(0), m(1), m(2)],
            value(Q, R::ONE),
            Index::new(value(4, R::ONE), value(5, R::ZERO)),
        )
    }

    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn build(rho_d: R, rho: [R; LOBES], rho_m: R, m: [R; LOBES], q: R, index: Index<R>) -> Self {
        let when = |present: bool, x: R| if present { x } else { R::ZERO };
        let rho_d = when(TERMS & DIFFUSE != 0, rho_d);
        let rho = [
            when(TERMS & SURFACE != 0, rho[0]),
            when(TERMS & VOLUME != 0, rho[1]),
            when(TERMS & SECOND != 0, rho[2]),
        ];
        let index = if has(TERMS, 5) {
            index
        } else {
            Index::new(index.n, R::ZERO)
        };
        let shines = |rho: R| rho > R::TINY && !index.is_vacuum();
        let rho_m = when(TERMS & MIRRORS != 0, rho_m);
        let shining = [shines(rho[0]) || rho_m > R::TINY, shines(rho[1]), shines(rho[2])];
        // Lobes that share a slope share one division.
        let first = R::ONE / m[0];
        let inverse_m = [
            first,
            if has(TERMS, M_V) { R::ONE / m[1] } else { first },
            if has(TERMS, M_2) { R::ONE / m[2] } else { first },
        ];
        let ln_rho_d = if rho_d > R::TINY { rho_d.portable_ln() } else { -R::MAX };
        Brdf {
            rho_d_pi: rho_d / R::PI,
            rho,
            rho_m,
            inverse_m,
            inverse_m2: [
                inverse_m[0] * inverse_m[0],
                inverse_m[1] * inverse_m[1],
                inverse_m[2] * inverse_m[2],
            ],
            q,
            index,
            may_underflow: D::UNDERFLOWS && !(rho_d > R::LEAST_DIFFUSE) && (shining[0] || shining[1] || shining[2]),
            shining,
            ln_rho_d,
            most_shift: if rho_d > R::TINY { -ln_rho_d } else { R::MOST_EXPONENT },
            pieces: PhantomData,
        }
    }

    /// Where no diffuse term keeps the lobes from underflow, the largest exponent of each lane.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    pub(crate) fn shifts<const L: usize, const C: usize>(&self, block: &Block<R, L, C>) -> Shifts<R, L> {
        let mut shift = [R::ZERO; L];
        let mut factor = [R::ONE; L];
        if D::UNDERFLOWS && self.may_underflow {
            for lane in 0..L {
                (shift[lane], factor[lane]) = self.shift_of_lane(block, lane);
            }
        }
        Shifts { shift, factor }
    }

    /// The same of one lane, if no diffuse term keeps its lobes from underflow.
    #[inline(always)]
    fn shift_of_lane<const L: usize, const C: usize>(&self, block: &Block<R, L, C>, lane: usize) -> (R, R) {
        let mut brightest = self.ln_rho_d;
        for place in 0..lobes(TERMS) {
            let lobe = lobe(TERMS, place);
            let exponent = -block.columns[pair(lobe)][lane] * self.inverse_m2[lobe];
            brightest = brightest.max(if self.shining[lobe] { exponent } else { -R::MAX });
        }
        (brightest, (-brightest).min(self.most_shift).portable_exp())
    }

    /// A column of the pair of facet angles of each lobe from place `from` on: lobe by lobe, the `G` lanes of [`Pack::gather`].
    #[inline(always)]
    fn facets<const K: usize, const G: usize, const L: usize, const C: usize>(
        block: &Block<R, L, C>,
        from: usize,
        first: usize,
        lane: usize,
    ) -> Pack<R, K> {
        Pack::from_fn(|k| block.columns[first + pair(lobe(TERMS, from + k / G))][lane + k % G * (L / G)])
    }

    /// A number of each lobe from place `from` on, for each of its lanes.
    #[inline(always)]
    fn of_lobes<const K: usize, const G: usize>(numbers: &[R; LOBES], from: usize) -> Pack<R, K> {
        Pack::from_fn(|k| numbers[lobe(TERMS, from + k / G)])
    }

    /// f of each lobe from place `from` on and of each lane at rho F = 1, times exp(-shift).
    #[inline(always)]
    fn unit_lobes<const K: usize, const G: usize, const L: usize, const C: usize>(
        &self,
        block: &Block<R, L, C>,
        from: usize,
        shift: Pack<R, G>,
        lane: usize,
    ) -> UnitLobes<R, K>
    where
        M: Masking<D, C>,
    {
        let shift = Pack::<R, K>::from_fn(|k| shift.0[k % G]);
        let inverse_m2 = Self::of_lobes::<K, G>(&self.inverse_m2, from);
        let t = Self::facets::<K, G, L, C>(block, from, 0, lane) * inverse_m2;
        let f = Self::facets::<K, G, L, C>(block, from, 4, lane) * inverse_m2 * D::shape(t, shift, self.q);
        let mut unit_lobes = UnitLobes {
            f,
            t,
            masking_slope: Pack::splat(R::ZERO),
        };
        if M::SLOPED {
            // The volume lobe has no masking: there, facets of slope 0.
            let m2 = Pack::<R, K>::from_fn(|k| {
                let lobe = lobe(TERMS, from + k / G);
                if pair(lobe) == 0 {
                    R::ONE / self.inverse_m2[lobe]
                } else {
                    R::ZERO
                }
            });
            let tan2_theta =
                |column: usize| Pack::<R, K>::from_fn(|k| block.columns[column % C][lane + k % G * (L / G)]);
            let (masking, slope) = M::masking([tan2_theta(6), tan2_theta(7)], m2);
            unit_lobes.f = unit_lobes.f * masking;
            unit_lobes.masking_slope = slope;
        }
        unit_lobes
    }

    /// F of each lobe from place `from` on and of each lane; `KP` is `G` times the number of pairs of facet angles.
    #[inline(always)]
    fn reflect<const K: usize, const KP: usize, const G: usize, const L: usize, const C: usize>(
        &self,
        block: &Block<R, L, C>,
        from: usize,
        lane: usize,
        gradient: bool,
    ) -> Fresnel<R, K> {
        let cos_theta_d = Self::facets::<KP, G, L, C>(block, from, 2, lane);
        let fresnel = self.index.reflect(cos_theta_d, gradient);
        // The second surface lobe has the angles of the first.
        let spread = |pack: Pack<R, KP>| Pack::<R, K>::from_fn(|k| pack.0[if k < KP { k } else { k % G }]);
        Fresnel {
            f: spread(fresnel.f),
            d_n2: spread(fresnel.d_n2),
            d_kappa2: spread(fresnel.d_kappa2),
        }
    }

    /// ln f of `G` lanes, those of [`Pack::gather`], and if `GRADIENT` its derivatives; `K` is `G` times the number of lobes.
    ///
    /// With t = tan^2 theta_h / m^2, f = rho_d/pi + sum over lobes of rho F factor g(t) / m^2; mirrors of the first lobe add rho_m to its rho F.
    /// Where no diffuse term keeps that from underflow, the largest exponent (`shift`) is taken out of the sum, so ln f stays right where D_b is outside the range of this type.
    #[inline(always)]
    pub(crate) fn write<
        const K: usize,
        const KP: usize,
        const G: usize,
        const L: usize,
        const C: usize,
        const GRADIENT: bool,
        const P: usize,
    >(
        &self,
        block: &Block<R, L, C>,
        shifts: &Shifts<R, L>,
        lane: usize,
        rows: &mut Rows<R, G, P>,
    ) where
        M: Masking<D, C>,
    {
        let shift = Pack::<R, G>::gather(&shifts.shift, lane);
        let factor = Pack::<R, G>::gather(&shifts.factor, lane);
        let rho = Self::of_lobes::<K, G>(&self.rho, 0);
        let unit_lobes = self.unit_lobes::<K, G, L, C>(block, 0, shift, lane);
        let fresnel = self.reflect::<K, KP, G, L, C>(block, 0, lane, GRADIENT);
        let d_rho = unit_lobes.f * fresnel.f;
        let mut term = rho * d_rho;
        if TERMS & MIRRORS != 0 {
            term = term + Self::of_lobes::<K, G>(&[self.rho_m, R::ZERO, R::ZERO], 0) * unit_lobes.f;
        }
        let f = sum_lobes(factor * self.rho_d_pi, term).map(|f| f.max(R::TINY));
        rows.ln_f = shift + f.ln();
        if !GRADIENT {
            return;
        }
        let two = R::of(2.0);
        let share = Pack::gather(&block.weight, lane) / f;
        let weighted = rho * unit_lobes.f;
        let mut set = |index: usize, value: Pack<R, G>| {
            if has(TERMS, index)
                && let Some(row) = rows.gradient.get_mut(slot(TERMS, index))
            {
                *row = value;
            }
        };
        set(0, factor * share * (R::ONE / R::PI));
        // Written out, as the steep ones below are: where a loop counts the places, the compiler knows them too late to use vectors.
        if const { K > 0 } {
            set(WEIGHT[lobe(TERMS, 0)], of_place(&d_rho, 0) * share);
        }
        if const { K > G } {
            set(WEIGHT[lobe(TERMS, 1)], of_place(&d_rho, 1) * share);
        }
        if const { K > 2 * G } {
            set(WEIGHT[lobe(TERMS, 2)], of_place(&d_rho, 2) * share);
        }
        if TERMS & MIRRORS != 0 {
            set(RHO_M, Pack::from_fn(|k| unit_lobes.f.0[k]) * share);
        }
        // m d ln(f of a lobe) / dm, over 2.
        let mut steepness = D::fall(unit_lobes.t, self.q) - Pack::splat(R::ONE);
        if M::SLOPED {
            steepness = steepness + unit_lobes.masking_slope * R::of(0.5);
        }
        let by_slope = term * steepness;
        let mut steep = |owner: usize| {
            let index = SLOPE[owner];
            let sum = sum_some(by_slope, |place| slope(TERMS, lobe(TERMS, place)) == index);
            set(index, sum * share * (two * self.inverse_m[owner]));
        };
        steep(0);
        steep(1);
        steep(2);
        set(
            4,
            sum_lobes(Pack::splat(R::ZERO), weighted * fresnel.d_n2) * share * (two * self.index.n),
        );
        set(5, sum_lobes(Pack::splat(R::ZERO), weighted * fresnel.d_kappa2) * share);
        if D::TAIL {
            set(
                Q,
                sum_lobes(Pack::splat(R::ZERO), term * D::tail(unit_lobes.t, self.q)) * share,
            );
        }
    }

    /// f of each weight at 1 and the others at 0; lanes, `K` and `KP` as in `write`.
    #[inline(always)]
    pub(crate) fn columns<const K: usize, const KP: usize, const G: usize, const L: usize, const C: usize>(
        &self,
        block: &Block<R, L, C>,
        lane: usize,
    ) -> [Pack<R, G>; WEIGHTS]
    where
        M: Masking<D, C>,
    {
        let unit_lobes = self.unit_lobes::<K, G, L, C>(block, 0, Pack::splat(R::ZERO), lane);
        let lobes = unit_lobes.f * self.reflect::<K, KP, G, L, C>(block, 0, lane, false).f;
        let mut columns = [Pack::splat(R::ONE / R::PI); WEIGHTS];
        let diffuse = (TERMS & DIFFUSE != 0) as usize;
        for place in 0..K / G {
            if let Some(column) = columns.get_mut(diffuse + place) {
                *column = Pack::from_fn(|k| lobes.0[place * G + k]);
            }
        }
        if TERMS & MIRRORS != 0
            && let Some(column) = columns.get_mut(diffuse + K / G)
        {
            *column = Pack::from_fn(|k| unit_lobes.f.0[k]);
        }
        columns
    }
}

/// What the lobes are made of, in each lane.
struct UnitLobes<R, const K: usize> {
    /// f of each lobe at rho F = 1, sr^-1, times exp(-shift).
    f: Pack<R, K>,
    /// tan^2 theta_h / m^2.
    t: Pack<R, K>,
    /// m d ln G / dm, where G depends on the slope.
    masking_slope: Pack<R, K>,
}

/// Those of `x` that belong to the lobe in place `place`.
#[inline(always)]
fn of_place<R: Real, const K: usize, const G: usize>(x: &Pack<R, K>, place: usize) -> Pack<R, G> {
    Pack::from_fn(|k| x.0[place * G + k])
}

/// Adds what belongs to each lane, lobe by lobe.
#[inline(always)]
fn sum_lobes<R: Real, const K: usize, const G: usize>(mut sum: Pack<R, G>, x: Pack<R, K>) -> Pack<R, G> {
    each!(K, |k| sum.0[k % G] += x.0[k]);
    sum
}

/// The same over some of the lobes, from 0.
#[inline(always)]
fn sum_some<R: Real, const K: usize, const G: usize>(x: Pack<R, K>, counts: impl Fn(usize) -> bool) -> Pack<R, G> {
    let mut sum = Pack::splat(R::ZERO);
    each!(K, |k| if counts(k / G) {
        sum.0[k % G] += x.0[k];
    });
    sum
}
