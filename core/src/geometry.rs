//! `Sample` (angles, BRDF) -> `Observation` (everything that does not depend on the parameters) -> `Block` (16 lanes).

use crate::real::Real;

/// Number of rows that are evaluated together; the order of summation, and so every bit of a fit, depends on it.
pub const LANES: usize = 16;

/// One measured value of the BRDF.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sample<R> {
    /// Angle of incidence, radians, `0 <= theta_i < pi/2`.
    pub theta_i: R,
    /// Scattering angle, radians, `-pi/2 < theta_s < pi/2`; in plane positive forward, towards the specular peak.
    pub theta_s: R,
    /// Azimuth of scattering less azimuth of incidence, radians; pi is forward.
    pub delta_phi: R,
    /// Measured BRDF f, sr^-1, above 0.
    ///
    /// A scan whose largest is below 1e-9, in `f32` below 6e-5, is to be multiplied by a power of two before: squares of 1 / f lose digits, and the weights of the model have the same factor.
    pub brdf: R,
    /// Factor of the sample's residual of ln f, dimensionless; in proportion to 1 / (standard deviation of ln f), or 1. 0 leaves the sample out.
    pub weight: R,
}

impl<R: Real> Sample<R> {
    /// A sample in the plane of incidence, with weight 1.
    pub fn in_plane(theta_i: R, theta_s: R, brdf: R) -> Self {
        Sample {
            theta_i,
            theta_s,
            delta_phi: R::PI,
            brdf,
            weight: R::ONE,
        }
    }
}

/// Why a [`Sample`] is not a valid [`Observation`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SampleError {
    /// An angle, the BRDF or the weight is NaN or infinite.
    NotFinite,
    /// `theta_i` is negative, or an angle is at or beyond the horizon.
    BeyondHorizon,
    /// The BRDF is zero or negative: it has no logarithm.
    NotPositive,
}

impl core::fmt::Display for SampleError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            SampleError::NotFinite => "the value is not a finite number",
            SampleError::BeyondHorizon => "the angle is at or beyond the horizon",
            SampleError::NotPositive => "the BRDF is not positive, so it has no logarithm",
        })
    }
}
impl core::error::Error for SampleError {}

/// The parameter-free part of one lobe in one pair of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LobeGeometry<R> {
    /// tan^2 of the angle between surface normal and facet normal, theta_h or theta_he (Eq. 13); dimensionless.
    pub tan2_theta_h: R,
    /// Cosine of the angle of incidence on the facet, theta_d or theta_de (Eq. 12); 0 to 1.
    pub cos_theta_d: R,
    /// What multiplies `rho F exp(-tan^2 theta_h / m^2) / m^2`, sr^-1.
    pub factor: R,
}

/// The parameter-free part of the model in one pair of directions, from [`Geometry::new`].
///
/// A firmware that measures at known angles can hold a table of these that a host has computed: then it has no trigonometry.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Geometry<R> {
    /// Of the surface lobe and of the volume lobe.
    pub lobes: [LobeGeometry<R>; 2],
}

/// Place of the surface lobe; its factor is `sigma G_c / (pi cos^4 theta_h)` (Eq. 7, 8, 9).
pub(crate) const SURFACE_LOBE: usize = 0;
/// Place of the volume lobe; its factor is `1 / (pi cos^4 theta_he)` (Eq. 8).
pub(crate) const VOLUME_LOBE: usize = 1;

