use super::{Distribution, Shadowing};
use crate::pack::Pack;
use crate::real::Real;

/// Trowbridge and Reitz 1975, called GGX by Walter, Marschner, Li and Torrance 2007 (their Eq. 33): `g(t) = 1 / (1 + t)^2`.
#[derive(Clone, Copy, Debug)]
pub struct Ggx;

impl Distribution for Ggx {
    #[inline(always)]
    fn shape<R: Real, const K: usize>(t: Pack<R, K>, _shift: Pack<R, K>, _q: R) -> Pack<R, K> {
        let inverse = (t + R::ONE).map(|x| R::ONE / x);
        inverse * inverse
    }

    #[inline(always)]
    fn fall<R: Real, const K: usize>(t: Pack<R, K>, _q: R) -> Pack<R, K> {
        let inverse = (t + R::ONE).map(|x| R::ONE / x);
        t * inverse * R::of(2.0)
    }
}

impl Shadowing for Ggx {
    /// Walter et al. 2007, Eq. 34: `2 / (1 + sqrt(1 + m^2 tan^2 theta))`.
    #[inline(always)]
    fn visible<R: Real, const K: usize>(a2: Pack<R, K>) -> (Pack<R, K>, Pack<R, K>) {
        let inverse_root = (a2 + R::ONE).rsqrt();
        let root = (a2 + R::ONE) * inverse_root;
        let half = (root + R::ONE).map(|x| R::ONE / x);
        let slope = half * half * a2 * inverse_root * -R::of(2.0);
        (half + half, slope)
    }
}
