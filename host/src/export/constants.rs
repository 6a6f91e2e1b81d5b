//! The parameters as constants of a program, such as a firmware's.

use brdfit_core::brdf::NAMES;

use super::model::{Model, word};
use crate::error::Error;

/// A number that both languages take for an f64, with all its digits.
fn literal(x: f64) -> String {
    format!("{x:?}")
}

/// A header file.
pub fn c(model: &Model) -> Result<String, Error> {
    let params = model.eq_14("--to c")?;
    let name = word(&model.name);
    let guard = format!("{}_BRDF_H", name.to_uppercase());
    let mut text = format!(
        "/* {}. */\n#ifndef {guard}\n#define {guard}\n\n",
        model.origin.replace("*/", "* /")
    );
    text += "/* Modified Cook-Torrance model of Bishop, Butler and Marciniak (2021), Eq. 14; dimensionless, index of refraction n - i kappa. */\n";
    for (parameter, value) in NAMES.into_iter().zip(params.to_array()) {
        text += &format!(
            "#define {}_{} {}\n",
            name.to_uppercase(),
            parameter.to_uppercase(),
            literal(value)
        );
    }
    Ok(text + "\n#endif\n")
}

/// A constant of the core's type; `f32` in place of `f64` rounds each number to the nearest.
pub fn rust(model: &Model) -> Result<String, Error> {
    let params = model.eq_14("--to rust")?;
    let mut text = format!(
        "/// {}.\npub const {}: brdfit_core::brdf::Params<f64> = brdfit_core::brdf::Params {{\n",
        model.origin,
        word(&model.name).to_uppercase()
    );
    for (parameter, value) in NAMES.into_iter().zip(params.to_array()) {
        text += &format!("    {parameter}: {},\n", literal(value));
    }
    Ok(text + "};\n")
}
