//! Microfacet models as [`Model`]s: Eq. 14 with what a scene needs, and the same with other pieces of Eq. 5.

use core::marker::PhantomData;

use crate::bend::{FINEST, bend, peak, ratio};
use crate::brdf::{Brdf, EVERY, SECOND, Shifts, WEIGHT, has, lobes, pair, place, slot};
use crate::geometry::{Block, LANES, SampleError};
use crate::lm::Bounds;
use crate::lobes::{Beckmann, Distribution, Masking, VGroove};
use crate::model::{GROUP, Model, Parameter, Role, Rows, Seen, WEIGHTS, Want};
use crate::pack::Pack;
use crate::real::Real;

/// A microfacet model of some terms (`brdf::ALL` is Eq. 14), of distribution `D` and masking `M`.
#[derive(Clone, Copy, Debug)]
pub struct Microfacet<const TERMS: u8, D = Beckmann, M = VGroove>(PhantomData<(D, M)>);

/// Every parameter that a microfacet model can have, with the bounds of Table 1.
pub const PARAMETERS: [Parameter; EVERY] = [
    Parameter::new("rho_d", "ρ_d", Role::Weight, 1.0).what("diffuse reflectance"),
    Parameter::new("rho_s", "ρ_s", Role::Weight, 100.0).what("weight of the surface lobe"),
    Parameter::new("rho_v", "ρ_v", Role::Weight, 100.0).what("weight of the volume lobe"),
    SLOPE_OF_FACETS,
    Parameter::new("n", "n", Role::Index, 100.0)
        .what("real part of the index of refraction")
        .bounds(1.0, 100.0)
        .domain(1.0, crate::model::LARGEST)
        .spread(1.0, 10.0),
    Parameter::new("kappa", "κ", Role::Absorption, 100.0)
        .what("imaginary part of the index of refraction")
        .spread(1e-3, 100.0),
    Parameter {
        name: "m_v",
        symbol: "m_v",
        what: "slope of the volume lobe's facets",
        ..SLOPE_OF_FACETS
    },
    Parameter::new("rho_2", "ρ_2", Role::Weight, 100.0).what("weight of the second surface lobe"),
    Parameter {
        name: "m_2",
        symbol: "m_2",
        what: "slope of the second surface lobe's facets",
        ..SLOPE_OF_FACETS
    },
    Parameter::new("q", "q", Role::Shape, 50.0)
        .what("exponent of the distribution's tail")
        .bounds(1.01, 50.0)
        .domain(1.001, 1000.0)
        .spread(1.1, 10.0),
    Parameter::new("rho_m", "ρ_m", Role::Weight, 100.0).what("weight of facets that are mirrors"),
];

const SLOPE_OF_FACETS: Parameter = Parameter::new("m", "m", Role::Slope, 10.0)
    .what("slope of the facets")
    .bounds(1e-5, 10.0)
    .domain(1e-6, crate::model::LARGEST);

/// The parameters of some terms, in their order.
const fn parameters_of<const P: usize>(terms: u8) -> [Parameter; P] {
    assert!(P == crate::brdf::parameters(terms), "P must be parameters(TERMS)");
    let mut list = [PARAMETERS[0]; P];
    let mut index = 0;
    while index < EVERY {
        if has(terms, index) {
            list[slot(terms, index)] = PARAMETERS[index];
        }
        index += 1;
    }
    list
}

/// Place of the weight of each lobe, `usize::MAX` for one that is not there, and which pair of facet angles the lobe has.
const fn weights_of_lobes(terms: u8) -> [(usize, usize); WEIGHT.len()] {
    let mut list = [(0, 0); WEIGHT.len()];
    let mut lobe = 0;
    while lobe < list.len() {
        list[lobe] = (place(terms, WEIGHT[lobe]), pair(lobe));
        lobe += 1;
    }
    list
}

