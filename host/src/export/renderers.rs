//! Materials of renderers: glTF, OpenPBR, MaterialX, and Mitsuba's `principled`, whose parameters are fitted to the model.

use serde_json::json;

use super::model::{Model, word};
use super::openpbr::OPEN_PBR;
use super::refit::{Refit, refit};
use super::targets::{GLTF, PRINCIPLED};
use crate::error::Error;

/// What all of these materials have, of which the colour differs by channel.
struct Surface {
    base: [f64; 3],
    metallic: f64,
    roughness: f64,
    n: f64,
    deviation: String,
}

fn surface(models: &[Model], to: &'static crate::engine::Model) -> Result<Surface, Error> {
    if !matches!(models.len(), 1 | 3) {
        return Err(
            Error::new(format!("a colour has one result or three, not {}", models.len()))
                .help("choose red, green and blue with --index R,G,B"),
        );
    }
    let Refit { channels, deviation } = refit(models, to)?;
    Ok(Surface {
        // One result is grey.
        base: [0, 1, 2].map(|channel| channels[channel.min(channels.len() - 1)][0]),
        metallic: channels[0][1],
        roughness: channels[0][2],
        n: channels[0][3],
        deviation,
    })
}

/// A glTF 2.0 file with the material alone, and how far it is off.
///
/// # Errors
/// The number of models is not that of a colour.
pub fn gltf(models: &[Model]) -> Result<(String, String), Error> {
    let surface = surface(models, &GLTF)?;
    let [red, green, blue] = surface.base;
    let file = json!({
        "asset": {
            "version": "2.0",
            "generator": concat!("brdfit ", env!("CARGO_PKG_VERSION")),
            "extras": { "origin": origins(models), "deviation": surface.deviation },
        },
        "extensionsUsed": ["KHR_materials_ior"],
        "materials": [{
            "name": word(&models[0].name),
            "pbrMetallicRoughness": {
                "baseColorFactor": [red, green, blue, 1.0],
                "metallicFactor": surface.metallic,
                "roughnessFactor": surface.roughness,
            },
            "extensions": { "KHR_materials_ior": { "ior": surface.n } },
        }],
    });
    Ok((format!("{file:#}\n"), surface.deviation))
}

/// A MaterialX document with a `gltf_pbr` surface, and how far it is off.
///
/// # Errors
/// The number of models is not that of a colour.
pub fn materialx(models: &[Model]) -> Result<(String, String), Error> {
    let inputs = ["metallic", "roughness", "ior"];
    Ok(document("1.38", "gltf_pbr", inputs, models, surface(models, &GLTF)?))
}

/// A MaterialX document with an `open_pbr_surface`, and how far it is off.
///
/// # Errors
/// The number of models is not that of a colour.
pub fn openpbr(models: &[Model]) -> Result<(String, String), Error> {
    let inputs = ["base_metalness", "specular_roughness", "specular_ior"];
    let surface = surface(models, &OPEN_PBR)?;
    Ok(document("1.39", "open_pbr_surface", inputs, models, surface))
}

/// A MaterialX document of this version with this node, whose inputs for metallic, roughness and index have these names.
fn document(version: &str, node: &str, inputs: [&str; 3], models: &[Model], surface: Surface) -> (String, String) {
    let [red, green, blue] = surface.base;
    let name = word(&models[0].name);
    let [metallic, roughness, ior] = inputs;
    // Two hyphens would end the comment.
    let comment = format!("{}; {}", origins(models), surface.deviation).replace("--", "- -");
    let text = format!(
        "<?xml version=\"1.0\"?>\n<materialx version=\"{version}\" colorspace=\"lin_rec709\">\n  <!-- {} -->\n  \
         <{node} name=\"{name}_surface\" type=\"surfaceshader\">\n    \
         <input name=\"base_color\" type=\"color3\" value=\"{red:?}, {green:?}, {blue:?}\" />\n    \
         <input name=\"{metallic}\" type=\"float\" value=\"{:?}\" />\n    \
         <input name=\"{roughness}\" type=\"float\" value=\"{:?}\" />\n    \
         <input name=\"{ior}\" type=\"float\" value=\"{:?}\" />\n  </{node}>\n  \
         <surfacematerial name=\"{name}\" type=\"material\">\n    \
         <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"{name}_surface\" />\n  \
         </surfacematerial>\n</materialx>\n",
        comment.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;"),
        surface.metallic,
        surface.roughness,
        surface.n,
    );
    (text, surface.deviation)
}

/// A Python module with the dictionary of Mitsuba 3's `principled`, and how far it is off.
///
/// # Errors
/// The number of models is not that of a colour.
pub fn mitsuba_principled(models: &[Model]) -> Result<(String, String), Error> {
    let surface = surface(models, &PRINCIPLED)?;
    let name = word(&models[0].name);
    let text = format!(
        "# {}.\n# {}.\n# mi.load_dict({name}) makes it a BSDF.\n{name} = {{\n    \"type\": \"principled\",\n    \
         \"base_color\": {{\"type\": \"rgb\", \"value\": {:?}}},\n    \"metallic\": {:?},\n    \
         \"roughness\": {:?},\n    \"eta\": {:?},\n}}\n",
        origins(models),
        surface.deviation,
        surface.base,
        surface.metallic,
        surface.roughness,
        surface.n,
    );
    Ok((text, surface.deviation))
}

fn origins(models: &[Model]) -> String {
    let origins: Vec<&str> = models.iter().map(|model| model.origin.as_str()).collect();
    origins.join("; ")
}
