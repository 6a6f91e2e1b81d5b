use super::{Masking, Shadowing};
use crate::geometry::{Geometry, SampleError};
use crate::pack::Pack;
use crate::real::Real;

/// Torrance and Sparrow 1967 (Eq. 9): the facets are the sides of long V-shaped grooves, whatever their slope.
#[derive(Clone, Copy, Debug)]
pub struct VGroove;

impl<D> Masking<D, 6> for VGroove {
    fn geometry<R: Real>(theta_i: R, theta_s: R, delta_phi: R) -> Result<[R; 6], SampleError> {
        Ok(Geometry::new(theta_i, theta_s, delta_phi)?.into())
    }
}

/// `G = 1`: no facet hides another.
#[derive(Clone, Copy, Debug)]
pub struct NoMasking;

impl<D> Masking<D, 6> for NoMasking {
    fn geometry<R: Real>(theta_i: R, theta_s: R, delta_phi: R) -> Result<[R; 6], SampleError> {
        Ok(unmasked(theta_i, theta_s, delta_phi)?.into())
    }
}

/// Smith 1967: the chance that a facet is hidden does not depend on its own slope; theta_i and theta_s each on their own.
#[derive(Clone, Copy, Debug)]
pub struct Smith;

impl<D: Shadowing> Masking<D, 8> for Smith {
    const SLOPED: bool = true;

    fn geometry<R: Real>(theta_i: R, theta_s: R, delta_phi: R) -> Result<[R; 8], SampleError> {
        let [a, b, c, d, e, f] = unmasked(theta_i, theta_s, delta_phi)?.into();
        let tan2 = |theta: R| {
            let (sin, cos) = theta.portable_sin_cos();
            (sin / cos) * (sin / cos)
        };
        Ok([a, b, c, d, e, f, tan2(theta_i), tan2(theta_s)])
    }

    #[inline(always)]
    fn masking<R: Real, const K: usize>(
        [tan2_theta_i, tan2_theta_s]: [Pack<R, K>; 2],
        m2: Pack<R, K>,
    ) -> (Pack<R, K>, Pack<R, K>) {
        let (g_i, slope_i) = D::visible(tan2_theta_i * m2);
        let (g_s, slope_s) = D::visible(tan2_theta_s * m2);
        (g_i * g_s, slope_i / g_i + slope_s / g_s)
    }
}

/// Eq. 14's geometry without Eq. 9 in the factor of the surface lobe.
fn unmasked<R: Real>(theta_i: R, theta_s: R, delta_phi: R) -> Result<Geometry<R>, SampleError> {
    let mut geometry = Geometry::new(theta_i, theta_s, delta_phi)?;
    let (cos_i, cos_s) = (theta_i.portable_sin_cos().1, theta_s.portable_sin_cos().1);
    let surface = &mut geometry.lobes[0];
    let inverse_cos2 = R::ONE + surface.tan2_theta_h;
    surface.factor = R::of(0.25) / (cos_i * cos_s) * (inverse_cos2 * inverse_cos2) / R::PI;
    Ok(geometry)
}
