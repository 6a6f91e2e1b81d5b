//! Finds the columns of a scan by their names, or where the options say they are.

use super::channel;
use super::columns::{Azimuth, Columns, Value, WeightKind};
use super::finder::Finder;
use super::head::Head;
use super::options::ReadOptions;
use super::part::{self, Part};
use super::role::{self, Look, Role};
use super::uncertainty;
use super::unit::Unit;
use super::units::{Angles, Quantity, ValueUnit};
use crate::error::{Error, shown};

/// Finds the columns.
///
/// Case, spaces and punctuation do not count, and units are taken off: `Theta_i [deg]` is `theta_i_deg`, and `BRDF (1/sr)` is `brdf_per_sr`; angles whose unit is `rad` are in radians.
/// The values are the columns that the options name, or the BRDF in one of the forms of [`Quantity`], or columns such as `R`, `G`, `B`, `550 nm`, `brdf_550nm`, `brdf_s`.
/// What the options say of a column goes before its name.
///
/// # Errors
/// A required column is missing, there are two for one quantity, or a unit does not fit.
pub fn find(heads: Vec<Head>, options: &ReadOptions) -> Result<Columns, Error> {
    let mut roles: Vec<Option<Role>> = heads.iter().map(|head| Some(role::role(head))).collect();
    let mut weight = None;
    let mut given: Vec<(usize, Quantity)> = Vec::new();
    for (part, column) in &options.columns {
        let place = part::place(column, &heads, "--columns")?;
        // What is given takes the place of what was known by its name.
        if let Part::Role(role) = part {
            roles
                .iter_mut()
                .filter(|known| **known == Some(*role))
                .for_each(|known| *known = None);
        }
        given.extend(part::quantity(*part).map(|quantity| (place, quantity)));
        roles[place] = match part {
            Part::Role(role) => Some(*role),
            other => {
                weight = Some((place, *other));
                None
            }
        };
    }
    // A column that an option gives twice is a mistake; one that it overrides is not used.
    let mut ignored = Vec::new();
    for name in &options.ignore {
        let place = part::place(name, &heads, "--ignore")?;
        roles[place] = None;
        ignored.push(place);
    }
    let mut splits = Vec::new();
    for name in &options.split {
        let place = part::place(name, &heads, "--split")?;
        roles[place] = None;
        splits.push(place);
    }
    let mut finder = Finder {
        taken: vec![false; heads.len()],
        heads: &heads,
        roles: &roles,
    };
    let theta_s = match finder.one("theta_s", Role::ThetaS)? {
        Some(place) => Some(place),
        None => finder.one("theta_s", Role::Theta)?,
    };
    let theta_i = finder.one("theta_i", Role::ThetaI)?;
    let azimuth = finder.azimuth()?;
    let wavelength = finder.one("the wavelength", Role::Wavelength)?;
    let polarisation = finder.one("the polarisation", Role::Polarisation)?;
    let unit = finder.one("the unit", Role::Unit)?;
    let sigma_ln = finder.one("the unit of weights", Role::SigmaLn)?;
    let absolute = finder.one("the absolute deviation", Role::OwnAbsolute)?;
    let relative = finder.one("the relative deviation", Role::OwnRelative)?;
    let own_sigma = absolute.zip(relative).map(|(absolute, relative)| [absolute, relative]);
    splits.extend(finder.one("the sample", Role::Sample)?);
    for &place in splits.iter().chain(&ignored) {
        finder.taken[place] = true;
    }
    finder.taken.extend(weight.map(|_| false));
    let theta_s = theta_s.ok_or_else(|| finder.missing("theta_s_deg"))?;
    let chosen = if given.is_empty() {
        finder.values(options)?
    } else {
        given
    };
    let mut taken = finder.taken;
    taken.truncate(heads.len());
    let mut values = Vec::new();
    let several = chosen.len() > 1;
    for (column, quantity) in chosen {
        taken[column] = true;
        let single = !several && role::quantity(&heads[column].plain).is_some();
        if options.columns.is_empty() && options.quantity.is_none() {
            let head = &heads[column];
            let clear = channel::refuse_percent(head).and_then(|()| channel::refuse_log(head));
            clear.map_err(|error| error.at_column(column as u64 + 1))?;
        }
        values.push(Value {
            column,
            name: (several || !single && options.columns.is_empty()).then(|| channel::name(&heads[column])),
            quantity,
            divisor: divisor(&heads[column], column, options)?,
            weight: None,
            angle: None,
            scan: values.len(),
        });
    }
    if let Some((place, part)) = weight {
        taken[place] = true;
        let coverage = heads[place].coverage.or(options.coverage).unwrap_or(1.0);
        let kind = match part {
            Part::Weight => WeightKind::Factor,
            Part::PercentSigma => WeightKind::PercentSigma(coverage),
            Part::RelativeSigma if heads[place].unit == Some(Unit::Percent) => WeightKind::PercentSigma(coverage),
            Part::RelativeSigma => WeightKind::RelativeSigma(coverage),
            _ => WeightKind::Sigma(coverage),
        };
        values.iter_mut().for_each(|value| value.weight = Some((place, kind)));
    }
    for place in uncertainty::assign(&heads, &taken, &mut values, options)? {
        taken[place] = true;
    }
    let used = [
        theta_i,
        Some(theta_s),
        wavelength,
        polarisation,
        unit,
        sigma_ln,
        absolute,
        relative,
    ];
    let used: Vec<usize> = used.into_iter().flatten().collect();
    let unused = (0..heads.len()).filter(|&k| ignored.contains(&k) || !taken[k] && !used.contains(&k));
    let unused: Vec<(usize, Role)> = unused
        .map(|place| (place, roles[place].unwrap_or(Role::Unknown(Look::Other))))
        .collect();
    let (angles, angles_named) = angles(&heads, theta_i, theta_s, azimuth, options)?;
    Ok(Columns {
        theta_i,
        theta_s: Some(theta_s),
        azimuth,
        angles,
        angles_named,
        wavelength,
        polarisation,
        splits,
        unit,
        sigma_ln,
        own_sigma,
        values,
        unused,
        heads,
    })
}