impl<R, D, M, const TERMS: u8, const P: usize, const C: usize> Model<R, P, C> for Microfacet<TERMS, D, M>
where
    R: Real,
    D: Distribution,
    M: Masking<D, C>,
{
    const PARAMETERS: [Parameter; P] = parameters_of(TERMS);
    type Pass = Brdf<R, TERMS, D, M>;
    type Begun<const L: usize> = Shifts<R, L>;

    fn geometry(theta_i: R, theta_s: R, delta_phi: R) -> Result<[R; C], SampleError> {
        M::geometry(theta_i, theta_s, delta_phi)
    }

    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn pass(x: &[R; P]) -> Self::Pass {
        Brdf::at(x)
    }

    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn begin<const L: usize>(pass: &Self::Pass, block: &Block<R, L, C>) -> Shifts<R, L> {
        pass.shifts(block)
    }

    #[inline(always)]
    fn rows<const GRADIENT: bool>(
        pass: &Self::Pass,
        block: &Block<R, LANES, C>,
        shifts: &Shifts<R, LANES>,
        lane: usize,
    ) -> Rows<R, GROUP, P> {
        const TWO: usize = 2 * GROUP;
        const THREE: usize = 3 * GROUP;
        let mut rows = Rows {
            ln_f: Pack::splat(R::ZERO),
            gradient: [Pack::splat(R::ZERO); P],
        };
        // What other terms need is not even compiled.
        if const { lobes(TERMS) == 0 } {
            pass.write::<0, 0, GROUP, LANES, C, GRADIENT, P>(block, shifts, lane, &mut rows);
        } else if const { lobes(TERMS) == 1 } {
            pass.write::<GROUP, GROUP, GROUP, LANES, C, GRADIENT, P>(block, shifts, lane, &mut rows);
        } else if const { lobes(TERMS) == 2 && TERMS & SECOND == 0 } {
            pass.write::<TWO, TWO, GROUP, LANES, C, GRADIENT, P>(block, shifts, lane, &mut rows);
        } else if const { lobes(TERMS) == 2 } {
            pass.write::<TWO, GROUP, GROUP, LANES, C, GRADIENT, P>(block, shifts, lane, &mut rows);
        } else {
            pass.write::<THREE, TWO, GROUP, LANES, C, GRADIENT, P>(block, shifts, lane, &mut rows);
        }
        rows
    }

    #[inline(always)]
    fn row<const L: usize>(pass: &Self::Pass, block: &Block<R, L, C>, lane: usize, want: Want, row: &mut [R; P]) -> R {
        pass.row(block, lane, want, row)
    }

    #[inline(always)]
    fn columns(pass: &Self::Pass, block: &Block<R, LANES, C>, lane: usize) -> [Pack<R, GROUP>; WEIGHTS] {
        const TWO: usize = 2 * GROUP;
        const THREE: usize = 3 * GROUP;
        if const { lobes(TERMS) == 0 } {
            pass.columns::<0, 0, GROUP, LANES, C>(block, lane)
        } else if const { lobes(TERMS) == 1 } {
            pass.columns::<GROUP, GROUP, GROUP, LANES, C>(block, lane)
        } else if const { lobes(TERMS) == 2 && TERMS & SECOND == 0 } {
            pass.columns::<TWO, TWO, GROUP, LANES, C>(block, lane)
        } else if const { lobes(TERMS) == 2 } {
            pass.columns::<TWO, GROUP, GROUP, LANES, C>(block, lane)
        } else {
            pass.columns::<THREE, TWO, GROUP, LANES, C>(block, lane)
        }
    }

    fn seen(blocks: &[Block<R, LANES, C>]) -> Seen<R> {
        seen(blocks)
    }

    fn keep_heights(seen: &Seen<R>, like: &[R; P], x: &mut [R; P]) {
        let places = const { [place(TERMS, 0), place(TERMS, 4), place(TERMS, 5)] };
        keep_heights(seen, like, x, places, const { &weights_of_lobes(TERMS) });
    }

    fn fade(x: &mut [R; P], bounds: &Bounds<R, P>) -> bool {
        let index = const { [place(TERMS, 4), place(TERMS, 5)] };
        fade(x, bounds, index, const { &weights_of_lobes(TERMS) })
    }

    fn bend(seen: &Seen<R>, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P] {
        let index = const { [place(TERMS, 4), place(TERMS, 5)] };
        bend(x, step, to, index, const { &weights_of_lobes(TERMS) }, &seen.peaks)
    }
}

// What follows takes the places of parameters as numbers: it is compiled once for all models of as many parameters.

#[cfg_attr(target_os = "none", inline(always))]
fn seen<R: Real, const C: usize>(blocks: &[Block<R, LANES, C>]) -> Seen<R> {
    let mut seen = Seen::nothing();
    let mut third = R::MAX;
    for pair in 0..2 {
        let (cos_theta_d, of_pair) = peak(blocks, [pair, 2 + pair], &mut seen.near[pair]);
        seen.peaks.0[pair] = cos_theta_d;
        third = third.min(of_pair);
    }
    seen.finest = R::of(FINEST) * third.sqrt();
    seen
}

#[cfg_attr(target_os = "none", inline(always))]
fn keep_heights<R: Real, const P: usize>(
    seen: &Seen<R>,
    like: &[R; P],
    x: &mut [R; P],
    [rho_d, n, kappa2]: [usize; 3],
    weights: &[(usize, usize); WEIGHT.len()],
) {
    let at = |x: &[R; P], place: usize, absent: R| x.get(place).copied().unwrap_or(absent);
    let index = |x: &[R; P]| [at(x, n, R::ONE), at(x, kappa2, R::ZERO)];
    let ratio = ratio(index(like), index(x), &seen.peaks);
    if let Some(x) = x.get_mut(rho_d) {
        *x = at(like, rho_d, R::ZERO);
    }
    for &(place, pair) in weights {
        if let Some((rho, &old)) = x.get_mut(place).zip(like.get(place)) {
            *rho = old * ratio[pair % 2];
        }
    }
}

/// As n goes to 1 and kappa to 0, F goes to 0 in proportion to |n - i kappa - 1|^2.
#[cfg_attr(target_os = "none", inline(always))]
fn fade<R: Real, const P: usize>(
    x: &mut [R; P],
    bounds: &Bounds<R, P>,
    [n, kappa2]: [usize; 2],
    weights: &[(usize, usize); WEIGHT.len()],
) -> bool {
    let mut part = R::ZERO;
    for &(place, _) in weights {
        if let Some((rho, &most)) = x.get(place).zip(bounds.upper.get(place)) {
            part = part.max(*rho / most);
        }
    }
    if !(part > R::ZERO) {
        return false;
    }
    // Not so far up that F is no longer in proportion.
    let part = part.min(R::of(10.0));
    if let Some(n) = x.get_mut(n) {
        *n = R::ONE + (*n - R::ONE) * part.sqrt();
    }
    if let Some(kappa2) = x.get_mut(kappa2) {
        *kappa2 *= part;
    }
    for &(place, _) in weights {
        if let Some((rho, &most)) = x.get_mut(place).zip(bounds.upper.get(place)) {
            *rho = (*rho / part).min(most);
        }
    }
    true
}
