//! What the corner cell of a matrix says: which angle is along which side, in which unit, and what the values are.

use super::names::{ALONG, Names, one, pair, value_and_sides};
use crate::error::{Error, shown};
use crate::input::head::Head;
use crate::input::options::ReadOptions;
use crate::input::role::{self, Role};
use crate::input::unit::Unit;
use crate::input::units::{Angles, Quantity};
use crate::input::{channel, find, finder, uncertainty};

/// What the corner cell says.
#[derive(Clone, Debug, PartialEq)]
pub struct Corner {
    /// The sides that it names.
    pub names: Names,
    /// The unit of the angles, if it names one.
    pub angles: Option<Angles>,
    /// What the values are.
    pub quantity: Quantity,
    /// What they are divided by: 100 for percent.
    pub divisor: f64,
    /// The channel that they are of.
    pub channel: Option<String>,
}

impl Corner {
    /// What this cell says: nothing, `theta_s\theta_i`, `theta_s (deg)`, `BRF (%)`, `BRF (%) theta_s\theta_i`, `550 nm`.
    ///
    /// # Errors
    /// It says anything else, or a unit does not fit.
    pub fn of(text: &str, options: &ReadOptions) -> Result<Corner, Error> {
        Corner::read(text, options).map_err(|error| error.at_column(1))
    }

    fn read(text: &str, options: &ReadOptions) -> Result<Corner, Error> {
        let whole = Head::new(text);
        let of_angles = |names, angles| -> Result<Corner, Error> {
            Ok(Corner {
                names,
                angles,
                quantity: Quantity::Brdf,
                divisor: find::divisor(&Head::new(""), 0, options)?,
                channel: None,
            })
        };
        if is_empty(text) {
            return of_angles(Names::Neither, None);
        }
        if let Some((names, heads)) = pair(text) {
            return of_angles(names, unit_of_angles(&heads, options)?);
        }
        if let Some((value, sides)) = value_and_sides(text) {
            let (names, heads) = sides;
            return Ok(Corner {
                names,
                angles: unit_of_angles(&heads, options)?,
                ..values(&value, options)?
            });
        }
        // A single name with an arrow leaves the other side open, and may contradict the order that is usual.
        if let Some(names) = one(&whole) {
            if text.contains('↓') || ALONG.iter().any(|arrow| text.contains(arrow)) {
                return Err(not_understood(&whole));
            }
            return of_angles(names, unit_of_angles(&[whole], options)?);
        }
        values(&whole, options)
    }
}

/// True of a cell without a word: of marks alone, of what stands for no number, and of the name that pandas gives.
fn is_empty(text: &str) -> bool {
    let word = text.to_lowercase();
    !text.contains(|c: char| c.is_alphanumeric() || "%°‰".contains(c))
        || ["nan", "n/a", "na", "null", "none", "unnamed: 0"].contains(&word.as_str())
}

/// The unit of the angles that these name.
fn unit_of_angles(heads: &[Head], options: &ReadOptions) -> Result<Option<Angles>, Error> {
    let mut known = None;
    for head in heads {
        let unit = match head.unit.or_else(|| Unit::parse(&head.text)) {
            None => continue,
            Some(Unit::Deg) => Angles::Deg,
            Some(Unit::Rad) => Angles::Rad,
            Some(_) if options.angles.is_some() => continue,
            Some(_) => {
                let what = format!("'{}' is neither in degrees nor in radians", shown(&head.text));
                return Err(Error::new(what).help("convert it, or say with --angles deg or --angles rad what it is"));
            }
        };
        if *known.get_or_insert(unit) != unit {
            return Err(Error::new("some angles are in degrees and some in radians").help("give all in one unit"));
        }
    }
    Ok(known)
}

/// A corner that says what the values are.
fn values(head: &Head, options: &ReadOptions) -> Result<Corner, Error> {
    let name = shown(&head.text);
    if finder::goes_through(head) {
        let what = format!("the corner cell says '{name}': this is of light that goes through, and no reflectance");
        return Err(Error::new(what).help("measure the BRDF"));
    }
    let quantity = match role::role(head) {
        Role::Value(quantity) => Some(quantity),
        _ => None,
    };
    let is_value = |of: String| of.is_empty() || role::quantity(&of).is_some();
    if quantity.is_none() && uncertainty::of(head).any(is_value) {
        let what = format!("the corner cell says '{name}': these are uncertainties, and no BRDF");
        return Err(Error::new(what)
            .help("give the matrix of the values, or a table with the columns theta_i, theta_s, brdf and sigma"));
    }
    let is_channel = quantity.is_none() && channel::is(head);
    let alone = Unit::parse(&head.text).or(head.unit);
    let is_unit = matches!(
        alone,
        Some(Unit::PerSr | Unit::One | Unit::Multiple | Unit::Percent | Unit::Foreign)
    );
    if quantity.is_none() && !is_channel && !is_unit {
        return Err(not_understood(head));
    }
    let head = head.clone().with_unit(&head.text);
    if options.quantity.is_none() {
        channel::refuse_percent(&head)?;
        channel::refuse_log(&head)?;
    }
    Ok(Corner {
        names: Names::Neither,
        angles: None,
        quantity: quantity.unwrap_or_else(|| channel::quantity(&head)),
        divisor: find::divisor(&head, 0, options)?,
        channel: is_channel.then(|| channel::name(&head)),
    })
}

