//! Finds the columns of a scan by their names.

use crate::error::{Error, shown};

/// Where the columns of a scan are, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Columns {
    /// Angle of incidence.
    pub theta_i: usize,
    /// Scattering angle.
    pub theta_s: usize,
    /// BRDF, or its natural logarithm.
    pub brdf: usize,
    /// True if `brdf` holds ln of the BRDF.
    pub is_ln: bool,
    /// Azimuth of scattering, or its difference from that of incidence; without it the scan is in plane.
    pub phi_s: Option<usize>,
    /// Azimuth of incidence; 0 without it.
    pub phi_i: Option<usize>,
    /// Number of columns.
    pub count: usize,
}

const THETA_I: [&str; 8] = [
    "thetai",
    "thetain",
    "thetainc",
    "thetaincident",
    "incidentangle",
    "incidenceangle",
    "angleofincidence",
    "aoi",
];
const THETA_S: [&str; 9] = [
    "thetas",
    "thetar",
    "thetao",
    "thetaout",
    "thetasc",
    "thetascatter",
    "scatterangle",
    "scatteringangle",
    "angleofscatter",
];
const BRDF: [&str; 3] = ["brdf", "fr", "f"];
const LN_BRDF: [&str; 3] = ["lnbrdf", "lnfr", "lnf"];
const PHI_S: [&str; 6] = ["deltaphi", "dphi", "phis", "phir", "phio", "phi"];
const PHI_I: [&str; 2] = ["phii", "phiin"];
const UNITS: [&str; 9] = [
    "degrees",
    "degree",
    "deg",
    "°",
    "persteradian",
    "persr",
    "sr1",
    "sr⁻¹",
    "1sr",
];

/// Finds the columns in a header line.
///
/// Case, spaces, punctuation and units do not count: `Theta_i [deg]` is `theta_i_deg`, and `BRDF (1/sr)` is `brdf_per_sr`.
///
/// # Errors
/// A required column is missing, or there are two for one quantity.
pub fn find<'a>(names: impl Iterator<Item = &'a str> + Clone) -> Result<Columns, Error> {
    let plain: Vec<String> = names.clone().map(plain).collect();
    let one = |quantity: &str, synonyms: &[&str]| -> Result<Option<usize>, Error> {
        let mut places = (0..plain.len()).filter(|&place| synonyms.contains(&plain[place].as_str()));
        let first = places.next();
        match places.next() {
            Some(second) => Err(Error::new(format!("there is more than one column for {quantity}"))
                .at_column(second as u64 + 1)
                .help("rename or remove all but one")),
            None => Ok(first),
        }
    };
    let required = |quantity: &str, column: Option<usize>| {
        column.ok_or_else(|| {
            let found: Vec<String> = names.clone().map(shown).collect();
            Error::new(format!("no column {quantity} among the columns {}", found.join(", ")))
                .help("the first line must name the columns theta_i_deg,theta_s_deg,brdf_per_sr")
        })
    };
    let theta_i = required("theta_i_deg", one("theta_i", &THETA_I)?)?;
    let theta_s = required("theta_s_deg", one("theta_s", &THETA_S)?)?;
    let (linear, ln) = (one("the BRDF", &BRDF)?, one("ln of the BRDF", &LN_BRDF)?);
    Ok(Columns {
        theta_i,
        theta_s,
        brdf: required("brdf_per_sr", linear.or(ln))?,
        is_ln: linear.is_none(),
        phi_s: one("the azimuth", &PHI_S)?,
        phi_i: one("the azimuth of incidence", &PHI_I)?,
        count: plain.len(),
    })
}

/// The name without what people write differently.
fn plain(name: &str) -> String {
    let spelt = name
        .to_lowercase()
        .replace('θ', "theta")
        .replace(['φ', 'ϕ'], "phi")
        .replace(['δ', '∆'], "delta");
    let mut plain: String = spelt
        .chars()
        .filter(|c| c.is_alphanumeric() || *c == '°' || *c == '⁻')
        .collect();
    for unit in UNITS {
        if let Some(rest) = plain.strip_suffix(unit).filter(|rest| !rest.is_empty()) {
            plain.truncate(rest.len());
            break;
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_synonyms() {
        for header in [
            "theta_i_deg,theta_s_deg,brdf_per_sr",
            "theta_i_deg,theta_s_deg,brdf_sr-1",
            "Theta_I [deg],THETA_R (degrees),BRDF (1/sr)",
            "θ_i (°),θ_s (°),f_r (sr⁻¹)",
            "AOI,scatter angle,BRDF [sr^-1]",
        ] {
            let columns = find(header.split(',')).unwrap();
            assert_eq!((columns.theta_i, columns.theta_s, columns.brdf), (0, 1, 2), "{header}");
            assert_eq!((columns.is_ln, columns.phi_s), (false, None));
        }
        let columns = find("ln_brdf,note,delta_phi_deg,theta_s,theta_i,phi_i".split(',')).unwrap();
        assert_eq!((columns.theta_i, columns.theta_s, columns.brdf), (4, 3, 0));
        assert_eq!((columns.is_ln, columns.phi_s, columns.phi_i), (true, Some(2), Some(5)));
    }

    #[test]
    fn refuses_missing_and_double_columns() {
        let error = find("theta_i,theta_s,value".split(',')).unwrap_err().to_string();
        assert!(
            error.contains("brdf_per_sr") && error.contains("theta_i, theta_s, value"),
            "{error}"
        );
        let error = find("theta_i,theta_s,theta_r,brdf".split(',')).unwrap_err();
        assert_eq!(error.column, Some(3));
        // Radians are another quantity, not a synonym.
        assert!(find("theta_i_rad,theta_s_rad,brdf".split(',')).is_err());
    }
}
