//! The pieces of Eq. 5 that a microfacet model is put together from at compile time: a distribution of facets and a masking.
//!
//! Each piece is a type without a value, so a piece that is not named costs nothing.

mod beckmann;
mod ggx;
mod hyper_cauchy;
mod in_angle;
mod masking;

pub use beckmann::Beckmann;
pub use ggx::Ggx;
pub use hyper_cauchy::HyperCauchy;
pub use in_angle::InAngle;
pub use masking::{NoMasking, Smith, VGroove};

use crate::geometry::SampleError;
use crate::pack::Pack;
use crate::real::Real;

/// How the slopes of the facets are distributed: `D = g(tan^2 theta_h / m^2) / (pi m^2 cos^4 theta_h)`.
pub trait Distribution: Copy {
    /// Is g(t) outside the range of its type where t is large? Then ln f is computed from its exponent.
    const UNDERFLOWS: bool = false;
    /// Has it a further parameter q, the exponent of its tail?
    const TAIL: bool = false;

    /// `g(t) exp(-shift)`, dimensionless; `t >= 0`, and `shift` is 0 unless [`Distribution::UNDERFLOWS`].
    fn shape<R: Real, const K: usize>(t: Pack<R, K>, shift: Pack<R, K>, q: R) -> Pack<R, K>;

    /// `-d ln g / d ln t`, dimensionless.
    fn fall<R: Real, const K: usize>(t: Pack<R, K>, q: R) -> Pack<R, K>;

    /// `d ln g / dq`.
    fn tail<R: Real, const K: usize>(t: Pack<R, K>, q: R) -> Pack<R, K> {
        let _ = (t, q);
        Pack::splat(R::ZERO)
    }
}

/// A distribution with Smith's shadowing, which follows from its slopes.
pub trait Shadowing: Distribution {
    /// The share of the facets seen from one direction that are not hidden, 0 to 1, by Smith's argument, and `m` times its derivative by `m`; `a2 = m^2 tan^2 theta`.
    fn visible<R: Real, const K: usize>(a2: Pack<R, K>) -> (Pack<R, K>, Pack<R, K>);
}

/// How facets hide one another: G of Eq. 5, 0 to 1, for a distribution `D`; it needs `C` numbers of each pair of directions.
pub trait Masking<D, const C: usize>: Copy {
    /// Does G depend on the slope?
    const SLOPED: bool = false;

    /// First the six numbers of [`crate::geometry::Geometry`], where the factor of the surface lobe has all of G that does not depend on the slope.
    ///
    /// # Errors
    /// [`SampleError::NotFinite`] and [`SampleError::BeyondHorizon`].
    fn geometry<R: Real>(theta_i: R, theta_s: R, delta_phi: R) -> Result<[R; C], SampleError>;

    /// The rest of G, and `m` times the derivative of its logarithm by `m`; `tan2_theta` of incidence and of scattering.
    fn masking<R: Real, const K: usize>(tan2_theta: [Pack<R, K>; 2], m2: Pack<R, K>) -> (Pack<R, K>, Pack<R, K>) {
        let _ = (tan2_theta, m2);
        (Pack::splat(R::ONE), Pack::splat(R::ZERO))
    }
}

/// Slopes that fall exponentially: `g(t) = exp(-sqrt(t)) / 2`, between Beckmann and GGX in its tail, with a peak as sharp as a cone's.
///
/// The exponential power distribution `p exp(-t^p) / Gamma(1/p)` of Brady et al. 2014 and of Holzschuch and Pacanowski 2017 at p = 1/2; p = 1 is Beckmann. The root mean square of the slopes is sqrt(6) m.
#[derive(Clone, Copy, Debug)]
pub struct Exponential;

impl Distribution for Exponential {
    #[inline(always)]
    fn shape<R: Real, const K: usize>(t: Pack<R, K>, _shift: Pack<R, K>, _q: R) -> Pack<R, K> {
        let exponent = t.map(|t| -t.sqrt());
        exponent.zip(exponent.exp(), |x, e| if x < R::LEAST_EXPONENT { R::ZERO } else { e }) * R::of(0.5)
    }

    #[inline(always)]
    fn fall<R: Real, const K: usize>(t: Pack<R, K>, _q: R) -> Pack<R, K> {
        t.map(|t| t.sqrt()) * R::of(0.5)
    }
}