impl<R: Real> Geometry<R> {
    /// Eq. 7, 9, 12 and 13 in a form without cancellation; angles in radians as in [`Sample`].
    ///
    /// Printed: `theta_d = acos(cos ti cos ts + sin ti sin ts cos(dphi - pi)) / 2`, `theta_h = acos((cos ti + cos ts) / (2 cos theta_d))`.
    /// Near the peak that loses theta_h, and rounding can take its argument above 1.
    /// With half angles, `tan^2 theta_h = tan^2((ti - ts)/2) + sin ti sin ts cos^2(dphi/2) / (cos^2((ti + ts)/2) cos^2((ti - ts)/2))`; the volume lobe's pair has sin^2(dphi/2) in place of cos^2.
    ///
    /// # Errors
    /// [`SampleError::NotFinite`] and [`SampleError::BeyondHorizon`].
    pub fn new(theta_i: R, theta_s: R, delta_phi: R) -> Result<Self, SampleError> {
        if ![theta_i, theta_s, delta_phi].iter().all(|angle| angle.is_finite()) {
            return Err(SampleError::NotFinite);
        }
        let half = R::of(0.5);
        let quarter_turn = R::PI * half;
        let (sin_i, cos_i) = theta_i.portable_sin_cos();
        let (sin_s, cos_s) = theta_s.portable_sin_cos();
        let above = R::ZERO <= theta_i && theta_i < quarter_turn && theta_s.abs() < quarter_turn;
        if !(above && cos_i > R::EPSILON && cos_s > R::EPSILON) {
            return Err(SampleError::BeyondHorizon);
        }
        let (sin_sum, cos_sum) = ((theta_i + theta_s) * half).portable_sin_cos();
        let (sin_difference, cos_difference) = ((theta_i - theta_s) * half).portable_sin_cos();
        // In plane exactly, though pi is not a number of this type.
        let (sin_phi, cos_phi) = if delta_phi.abs() == R::PI {
            (R::ONE, R::ZERO)
        } else {
            (delta_phi * half).portable_sin_cos()
        };
        let half_sum = cos_sum * cos_difference; // (cos ti + cos ts) / 2
        // The same tan^2 written from its value at dphi = pi or from that at dphi = 0: the nearer one has the smaller azimuth term, and so no cancellation.
        let tan2 = |sin_phi: R, cos_phi: R| {
            let (near, across) = if sin_phi.abs() >= cos_phi.abs() {
                (sin_difference * cos_sum, sin_i * sin_s * cos_phi * cos_phi)
            } else {
                (sin_sum * cos_difference, -(sin_i * sin_s * sin_phi * sin_phi))
            };
            ((near * near + across) / (half_sum * half_sum)).max(R::ZERO)
        };
        let tan2_theta_h = tan2(sin_phi, cos_phi);
        let tan2_theta_he = tan2(cos_phi, sin_phi);
        let cos_theta_d = (half_sum * (R::ONE + tan2_theta_h).sqrt()).min(R::ONE);
        let cos_theta_de = (half_sum * (R::ONE + tan2_theta_he).sqrt()).min(R::ONE);
        let sigma = R::of(0.25) / (cos_i * cos_s);
        // Eq. 9, with cos theta_h / cos theta_d = half_sum / cos^2 theta_d.
        let two_ratio = R::of(2.0) * half_sum / (cos_theta_d * cos_theta_d);
        let masking = (two_ratio * cos_i.min(cos_s)).min(R::ONE);
        let inverse_cos4 = |tan2: R| (R::ONE + tan2) * (R::ONE + tan2);
        let surface = LobeGeometry {
            tan2_theta_h,
            cos_theta_d,
            factor: sigma * masking * inverse_cos4(tan2_theta_h) / R::PI,
        };
        let volume = LobeGeometry {
            tan2_theta_h: tan2_theta_he,
            cos_theta_d: cos_theta_de,
            factor: inverse_cos4(tan2_theta_he) / R::PI,
        };
        Ok(Geometry {
            lobes: [surface, volume],
        })
    }

    /// Theta_h and theta_d of the surface lobe.
    pub fn surface(&self) -> LobeGeometry<R> {
        self.lobes[SURFACE_LOBE]
    }

    /// Theta_he and theta_de of the volume lobe.
    pub fn volume(&self) -> LobeGeometry<R> {
        self.lobes[VOLUME_LOBE]
    }
}

/// First tan^2 theta_h, then cos theta_d, then the factor, each of the surface and of the volume lobe.
impl<R: Real> From<Geometry<R>> for [R; 6] {
    fn from(Geometry { lobes: [a, b] }: Geometry<R>) -> Self {
        [
            a.tan2_theta_h,
            b.tan2_theta_h,
            a.cos_theta_d,
            b.cos_theta_d,
            a.factor,
            b.factor,
        ]
    }
}

