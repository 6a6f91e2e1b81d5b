//! The directions that a detector of finite size sees around the one that it points to.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

/// Rings of the aperture.
const RINGS: usize = 6;
/// Directions of a ring on one side of the plane through normal and detector.
const HALF: usize = 8;

/// Gauss and Legendre's nodes of [-1, 1], with their weights.
const LEGENDRE: [(f64, f64); RINGS] = [
    (-0.932_469_514_203_152_1, 0.171_324_492_379_170_4),
    (-0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (-0.238_619_186_083_196_9, 0.467_913_934_572_691_0),
    (0.238_619_186_083_196_9, 0.467_913_934_572_691_0),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152_1, 0.171_324_492_379_170_4),
];

/// Directions within `half_angle`, radians, around that of `sample`, each with its share of the measured BRDF.
///
/// A detector measures the power in its solid angle, and the BRDF is that over the cosine in its middle: the shares are those of the projected solid angle, 1 in all where none is below the horizon.
/// In the plane of incidence one side stands for both.
pub fn directions(sample: &Sample<f64>, half_angle: f64) -> Vec<(Sample<f64>, f64)> {
    let (sin_s, cos_s) = Real::portable_sin_cos(sample.theta_s);
    let in_plane = Real::portable_sin_cos(sample.delta_phi).0.abs() < 1e-12;
    let depth = 1.0 - Real::portable_sin_cos(half_angle).1;
    let mean_cos = 1.0 - 0.5 * depth;
    let count = if in_plane { HALF } else { 2 * HALF };
    let mut all = Vec::with_capacity(RINGS * count);
    for (node, weight) in LEGENDRE {
        let down = 0.5 * depth * (1.0 + node);
        let (sin_r, cos_r) = ((down * (2.0 - down)).sqrt(), 1.0 - down);
        for k in 0..count {
            let (sin_a, cos_a) = Real::portable_sin_cos((k as f64 + 0.5) * f64::PI / HALF as f64);
            let x = sin_s * cos_r + cos_s * sin_r * cos_a;
            let y = sin_r * sin_a;
            let z = cos_s * cos_r - sin_s * sin_r * cos_a;
            // Below the horizon there is no light.
            if z <= 1e-9 {
                continue;
            }
            let direction = Sample {
                theta_s: libm::atan2((x * x + y * y).sqrt(), z),
                delta_phi: sample.delta_phi + libm::atan2(y, x),
                ..*sample
            };
            all.push((direction, 0.5 * weight / count as f64 * z / (mean_cos * cos_s)));
        }
    }
    all
}
