//! What a column holds, by the words of its name.

use std::cell::RefCell;

use serde::Serialize;

use super::head::Head;
use super::lately::Lately;
use super::spell::{Word, spell};
use super::unit::Unit;
use super::units::Quantity;

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// Angle of incidence.
    ThetaI,
    /// Scattering angle.
    ThetaS,
    /// A polar angle that does not say of which direction.
    Theta,
    /// Azimuth of incidence.
    PhiI,
    /// Azimuth of scattering.
    PhiS,
    /// Azimuth of scattering less that of incidence.
    DeltaPhi,
    /// An azimuth that does not say of which direction.
    Phi,
    /// Wavelength or wavenumber of the row.
    Wavelength,
    /// Polarisation of the row.
    Polarisation,
    /// Name of the sample or of the scan that the row is of.
    Sample,
    /// Unit of the value in the row.
    Unit,
    /// The standard deviation of ln f that a weight of 1 stands for.
    SigmaLn,
    /// The absolute part of the standard deviation that a weight of the program's own table is from.
    OwnAbsolute,
    /// The relative part.
    OwnRelative,
    /// Number or time of a measurement: it tells repeated rows apart.
    Repeat,
    /// Values of this kind.
    Value(Quantity),
    /// Anything else.
    Unknown(Look),
}

/// What an unknown column may be, to judge by its name and unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Look {
    /// An angle or azimuth.
    Angle,
    /// A wavelength.
    Wavelength,
    /// A polarisation.
    Polarisation,
    /// A sample.
    Sample,
    /// A unit.
    Unit,
    /// None of these.
    Other,
}

/// The names of values, in the order of [`Quantity::ALL`].
const QUANTITIES: [&[&str]; 6] = [
    &["brdf", "bsdf", "fr", "f"],
    &["lnbrdf", "lnfr", "lnf"],
    &["log10brdf", "logbrdf", "logfr", "logf", "log10fr", "log10f"],
    &[
        "brdfcos",
        "ccbrdf",
        "brdfcosthetas",
        "brdfcosthetar",
        "fcosthetas",
        "cosinecorrectedbrdf",
    ],
    &[
        "brf",
        "reflectancefactor",
        "radiancefactor",
        "bidirectionalreflectancefactor",
        "pibrdf",
    ],
    &["brfcos", "brfcosthetas"],
];

/// What the column of this head holds.
pub fn role(head: &Head) -> Role {
    thread_local! {
        static LATELY: RefCell<Lately<Head, Role>> = const { RefCell::new(Lately::new()) };
    }
    LATELY.with_borrow_mut(|lately| lately.of(head, || found(head)))
}

fn found(head: &Head) -> Role {
    let plain = head.plain.as_str();
    if let Some(quantity) = quantity(plain) {
        return Role::Value(quantity);
    }
    if let Some(role) = word(plain).or_else(|| angle(head)) {
        return role;
    }
    Role::Unknown(look(head))
}

/// The quantity that values of this plain name are.
pub fn quantity(plain: &str) -> Option<Quantity> {
    let bare = |ending: &&str| plain.strip_suffix(*ending);
    let plain = ["mean", "average", "avg", "value", "measured"]
        .iter()
        .find_map(bare)
        .unwrap_or(plain);
    let mut known = Quantity::ALL.into_iter().zip(QUANTITIES);
    known
        .find(|(_, names)| names.contains(&plain))
        .map(|(quantity, _)| quantity)
}

/// Names of one word, and the initials of satellites' angles.
fn word(plain: &str) -> Option<Role> {
    Some(match plain {
        "aoi" | "angleofinc" | "sza" | "iza" | "izenith" => Role::ThetaI,
        "vza" | "oza" | "aor" | "aos" | "aod" => Role::ThetaS,
        "saa" | "iaa" => Role::PhiI,
        "vaa" | "oaa" => Role::PhiS,
        "raa" | "dphi" | "dazimuth" | "dazi" | "daz" => Role::DeltaPhi,
        "wavelength" | "wellenlänge" | "wellenlaenge" | "longueurdonde" | "wavelengthm" | "wavelengthi" | "wl"
        | "wvl" | "wavelen" | "lambda" | "lambdam" | "lam" | "wave" | "wavenumber" | "laserwavelength" | "nm"
        | "um" | "µm" | "μm" => Role::Wavelength,
        "polarisation" | "polarization" | "pol" | "polstate" | "polarisationstate" | "polarizationstate" => {
            Role::Polarisation
        }
        "sample" | "échantillon" | "echantillon" | "samplename" | "sampleid" | "sampleno" | "samplenumber"
        | "specimen" | "specimenid" | "material" | "coupon" | "scan" | "scanname" | "target" => Role::Sample,
        "unit" | "units" => Role::Unit,
        "sigmaln" => Role::SigmaLn,
        "ownabsolutesigma" => Role::OwnAbsolute,
        "ownrelativesigma" => Role::OwnRelative,
        "run" | "repeat" | "repetition" | "rep" | "index" | "idx" | "no" | "nr" | "number" | "id" | "time" | "date"
        | "datetime" | "timestamp" | "measurement" | "measurementno" | "runno" | "runid" | "point" | "row"
        | "sweep" => Role::Repeat,
        _ => return None,
    })
}