/// Geometry and measured ln f of one sample; one that [`Observation::new`] made is valid.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Observation<R, G = Geometry<R>> {
    /// Where the sample was measured: [`Geometry`] for Eq. 14, or the numbers that another model needs.
    pub geometry: G,
    /// ln of the measured BRDF in sr^-1.
    pub ln_f: R,
    /// Factor of the residual of ln f, dimensionless, not negative.
    pub weight: R,
}

impl<R: Real> Observation<R> {
    /// The observation of a sample; the sign of its weight does not count.
    ///
    /// # Errors
    /// [`SampleError`] tells what is wrong with the sample.
    #[cfg_attr(target_os = "none", inline(never))]
    pub fn new(sample: &Sample<R>) -> Result<Self, SampleError> {
        let geometry = Geometry::new(sample.theta_i, sample.theta_s, sample.delta_phi)?;
        Self::at(geometry, sample.brdf, sample.weight)
    }
}

impl<R: Real, G> Observation<R, G> {
    /// The observation of `brdf`, in sr^-1, where the geometry is known; the sign of its weight does not count.
    ///
    /// # Errors
    /// [`SampleError::NotFinite`] and [`SampleError::NotPositive`].
    pub fn at(geometry: G, brdf: R, weight: R) -> Result<Self, SampleError> {
        if ![brdf, weight].iter().all(|number| number.is_finite()) {
            return Err(SampleError::NotFinite);
        }
        if !(brdf >= R::MIN_POSITIVE) {
            return Err(SampleError::NotPositive);
        }
        Ok(Observation {
            geometry,
            ln_f: brdf.portable_ln(),
            weight: weight.abs(),
        })
    }
}

/// `L` observations, lane by lane, each with the `C` numbers that a model needs of its directions; empty lanes have weight 0 and add exactly 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(align(64))]
pub struct Block<R, const L: usize = LANES, const C: usize = 6> {
    /// Column by column, lane by lane.
    pub columns: [[R; L]; C],
    pub(crate) ln_f: [R; L],
    pub(crate) weight: [R; L],
}

impl<R: Real, const L: usize, const C: usize> Block<R, L, C> {
    /// A block without observations: each lane in directions where every model computes ordinary numbers.
    pub const EMPTY: Self = Self::empty();

    /// A block without observations.
    pub const fn empty() -> Self {
        let mut block = Block {
            columns: [[R::ZERO; L]; C],
            ln_f: [R::ZERO; L],
            weight: [R::ZERO; L],
        };
        // A loop, where an image would otherwise hold a whole block.
        let columns = block.columns.as_flattened_mut();
        let mut k = 0;
        while k < columns.len() {
            columns[k] = R::ONE;
            k += 1;
        }
        block
    }

    /// The first `L` of `observations`, in order.
    pub fn new<G: Copy + Into<[R; C]>>(observations: &[Observation<R, G>]) -> Self {
        let mut block = Block::EMPTY;
        for (lane, observation) in observations.iter().enumerate() {
            block.set(lane, observation);
        }
        block
    }

    /// Puts an observation into a lane; a lane from `L` on is ignored.
    pub fn set<G: Copy + Into<[R; C]>>(&mut self, lane: usize, observation: &Observation<R, G>) {
        if lane < L {
            let numbers: [R; C] = observation.geometry.into();
            for c in 0..C {
                self.columns[c][lane] = numbers[c];
            }
            self.ln_f[lane] = observation.ln_f;
            self.weight[lane] = observation.weight;
        }
    }
}

impl<R: Real, const C: usize> Block<R, 1, C> {
    /// One pair of directions, of weight 1.
    pub(crate) fn of(numbers: [R; C]) -> Self {
        Block {
            columns: numbers.map(|number| [number]),
            ln_f: [R::ZERO],
            weight: [R::ONE],
        }
    }
}
