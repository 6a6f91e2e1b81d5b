//! The modified Cook-Torrance BRDF of Eq. 14, as ln f with its gradient.

use crate::fresnel::{Fresnel, Index};
use crate::geometry::{Block, Geometry, SURFACE_LOBE, VOLUME_LOBE};
use crate::pack::{ALONE, Pack};
use crate::real::Real;

/// Lambertian term `rho_d / pi`.
pub const DIFFUSE: u8 = 1;
/// Surface lobe `rho_s sigma D_b(theta_h) F(theta_d) G_c`.
pub const SURFACE: u8 = 2;
/// Volume lobe `rho_v D_b(theta_he) F(theta_de)`.
pub const VOLUME: u8 = 4;
/// kappa is a parameter; without it kappa = 0.
pub const ABSORBING: u8 = 8;
/// Eq. 14 whole.
pub const ALL: u8 = DIFFUSE | SURFACE | VOLUME | ABSORBING;

/// The parameters' names, in the order used everywhere.
pub const NAMES: [&str; 6] = ["rho_d", "rho_s", "rho_v", "m", "n", "kappa"];

/// Is parameter `index` of [`NAMES`] part of `terms`?
pub const fn has(terms: u8, index: usize) -> bool {
    present(terms) >> index & 1 != 0
}

/// Bit i tells whether parameter i of [`NAMES`] is part of `terms`.
const fn present(terms: u8) -> u32 {
    let weights = (terms & (DIFFUSE | SURFACE | VOLUME)) as u32;
    let lobes = terms & (SURFACE | VOLUME) != 0;
    let m_and_n = if lobes { 0b011_000 } else { 0 };
    let kappa = if lobes && terms & ABSORBING != 0 { 0b100_000 } else { 0 };
    weights | m_and_n | kappa
}

/// Number of parameters of `terms`.
pub const fn parameters(terms: u8) -> usize {
    slot(terms, 6)
}

/// Place of parameter `index` among those of `terms`.
pub const fn slot(terms: u8, index: usize) -> usize {
    (present(terms) & ((1 << index) - 1)).count_ones() as usize
}

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

/// The model with its parameters, and what follows from them alone; `TERMS` is what the scene needs, and what is left out costs nothing.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Brdf<R, const TERMS: u8> {
    rho_d_pi: R,
    /// Of the surface and the volume lobe.
    rho: [R; 2],
    inverse_m: R,
    inverse_m2: R,
    index: Index<R>,
    /// No diffuse term keeps the lobes from underflow.
    faint: bool,
    /// Lobes that are not 0 everywhere.
    shining: [bool; 2],
    ln_rho_d: R,
    lift_limit: R,
}

/// ln f of `G` lanes of a block, with its derivatives.
pub(crate) struct Rows<R, const G: usize> {
    pub ln_f: Pack<R, G>,
    /// In the order of [`NAMES`], the last by kappa^2; multiplied by the block's weights.
    pub gradient: [Pack<R, G>; 6],
}

/// What keeps the lobes of a block from underflow.
pub(crate) struct Lift<R, const L: usize> {
    /// Taken out of the exponents.
    shift: [R; L],
    /// exp(-shift), within limits.
    lift: [R; L],
}

/// Number of lobes of `terms`.
pub(crate) const fn lobes(terms: u8) -> usize {
    (terms & (SURFACE | VOLUME)).count_ones() as usize
}

impl<R: Real, const TERMS: u8> Brdf<R, TERMS> {
    const DIFFUSE: bool = TERMS & DIFFUSE != 0;
    const FIRST_LOBE: usize = if TERMS & SURFACE != 0 {
        SURFACE_LOBE
    } else {
        VOLUME_LOBE
    };
    const LAST_LOBE: usize = if TERMS & VOLUME != 0 { VOLUME_LOBE } else { SURFACE_LOBE };

    /// The model at `params`, of which those of absent terms are ignored.
    pub fn new(params: &Params<R>) -> Self {
        let kappa2 = params.kappa * params.kappa;
        Self::with_kappa2(&Params {
            kappa: kappa2,
            ..*params
        })
    }

