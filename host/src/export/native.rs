//! Mitsuba 3: the nearest of its own models, a `roughconductor` and a `diffuse`, and how far it is off.

use brdfit_core::brdf::{Params, fresnel};
use brdfit_core::geometry::Geometry;
use brdfit_core::real::Real;

use super::model::{Model, word};
use crate::error::Error;

/// Pairs of directions that are compared, up to 85 degrees from the normal.
const DIRECTIONS: u32 = 1000;

/// A BRDF below this does not count, sr^-1.
const DARK: f64 = 1e-9;

/// The dictionary as a Python module, and the largest deviations as a sentence.
///
/// Beckmann's facets and Fresnel are the same; masking is Smith's in place of Blinn's, and there is no volume lobe.
pub fn write(model: &Model) -> Result<(String, String), Error> {
    let p = &model.eq_14("--to mitsuba-native")?;
    let uniform = |value: f64| format!("{{\"type\": \"uniform\", \"value\": {value:?}}}");
    let conductor = |rho_s: f64, indent: &str| {
        format!(
            "{{\n{indent}    \"type\": \"roughconductor\",\n{indent}    \"distribution\": \"beckmann\",\n{indent}    \"alpha\": {:?},\n{indent}    \"eta\": {},\n{indent}    \"k\": {},\n{indent}    \"specular_reflectance\": {},\n{indent}}}",
            p.m,
            uniform(p.n),
            uniform(p.kappa),
            uniform(rho_s)
        )
    };
    // The sum of two models is a blend of both, each over its part.
    let bsdf = if p.rho_d == 0.0 {
        conductor(p.rho_s, "")
    } else {
        format!(
            "{{\n    \"type\": \"blendbsdf\",\n    \"weight\": 0.5,\n    \"diffuse\": {{\"type\": \"diffuse\", \"reflectance\": {}}},\n    \"surface\": {},\n}}",
            uniform(2.0 * p.rho_d),
            conductor(2.0 * p.rho_s, "    ")
        )
    };
    let (least, largest) = deviation(model, p);
    let deviation = format!(
        "against the exact model {:+.1} to {:+.1} % at {DIRECTIONS} pairs of directions up to 85 deg",
        100.0 * least,
        100.0 * largest
    );
    let text = format!(
        "# {}.\n# The nearest of Mitsuba's own models: {deviation}.\n# mi.load_dict({}) makes it a BSDF.\n{} = {bsdf}\n",
        model.origin,
        word(&model.name),
        word(&model.name)
    );
    Ok((text, deviation))
}

/// The nearest model in sr^-1, angles in radians.
pub fn f(p: &Params<f64>, theta_i: f64, theta_s: f64, delta_phi: f64) -> f64 {
    let Ok(geometry) = Geometry::new(theta_i, theta_s, delta_phi) else {
        return 0.0;
    };
    let surface = geometry.surface();
    let (_, cos_i) = Real::sin_cos(theta_i);
    let (_, cos_s) = Real::sin_cos(theta_s);
    let (tan2, m2) = (surface.tan2_theta_h, p.m * p.m);
    let beckmann = Real::exp(-tan2 / m2) * (1.0 + tan2) * (1.0 + tan2) / (f64::PI * m2);
    let masking = smith(cos_i, p.m) * smith(cos_s, p.m);
    p.rho_d / f64::PI
        + p.rho_s * beckmann * fresnel(surface.cos_theta_d, p.n, p.kappa).0 * masking / (4.0 * cos_i * cos_s)
}

/// Smith's masking for Beckmann's facets in the rational form that Mitsuba has.
fn smith(cos: f64, m: f64) -> f64 {
    let a = cos / (m * (1.0 - cos * cos).max(0.0).sqrt());
    if a >= 1.6 {
        1.0
    } else {
        (3.535 + 2.181 * a) * a / (1.0 + (2.276 + 2.577 * a) * a)
    }
}

/// The least and the largest of f_nearest / f - 1: a third of the directions near the specular one, a third near the retro one, the others all over the hemisphere.
fn deviation(model: &Model, p: &Params<f64>) -> (f64, f64) {
    const LARGEST: f64 = 85.0;
    // Two irrational steps, which never fall into a grid.
    let part = |k: u32, step: f64| (f64::from(k) * step).fract();
    let width = 3.0 * libm::atan(p.m).to_degrees();
    let mut range = (0.0f64, 0.0f64);
    for k in 0..DIRECTIONS {
        let theta_i = LARGEST * f64::from(k) / f64::from(DIRECTIONS - 1);
        let (u, v) = (part(k, 0.754_877_666_246_692_8), part(k, 0.569_840_290_998_053_3));
        let near = |peak: f64| (peak + (2.0 * u - 1.0) * width).clamp(-LARGEST, LARGEST);
        let (theta_s, phi) = match k % 3 {
            0 => (near(theta_i), 180.0),
            1 => (near(-theta_i), 180.0),
            _ => (LARGEST * u, 360.0 * v),
        };
        let at = (theta_i.to_radians(), theta_s.to_radians(), phi.to_radians());
        let exact = model.f(at.0, at.1, at.2);
        // Where no instrument sees anything, ratios tell nothing.
        if exact > DARK {
            let off = f(p, at.0, at.1, at.2) / exact - 1.0;
            range = (range.0.min(off), range.1.max(off));
        }
    }
    range
}
