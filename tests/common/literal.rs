//! Eq. 3 to 14 as printed, in f64: slow, and inaccurate near the peak and where a lobe underflows, but plainly the paper's.

use std::f64::consts::PI;

/// Eq. 7.
pub fn sigma(theta_i: f64, theta_s: f64) -> f64 {
    1.0 / (4.0 * theta_i.cos() * theta_s.cos())
}

/// Eq. 8.
pub fn beckmann(theta_h: f64, m: f64) -> f64 {
    (-(theta_h.tan() / m).powi(2)).exp() / (PI * m * m * theta_h.cos().powi(4))
}

/// Eq. 9.
pub fn blinn(theta_i: f64, theta_s: f64, theta_h: f64, theta_d: f64) -> f64 {
    let obscured = 2.0 * theta_h.cos() * theta_s.cos() / theta_d.cos();
    let shadowed = 2.0 * theta_h.cos() * theta_i.cos() / theta_d.cos();
    1.0f64.min(obscured).min(shadowed)
}

/// Eq. 12, for the volume lobe with `azimuth` = delta_phi - pi, for the surface lobe with `azimuth` = delta_phi; (theta_d, theta_h) with Eq. 13.
pub fn half_angles(theta_i: f64, theta_s: f64, azimuth: f64) -> (f64, f64) {
    let (cos_i, cos_s) = (theta_i.cos(), theta_s.cos());
    let theta_d = 0.5 * (cos_i * cos_s + theta_i.sin() * theta_s.sin() * azimuth.cos()).acos();
    let theta_h = ((cos_i + cos_s) / (2.0 * theta_d.cos())).min(1.0).acos();
    (theta_d, theta_h)
}

/// Reflectance of unpolarised light, by the textbook's complex square root.
pub fn fresnel(theta: f64, n: f64, kappa: f64) -> f64 {
    let (c, s2) = (theta.cos(), theta.sin().powi(2));
    let (re, im) = (n * n - kappa * kappa - s2, 2.0 * n * kappa);
    let modulus = re.hypot(im);
    let a2 = 0.5 * (modulus + re);
    let b2 = 0.5 * (modulus - re).max(0.0);
    let a = a2.sqrt();
    let perpendicular = ((a - c).powi(2) + b2) / ((a + c).powi(2) + b2);
    let tangent = s2 / c;
    let parallel = perpendicular * ((a - tangent).powi(2) + b2) / ((a + tangent).powi(2) + b2);
    0.5 * (perpendicular + parallel)
}

/// Eq. 14; parameters in the order rho_d, rho_s, rho_v, m, n, kappa.
pub fn f([theta_i, theta_s, delta_phi]: [f64; 3], [rho_d, rho_s, rho_v, m, n, kappa]: [f64; 6]) -> f64 {
    // delta_phi is pi in the forward plane, where the surface lobe's azimuth has cos(delta_phi) = -1.
    let (theta_d, theta_h) = half_angles(theta_i, theta_s, delta_phi);
    let (theta_de, theta_he) = half_angles(theta_i, theta_s, delta_phi - PI);
    rho_s
        * sigma(theta_i, theta_s)
        * beckmann(theta_h, m)
        * fresnel(theta_d, n, kappa)
        * blinn(theta_i, theta_s, theta_h, theta_d)
        + rho_d / PI
        + rho_v * beckmann(theta_he, m) * fresnel(theta_de, n, kappa)
}
