//! Finds the columns of a scan by their names.

use super::options::ReadOptions;
use super::units::{Angles, Quantity};
use crate::error::{Error, shown};

/// Where the columns of a scan are, counted from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Columns {
    /// Angle of incidence.
    pub theta_i: usize,
    /// Scattering angle.
    pub theta_s: usize,
    /// Azimuth of scattering, or its difference from that of incidence; without it the scan is in plane.
    pub phi_s: Option<usize>,
    /// Azimuth of incidence; 0 without it.
    pub phi_i: Option<usize>,
    /// The unit of all angles.
    pub angles: Angles,
    /// Wavelength of the row.
    pub wavelength: Option<usize>,
    /// The columns of values, each a scan of its own; at least one.
    pub values: Vec<Value>,
    /// Number of columns.
    pub count: usize,
}

/// A column of values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Value {
    /// Where it is.
    pub column: usize,
    /// What tells it from other columns of values; none if there are no others.
    pub name: Option<String>,
    /// What it holds.
    pub quantity: Quantity,
    /// Its standard deviation or weight, and which of these it is.
    pub weight: Option<(usize, WeightKind)>,
}

/// What a column says of the uncertainty of another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WeightKind {
    /// Standard deviation in the unit of the value.
    Sigma,
    /// Standard deviation over the value.
    RelativeSigma,
    /// The same in percent.
    PercentSigma,
    /// Factor of the residual.
    Factor,
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
const PHI_S: [&str; 6] = ["deltaphi", "dphi", "phis", "phir", "phio", "phi"];
const PHI_I: [&str; 2] = ["phii", "phiin"];
const WAVELENGTH: [&str; 5] = ["wavelength", "wavelengthnm", "lambda", "lambdanm", "wavelengthi"];
/// In the order of [`Quantity::ALL`].
const QUANTITIES: [&[&str]; 6] = [
    &["brdf", "fr", "f"],
    &["lnbrdf", "lnfr", "lnf"],
    &["log10brdf", "logbrdf", "log10f"],
    &["brdfcos", "ccbrdf", "brdfcosthetas", "fcosthetas"],
    &["brf", "reflectancefactor", "radiancefactor"],
    &["brfcos", "brfcosthetas"],
];
const SIGMA: [&str; 6] = ["sigma", "std", "sd", "stdev", "uncertainty", "standarddeviation"];
const UNITS: [&str; 13] = [
    "degrees",
    "degree",
    "deg",
    "°",
    "radians",
    "radian",
    "rad",
    "persteradian",
    "persr",
    "sr1",
    "sr⁻¹",
    "1sr",
    "%",
];