/// What is said of a corner that is none of these.
fn not_understood(head: &Head) -> Error {
    let name = shown(&head.text);
    match role::role(head) {
        Role::Wavelength | Role::Polarisation | Role::Sample | Role::Repeat => Error::new(format!(
            "the corner cell says '{name}', which is no angle, and a matrix has angles along both sides"
        ))
        .help("write a table, one value a row, with a column for that beside theta_i, theta_s and brdf"),
        _ => Error::new(format!(
            "the corner cell '{name}' is understood neither as the angles along the sides nor as the values"
        ))
        .help(r"write there what the first column and the first row are, such as theta_s\theta_i, or what the values are, such as BRDF, or nothing"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::names::Axis;
    use super::*;

    fn corner(text: &str) -> Result<Corner, Error> {
        Corner::of(text, &ReadOptions::default())
    }

    #[test]
    fn names_of_sides_and_their_unit() {
        use Axis::{Azimuth, Incidence, Scattering};
        let both = |side, top| Names::Both { side, top };
        for (text, names, angles) in [
            ("", Names::Neither, None),
            ("NaN", Names::Neither, None),
            ("Unnamed: 0", Names::Neither, None),
            ("angle (°)", Names::Neither, Some(Angles::Deg)),
            ("deg", Names::Neither, Some(Angles::Deg)),
            ("theta_s [rad]", Names::One(Scattering), Some(Angles::Rad)),
            ("AOI", Names::One(Incidence), None),
            ("phi", Names::One(Azimuth), None),
            (r"theta_s\theta_i", both(Scattering, Incidence), None),
            (
                "theta_i / theta_r (deg)",
                both(Incidence, Scattering),
                Some(Angles::Deg),
            ),
            ("theta_i → / theta_s ↓", both(Scattering, Incidence), None),
            (
                "scatter angle/deg, AOI/deg",
                both(Scattering, Incidence),
                Some(Angles::Deg),
            ),
            ("theta/phi", both(Scattering, Azimuth), None),
            (r"theta_i -> \ theta_s", both(Scattering, Incidence), None),
            (r"raa\zenith", both(Azimuth, Scattering), None),
            (r"theta\theta_i", both(Scattering, Incidence), None),
        ] {
            let found = corner(text).unwrap();
            assert_eq!((found.names, found.angles), (names, angles), "{text}");
        }
    }

    #[test]
    fn values_are_those_of_tables() {
        for (text, quantity, divisor) in [
            ("BRDF (1/sr)", Quantity::Brdf, 1.0),
            ("BRF", Quantity::Brf, 1.0),
            ("reflectance factor (%)", Quantity::Brf, 100.0),
            ("CCBRDF", Quantity::BrdfCos, 1.0),
            ("ln(BRDF)", Quantity::LnBrdf, 1.0),
            ("1/sr", Quantity::Brdf, 1.0),
        ] {
            let found = corner(text).unwrap();
            assert_eq!((found.quantity, found.divisor), (quantity, divisor), "{text}");
        }
        assert_eq!(corner("550 nm").unwrap().channel.as_deref(), Some("550 nm"));
    }

    #[test]
    fn the_values_may_stand_beside_both_sides() {
        use Axis::{Incidence, Scattering};
        let up = Names::Both {
            side: Incidence,
            top: Scattering,
        };
        for (text, angles, quantity, divisor) in [
            (r"BRDF theta_i\theta_s", None, Quantity::Brdf, 1.0),
            (r"BRDF (1/sr) theta_i\theta_s", None, Quantity::Brdf, 1.0),
            (r"BRDF: theta_i / theta_s [rad]", Some(Angles::Rad), Quantity::Brdf, 1.0),
            (
                r"BRF (%) | theta_i (deg)\theta_s (deg)",
                Some(Angles::Deg),
                Quantity::Brf,
                100.0,
            ),
            (r"theta_i\theta_s ln(BRDF)", None, Quantity::LnBrdf, 1.0),
            (r"theta_i\theta_s: BRDF [1/sr]", None, Quantity::Brdf, 1.0),
            (r"theta_i\theta_s (BRDF)", None, Quantity::Brdf, 1.0),
        ] {
            let found = corner(text).unwrap_or_else(|error| panic!("{text}: {error}"));
            assert_eq!((found.names, found.angles), (up, angles), "{text}");
            assert_eq!((found.quantity, found.divisor), (quantity, divisor), "{text}");
        }
        for text in [
            r"BTDF theta_i\theta_s",
            r"sigma theta_i\theta_s",
            r"log(BRDF) theta_i\theta_s",
        ] {
            assert!(corner(text).is_err(), "{text}");
        }
    }

    #[test]
    fn what_is_not_understood_is_refused() {
        for (text, what) in [
            ("BTDF", "goes through"),
            ("sigma", "uncertainties"),
            ("uncertainty", "uncertainties"),
            ("theta_s (gon)", "neither in degrees nor"),
            (r"theta_s (deg)\theta_i (rad)", "some in radians"),
            ("wavelength (um)", "no angle"),
            ("run", "no angle"),
            ("sample", "no angle"),
            ("time (s)", "understood neither"),
            ("temperature", "understood neither"),
            ("elevation", "understood neither"),
            ("relative angle to specular", "understood neither"),
            ("beta-beta0", "understood neither"),
            (r"theta_i\phi", "understood neither"),
            ("theta_s →", "understood neither"),
            ("counts", "not in sr^-1"),
            ("R (%)", "in percent"),
            ("log(BRDF)", "natural logarithm or that to base 10"),
        ] {
            let error = corner(text).unwrap_err();
            assert!(error.what.contains(what) && error.help.is_some(), "{text}: {error}");
            assert_eq!(error.column, Some(1));
        }
    }
}
