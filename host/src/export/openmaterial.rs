//! ASAM OpenMATERIAL 3D (`.xompt`): the BRDF as a look-up table over wavelength, angle of incidence, scattering angle and azimuth.

use std::f64::consts::PI;

use libm::atan2;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::model::Model;

const SCHEMA: &str =
    "https://raw.githubusercontent.com/asam-ev/OpenMATERIAL-3D/refs/tags/v1.0.0/schemas/material_brdf_schema.json";
/// What the format wants to know and a fit does not tell.
const NOT_STATED: &str = "not stated";

/// The file; each of `models` is one wavelength, in nm, rising, and there is at least one.
///
/// Angles are in radians, azimuth 0 is that of incidence and half a turn is forward.
pub fn write(models: &[(f64, &Model)]) -> String {
    let mut table = Vec::new();
    for (wavelength, model) in models {
        rows(model, wavelength * 1e-9, &mut table);
    }
    let names: Vec<&str> = models.iter().map(|(_, model)| model.name.as_str()).collect();
    let origins: Vec<&str> = models.iter().map(|(_, model)| model.origin.as_str()).collect();
    let wavelengths: Vec<f64> = models.iter().map(|(wavelength, _)| wavelength * 1e-9).collect();
    let of = models[0].1.material.model;
    let table: Vec<Value> = table.into_iter().map(|row| json!(row)).collect();
    let mut metadata = json!({
        "$schema": SCHEMA,
        "metadata": {
            "name": names.join(", "),
            "description": format!("{}. Model: {} ({}).", origins.join("; "), of.name, of.source),
            "uuid": uuid(models),
            "materialVersion": "1.0.0",
            "openMaterial3dVersion": "1.0.0",
            "copyrights": [NOT_STATED],
            "license": NOT_STATED,
            "authors": [NOT_STATED],
            "sources": "measurement, fitted model",
        },
    });
    metadata["brdf"] = json!({ "wavelengths": wavelengths, "lookupTable": table });
    // Only maps with other keys than strings, and failing writers, can make this fail.
    serde_json::to_string(&metadata)
        .unwrap_or_default()
        .replace("],[", "],\n[")
        + "\n"
}

/// Appends the rows of one model.
fn rows(model: &Model, metres: f64, table: &mut Vec<[f64; 5]>) {
    let width = model.material.width();
    for theta_i in (0..=85).step_by(5).map(f64::from) {
        let near = near(theta_i, width);
        for &theta_s in &near {
            for azimuth in azimuths(theta_s, width) {
                let f = model.f(theta_i.to_radians(), theta_s.to_radians(), azimuth);
                table.push([metres, theta_i.to_radians(), theta_s.to_radians(), azimuth, f]);
            }
        }
    }
}

/// Scattering angles in degrees: even steps, and finer ones over a lobe of slope m, which is as wide as 2 atan m in them.
fn near(theta_i: f64, m: f64) -> Vec<f64> {
    let step = 2.0 * atan2(m, 1.0).to_degrees() / 4.0;
    let even = (0..=85).step_by(5).map(f64::from);
    let fine = (-6..=6).map(|k| ((theta_i + f64::from(k) * step) * 1e6).round() / 1e6);
    let mut angles: Vec<f64> = even.chain(fine).filter(|angle| (0.0..=85.0).contains(angle)).collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    angles
}

/// Azimuths in radians from 0 to less than a turn: even steps, and finer ones around half a turn, where the lobe is.
fn azimuths(theta_s: f64, m: f64) -> Vec<f64> {
    if theta_s == 0.0 {
        return vec![0.0];
    }
    let width = 2.0 * atan2(m, 1.0).to_degrees();
    let even = (0..360).step_by(15).map(f64::from);
    let fine = (-4..=4).map(|k| ((180.0 + f64::from(k) * width / 4.0) * 1e6).round() / 1e6);
    let mut degrees: Vec<f64> = even.chain(fine).collect();
    degrees.sort_by(f64::total_cmp);
    degrees.dedup();
    let radians = |degrees: f64| if degrees == 180.0 { PI } else { degrees.to_radians() };
    degrees.into_iter().map(radians).collect()
}

/// The same for the same material, as the format asks: version 8 of RFC 9562, of a hash.
fn uuid(models: &[(f64, &Model)]) -> String {
    let mut hash = Sha256::new();
    for (wavelength, model) in models {
        hash.update(model.name.as_bytes());
        for number in model.material.values.iter().chain([wavelength]) {
            hash.update(number.to_le_bytes());
        }
    }
    let mut bytes = [0u8; 16];
    bytes.copy_from_slice(&hash.finalize()[..16]);
    bytes[6] = bytes[6] & 0x0f | 0x80;
    bytes[8] = bytes[8] & 0x3f | 0x80;
    let hex = bytes.map(|byte| format!("{byte:02x}")).concat();
    [&hex[..8], &hex[8..12], &hex[12..16], &hex[16..20], &hex[20..]].join("-")
}
