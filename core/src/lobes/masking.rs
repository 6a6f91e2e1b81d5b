use super::{Distribution, Facets, Lanes, Masking};
use crate::pack::Pack;
use crate::real::Real;

/// Torrance and Sparrow 1967 (Eq. 9): the facets are the sides of long V-shaped grooves, whatever their slope.
#[derive(Clone, Copy, Debug)]
pub struct VGroove;

impl<D> Masking<D> for VGroove {
    #[inline(always)]
    fn masking<R: Real>(facets: &Facets<R>, _m: R) -> (Lanes<R>, Lanes<R>) {
        (facets.v_groove, Pack::splat(R::ZERO))
    }
}

/// Smith 1967: the chance that a facet is hidden does not depend on its own slope; theta_i and theta_s each on their own.
#[derive(Clone, Copy, Debug)]
pub struct Smith;

impl<D: Distribution> Masking<D> for Smith {
    #[inline(always)]
    fn masking<R: Real>(facets: &Facets<R>, m: R) -> (Lanes<R>, Lanes<R>) {
        let m2 = m * m;
        let (g_i, slope_i) = D::visible(facets.tan2_theta[0] * m2);
        let (g_s, slope_s) = D::visible(facets.tan2_theta[1] * m2);
        (g_i * g_s, slope_i * g_s + g_i * slope_s)
    }
}

/// `G = 1`: no facet hides another.
#[derive(Clone, Copy, Debug)]
pub struct NoMasking;

impl<D> Masking<D> for NoMasking {
    #[inline(always)]
    fn masking<R: Real>(_facets: &Facets<R>, _m: R) -> (Lanes<R>, Lanes<R>) {
        (Pack::splat(R::ONE), Pack::splat(R::ZERO))
    }
}
