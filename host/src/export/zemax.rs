//! Zemax tabular BSDF: BRDF over angles from the specular ray, one block an angle of incidence.

use brdfit_core::real::Real;
use libm::{atan2, hypot};

use super::model::Model;
use crate::analysis::reflectance::reflectance;
use crate::number::four;

/// Angles of incidence in degrees.
const INCIDENCES: [f64; 18] = [
    0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 70.0, 75.0, 80.0, 85.0,
];
/// Steps of the azimuth, degrees.
const AZIMUTH_STEP: usize = 5;

/// What is said of a model whose reflectance is above 1 somewhere, where the file says 1.
pub fn clamped(model: &Model) -> Option<String> {
    let each = INCIDENCES.map(|theta_i| (reflectance(&model.material, theta_i.to_radians()).0, theta_i));
    let above = each.iter().filter(|(sum, _)| *sum > 1.0).count();
    let (most, theta_i) = each.into_iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    (above > 0).then(|| {
        format!(
            "TIS is written as 1 at {above} of {} angles of incidence: the model sends out more light than arrives, {} times as much at {theta_i} deg",
            INCIDENCES.len(),
            four(most)
        )
    })
}

/// The file: degrees, sr^-1; 0 is below the horizon.
pub fn write(model: &Model) -> String {
    let azimuths: Vec<f64> = (0..=180).step_by(AZIMUTH_STEP).map(|degrees| degrees as f64).collect();
    let radials = radials(model.material.width());
    let mut text = format!("# {}\n", model.origin);
    text += "Source  Measured\nSymmetry  PlaneSymmetrical\nSpectralContent  Monochrome\nScatterType  BRDF\n";
    for (keyword, angles) in [
        ("SampleRotation", &[0.0][..]),
        ("AngleOfIncidence", &INCIDENCES),
        ("ScatterAzimuth", &azimuths),
        ("ScatterRadial", &radials),
    ] {
        text += &format!(
            "{keyword}  {}\n{}\n",
            angles.len(),
            joined(angles.iter().map(f64::to_string))
        );
    }
    text += "\nMonochrome\nDataBegin\n";
    for theta_i in INCIDENCES {
        // The format has no place for a model that makes energy: see [`clamped`].
        let tis = reflectance(&model.material, theta_i.to_radians()).0.min(1.0);
        text += &format!("TIS  {tis:.6}\n");
        for &azimuth in &azimuths {
            let value = |&radial: &f64| format!("{:.9e}", at(model, theta_i, azimuth, radial));
            text += &(joined(radials.iter().map(value)) + "\n");
        }
    }
    text + "DataEnd\n"
}

fn joined(words: impl Iterator<Item = String>) -> String {
    words.collect::<Vec<_>>().join("\t")
}

/// Angles from the specular ray in degrees: dense enough for a lobe of slope m, which is as wide as 2 atan m in them.
fn radials(m: f64) -> Vec<f64> {
    let width = 2.0 * atan2(m, 1.0).to_degrees();
    let narrow = (0..20).map(|step| (f64::from(step) * width / 8.0 * 1e6).round() / 1e6);
    let wide = (0..=20)
        .map(f64::from)
        .chain((22..=90).step_by(2).map(f64::from))
        .chain((95..=175).step_by(5).map(f64::from));
    let mut angles: Vec<f64> = narrow.filter(|&angle| angle < 20.0).chain(wide).collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    angles
}

/// f in the direction `radial` degrees from the specular ray, turned by `azimuth` from the side of the normal; 0 below the horizon.
fn at(model: &Model, theta_i: f64, azimuth: f64, radial: f64) -> f64 {
    let radians = theta_i.to_radians();
    // In plane the angle is a difference, which stays exact.
    let in_plane = match azimuth {
        0.0 => Some(theta_i - radial),
        180.0 => Some(theta_i + radial),
        _ if radial == 0.0 => Some(theta_i),
        _ => None,
    };
    if let Some(theta_s) = in_plane {
        return if theta_s.abs() < 90.0 {
            model.f(radians, theta_s.to_radians(), f64::PI)
        } else {
            0.0
        };
    }
    let (sin_i, cos_i) = Real::portable_sin_cos(radians);
    let (sin_a, cos_a) = Real::portable_sin_cos(azimuth.to_radians());
    let (sin_r, cos_r) = Real::portable_sin_cos(radial.to_radians());
    let x = sin_i * cos_r - cos_i * sin_r * cos_a;
    let y = sin_r * sin_a;
    let z = cos_i * cos_r + sin_i * sin_r * cos_a;
    if z <= 0.0 {
        return 0.0;
    }
    model.f(radians, atan2(hypot(x, y), z), f64::PI - atan2(y, x))
}
