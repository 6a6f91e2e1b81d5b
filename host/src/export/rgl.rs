//! RGL tensor file (`.bsdf`), which Mitsuba's `measured` BSDF reads: any isotropic model as a table over half vectors.
//!
//! Source: Dupuy and Jakob, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering", ACM TOG 37(6) (2018).
//! The nodes of the table follow the distribution of visible normals, so that they are dense where the lobe is.

use std::f64::consts::PI;

use libm::{cos, sin};

use super::model::Model;
use crate::input::formats::tensor::{self, Numbers};
use crate::input::formats::warp::{Table, Warp};

/// Angles of incidence: so many, evenly up to [`LARGEST`].
const INCIDENCES: usize = 45;
/// The largest angle of incidence, degrees.
const LARGEST: f64 = 88.0;
/// Nodes of the table along each side.
const NODES: usize = 96;
/// Nodes of the distribution of normals along the angle, and of that of visible normals.
const NORMALS: usize = 512;
const VISIBLE: [usize; 2] = [256, 32];

/// The file; each of `models` is one wavelength, in nm, rising.
pub fn write(models: &[(f64, &Model)]) -> Vec<u8> {
    let incidences: Vec<f64> = (0..INCIDENCES)
        .map(|k| (LARGEST * k as f64 / (INCIDENCES - 1) as f64).to_radians())
        .collect();
    let (profile, floor) = normals(models);
    let ndf = [profile.clone(), profile.clone()].concat();
    // Two rows of the same: it does not depend on the azimuth.
    let Some(normals) = Table::new(ndf.iter().map(|&d| f64::from(d)).collect(), NORMALS) else {
        return Vec::new();
    };
    let (mut visible, mut luminance, mut spectra) = (Vec::new(), Vec::new(), Vec::new());
    for &theta_i in &incidences {
        let density = visible_normals(&normals, floor, theta_i);
        let warp = Warp::new(density.iter().map(|&d| f64::from(d)).collect(), VISIBLE[0]);
        visible.extend(density);
        let begin = spectra.len();
        for (_, model) in models {
            for place in 0..NODES * NODES {
                let even = |node: usize| node as f64 / (NODES - 1) as f64;
                let [u, v] = warp.sample(even(place % NODES), even(place / NODES));
                spectra.push((reflected(model, theta_i, u, v) / normals.at(u, v)) as f32);
            }
        }
        // The mean over the wavelengths stands for the luminance, by which a renderer chooses directions.
        let own = &spectra[begin..];
        luminance.extend((0..NODES * NODES).map(|place| {
            let sum: f32 = own[place..].iter().step_by(NODES * NODES).sum();
            sum / models.len() as f32
        }));
    }
    let origins: Vec<&str> = models.iter().map(|(_, model)| model.origin.as_str()).collect();
    let description = origins.join("; ").into_bytes();
    let floats = |values: &[f64]| values.iter().map(|&value| value as f32).collect::<Vec<f32>>();
    let wavelengths: Vec<f64> = models.iter().map(|(nm, _)| *nm).collect();
    tensor::write(&[
        ("description", vec![description.len()], Numbers::Bytes(description)),
        ("phi_i", vec![1], Numbers::F32(vec![0.0])),
        ("theta_i", vec![INCIDENCES], Numbers::F32(floats(&incidences))),
        ("wavelengths", vec![models.len()], Numbers::F32(floats(&wavelengths))),
        ("ndf", vec![2, NORMALS], Numbers::F32(ndf)),
        // With a quarter, the scale of the table is the distribution of normals alone.
        ("sigma", vec![2, 2], Numbers::F32(vec![0.25; 4])),
        (
            "vndf",
            vec![1, INCIDENCES, VISIBLE[1], VISIBLE[0]],
            Numbers::F32(visible),
        ),
        ("luminance", vec![1, INCIDENCES, NODES, NODES], Numbers::F32(luminance)),
        (
            "spectra",
            vec![1, INCIDENCES, models.len(), NODES, NODES],
            Numbers::F32(spectra),
        ),
        ("jacobian", vec![1], Numbers::Bytes(vec![1])),
    ])
}

/// The distribution of normals, which is what the models reflect at normal incidence, and its mean over the hemisphere.
fn normals(models: &[(f64, &Model)]) -> (Vec<f32>, f64) {
    let angle = |k: usize| theta_of_u(k as f64 / (NORMALS - 1) as f64);
    let seen = |k: usize| -> f64 {
        let theta_s = (2.0 * angle(k)).min(LARGEST.to_radians());
        models.iter().map(|(_, model)| model.f(0.0, theta_s, PI)).sum()
    };
    let seen: Vec<f64> = (0..NORMALS).map(seen).collect();
    let solid = |k: usize| angle(k + 1) - angle(k);
    let half = (0..NORMALS - 1).map(|k| 0.5 * (seen[k] * sin(angle(k)) + seen[k + 1] * sin(angle(k + 1))) * solid(k));
    let mean = half.sum();
    (seen.iter().map(|&d| d as f32).collect(), mean)
}

/// The density of visible normals over the unit square, without a factor.
///
/// Half of the normals are spread evenly, so that half of the nodes lie beside the lobe.
fn visible_normals(normals: &Table, mean: f64, theta_i: f64) -> Vec<f32> {
    let [width, height] = VISIBLE;
    let node = |place: usize| {
        let (u, v) = (
            (place % width) as f64 / (width - 1) as f64,
            (place / width) as f64 / (height - 1) as f64,
        );
        let (theta_m, phi_m) = (theta_of_u(u), phi_of_u(v));
        let seen = cos(theta_i) * cos(theta_m) + sin(theta_i) * sin(theta_m) * cos(phi_m);
        ((normals.at(u, v) + mean) * seen.max(0.0) * u * sin(theta_m)) as f32
    };
    (0..width * height).map(node).collect()
}

/// f cos theta_s where the facet at (u, v) mirrors incidence at `theta_i`; 0 below the horizon.
fn reflected(model: &Model, theta_i: f64, u: f64, v: f64) -> f64 {
    let (theta_m, phi_m) = (theta_of_u(u), phi_of_u(v));
    let (sin_i, cos_i) = (sin(theta_i), cos(theta_i));
    let half = [sin(theta_m) * cos(phi_m), sin(theta_m) * sin(phi_m), cos(theta_m)];
    let twice = 2.0 * (half[0] * sin_i + half[2] * cos_i);
    let out = [twice * half[0] - sin_i, twice * half[1], twice * half[2] - cos_i];
    if out[2] <= 0.0 {
        return 0.0;
    }
    let theta_s = libm::atan2(libm::hypot(out[0], out[1]), out[2]);
    let delta_phi = libm::atan2(out[1], out[0]);
    model.f(theta_i, theta_s, delta_phi) * out[2]
}

/// The angle from the normal at a place of the unit square, radians.
fn theta_of_u(u: f64) -> f64 {
    u * u * PI / 2.0
}

/// The azimuth from incidence at a place of the unit square, radians.
fn phi_of_u(v: f64) -> f64 {
    (2.0 * v - 1.0) * PI
}
