//! A `.brdf` file for BRDF Explorer: the model as a GLSL function, its parameters as sliders.

use brdfit_core::brdf::NAMES;

use super::model::Model;
use crate::engine::FitOptions;
use crate::error::Error;
use crate::number::shortest;

/// Eq. 14 in vectors; the tangential parts give the half angles without cancellation.
const SHADER: &str = "\
float fresnel(float c, float n, float kappa)
{
    float c2 = c * c;
    float s2 = 1.0 - c2;
    float re = n * n - kappa * kappa - s2;
    float im = 2.0 * n * kappa;
    float modulus = sqrt(re * re + im * im);
    float a = sqrt(max(0.5 * (modulus + re), 0.0));
    float perpendicular = (modulus - 2.0 * a * c + c2) / (modulus + 2.0 * a * c + c2);
    float parallel = (modulus * c2 - 2.0 * a * c * s2 + s2 * s2) / (modulus * c2 + 2.0 * a * c * s2 + s2 * s2);
    return 0.5 * perpendicular * (1.0 + parallel);
}

// D_b F, where t is the part of L + V, or of its mirror image, along the surface, and z that along the normal.
float facets(float t2, float z2, float m, float n, float kappa)
{
    float tan2 = t2 / z2;
    float beckmann = exp(-tan2 / (m * m)) * (1.0 + tan2) * (1.0 + tan2) / (3.14159265358979323846 * m * m);
    return beckmann * fresnel(min(0.5 * sqrt(t2 + z2), 1.0), n, kappa);
}

vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y)
{
    float cos_i = dot(N, L);
    float cos_s = dot(N, V);
    if (cos_i <= 0.0 || cos_s <= 0.0) return vec3(0.0);
    vec3 along_i = L - cos_i * N;
    vec3 along_s = V - cos_s * N;
    vec3 forward = along_s + along_i;
    vec3 back = along_s - along_i;
    float z = cos_i + cos_s;
    float masking = min(1.0, 4.0 * z * min(cos_i, cos_s) / (dot(forward, forward) + z * z));
    float surface = rho_s * masking / (4.0 * cos_i * cos_s) * facets(dot(forward, forward), z * z, m, n, kappa);
    float volume = rho_v * facets(dot(back, back), z * z, m, n, kappa);
    return vec3(rho_d / 3.14159265358979323846 + surface + volume);
}
";

/// The file.
pub fn write(model: &Model) -> Result<String, Error> {
    let params = model.eq_14("--to glsl")?;
    let FitOptions { lower, upper, .. } = FitOptions::default();
    let mut text = format!("analytic\n\n# {}\n\n::begin parameters\n", model.origin);
    for (place, value) in params.to_array().into_iter().enumerate() {
        let (least, largest) = (lower[place].min(value), upper[place].max(value));
        text += &format!(
            "float {} {} {} {}\n",
            NAMES[place],
            shortest(least),
            shortest(largest),
            shortest(value)
        );
    }
    Ok(text + "::end parameters\n\n::begin shader\n\n" + SHADER + "\n::end shader\n")
}
