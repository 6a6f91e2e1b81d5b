//! ABg as the parameters of programs that have that model themselves: `f = A / (B + |beta - beta_0|^g)` on Lambert's floor.

use brdfit_core::real::Real;

use super::model::Model;
use crate::error::Error;
use crate::number::shortest;
use crate::plain::plain;

/// OpticStudio takes no smaller B, unless g is 0 (its user guide, "Available Scatter Models").
const LEAST_B: f64 = 1e-12;

/// The two profiles for the ABg catalogue of OpticStudio, and the `.ABGF` file that adds them up, as text: the catalogue is filled in by hand.
///
/// # Errors
/// It is another model, or a B that the program does not take.
pub fn zemax(model: &Model) -> Result<String, Error> {
    let [rho_d, a, b, g] = model.abg("--to zemax-abg")?;
    if b <= LEAST_B && g != 0.0 {
        return Err(
            Error::new(format!("OpticStudio takes no B of {}", shortest(b))).help("fit with --bounds B=1.1e-12:10")
        );
    }
    let name = name(model);
    let wave = shortest(model.wavelength.map_or(0.0, |nm| nm / 1000.0));
    let row = |name: &str, [a, b, g]: [f64; 3]| {
        format!("{name}\t{wave}\t0\t{}\t{}\t{}\n", shortest(a), shortest(b), shortest(g))
    };
    // With B = 1 and g = 0 ABg is A / 2 everywhere, which is Lambert's law.
    let floor = [2.0 * rho_d / f64::PI, 1.0, 0.0];
    let rows = row(&format!("{name}_LOBE"), [a, b, g]) + &row(&format!("{name}_FLOOR"), floor);
    Ok(format!(
        "! {}\n\
         ! Enter these two rows in Libraries > ABg Scatter Catalog; a wavelength of 0 um means no scaling by wavelength.\n\
         Name\tWave\tAngle\tA\tB\tg\n\
         {rows}\
         ! Save the next three lines as {name}.ABGF in the folder ABg_Data: it adds the two up.\n\
         2 1\n{name}_LOBE 1\n{name}_FLOOR 1\n",
        model.origin
    ))
}

/// A script in FRED's BASIC that adds the ABg and the Lambertian scatter model to the open document.
///
/// # Errors
/// It is another model.
pub fn fred(model: &Model) -> Result<String, Error> {
    let [rho_d, a, b, g] = model.abg("--to fred")?;
    let quoted = |text: &str| format!("\"{}\"", plain(text).replace('"', "\"\""));
    let common = |variable: &str, what: &str| {
        format!(
            "    {variable}.Name = {}\n    {variable}.Description = {}\n    \
             {variable}.ApplyRefl = True\n    {variable}.ApplyTrans = False\n    {variable}.HaltIncident = True\n",
            quoted(&format!("{} {what}", model.name)),
            quoted(&model.origin),
        )
    };
    Ok(format!(
        "' {}\n' Run it in FRED, and give both scatter models to the surface.\nSub Main\n    \
         Dim lobe As T_ABGSCATTER\n    InitAbgScatter lobe\n    \
         lobe.Acoef = {}\n    lobe.Bcoef = {}\n    lobe.G = {}\n{}    AddAbgScatter lobe\n\n    \
         Dim lambert As T_LAMBERTIANSCATTER\n    InitLambertianScatter lambert\n    \
         lambert.Refl = {}\n{}    AddLambertianScatter lambert\nEnd Sub\n",
        model.origin,
        shortest(a),
        shortest(b),
        shortest(g),
        common("lobe", "ABg"),
        shortest(rho_d),
        common("lambert", "floor"),
    ))
}

/// The model's name in the letters of a file's.
fn name(model: &Model) -> String {
    super::model::word(&model.name).to_uppercase()
}