/// Finds the columns in a header line.
///
/// Case, spaces, punctuation and units do not count: `Theta_i [deg]` is `theta_i_deg`, and `BRDF (1/sr)` is `brdf_per_sr`; angles whose unit is `rad` are in radians.
/// The values are the columns that the options name, or the BRDF in one of the forms of [`Quantity`], or columns such as `R`, `G`, `B`, `550 nm`, `brdf_550nm`.
/// A column such as `sigma` or `sigma_R` holds the standard deviation of a value, `rel_sigma` or `sigma_%` the relative one, `weight` a factor.
///
/// # Errors
/// A required column is missing, or there are two for one quantity.
pub fn find(names: &[&str], options: &ReadOptions) -> Result<Columns, Error> {
    let plain: Vec<String> = names.iter().map(|name| plain(name)).collect();
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
    let missing = |quantity: &str| {
        let found: Vec<String> = names.iter().map(|name| shown(name)).collect();
        Error::new(format!("no column {quantity} among the columns {}", found.join(", ")))
            .help("the first line must name the columns theta_i_deg,theta_s_deg,brdf_per_sr")
    };
    let theta_i = one("theta_i", &THETA_I)?.ok_or_else(|| missing("theta_i_deg"))?;
    let theta_s = one("theta_s", &THETA_S)?.ok_or_else(|| missing("theta_s_deg"))?;
    let (phi_s, phi_i) = (one("the azimuth", &PHI_S)?, one("the azimuth of incidence", &PHI_I)?);
    let angles = unit(names[theta_i]);
    for place in [Some(theta_s), phi_s, phi_i].into_iter().flatten() {
        if unit(names[place]) != angles {
            return Err(Error::new("some angles are in degrees and some in radians")
                .at_column(place as u64 + 1)
                .help("give all in one unit, and name it in each column"));
        }
    }
    let mut values: Vec<(usize, Quantity)> = Vec::new();
    let wanted = |name: &String| options.column.iter().any(|wanted| self::plain(wanted) == *name);
    values.extend(
        (0..plain.len())
            .filter(|&k| wanted(&plain[k]))
            .map(|k| (k, quantity(&plain[k]))),
    );
    let named = !values.is_empty();
    if !named {
        let mut known = Vec::new();
        for (quantity, synonyms) in Quantity::ALL.into_iter().zip(QUANTITIES) {
            known.extend(one(quantity.title(), synonyms)?.map(|column| (column, quantity)));
        }
        let asked = known.iter().find(|(_, quantity)| options.quantity == Some(*quantity));
        values.extend(asked.or(known.first()));
    }
    let single = !named && !values.is_empty();
    if values.is_empty() {
        values.extend(
            (0..plain.len())
                .filter(|&k| is_channel(&plain[k]))
                .map(|k| (k, Quantity::Brdf)),
        );
    }
    if values.is_empty() {
        return Err(missing("brdf_per_sr"));
    }
    let several = values.len() > 1;
    let value = |(column, quantity): (usize, Quantity)| Value {
        column,
        name: (!single).then(|| names[column].trim().to_string()),
        quantity,
        weight: weight(names, &plain, &plain[column], several),
    };
    Ok(Columns {
        theta_i,
        theta_s,
        phi_s,
        phi_i,
        angles,
        wavelength: one("the wavelength", &WAVELENGTH)?,
        values: values.into_iter().map(value).collect(),
        count: plain.len(),
    })
}

/// The quantity in a column of this plain name; the BRDF if it is unknown.
fn quantity(plain: &str) -> Quantity {
    let known = Quantity::ALL.into_iter().zip(QUANTITIES);
    let mut matching = known.filter(|(_, synonyms)| synonyms.contains(&plain));
    matching.next().map_or(Quantity::Brdf, |(quantity, _)| quantity)
}

/// True of `r`, `g`, `b` and `550nm`, also after `brdf`.
fn is_channel(plain: &str) -> bool {
    let tag = plain.strip_prefix("brdf").unwrap_or(plain);
    let wavelength = tag
        .strip_suffix("nm")
        .is_some_and(|number| number.parse::<f64>().is_ok());
    matches!(tag, "r" | "g" | "b") || wavelength
}

/// The column that tells how sure the values in column `value` are; with several columns of values it must name its own.
fn weight(names: &[&str], plain: &[String], value: &str, several: bool) -> Option<(usize, WeightKind)> {
    let tag = value
        .strip_prefix("brdf")
        .filter(|tag| !tag.is_empty())
        .unwrap_or(value);
    let kind = |place: usize| {
        let name = plain[place].as_str();
        let of_value = |name: &str| name == value || name == tag || (name.is_empty() && !several);
        if name.strip_prefix("weight").is_some_and(of_value) {
            return Some(WeightKind::Factor);
        }
        let relative = ["relative", "rel"].into_iter().find_map(|word| name.strip_prefix(word));
        let name = relative.unwrap_or(name);
        let sigma = SIGMA.iter().any(|sigma| {
            name.strip_prefix(sigma).is_some_and(of_value) || name.strip_suffix(sigma).is_some_and(of_value)
        });
        // The metrologists' `uBRDF`.
        if !sigma && name.strip_prefix('u') != Some(value) {
            return None;
        }
        Some(match relative {
            _ if names[place].contains('%') => WeightKind::PercentSigma,
            Some(_) => WeightKind::RelativeSigma,
            None => WeightKind::Sigma,
        })
    };
    (0..plain.len()).find_map(|place| Some((place, kind(place)?)))
}

