//! The modified Cook-Torrance BRDF of Eq. 14, as ln f with its gradient.

use crate::fresnel::Index;
use crate::geometry::{Block, Geometry, SURFACE_LOBE, VOLUME_LOBE};
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
    index: Index<R>,
    /// No diffuse term keeps the lobes from underflow.
    faint: bool,
    /// Lobes that are not 0 everywhere.
    shining: [bool; 2],
    ln_rho_d: R,
    lift_limit: R,
}

/// ln f of a block, with its derivatives.
pub(crate) struct Rows<R, const L: usize> {
    pub ln_f: [R; L],
    /// In the order of [`NAMES`], the last by kappa^2; multiplied by the block's weights.
    pub gradient: [[R; L]; 6],
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
    #[inline(always)]
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
        let shining = [shines(rho[0]), shines(rho[1])];
        let ln_rho_d = if rho_d > R::TINY { rho_d.ln() } else { -R::MAX };
        Brdf {
            rho_d_pi: rho_d / R::PI,
            rho,
            inverse_m: R::ONE / params.m,
            index,
            faint: !(rho_d > R::FAINT) && (shining[0] || shining[1]),
            shining,
            ln_rho_d,
            lift_limit: if rho_d > R::TINY { -ln_rho_d } else { R::LIFT },
        }
    }

    /// ln f of every lane, and if `GRADIENT` its derivatives.
    ///
    /// With E = exp(-tan^2 theta_h / m^2), f = rho_d/pi + sum over lobes of rho F factor E / m^2.
    /// Where no diffuse term keeps that from underflow, the largest exponent (`shift`) is taken out of the sum, so ln f stays right where D_b is no number of this type.
    #[inline(always)]
    pub(crate) fn rows<const L: usize, const GRADIENT: bool>(&self, block: &Block<R, L>) -> Rows<R, L> {
        let (zero, one, two) = (R::ZERO, R::ONE, R::of(2.0));
        let inverse_m2 = self.inverse_m * self.inverse_m;
        let lobes = Self::FIRST_LOBE..Self::LAST_LOBE + 1;
        let mut shift = [zero; L];
        let mut lift = [one; L];
        if self.faint {
            for lane in 0..L {
                let mut brightest = self.ln_rho_d;
                for lobe in lobes.clone() {
                    let exponent = -block.tan2_theta_h[lobe][lane] * inverse_m2;
                    brightest = brightest.max(if self.shining[lobe] { exponent } else { -R::MAX });
                }
                shift[lane] = brightest;
                lift[lane] = (-brightest).min(self.lift_limit).exp();
            }
        }
        // beam = factor E / m^2, for both lobes; then F in its stages.
        let mut beam = [[zero; L]; 2];
        for lobe in lobes.clone() {
            for lane in 0..L {
                let exponent = (-block.tan2_theta_h[lobe][lane] * inverse_m2 - shift[lane]).min(R::LIFT);
                let beckmann = if exponent < R::CUT { zero } else { exponent.exp() };
                beam[lobe][lane] = block.factor[lobe][lane] * inverse_m2 * beckmann;
            }
        }
        let fresnel = self.index.lanes::<2, L, GRADIENT>(&block.cos_theta_d, lobes.clone());
        let mut rows = Rows {
            ln_f: [zero; L],
            gradient: [[zero; L]; 6],
        };
        for lane in 0..L {
            let mut sum = self.rho_d_pi * lift[lane];
            let (mut d_m, mut d_n, mut d_kappa2) = (zero, zero, zero);
            for lobe in lobes.clone() {
                let d_rho = beam[lobe][lane] * fresnel.f[lobe][lane];
                let term = self.rho[lobe] * d_rho;
                sum += term;
                d_m += term * (block.tan2_theta_h[lobe][lane] * inverse_m2 - one);
                let weighted = self.rho[lobe] * beam[lobe][lane];
                d_n += weighted * fresnel.d_n[lobe][lane];
                d_kappa2 += weighted * fresnel.d_kappa2[lobe][lane];
                rows.gradient[1 + lobe][lane] = d_rho;
            }
            let sum = sum.max(R::TINY);
            rows.ln_f[lane] = shift[lane] + sum.ln();
            if GRADIENT {
                let share = block.weight[lane] / sum;
                rows.gradient[0][lane] = lift[lane] * (share / R::PI);
                rows.gradient[1][lane] *= share;
                rows.gradient[2][lane] *= share;
                rows.gradient[3][lane] = d_m * share * (two * self.inverse_m);
                rows.gradient[4][lane] = d_n * share;
                rows.gradient[5][lane] = d_kappa2 * share;
            }
        }
        rows
    }

    /// f / f_measured for unit rho_d, rho_s and rho_v, times the block's weights.
    #[inline(always)]
    pub(crate) fn relative_columns<const L: usize>(&self, block: &Block<R, L>) -> [[R; L]; 3] {
        let inverse_m2 = self.inverse_m * self.inverse_m;
        let lobes = Self::FIRST_LOBE..Self::LAST_LOBE + 1;
        let fresnel = self.index.lanes::<2, L, false>(&block.cos_theta_d, lobes.clone());
        let mut columns = [[R::ZERO; L]; 3];
        for lane in 0..L {
            columns[0][lane] = block.weight[lane] * (-block.ln_f[lane]).exp() / R::PI;
        }
        for lobe in lobes {
            for lane in 0..L {
                let exponent = -block.tan2_theta_h[lobe][lane] * inverse_m2;
                let beckmann = if exponent < R::CUT { R::ZERO } else { exponent.exp() };
                let beam = block.factor[lobe][lane] * inverse_m2 * beckmann * fresnel.f[lobe][lane];
                columns[1 + lobe][lane] = beam * (columns[0][lane] * R::PI);
            }
        }
        columns
    }

    /// ln f, f in sr^-1; where f vanishes (all weights 0), ln of the smallest sum that counts.
    pub fn ln_f(&self, geometry: &Geometry<R>) -> R {
        self.rows::<1, false>(&single(geometry)).ln_f[0]
    }

    /// ln f, and its derivatives by rho_d, rho_s, rho_v, m, n and kappa (0 for absent terms).
    pub fn gradient(&self, geometry: &Geometry<R>) -> (R, [R; 6]) {
        let rows = self.rows::<1, true>(&single(geometry));
        let mut gradient = [R::ZERO; 6];
        for (index, value) in gradient.iter_mut().enumerate() {
            if has(TERMS, index) {
                *value = rows.gradient[index][0];
            }
        }
        gradient[5] *= R::of(2.0) * self.index.kappa;
        (rows.ln_f[0], gradient)
    }
}

fn single<R: Real>(geometry: &Geometry<R>) -> Block<R, 1> {
    let mut block = Block::empty();
    block.set_geometry(0, geometry);
    block.weight = [R::ONE];
    block
}

/// F, dF/dn and dF/dkappa of unpolarised light; `0 < cos_theta <= 1`, `n >= 1`, `kappa >= 0`, result 0 to 1.
pub fn fresnel<R: Real>(cos_theta: R, n: R, kappa: R) -> (R, R, R) {
    let fresnel = Index::new(n, kappa * kappa).lanes::<1, 1, true>(&[[cos_theta]], 0..1);
    (
        fresnel.f[0][0],
        fresnel.d_n[0][0],
        R::of(2.0) * kappa * fresnel.d_kappa2[0][0],
    )
}
