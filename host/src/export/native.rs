//! Mitsuba 3: the nearest of its own models, a `roughconductor` and a `diffuse`, and how far it is off.

use super::model::{Model, word};
use super::refit::{Refit, refit};
use super::targets::NATIVE;
use crate::error::Error;

/// The dictionary as a Python module, and the largest deviations as a sentence.
///
/// Beckmann's facets and Fresnel are those of Eq. 14; masking is Smith's in place of Blinn's, and there is no volume lobe.
///
/// # Errors
/// The model cannot be fitted.
pub fn write(model: &Model) -> Result<(String, String), Error> {
    let Refit { channels, deviation } = refit(std::slice::from_ref(model), &NATIVE)?;
    let [rho_d, rho_s, m, n, kappa] = [0, 1, 2, 3, 4].map(|place| channels[0][place]);
    let uniform = |value: f64| format!("{{\"type\": \"uniform\", \"value\": {value:?}}}");
    // The sum of two models is a blend of both, each over its part.
    let bsdf = format!(
        "{{\n    \"type\": \"blendbsdf\",\n    \"weight\": 0.5,\n    \
         \"diffuse\": {{\"type\": \"diffuse\", \"reflectance\": {}}},\n    \
         \"surface\": {{\n        \"type\": \"roughconductor\",\n        \"distribution\": \"beckmann\",\n        \
         \"alpha\": {m:?},\n        \"eta\": {},\n        \"k\": {},\n        \
         \"specular_reflectance\": {},\n    }},\n}}",
        uniform(2.0 * rho_d),
        uniform(n),
        uniform(kappa),
        uniform(2.0 * rho_s)
    );
    let text = format!(
        "# {}.\n# The nearest of Mitsuba's own models: {deviation}.\n# mi.load_dict({}) makes it a BSDF.\n{} = {bsdf}\n",
        model.origin,
        word(&model.name),
        word(&model.name)
    );
    Ok((text, deviation))
}