/// The role of an angle whose name is made of known words alone.
fn angle(head: &Head) -> Option<Role> {
    // A `d` in front is a difference, and behind it the half angle of another parameterisation.
    let (cut, difference) = match head.plain.strip_prefix('d') {
        Some(rest) if rest.starts_with("phi") || rest.starts_with("az") || rest.starts_with("theta") => (1, true),
        _ => (0, false),
    };
    let breaks: Vec<usize> = head.breaks.iter().filter_map(|at| at.checked_sub(cut)).collect();
    let words = spell(&head.plain[cut..], &breaks)?;
    // Acidity, or an azimuth: which of them is not for a reader to guess.
    if head.plain == "ph" {
        return None;
    }
    let has = |word: Word| words.contains(&word);
    let (incidence, scattering) = (has(Word::Incidence), has(Word::Scattering));
    // As in `phi_r - phi_i`.
    let is_two = words.iter().filter(|&&word| word == Word::Azimuth).count() == 2;
    let minus = is_two && incidence && scattering && head.text.contains(['-', '\u{2212}', '\u{2013}']);
    let difference = difference || minus || has(Word::Difference);
    if has(Word::Azimuth) {
        return match (has(Word::Polar), difference, incidence, scattering) {
            (true, ..) => None,
            (_, true, ..) => Some(Role::DeltaPhi),
            (_, _, false, false) => Some(Role::Phi),
            (_, _, true, false) => Some(Role::PhiI),
            (_, _, false, true) => Some(Role::PhiS),
            _ => None,
        };
    }
    let named = has(Word::Polar) || has(Word::Angle);
    let in_angles = matches!(head.unit, Some(Unit::Deg | Unit::Rad));
    // `scatter angle in deg` says in which unit, and not of which direction.
    let incidence = incidence && !(scattering && head.unit.is_some() && head.plain.ends_with("in"));
    match (difference, incidence, scattering) {
        _ if !named && (!in_angles || head.plain.len() < 3) => None,
        (true, ..) | (_, true, true) => None,
        (_, true, false) => Some(Role::ThetaI),
        (_, false, true) => Some(Role::ThetaS),
        _ => named.then_some(Role::Theta),
    }
}

/// True of `ph` and `pho`, but not of acidity.
fn may_be_azimuth(head: &Head) -> bool {
    head.plain.len() < 4 && head.plain.starts_with("ph") && !head.text.contains("pH")
}

