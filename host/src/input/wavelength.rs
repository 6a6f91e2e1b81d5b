//! Wavelengths: in one unit, so that 550, 550.0 and 5.5e2 are one.

use super::unit::Unit;
use crate::error::Error;

/// What a scatterometer can work at, from extreme ultraviolet to far infrared, nanometres.
const RANGE: std::ops::RangeInclusive<f64> = 5.0..=2e5;

/// A wavelength in nanometres.
///
/// Without a unit its size tells it: 0.2 to 20 are micrometres, 100 to 20 000 nanometres, and 1e-7 to 2e-5 metres.
///
/// # Errors
/// No such wavelength is used: the unit is another.
pub fn nanometres(number: f64, unit: Option<Unit>) -> Result<f64, Error> {
    let nanometres = match unit {
        Some(Unit::Length(nanometres)) => number * nanometres,
        Some(Unit::PerCm) => 1e7 / number,
        _ if (100.0..=2e4).contains(&number) => number,
        _ if (0.2..=20.0).contains(&number) => number * 1e3,
        _ if (1e-7..=2e-5).contains(&number) => number * 1e9,
        _ => f64::NAN,
    };
    // Rounding of the unit must not make two of one.
    let rounded: f64 = format!("{nanometres:.8e}").parse().unwrap_or(nanometres);
    if RANGE.contains(&rounded) {
        return Ok(rounded);
    }
    let as_read = if nanometres.is_finite() {
        format!("{nanometres} nm")
    } else {
        format!("{number} without a unit")
    };
    let fits = [("nm", 1.0), ("um", 1e3), ("m", 1e9)].into_iter();
    let fits = fits
        .filter(|(_, factor)| (100.0..=2e4).contains(&(number * factor)))
        .map(|(name, _)| name);
    let help = match fits.collect::<Vec<_>>().first() {
        Some(unit) => format!("is it in {unit}? say so with --wavelength-unit {unit}"),
        None => "say its unit with --wavelength-unit".to_string(),
    };
    Err(Error::new(format!("the wavelength is {as_read}, at which nothing is measured")).help(help))
}

/// A wavelength for people.
pub fn name(nanometres: f64) -> String {
    format!("{nanometres} nm")
}

/// The wavelength in a name such as `550nm` or `0.55 um`, nanometres; none if the name is no such thing.
pub fn of_name(name: &str) -> Option<f64> {
    let (number, unit) = Unit::at_end(name);
    let unit @ (Unit::Length(_) | Unit::PerCm) = unit? else {
        return None;
    };
    nanometres(number.trim().parse().ok()?, Some(unit)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_wavelength_in_every_unit() {
        for (number, unit) in [
            (550.0, Some(Unit::Length(1.0))),
            (0.55, Some(Unit::Length(1e3))),
            (5.5e-7, Some(Unit::Length(1e9))),
            (5500.0, Some(Unit::Length(0.1))),
            (1e7 / 550.0, Some(Unit::PerCm)),
            (550.0, None),
            (0.55, None),
            (5.5e-7, None),
        ] {
            assert_eq!(nanometres(number, unit).unwrap(), 550.0, "{number} {unit:?}");
        }
        assert_eq!(of_name("0.55um"), Some(550.0));
        assert_eq!(of_name("550 nm"), Some(550.0));
        assert_eq!(of_name("R"), None);
        assert_eq!(name(632.8), "632.8 nm");
    }

    #[test]
    fn a_wrong_unit_is_refused() {
        let error = nanometres(5e-7, Some(Unit::Length(1.0))).unwrap_err().to_string();
        assert!(error.contains("--wavelength-unit m"), "{error}");
        let error = nanometres(0.55, Some(Unit::Length(1.0))).unwrap_err().to_string();
        assert!(error.contains("--wavelength-unit um"), "{error}");
        assert!(nanometres(550.0, Some(Unit::Length(1e3))).is_err());
        assert!(nanometres(50.0, None).is_err());
    }
}
