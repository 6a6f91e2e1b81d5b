//! Numbers and words of options: what they may be, on the command line and in JSON.

use serde::de::Error;
use serde::{Deserialize, Deserializer};

use crate::input::part::{self, Part};

/// A number that may be what is asked of it, or why it may not.
pub type Allowed = fn(f64) -> Result<f64, String>;

/// Above 0.
pub fn above_0(x: f64) -> Result<f64, String> {
    allowed(x, x > 0.0 && x.is_finite(), "it must be above 0")
}

/// An angle of incidence.
pub fn within_90(x: f64) -> Result<f64, String> {
    allowed(x, x.abs() < 90.0, "it must be an angle between -90 and 90 degrees")
}

/// Not negative.
pub fn from_0(x: f64) -> Result<f64, String> {
    allowed(x, x >= 0.0 && x.is_finite(), "it must not be negative")
}

/// An angle between directions.
pub fn within_180(x: f64) -> Result<f64, String> {
    allowed(x, (0.0..=180.0).contains(&x), "it must be an angle in degrees")
}

fn allowed(x: f64, yes: bool, why: &str) -> Result<f64, String> {
    if yes { Ok(x) } else { Err(why.to_string()) }
}

fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| format!("'{text}' is not a number"))
}

#[cfg(feature = "cli")]
pub fn positive(text: &str) -> Result<f64, String> {
    above_0(number(text)?)
}

#[cfg(feature = "cli")]
pub fn theta_i(text: &str) -> Result<f64, String> {
    within_90(number(text)?)
}

#[cfg(feature = "cli")]
pub fn not_negative(text: &str) -> Result<f64, String> {
    from_0(number(text)?)
}

#[cfg(feature = "cli")]
pub fn angle(text: &str) -> Result<f64, String> {
    within_180(number(text)?)
}

/// `60=0.5`.
pub fn weight_angle(text: &str) -> Result<(f64, f64), String> {
    let (theta_i, factor) = text.split_once('=').ok_or("write DEG=FACTOR, such as 60=0.5")?;
    Ok((within_180(number(theta_i)?)?, from_0(number(factor)?)?))
}

/// Columns as the command line has them.
pub fn columns<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<(Part, String)>, D::Error> {
    each(from, part::parse)
}

/// Weights of angles as the command line has them.
pub fn weights<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<(f64, f64)>, D::Error> {
    each(from, weight_angle)
}

fn each<'de, D: Deserializer<'de>, T>(from: D, one: fn(&str) -> Result<T, String>) -> Result<Vec<T>, D::Error> {
    let texts = Vec::<String>::deserialize(from)?;
    texts.iter().map(|text| one(text).map_err(D::Error::custom)).collect()
}