    /// As `new`, but the last parameter is kappa^2.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    pub(crate) fn with_kappa2(params: &Params<R>) -> Self {
        let when = |present: bool, x: R| if present { x } else { R::ZERO };
        let rho_d = when(Self::DIFFUSE, params.rho_d);
        let rho = [
            when(TERMS & SURFACE != 0, params.rho_s),
            when(TERMS & VOLUME != 0, params.rho_v),
        ];
        let kappa2 = when(has(TERMS, 5), params.kappa);
        let index = Index::new(params.n, kappa2);
        let shines = |rho: R| rho > R::TINY && !index.is_vacuum();
        let inverse_m = R::ONE / params.m;
        let shining = [shines(rho[0]), shines(rho[1])];
        let ln_rho_d = if rho_d > R::TINY { rho_d.ln() } else { -R::MAX };
        Brdf {
            rho_d_pi: rho_d / R::PI,
            rho,
            inverse_m,
            inverse_m2: inverse_m * inverse_m,
            index,
            faint: !(rho_d > R::FAINT) && (shining[0] || shining[1]),
            shining,
            ln_rho_d,
            lift_limit: if rho_d > R::TINY { -ln_rho_d } else { R::LIFT },
        }
    }

    /// Where no diffuse term keeps the lobes from underflow, the largest exponent of each lane.
    #[cfg_attr(not(target_os = "none"), inline(always))]
    pub(crate) fn lift<const L: usize>(&self, block: &Block<R, L>) -> Lift<R, L> {
        let mut shift = [R::ZERO; L];
        let mut lift = [R::ONE; L];
        if self.faint {
            for lane in 0..L {
                let mut brightest = self.ln_rho_d;
                for lobe in Self::FIRST_LOBE..Self::LAST_LOBE + 1 {
                    let exponent = -block.tan2_theta_h[lobe][lane] * self.inverse_m2;
                    brightest = brightest.max(if self.shining[lobe] { exponent } else { -R::MAX });
                }
                shift[lane] = brightest;
                lift[lane] = (-brightest).min(self.lift_limit).exp();
            }
        }
        Lift { shift, lift }
    }

    /// One number of each lobe and lane: lobe by lobe, the `G` lanes of [`Pack::gather`].
    #[inline(always)]
    fn facets<const K: usize, const G: usize, const L: usize>(rows: &[[R; L]; 2], lane: usize) -> Pack<R, K> {
        Pack::from_fn(|k| rows[Self::FIRST_LOBE + k / G][lane + k % G * (L / G)])
    }

    /// factor E / m^2 and F of each lobe and lane, with E = exp(-tan^2 theta_h / m^2 - shift).
    #[inline(always)]
    fn beams<const K: usize, const G: usize, const L: usize, const GRADIENT: bool>(
        &self,
        block: &Block<R, L>,
        shift: Pack<R, G>,
        lane: usize,
    ) -> (Pack<R, K>, Fresnel<R, K>) {
        let shift = Pack::<R, K>::from_fn(|k| shift.0[k % G]);
        let exponent = Self::facets::<K, G, L>(&block.tan2_theta_h, lane) * -self.inverse_m2 - shift;
        let exponent = exponent.map(|x| x.min(R::LIFT));
        let beckmann = exponent.zip(exponent.exp(), |x, e| if x < R::CUT { R::ZERO } else { e });
        let beam = Self::facets::<K, G, L>(&block.factor, lane) * self.inverse_m2 * beckmann;
        let cos_theta_d = Self::facets::<K, G, L>(&block.cos_theta_d, lane);
        (beam, self.index.reflect::<K, GRADIENT>(cos_theta_d))
    }

    /// ln f of `G` lanes, those of [`Pack::gather`], and if `GRADIENT` its derivatives; `K` is `G` times the number of lobes.
    ///
    /// With E = exp(-tan^2 theta_h / m^2), f = rho_d/pi + sum over lobes of rho F factor E / m^2.
    /// Where no diffuse term keeps that from underflow, the largest exponent (`shift`) is taken out of the sum, so ln f stays right where D_b is no number of this type.
    #[inline(always)]
    pub(crate) fn rows<const K: usize, const G: usize, const L: usize, const GRADIENT: bool>(
        &self,
        block: &Block<R, L>,
        lift: &Lift<R, L>,
        lane: usize,
    ) -> Rows<R, G> {
        let shift = Pack::<R, G>::gather(&lift.shift, lane);
        let lift = Pack::<R, G>::gather(&lift.lift, lane);
        let rho = Pack::<R, K>::from_fn(|k| self.rho[Self::FIRST_LOBE + k / G]);
        let (beam, fresnel) = self.beams::<K, G, L, GRADIENT>(block, shift, lane);
        let d_rho = beam * fresnel.f;
        let term = rho * d_rho;
        let f = sum_lobes(lift * self.rho_d_pi, term).map(|f| f.max(R::TINY));
        let zero = Pack::splat(R::ZERO);
        let mut rows = Rows {
            ln_f: shift + f.ln(),
            gradient: [zero; 6],
        };
        if GRADIENT {
            let two = R::of(2.0);
            let share = Pack::gather(&block.weight, lane) / f;
            let weighted = rho * beam;
            let slope = Self::facets::<K, G, L>(&block.tan2_theta_h, lane) * self.inverse_m2 - R::ONE;
            rows.gradient[0] = lift * share * (R::ONE / R::PI);
            for k in 0..K {
                rows.gradient[1 + Self::FIRST_LOBE + k / G].0[k % G] = d_rho.0[k] * share.0[k % G];
            }
            rows.gradient[3] = sum_lobes(zero, term * slope) * share * (two * self.inverse_m);
            rows.gradient[4] = sum_lobes(zero, weighted * fresnel.d_n2) * share * (two * self.index.n);
            rows.gradient[5] = sum_lobes(zero, weighted * fresnel.d_kappa2) * share;
        }
        rows
    }

    /// f / f_measured for unit rho_d, rho_s and rho_v, times the block's weights; lanes and `K` as in `rows`.
    #[inline(always)]
    pub(crate) fn relative_columns<const K: usize, const G: usize, const L: usize>(
        &self,
        block: &Block<R, L>,
        lane: usize,
    ) -> [Pack<R, G>; 3] {
        if ALONE {
            let mut columns = [Pack::splat(R::ZERO); 3];
            for k in 0..G {
                let one = self.column(&block.lane(lane + k * (L / G)));
                for i in 0..3 {
                    columns[i].0[k] = one[i].0[0];
                }
            }
            return columns;
        }
        self.columns_pack::<K, G, L>(block, lane)
    }

    /// `relative_columns` of a block of one lane.
    fn column(&self, block: &Block<R, 1>) -> [Pack<R, 1>; 3] {
        match lobes(TERMS) {
            0 => self.columns_pack::<0, 1, 1>(block, 0),
            1 => self.columns_pack::<1, 1, 1>(block, 0),
            _ => self.columns_pack::<2, 1, 1>(block, 0),
        }
    }

    #[inline(always)]
    fn columns_pack<const K: usize, const G: usize, const L: usize>(
        &self,
        block: &Block<R, L>,
        lane: usize,
    ) -> [Pack<R, G>; 3] {
        let (beam, fresnel) = self.beams::<K, G, L, false>(block, Pack::splat(R::ZERO), lane);
        let lobes = beam * fresnel.f;
        let unit = Pack::gather(&block.weight, lane) * Pack::gather(&block.ln_f, lane).map(|x| -x).exp();
        let mut columns = [unit * (R::ONE / R::PI); 3];
        for k in 0..K {
            columns[1 + Self::FIRST_LOBE + k / G].0[k % G] = lobes.0[k] * unit.0[k % G];
        }
        columns
    }

    /// `rows` of a block of one lane.
    pub(crate) fn row<const GRADIENT: bool>(&self, block: &Block<R, 1>) -> Rows<R, 1> {
        let lift = self.lift(block);
        match lobes(TERMS) {
            0 => self.rows::<0, 1, 1, GRADIENT>(block, &lift, 0),
            1 => self.rows::<1, 1, 1, GRADIENT>(block, &lift, 0),
            _ => self.rows::<2, 1, 1, GRADIENT>(block, &lift, 0),
        }
    }

    fn single<const GRADIENT: bool>(&self, geometry: &Geometry<R>) -> Rows<R, 1> {
        let mut block = Block::empty();
        block.set_geometry(0, geometry);
        block.weight = [R::ONE];
        self.row::<GRADIENT>(&block)
    }

    /// ln f, f in sr^-1; where f vanishes (all weights 0), ln of the smallest sum that counts.
    pub fn ln_f(&self, geometry: &Geometry<R>) -> R {
        self.single::<false>(geometry).ln_f.0[0]
    }

    /// ln f, and its derivatives by rho_d, rho_s, rho_v, m, n and kappa (0 for absent terms).
    pub fn gradient(&self, geometry: &Geometry<R>) -> (R, [R; 6]) {
        let rows = self.single::<true>(geometry);
        let mut gradient = [R::ZERO; 6];
        for (index, value) in gradient.iter_mut().enumerate() {
            if has(TERMS, index) {
                *value = rows.gradient[index].0[0];
            }
        }
        gradient[5] *= R::of(2.0) * self.index.kappa;
        (rows.ln_f.0[0], gradient)
    }
}

/// Adds what belongs to each lane, lobe by lobe.
#[inline(always)]
fn sum_lobes<R: Real, const K: usize, const G: usize>(mut sum: Pack<R, G>, x: Pack<R, K>) -> Pack<R, G> {
    for k in 0..K {
        sum.0[k % G] += x.0[k];
    }
    sum
}

/// F, dF/dn and dF/dkappa of unpolarised light; `0 < cos_theta <= 1`, `n >= 1`, `kappa >= 0`, result 0 to 1.
pub fn fresnel<R: Real>(cos_theta: R, n: R, kappa: R) -> (R, R, R) {
    let fresnel = Index::new(n, kappa * kappa).reflect::<1, true>(Pack([cos_theta]));
    let two = R::of(2.0);
    (
        fresnel.f.0[0],
        two * n * fresnel.d_n2.0[0],
        two * kappa * fresnel.d_kappa2.0[0],
    )
}
