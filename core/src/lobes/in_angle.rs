use super::Masking;
use crate::geometry::SampleError;
use crate::real::Real;

/// The masking `M` of facets whose distribution is one of tilts, not of slopes: `D = g(theta_h^2 / m^2) / (pi m^2)`, with m in radians.
///
/// With [`super::Beckmann`]'s g that is the Gaussian `exp(-(c alpha)^2)` of Torrance and Sparrow 1967, as Blinn 1977 gives it, with c = 1/m.
#[derive(Clone, Copy, Debug)]
pub struct InAngle<M>(core::marker::PhantomData<M>);

impl<D, M: Masking<D, 6>> Masking<D, 6> for InAngle<M> {
    fn geometry<R: Real>(theta_i: R, theta_s: R, delta_phi: R) -> Result<[R; 6], SampleError> {
        let mut columns = M::geometry(theta_i, theta_s, delta_phi)?;
        for lobe in 0..2 {
            let tan2 = columns[lobe];
            let theta_h = tan2.sqrt().portable_atan();
            columns[lobe] = theta_h * theta_h;
            columns[4 + lobe] = columns[4 + lobe] / ((R::ONE + tan2) * (R::ONE + tan2));
        }
        Ok(columns)
    }
}
