//! Which parts of a microfacet model are there, as bits of a `u8`, and which parameters these have.

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
/// The volume lobe has a slope `m_v` of its own.
pub const OWN_SLOPE: u8 = 16;
/// There is a second surface lobe, of weight `rho_2` and slope `m_2`, with the index of the first.
pub const SECOND: u8 = 32;
/// The distribution has the exponent `q` of its tail ([`crate::lobes::HyperCauchy`]).
pub const TAIL: u8 = 64;
/// Facets of the surface lobe are mirrors too, of weight `rho_m`: what they reflect does not depend on the angle, as of flakes of metal in a paint.
pub const MIRRORS: u8 = 128;

/// The names of Eq. 14's parameters, in the order used everywhere.
pub const NAMES: [&str; 6] = ["rho_d", "rho_s", "rho_v", "m", "n", "kappa"];

/// Parameters that a microfacet model can have: the six of [`NAMES`], then `m_v`, `rho_2`, `m_2`, `q` and `rho_m`.
pub(crate) const EVERY: usize = 11;
/// Places of `m_v`, `rho_2`, `m_2`, `q` and `rho_m` among them.
pub(super) const M_V: usize = 6;
pub(super) const RHO_2: usize = 7;
pub(super) const M_2: usize = 8;
pub(super) const Q: usize = 9;
pub(super) const RHO_M: usize = 10;

/// Is parameter `index`, in the order of [`NAMES`], part of `terms`?
#[inline(always)]
pub const fn has(terms: u8, index: usize) -> bool {
    present(terms) >> index & 1 != 0
}

/// Bit i tells whether parameter i is part of `terms`.
#[inline(always)]
const fn present(terms: u8) -> u32 {
    let weights = (terms & (DIFFUSE | SURFACE | VOLUME)) as u32;
    let lobes = terms & (SURFACE | VOLUME) != 0;
    let m_and_n = if lobes { 0b011_000 } else { 0 };
    let kappa = if lobes && terms & ABSORBING != 0 { 0b100_000 } else { 0 };
    let own = if terms & OWN_SLOPE != 0 { 1 << M_V } else { 0 };
    let second = if terms & SECOND != 0 { 1 << RHO_2 | 1 << M_2 } else { 0 };
    let tail = if terms & TAIL != 0 { 1 << Q } else { 0 };
    let mirrors = if terms & MIRRORS != 0 { 1 << RHO_M } else { 0 };
    weights | m_and_n | kappa | own | second | tail | mirrors
}

/// Number of parameters of `terms`.
#[inline(always)]
pub const fn parameters(terms: u8) -> usize {
    slot(terms, EVERY)
}

/// Place of parameter `index` among those of `terms`.
#[inline(always)]
pub const fn slot(terms: u8, index: usize) -> usize {
    (present(terms) & ((1 << index) - 1)).count_ones() as usize
}

/// The same, or `usize::MAX` for one that is not part of `terms`: no array has that place.
pub(crate) const fn place(terms: u8, index: usize) -> usize {
    if has(terms, index) {
        slot(terms, index)
    } else {
        usize::MAX
    }
}

/// The places of Eq. 14's parameters.
pub(crate) const fn places(terms: u8) -> [usize; NAMES.len()] {
    let mut list = [0; NAMES.len()];
    let mut index = 0;
    while index < list.len() {
        list[index] = place(terms, index);
        index += 1;
    }
    list
}

/// Parameter `index` of the coordinates of `terms`, or `absent`.
#[inline(always)]
pub(crate) fn get<R: Real, const P: usize>(terms: u8, x: &[R; P], index: usize, absent: R) -> R {
    if has(terms, index) {
        x.get(slot(terms, index)).copied().unwrap_or(absent)
    } else {
        absent
    }
}
