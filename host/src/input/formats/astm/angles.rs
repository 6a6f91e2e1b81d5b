//! The angles that `VARS` names, and those that it forgets.

use crate::error::Error;
use crate::input::head::{Head, plain};
use crate::input::unit::Unit;
use crate::input::units::Angles;

/// Plain names of the angle of incidence.
pub const THETA_I: [&str; 1] = ["thetai"];
/// Plain names of the scattering angle.
pub const THETA_S: [&str; 2] = ["thetas", "thetar"];
/// Plain names of the azimuth of incidence.
pub const PHI_I: [&str; 1] = ["phii"];
/// Plain names of the azimuth of scattering.
pub const PHI_S: [&str; 2] = ["phis", "phir"];

/// The unit of the angles at these places: radians, if their names in `VARS` do not say degrees.
///
/// # Errors
/// Some are in degrees and some in radians.
pub fn unit(heads: &[Head], angles: &[usize]) -> Result<Angles, Error> {
    let is = |unit: Unit| angles.iter().find(|&&place| heads[place].unit == Some(unit));
    match (is(Unit::Deg), is(Unit::Rad)) {
        (Some(&place), Some(_)) => Err(Error::new("some angles are in degrees and some in radians")
            .at_column(place as u64 + 1)
            .help("give all in one unit, and say so in VARS")),
        (Some(_), None) => Ok(Angles::Deg),
        (None, _) => Ok(Angles::Rad),
    }
}

/// Names the azimuths where VARS forgets them and the rows have them: each stands behind its polar angle.
///
/// Instruments write such files; with one number more than names, and both azimuths without a name, nothing tells which it is.
pub fn name_forgotten(names: &mut Vec<&str>, numbers: usize) {
    let place = |wanted: &[&str]| names.iter().position(|name| wanted.contains(&plain(name).as_str()));
    let (phi_i, phi_s) = (place(&PHI_I), place(&PHI_S));
    let forgotten = [(phi_s, place(&THETA_S), "phi_s"), (phi_i, place(&THETA_I), "phi_i")];
    let mut forgotten: Vec<(usize, &str)> = forgotten
        .into_iter()
        .filter(|(phi, _, _)| phi.is_none())
        .filter_map(|(_, theta, name)| Some((theta? + 1, name)))
        .collect();
    if numbers != names.len() + forgotten.len() {
        return;
    }
    // From the back, so that the places before stay.
    forgotten.sort();
    for (place, name) in forgotten.into_iter().rev() {
        names.insert(place, name);
    }
}
