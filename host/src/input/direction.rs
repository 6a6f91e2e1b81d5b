//! Directions as vectors, for formats whose angles are not those of the surface.

use libm::{atan2, sqrt};

/// Scattering angle and azimuth from incidence, degrees, of a direction with x forward in the plane of incidence and z the normal.
///
/// In plane, where y is 0, the scattering angle is signed and there is no azimuth; the direction needs no length of 1.
pub fn angles([x, y, z]: [f64; 3]) -> (f64, Option<f64>) {
    if y == 0.0 {
        return (atan2(x, z).to_degrees(), None);
    }
    let theta_s = atan2(sqrt(x * x + y * y), z).to_degrees();
    (theta_s, Some(180.0 - atan2(y, x).to_degrees()))
}

/// Scattering angle and azimuth from incidence, degrees, of the direction at `radial` from the specular ray, which is at `specular` from the normal.
///
/// Azimuth 0 leads from the specular ray to the normal, 180 away from it.
pub fn of_specular(specular: f64, radial: f64, azimuth: f64) -> (f64, Option<f64>) {
    let [(sin_i, cos_i), (sin_a, cos_a), (sin_r, cos_r)] = [specular, azimuth, radial].map(sin_cos);
    angles([
        sin_i * cos_r - cos_i * sin_r * cos_a,
        sin_r * sin_a,
        cos_i * cos_r + sin_i * sin_r * cos_a,
    ])
}

/// Angle of incidence, scattering angle and azimuth from incidence, degrees, of a half vector at `theta_h` from the normal and incidence at `theta_d`, `phi_d` around it (Rusinkiewicz 1998).
///
/// At `phi_d` 0 incidence leans further from the normal than the half vector.
pub fn of_half_angles(theta_h: f64, theta_d: f64, phi_d: f64) -> (f64, f64, f64) {
    let [(sin_h, cos_h), (sin_d, cos_d), (sin_p, cos_p)] = [theta_h, theta_d, phi_d].map(sin_cos);
    // Incidence is on one side of the half vector, scattering opposite to it; the half vector leans by theta_h.
    let lean = |side: f64| {
        let (x, y) = (side * sin_d * cos_p, side * sin_d * sin_p);
        let (x, z) = (cos_h * x + sin_h * cos_d, cos_h * cos_d - sin_h * x);
        let theta = atan2(sqrt(x * x + y * y), z).to_degrees();
        (theta, atan2(y, x).to_degrees())
    };
    let ((theta_i, phi_i), (theta_s, phi_s)) = (lean(1.0), lean(-1.0));
    (theta_i, theta_s, phi_s - phi_i)
}

/// Sine and cosine of an angle in degrees; exact at multiples of 90, so that what is in plane stays there.
pub fn sin_cos(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => libm::sincos(degrees.to_radians()),
    }
}

/// Unit vectors of incidence, at azimuth 0, and of scattering; degrees, in plane without an azimuth.
#[cfg(test)]
pub fn vectors(theta_i: f64, theta_s: f64, delta_phi: Option<f64>) -> [[f64; 3]; 2] {
    [(theta_i, 0.0), (theta_s, delta_phi.unwrap_or(180.0))].map(|direction| {
        let [(sin, cos), (sin_phi, cos_phi)] = <[f64; 2]>::from(direction).map(sin_cos);
        [sin * cos_phi, sin * sin_phi, cos]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn in_plane_is_signed() {
        for theta_s in [-80.0, -1.0, 0.0, 45.0, 89.0] {
            let (sin, cos) = sin_cos(theta_s);
            let (back, delta_phi) = angles([2.0 * sin, 0.0, 2.0 * cos]);
            assert!((back - theta_s).abs() < 1e-13 && delta_phi.is_none());
        }
        let (theta_s, delta_phi) = angles([0.0, 1.0, 1.0]);
        assert!((theta_s - 45.0).abs() < 1e-13 && (delta_phi.unwrap() - 90.0).abs() < 1e-13);
        // Towards incidence the azimuth is 0.
        assert!(angles([-1.0, 1e-9, 1.0]).1.unwrap().abs() < 1e-6);
    }
}