/// The unit of the angles, and whether it is named.
fn angles(
    heads: &[Head],
    theta_i: Option<usize>,
    theta_s: usize,
    azimuth: Option<Azimuth>,
    options: &ReadOptions,
) -> Result<(Angles, bool), Error> {
    let azimuths = match azimuth {
        None => [None, None],
        Some(Azimuth::Difference(place)) => [Some(place), None],
        Some(Azimuth::Of(phi_s, phi_i)) => [Some(phi_s), phi_i],
    };
    let places = [theta_i, Some(theta_s), azimuths[0], azimuths[1]].into_iter().flatten();
    let mut known: Option<Angles> = None;
    let mut named = options.angles.is_some();
    for place in places {
        let head = &heads[place];
        let unit = match head.unit {
            Some(Unit::Rad) => Angles::Rad,
            None | Some(Unit::Deg) => Angles::Deg,
            Some(_) if options.angles.is_some() => continue,
            Some(_) => {
                return Err(
                    Error::new(format!("'{}' is neither in degrees nor in radians", shown(&head.text)))
                        .at_column(place as u64 + 1)
                        .help("convert it, or say with --angles deg or --angles rad what it is"),
                );
            }
        };
        named |= head.unit.is_some();
        if options.angles.is_none() && *known.get_or_insert(unit) != unit {
            return Err(Error::new("some angles are in degrees and some in radians")
                .at_column(place as u64 + 1)
                .help("give all in one unit, and name it in each column"));
        }
    }
    Ok((options.angles.or(known).unwrap_or(Angles::Deg), named))
}

/// What the values of a column are divided by.
///
/// # Errors
/// The unit is none of a BRDF, and no option says to take the numbers as they are.
pub fn divisor(head: &Head, column: usize, options: &ReadOptions) -> Result<f64, Error> {
    match options.value_unit {
        Some(ValueUnit::Percent) => return Ok(100.0),
        Some(ValueUnit::Plain) => return Ok(1.0),
        None => {}
    }
    let is_channel = head.plain.contains(|c: char| c.is_ascii_digit());
    let known = match head.unit {
        // The wavelength of a channel.
        Some(Unit::Length(_) | Unit::PerCm) if is_channel => Ok(1.0),
        unit => of_unit(unit, &head.text),
    };
    known.map_err(|error| error.at_column(column as u64 + 1))
}