/// The unit that an angle's name ends in; degrees without one.
fn unit(name: &str) -> Angles {
    let letters: String = name.to_lowercase().chars().filter(|c| c.is_alphabetic()).collect();
    if ["rad", "radian", "radians"].iter().any(|unit| letters.ends_with(unit)) {
        Angles::Rad
    } else {
        Angles::Deg
    }
}

/// The name without what people write differently.
pub fn plain(name: &str) -> String {
    let spelt = name
        .to_lowercase()
        .replace('θ', "theta")
        .replace(['φ', 'ϕ'], "phi")
        .replace(['δ', '∆'], "delta")
        .replace(['λ'], "lambda")
        .replace(['σ'], "sigma");
    let mut plain: String = spelt
        .chars()
        .filter(|c| c.is_alphanumeric() || ['°', '⁻', '%', '.'].contains(c))
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

    fn find(header: &str) -> Result<Columns, Error> {
        let names: Vec<&str> = header.split(',').collect();
        super::find(&names, &ReadOptions::default())
    }

    #[test]
    fn finds_synonyms() {
        for header in [
            "theta_i_deg,theta_s_deg,brdf_per_sr",
            "theta_i_deg,theta_s_deg,brdf_sr-1",
            "Theta_I [deg],THETA_R (degrees),BRDF (1/sr)",
            "θ_i (°),θ_s (°),f_r (sr⁻¹)",
            "AOI,scatter angle,BRDF [sr^-1]",
        ] {
            let columns = find(header).unwrap();
            assert_eq!(
                (columns.theta_i, columns.theta_s, columns.values[0].column),
                (0, 1, 2),
                "{header}"
            );
            assert_eq!((columns.values[0].quantity, columns.phi_s), (Quantity::Brdf, None));
        }
        let columns = find("ln_brdf,note,delta_phi_deg,theta_s,theta_i,phi_i").unwrap();
        assert_eq!((columns.theta_i, columns.theta_s, columns.values[0].column), (4, 3, 0));
        assert_eq!(
            (columns.values[0].quantity, columns.phi_s, columns.phi_i),
            (Quantity::LnBrdf, Some(2), Some(5))
        );
        assert_eq!(find("theta_i_rad,theta_s [rad],brdf").unwrap().angles, Angles::Rad);
    }

    #[test]
    fn finds_channels_and_their_uncertainties() {
        let columns = find("theta_i,theta_s,R,G,brdf_550nm,sigma_R,rel_sigma_G,550nm_sd_%,weight").unwrap();
        let names: Vec<_> = columns.values.iter().map(|value| value.name.as_deref()).collect();
        assert_eq!(names, [Some("R"), Some("G"), Some("brdf_550nm")]);
        let weights: Vec<_> = columns.values.iter().map(|value| value.weight).collect();
        assert_eq!(
            weights,
            [
                Some((5, WeightKind::Sigma)),
                Some((6, WeightKind::RelativeSigma)),
                Some((7, WeightKind::PercentSigma))
            ]
        );
        for (header, kind) in [
            ("aoi,theta_s,brdf,sigma", WeightKind::Sigma),
            ("aoi,theta_s,brdf,uBRDF", WeightKind::Sigma),
            ("aoi,theta_s,brdf,brdf std [1/sr]", WeightKind::Sigma),
            ("aoi,theta_s,ln_brdf,weight", WeightKind::Factor),
        ] {
            assert_eq!(find(header).unwrap().values[0].weight, Some((3, kind)), "{header}");
        }
        assert_eq!(find("aoi,theta_s,brdf,u,note").unwrap().values[0].weight, None);
    }

    #[test]
    fn refuses_missing_and_double_columns() {
        let error = find("theta_i,theta_s,value").unwrap_err().to_string();
        assert!(
            error.contains("brdf_per_sr") && error.contains("theta_i, theta_s, value"),
            "{error}"
        );
        let error = find("theta_i,theta_s,theta_r,brdf").unwrap_err();
        assert_eq!(error.column, Some(3));
        assert!(find("theta_i_rad,theta_s_deg,brdf").is_err());
    }
}
