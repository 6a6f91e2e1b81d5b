//! One row of a microfacet model: lobe after lobe, so that the image of a microcontroller has one copy of what they compute.
//!
//! The formulas and their order are those of [`Brdf::write`], and so are the bits.

use super::{Brdf, LOBES, M_2, M_V, MIRRORS, Q, RHO_2, RHO_M, SLOPE, has, lobe, lobes, pair, slope, slot};
use crate::geometry::Block;
use crate::lobes::{Distribution, Masking};
use crate::model::Want;
use crate::pack::Pack;
use crate::real::Real;

impl<R: Real, const TERMS: u8, D: Distribution, M> Brdf<R, TERMS, D, M> {
    /// ln f of one lane, and in `row` what is wanted beside it.
    #[inline(always)]
    pub(crate) fn row<const L: usize, const C: usize, const P: usize>(
        &self,
        block: &Block<R, L, C>,
        lane: usize,
        want: Want,
        row: &mut [R; P],
    ) -> R
    where
        M: Masking<D, C>,
    {
        // So the compiler sees that no index is out of range.
        let lane = lane % L;
        let gradient = want == Want::Gradient;
        let (shift, factor) = if D::UNDERFLOWS && self.may_underflow && want != Want::Columns {
            self.shift_of_lane(block, lane)
        } else {
            (R::ZERO, R::ONE)
        };
        let mut f = factor * self.rho_d_pi;
        let mut d_rho = [R::ZERO; LOBES];
        let mut by_slope = [R::ZERO; LOBES];
        let (mut by_n2, mut by_kappa2, mut by_q, mut by_mirrors) = (R::ZERO, R::ZERO, R::ZERO, R::ZERO);
        for place in 0..lobes(TERMS) {
            let lobe = lobe(TERMS, place);
            let unit_lobes = self.unit_lobes::<1, 1, L, C>(block, place, Pack([shift]), lane);
            let cos_theta_d = block.columns[2 + pair(lobe)][lane];
            let fresnel = self.index.reflect(Pack([cos_theta_d]), gradient);
            d_rho[lobe] = unit_lobes.f.0[0] * fresnel.f.0[0];
            let mut term = self.rho[lobe] * d_rho[lobe];
            if TERMS & MIRRORS != 0 && place == 0 {
                by_mirrors = unit_lobes.f.0[0];
                term += self.rho_m * by_mirrors;
            }
            f += term;
            if gradient {
                let mut steepness = D::fall(unit_lobes.t, self.q).0[0] - R::ONE;
                if M::SLOPED {
                    steepness += unit_lobes.masking_slope.0[0] * R::of(0.5);
                }
                by_slope[const { owners(TERMS) }[lobe]] += term * steepness;
                let weighted = self.rho[lobe] * unit_lobes.f.0[0];
                by_n2 += weighted * fresnel.d_n2.0[0];
                by_kappa2 += weighted * fresnel.d_kappa2.0[0];
                if D::TAIL {
                    by_q += term * D::tail(unit_lobes.t, self.q).0[0];
                }
            }
        }
        let f = f.max(R::TINY);
        if want != Want::Value {
            let two = R::of(2.0);
            let share = if gradient { block.weight[lane] / f } else { R::ONE };
            set::<0, TERMS, R, P>(row, factor * share * (R::ONE / R::PI));
            set::<1, TERMS, R, P>(row, d_rho[0] * share);
            set::<2, TERMS, R, P>(row, d_rho[1] * share);
            set::<RHO_2, TERMS, R, P>(row, d_rho[2] * share);
            set::<RHO_M, TERMS, R, P>(row, by_mirrors * share);
            if !gradient {
                return R::ZERO;
            }
            let steep = |lobe: usize| by_slope[lobe] * share * (two * self.inverse_m[lobe]);
            set::<3, TERMS, R, P>(row, steep(0));
            set::<4, TERMS, R, P>(row, by_n2 * share * (two * self.index.n));
            set::<5, TERMS, R, P>(row, by_kappa2 * share);
            set::<M_V, TERMS, R, P>(row, steep(1));
            set::<M_2, TERMS, R, P>(row, steep(2));
            set::<Q, TERMS, R, P>(row, by_q * share);
        }
        shift + f.portable_ln()
    }
}

/// The lobe whose slope each lobe of `terms` has.
const fn owners(terms: u8) -> [usize; LOBES] {
    let mut owners = [0; LOBES];
    let mut lobe = 1;
    while lobe < LOBES {
        if slope(terms, lobe) == SLOPE[lobe] {
            owners[lobe] = lobe;
        }
        lobe += 1;
    }
    owners
}

/// Puts a derivative into its place, if its parameter is part of `TERMS`; the place is known when this is compiled.
#[inline(always)]
fn set<const INDEX: usize, const TERMS: u8, R, const P: usize>(row: &mut [R; P], value: R) {
    if const { has(TERMS, INDEX) }
        && let Some(place) = row.get_mut(const { slot(TERMS, INDEX) })
    {
        *place = value;
    }
}