/// What an unknown column looks like.
fn look(head: &Head) -> Look {
    const ANGLES: [&str; 15] = [
        "theta",
        "phi",
        "angle",
        "azim",
        "zenith",
        "polar",
        "tilt",
        "rotation",
        "elevation",
        "inclination",
        "altitude",
        "declination",
        "yaw",
        "pitch",
        "roll",
    ];
    let has = |names: &[&str]| names.iter().any(|name| head.plain.contains(name));
    let is = |names: &[&str]| names.contains(&head.plain.as_str());
    let short = head.plain.ends_with("pol") || head.plain.starts_with("pol") && !head.plain.starts_with("polar");
    if has(&["polaris", "polariz"]) || short {
        return Look::Polarisation;
    }
    if ["sigma", "std", "u", "unc", "err"]
        .iter()
        .any(|word| head.plain.starts_with(word) || head.plain.ends_with(word))
        && has(&ANGLES)
    {
        // The uncertainty of an angle.
        return Look::Other;
    }
    if has(&ANGLES) || is(&["el", "inc", "alpha", "beta", "gamma", "psi"]) || may_be_azimuth(head) {
        return Look::Angle;
    }
    match head.unit {
        Some(Unit::Deg | Unit::Rad) => return Look::Angle,
        Some(Unit::Length(nanometres)) if nanometres < 1e6 && head.plain.parse::<f64>().is_err() => {
            return Look::Wavelength;
        }
        Some(Unit::PerCm) => return Look::Wavelength,
        _ => {}
    }
    const SAMPLES: [&str; 9] = [
        "name", "label", "batch", "lot", "wafer", "panel", "tile", "coating", "paint",
    ];
    if has(&["wavelength", "lambda", "wavenumber", "frequency", "photon"]) || is(&["colour", "color", "filter", "band"])
    {
        Look::Wavelength
    } else if has(&["sample", "specimen", "material", "coupon"]) || is(&SAMPLES) {
        Look::Sample
    } else if has(&["unit"]) {
        Look::Unit
    } else {
        Look::Other
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(role: Role, names: &str) {
        for name in names.split(", ") {
            assert_eq!(super::role(&Head::new(name)), role, "{name}");
        }
    }

    #[test]
    fn angles_by_all_their_names() {
        all(
            Role::ThetaI,
            "theta_i, theta_in, thetaIn, theta_inc, theta_incident, incident angle, Incidence_angle, angle of incidence, AOI, \
             theta_source, illumination zenith angle, solar_zenith, SZA, incidence (deg), theta_0, thetai_rad, Incident_angle, \
             Einfallswinkel, Einfallswinkel [°], Beleuchtungswinkel, angle d'incidence, Angle d'éclairage",
        );
        all(
            Role::ThetaS,
            "theta_s, theta_r, theta_o, theta_out, theta_sc, theta_scatter, scatter angle, scattering angle, theta_v, \
             viewing angle, detector angle, Measure_angle, view zenith, VZA, theta_refl, angle of reflection, theta_obs, \
             Streuwinkel, Beobachtungswinkel (°), Ausfallswinkel, angle de diffusion, Angle d'observation, angle de réflexion",
        );
        all(Role::Theta, "theta, angle, zenith [deg], polar angle");
        all(
            Role::PhiI,
            "phi_i, Einfallsazimut, azimut d'incidence, phi_in, phi_inc, azimuth_i, incident azimuth, SAA, phi_source, incidence azimuth angle",
        );
        all(
            Role::PhiS,
            "phi_s, phi_r, phi_o, phi_out, phi_v, phi_scatter, scatter azimuth, view_azimuth, azimuth_out, VAA, φ_r (°), azimuth of scattering",
        );
        all(
            Role::DeltaPhi,
            "raa, RAA [deg], relative_azimuth, delta_azimuth, azimuth_difference, phi_rel, \
             phi_diff, delta_phi, dphi, Δφ, phi_r - phi_i, phi_r_minus_phi_i, rel. azimuth, relative azimuth angle, d_phi",
        );
    }

    #[test]
    fn no_name_takes_long() {
        // `azi` is two words, or one: as many ways as there are subsets of the repetitions.
        let name = "azi".repeat(100_000) + "q";
        assert_eq!(super::role(&Head::new(&name)), Role::Unknown(Look::Other));
        assert_eq!(super::role(&Head::new(&"azi".repeat(100_000))), Role::Phi);
    }

    #[test]
    fn an_azimuth_of_no_direction() {
        all(Role::Phi, "phi, azimuth, azimuth angle, azi, φ [deg]");
    }

    #[test]
    fn words_that_hold_short_names_are_no_angles() {
        all(
            Role::Unknown(Look::Other),
            "V_ph, V ph, pH, sphere, range, orange, other, the, V_th, thin, azo, anger, U_th",
        );
        all(Role::Unknown(Look::Angle), "ph, PH, pho, rose (deg)");
        all(Role::ThetaI, "th_i, thi, thI, i_theta, itheta, ang_i, theta(i), iAngle");
        all(
            Role::ThetaS,
            "th_s, ths, th_r, th r, angs, r_ang, theta_out, thOut, Theta e, scAngle",
        );
        all(Role::PhiS, "ph_s, ph_r, ph r, phr, az_r, azr, phi(r), phiO");
        all(Role::PhiI, "ph_i, az_i, AzIn, sun az, phi0");
        all(Role::DeltaPhi, "rel_az, relaz, ph_r - ph_i");
    }

    #[test]
    fn other_columns() {
        all(
            Role::Wavelength,
            "wavelength, wavelength_um, lambda [nm], λ (µm), wavenumber (cm-1), lambda/m, wavelength_m, nm",
        );
        all(Role::Polarisation, "pol, polarization, Polarisation state");
        all(Role::Sample, "sample, Sample ID, specimen, scan");
        all(
            Role::Value(Quantity::Brdf),
            "BRDF, brdf_per_sr, f_r (sr⁻¹), brdf_mean, BSDF",
        );
        all(Role::Value(Quantity::Brf), "BRF (%), reflectance factor");
        all(
            Role::Unknown(Look::Angle),
            "theta_h, phi_d, theta_d, tilt (deg), sample rotation, x (rad), phi_h, polarangle_azimuth, azim_of_table",
        );
        all(
            Role::Unknown(Look::Wavelength),
            "centre wavelength of filter, x (nm), frequency_THz, filter",
        );
        all(Role::Unknown(Look::Sample), "sample batch, name, coating");
        all(
            Role::Unknown(Look::Polarisation),
            "polarizer_deg, detector polarisation, incident_pol, pol_in",
        );
        all(
            Role::Unknown(Look::Other),
            "note, temperature, u_theta_s, sigma_phi, x, R, 550 nm, in, s, det",
        );
        all(Role::Repeat, "run, index, time, No.");
    }
}
