//! Other pieces for Eq. 5, put together at compile time: a distribution of facets, a masking, and what the lobes do not share.
//!
//! Eq. 14 itself is [`crate::brdf`]; [`crate::composed`] fits what is put together from these.
//! Each piece is a type without a value, so a piece that is not named costs nothing.

mod beckmann;
mod ggx;
mod masking;

pub use beckmann::Beckmann;
pub use ggx::Ggx;
pub use masking::{NoMasking, Smith, VGroove};

use crate::geometry::{Observation, Sample, SampleError};
use crate::pack::Pack;
use crate::real::Real;

/// Lanes that go through the formulas side by side.
pub(crate) const LANES: usize = 8;

/// A number of each lane.
pub(crate) type Lanes<R> = Pack<R, LANES>;

/// How the slopes of the facets are distributed: `D = g(tan^2 theta_h / m^2) / (pi m^2 cos^4 theta_h)`.
pub trait Distribution: Copy {
    /// `g(t)` and `d ln g / dt`, dimensionless; `t >= 0`.
    fn shape<R: Real, const K: usize>(t: Pack<R, K>) -> (Pack<R, K>, Pack<R, K>);
    /// The share of the facets seen from one direction that are not hidden, 0 to 1, by Smith's argument, and `m` times its derivative by `m`; `a2 = m^2 tan^2 theta`.
    fn visible<R: Real, const K: usize>(a2: Pack<R, K>) -> (Pack<R, K>, Pack<R, K>);
}

/// How facets hide one another: G of Eq. 5, 0 to 1, and `m` times its derivative by `m`.
pub trait Masking<D>: Copy {
    /// At facets of slope `m`.
    fn masking<R: Real>(facets: &Facets<R>, m: R) -> (Lanes<R>, Lanes<R>);
}

/// Eight observations with everything that does not depend on the parameters; empty lanes have weight 0.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Facets<R> {
    /// Of the facets that mirror one direction into the other, and of those of the volume lobe (Eq. 13).
    pub(crate) tan2_theta_h: [Lanes<R>; 2],
    pub(crate) cos_theta_d: [Lanes<R>; 2],
    /// What multiplies `rho F G g / m^2`, sr^-1.
    pub(crate) factor: [Lanes<R>; 2],
    /// G of Eq. 9.
    pub(crate) v_groove: Lanes<R>,
    /// tan^2 of theta_i and theta_s.
    pub(crate) tan2_theta: [Lanes<R>; 2],
    pub(crate) ln_f: Lanes<R>,
    pub(crate) weight: Lanes<R>,
}

impl<R: Real> Facets<R> {
    /// The first eight of `samples`, in order.
    ///
    /// # Errors
    /// The place of the first sample that is not valid, and why.
    pub fn new(samples: &[Sample<R>]) -> Result<Self, (usize, SampleError)> {
        let (zero, one) = (Pack::splat(R::ZERO), Pack::splat(R::ONE));
        let mut facets = Facets {
            tan2_theta_h: [zero; 2],
            cos_theta_d: [one; 2],
            factor: [one; 2],
            v_groove: one,
            tan2_theta: [zero; 2],
            ln_f: zero,
            weight: zero,
        };
        for (lane, sample) in samples.iter().enumerate().take(LANES) {
            facets.set(lane, sample).map_err(|error| (lane, error))?;
        }
        Ok(facets)
    }

    fn set(&mut self, lane: usize, sample: &Sample<R>) -> Result<(), SampleError> {
        let observation = Observation::new(sample)?;
        let lobes = [observation.geometry.surface(), observation.geometry.volume()];
        let (sin_i, cos_i) = sample.theta_i.sin_cos();
        let (sin_s, cos_s) = sample.theta_s.sin_cos();
        let (tan_i, tan_s) = (sin_i / cos_i, sin_s / cos_s);
        for (lobe, from) in lobes.into_iter().enumerate() {
            self.tan2_theta_h[lobe].0[lane] = from.tan2_theta_h;
            self.cos_theta_d[lobe].0[lane] = from.cos_theta_d;
            self.factor[lobe].0[lane] = from.factor;
        }
        // The surface lobe's factor has Eq. 9 in it.
        let cos2_theta_d = lobes[0].cos_theta_d * lobes[0].cos_theta_d;
        let v_groove = ((cos_i + cos_s) * cos_i.min(cos_s) / cos2_theta_d).min(R::ONE);
        let inverse_cos2 = R::ONE + lobes[0].tan2_theta_h;
        self.factor[0].0[lane] = R::of(0.25) / (cos_i * cos_s) * (inverse_cos2 * inverse_cos2) / R::PI;
        self.v_groove.0[lane] = v_groove;
        self.tan2_theta[0].0[lane] = tan_i * tan_i;
        self.tan2_theta[1].0[lane] = tan_s * tan_s;
        self.ln_f.0[lane] = observation.ln_f;
        self.weight.0[lane] = observation.weight;
        Ok(())
    }
}
