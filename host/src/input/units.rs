//! What the numbers of a file mean: units of angles, the quantity of the values, the sign of theta_s.

use brdfit_core::real::Real;
use serde::{Deserialize, Serialize};

use crate::number::shortest;

/// The unit of angles.
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Angles {
    /// Degrees
    Deg,
    /// Radians
    Rad,
}

impl Angles {
    /// A polar angle in radians.
    pub fn radians(self, angle: f64) -> f64 {
        match self {
            Angles::Deg => angle.to_radians(),
            Angles::Rad => angle,
        }
    }

    /// A polar angle in degrees.
    pub fn degrees(self, angle: f64) -> f64 {
        match self {
            Angles::Deg => angle,
            Angles::Rad => angle.to_degrees(),
        }
    }

    /// An azimuth in radians, within -pi to pi; half a turn is exactly pi, which the model takes as in plane.
    pub fn azimuth(self, angle: f64) -> f64 {
        match self {
            Angles::Deg => azimuth(angle),
            // Files in radians have five or six decimals.
            Angles::Rad if (angle.abs() - f64::PI).abs() < 5e-6 => f64::PI,
            // What is in range keeps its bits.
            Angles::Rad if angle.abs() < f64::PI => angle,
            Angles::Rad => azimuth(angle.to_degrees()),
        }
    }
}

/// Degrees to radians, within -pi to pi; 180 degrees are exactly pi, which the model takes as in plane.
pub fn azimuth(degrees: f64) -> f64 {
    let turned = degrees % 360.0;
    let within = if turned > 180.0 {
        turned - 360.0
    } else if turned < -180.0 {
        turned + 360.0
    } else {
        turned
    };
    if within.abs() == 180.0 {
        f64::PI
    } else {
        within.to_radians()
    }
}

/// Where theta_s is positive.
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Forward {
    /// The specular peak is at theta_s = +theta_i, or at an azimuth of 180 degrees
    #[default]
    Positive,
    /// The specular peak is at theta_s = -theta_i, or at an azimuth of 0
    Negative,
}

/// What the numbers of the values are counted in.
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ValueUnit {
    /// Their own unit, as they stand
    Plain,
    /// Hundredths of it
    Percent,
}

/// The unit of wavelengths.
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WavelengthUnit {
    /// Nanometres
    Nm,
    /// Micrometres
    Um,
    /// Metres
    M,
    /// 0.1 nm
    Angstrom,
    /// Wavenumbers in cm^-1
    PerCm,
}

/// How rows of the two polarisations are taken.
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Polarisation {
    /// Each is a scan of its own
    #[default]
    Apart,
    /// The mean of s and p in each direction, which is the BRDF of unpolarised light
    Mean,
}

/// What is tabulated; f is the BRDF in sr^-1.
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// f
    Brdf,
    /// ln f
    LnBrdf,
    /// log10 f
    Log10Brdf,
    /// f cos(theta_s), the cosine-corrected BRDF
    #[cfg_attr(feature = "cli", value(alias = "ccbrdf"))]
    BrdfCos,
    /// pi f, the reflectance factor
    Brf,
    /// pi f cos(theta_s)
    BrfCos,
}

impl Quantity {
    /// All of them; where a file has several, the first is taken.
    pub const ALL: [Quantity; 6] = [
        Quantity::Brdf,
        Quantity::LnBrdf,
        Quantity::Log10Brdf,
        Quantity::BrdfCos,
        Quantity::Brf,
        Quantity::BrfCos,
    ];

    /// Its name in messages.
    pub fn title(self) -> &'static str {
        match self {
            Quantity::Brdf => "the BRDF",
            Quantity::LnBrdf => "ln BRDF",
            Quantity::Log10Brdf => "log10 BRDF",
            Quantity::BrdfCos => "BRDF cos(theta_s)",
            Quantity::Brf => "pi BRDF",
            Quantity::BrfCos => "pi BRDF cos(theta_s)",
        }
    }

    /// The factor that makes a value in linear or logarithmic form natural: 1, or ln 10.
    pub fn is_logarithm(self) -> Option<f64> {
        match self {
            Quantity::LnBrdf => Some(1.0),
            Quantity::Log10Brdf => Some(std::f64::consts::LN_10),
            _ => None,
        }
    }

    /// The BRDF in sr^-1.
    ///
    /// # Errors
    /// Why the value has none: it is not positive, or beyond the range of `f64`.
    pub fn brdf(self, value: f64, theta_s: f64) -> Result<f64, String> {
        let fail = |why: &str| Err(format!("{} is {}, {why}", self.title(), shortest(value)));
        if !value.is_finite() {
            return fail("which is not a number");
        }
        if let Some(factor) = self.is_logarithm() {
            let ln = value * factor;
            return if (-708.0..=709.0).contains(&ln) {
                Ok(Real::portable_exp(ln))
            } else {
                fail("the logarithm of a value beyond the range of numbers")
            };
        }
        if !(value > 0.0) {
            return fail("which has no logarithm");
        }
        let cos_s = || Real::portable_sin_cos(theta_s).1;
        let brdf = match self {
            Quantity::BrdfCos => value / cos_s(),
            Quantity::Brf => value / f64::PI,
            Quantity::BrfCos => value / (f64::PI * cos_s()),
            _ => value,
        };
        if brdf >= f64::MIN_POSITIVE && brdf.is_finite() {
            Ok(brdf)
        } else {
            fail("too small or too large to compute with")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_is_the_same_brdf() {
        let (f, theta_s) = (0.05, 60f64.to_radians());
        let values = [
            f,
            Real::portable_ln(f),
            Real::portable_ln(f) / std::f64::consts::LN_10,
            f / 2.0,
            f * f64::PI,
            f * f64::PI / 2.0,
        ];
        for (quantity, value) in Quantity::ALL.into_iter().zip(values) {
            let back = quantity.brdf(value, theta_s).unwrap();
            assert!((back / f - 1.0).abs() < 1e-15, "{quantity:?} {back}");
            assert!(quantity.brdf(f64::NAN, theta_s).is_err());
            assert_eq!(quantity.brdf(-1.0, theta_s).is_ok(), quantity.is_logarithm().is_some());
        }
    }

    #[test]
    fn half_a_turn_is_in_plane() {
        assert_eq!(Angles::Deg.azimuth(-180.0), f64::PI);
        assert_eq!(Angles::Rad.azimuth("3.141593".parse().unwrap()), f64::PI);
        assert_eq!(Angles::Rad.azimuth("-3.141593".parse().unwrap()), f64::PI);
        assert_eq!(Angles::Rad.azimuth("3.14159".parse().unwrap()), f64::PI);
        assert!((Angles::Rad.azimuth(-0.261799) + 0.261799).abs() < 1e-15);
        assert!((Angles::Rad.azimuth(4.0) - (4.0 - 2.0 * f64::PI)).abs() < 1e-15);
    }
}
