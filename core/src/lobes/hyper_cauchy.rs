use super::Distribution;
use crate::pack::Pack;
use crate::real::Real;

/// The hyper-Cauchy distribution of slopes (Renhorn and Boreman 2008, the paper's reference 21), with an exponent q > 1 of its own: `g(t) = (q - 1) / (1 + t)^q`.
///
/// With q = 2 it is GGX; a small q gives wide tails, and with m^2 = q m_B^2 and a large q it goes over into Beckmann's of slope m_B.
/// Computer graphics calls it GTR (Burley 2012).
#[derive(Clone, Copy, Debug)]
pub struct HyperCauchy;

impl Distribution for HyperCauchy {
    const TAIL: bool = true;

    #[inline(always)]
    fn shape<R: Real, const K: usize>(t: Pack<R, K>, _shift: Pack<R, K>, q: R) -> Pack<R, K> {
        let exponent = (t + R::ONE).ln() * -q;
        exponent.zip(exponent.exp(), |x, e| if x < R::LEAST_EXPONENT { R::ZERO } else { e }) * (q - R::ONE)
    }

    #[inline(always)]
    fn fall<R: Real, const K: usize>(t: Pack<R, K>, q: R) -> Pack<R, K> {
        let inverse = (t + R::ONE).map(|x| R::ONE / x);
        t * inverse * q
    }

    #[inline(always)]
    fn tail<R: Real, const K: usize>(t: Pack<R, K>, q: R) -> Pack<R, K> {
        (t + R::ONE).ln().map(|x| R::ONE / (q - R::ONE) - x)
    }
}