/// What values in this unit are divided by; `name` is what messages call their column.
///
/// # Errors
/// The unit is none of a BRDF.
pub fn of_unit(unit: Option<Unit>, name: &str) -> Result<f64, Error> {
    match unit {
        Some(Unit::Percent) => Ok(100.0),
        Some(Unit::Multiple) => Err(
            Error::new(format!("'{}' is in a multiple or a fraction of sr^-1", shown(name)))
                .help("write the values in sr^-1, or take the numbers as they are with --value-unit plain"),
        ),
        None | Some(Unit::PerSr | Unit::One) => Ok(1.0),
        Some(Unit::Foreign | Unit::Deg | Unit::Rad | Unit::Length(_) | Unit::PerCm) => Err(Error::new(format!(
            "'{}' is not in sr^-1, so it is no BRDF before it is calibrated",
            shown(name)
        ))
        .help("divide it by what a known standard gives, or take the numbers as they are with --value-unit plain")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(header: &str) -> Result<Columns, Error> {
        super::find(header.split(',').map(Head::new).collect(), &ReadOptions::default())
    }

    #[test]
    fn finds_synonyms() {
        for header in [
            "theta_i_deg,theta_s_deg,brdf_per_sr",
            "theta_i_deg,theta_s_deg,brdf_sr-1",
            "Theta_I [deg],THETA_R (degrees),BRDF (1/sr)",
            "θ_i (°),θ_s (°),f_r (sr⁻¹)",
            "AOI,scatter angle,BRDF [sr^-1]",
            "theta_i,theta,brdf",
        ] {
            let columns = find(header).unwrap();
            assert_eq!(
                (columns.theta_i, columns.theta_s, columns.values[0].column),
                (Some(0), Some(1), 2),
                "{header}"
            );
            assert_eq!((columns.values[0].quantity, columns.azimuth), (Quantity::Brdf, None));
        }
        let columns = find("ln_brdf,note,phi_s_deg,theta_s,theta_i,phi_i").unwrap();
        assert_eq!(
            (columns.theta_i, columns.theta_s, columns.values[0].column),
            (Some(4), Some(3), 0)
        );
        assert_eq!(
            (columns.values[0].quantity, columns.azimuth, &columns.unused[..]),
            (
                Quantity::LnBrdf,
                Some(Azimuth::Of(2, Some(5))),
                &[(1, Role::Unknown(Look::Other))][..]
            )
        );
        let columns = find("theta_i_rad,theta_s [rad],raa_rad,brdf").unwrap();
        assert_eq!(
            (columns.angles, columns.azimuth),
            (Angles::Rad, Some(Azimuth::Difference(2)))
        );
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
                Some((5, WeightKind::Sigma(1.0))),
                Some((6, WeightKind::RelativeSigma(1.0))),
                Some((7, WeightKind::PercentSigma(1.0)))
            ]
        );
        for (header, kind) in [
            ("aoi,theta_s,brdf,sigma", WeightKind::Sigma(1.0)),
            ("aoi,theta_s,brdf,uBRDF", WeightKind::Sigma(1.0)),
            ("aoi,theta_s,brdf,u", WeightKind::Sigma(1.0)),
            ("aoi,theta_s,brdf,U (k=2)", WeightKind::Sigma(2.0)),
            ("aoi,theta_s,brdf,U_BRDF (k=2) [%]", WeightKind::PercentSigma(2.0)),
            ("aoi,theta_s,brdf,expanded uncertainty (k=2)", WeightKind::Sigma(2.0)),
            ("aoi,theta_s,brdf,u (%)", WeightKind::PercentSigma(1.0)),
            ("aoi,theta_s,brdf,relative uncertainty", WeightKind::RelativeSigma(1.0)),
            ("aoi,theta_s,brdf,sigma/BRDF", WeightKind::RelativeSigma(1.0)),
            ("aoi,theta_s,brdf,std/BRDF (%)", WeightKind::PercentSigma(1.0)),
            ("aoi,theta_s,brdf,std", WeightKind::Sigma(1.0)),
            ("aoi,theta_s,brdf,brdf std [1/sr]", WeightKind::Sigma(1.0)),
            ("aoi,theta_s,brdf,standard deviation of BRDF", WeightKind::Sigma(1.0)),
            ("aoi,theta_s,brdf,±", WeightKind::Sigma(1.0)),
            ("aoi,theta_s,brdf,delta_BRDF", WeightKind::Sigma(1.0)),
            ("aoi,theta_s,ln_brdf,weight", WeightKind::Factor),
        ] {
            assert_eq!(find(header).unwrap().values[0].weight, Some((3, kind)), "{header}");
        }
        assert!(
            find("aoi,theta_s,brdf,U")
                .unwrap_err()
                .to_string()
                .contains("--coverage")
        );
        assert_eq!(find("aoi,theta_s,brdf,1/sigma").unwrap().values[0].weight, None);
        for of_another_unit in ["u (‰)", "sigma (um)", "error (deg)", "std (dB)", "sigma (nm)"] {
            let error = find(&format!("aoi,theta_s,brdf,{of_another_unit}")).unwrap_err();
            assert!(
                error.column == Some(4) && error.to_string().contains("--ignore 4"),
                "{error}"
            );
        }
        assert!(
            find("aoi,theta_s,BRF (%),u (%)")
                .unwrap_err()
                .to_string()
                .contains("--columns rel_sigma=4")
        );
    }

    #[test]
    fn units_of_values() {
        let divisor = |header| find(header).unwrap().values[0].divisor;
        assert_eq!(divisor("aoi,theta_s,BRF (%)"), 100.0);
        for header in [
            "aoi,theta_s,brdf [1/sr]",
            "aoi,theta_s,brdf_550nm",
            "aoi,theta_s,R,10 um",
        ] {
            assert_eq!(divisor(header), 1.0, "{header}");
        }
        for angle in ["aoi,theta_s ('),brdf", "aoi (″),theta_s,brdf"] {
            assert!(find(angle).unwrap_err().to_string().contains("--angles"), "{angle}");
        }
        // A radius is no channel.
        assert_eq!(find("aoi,theta_s,R (mm),brdf_550nm").unwrap().values.len(), 1);
        for (header, quantity) in [("log10(BRDF)", "log10 BRDF"), ("ln_brdf", "ln BRDF")] {
            let columns = find(&format!("aoi,theta_s,{header}")).unwrap();
            assert_eq!(columns.values[0].quantity.title(), quantity);
        }
        for header in ["aoi,theta_s,log(BRDF)", "aoi,theta_s,log_brdf", "aoi,theta_s,log f_r"] {
            let error = find(header).unwrap_err();
            assert!(
                error.column == Some(3) && error.to_string().contains("--quantity ln-brdf"),
                "{error}"
            );
        }
        for header in [
            "aoi,theta_s,BRDF (mV)",
            "aoi,theta_s,brdf_counts",
            "aoi,theta_s,brdf [a.u.]",
            "aoi,theta_s,BRDF (W/m2/sr)",
            "aoi,theta_s,BRDF (‰)",
            "aoi,theta_s,BRDF (um)",
            "aoi,theta_s,f (mm)",
            "aoi,theta_s,BRDF [1/um]",
        ] {
            let error = find(header).unwrap_err();
            assert!(
                error.column == Some(3) && error.to_string().contains("--value-unit"),
                "{error}"
            );
        }
    }

    #[test]
    fn refuses_missing_and_double_columns() {
        let error = find("theta_i,theta_s,value").unwrap_err().to_string();
        assert!(
            error.contains("brdf_per_sr")
                && error.contains("theta_i, theta_s, value")
                && error.contains("--columns brdf="),
            "{error}"
        );
        let error = find("theta_i,theta_s,theta_r,brdf").unwrap_err();
        assert!(error.column == Some(3) && error.to_string().contains("--columns theta_i=2,theta_s=3"));
        assert!(
            find("theta_i,theta_s,signal (mV)")
                .unwrap_err()
                .to_string()
                .contains("'signal (mV)' is not in sr^-1")
        );
        assert!(find("theta_i_rad,theta_s_deg,brdf").is_err());
        assert!(find("theta_i,theta_s,raa,phi_s,brdf").is_err());
    }
}
