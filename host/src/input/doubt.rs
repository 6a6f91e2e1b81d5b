//! Numbers that cannot be what they are taken for, and angles of a full turn.

use super::columns::Polar;
use super::options::ReadOptions;
use super::raw::{RawScan, Row};
use super::units::{Angles, Quantity};
use super::{azimuths, large_sigma, marks};
use crate::error::Error;
use crate::number::shortest;

/// Half a right angle in radians is less than this, and no scan in degrees is so narrow without a reason.
const RIGHT_ANGLE: f64 = 1.6;
/// A reflectance factor that no surface has in all directions.
const BRIGHTEST: f64 = 2.0;
/// A scan over fewer degrees may be of a peak alone.
const WIDE: f64 = 60.0;
/// Fewer samples say little of all directions.
const FEW: usize = 8;

/// Makes angles of 0 to 360 degrees signed, and refuses what cannot be.
///
/// # Errors
/// Angles in another unit, azimuths in place of scattering angles, values in percent or in no unit of a BRDF; each with the option that settles it.
pub fn settle(scan: &mut RawScan, options: &ReadOptions) -> Result<(), Error> {
    if scan.about.settled {
        return Ok(());
    }
    let unit = options.angles.unwrap_or(scan.angles);
    if options.angles.is_none() {
        unit_of_angles(scan, unit)?;
    }
    full_turn(scan, unit)?;
    if options.value_unit.is_none() {
        marks::doubt(scan, unit, options)?;
        size_of_values(scan, unit, options)?;
    }
    azimuths::doubt(scan, unit, options)?;
    large_sigma::doubt(scan, options)
}

/// The largest of some finite numbers without their signs; 0 without any.
pub fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.filter(|x| x.is_finite()).map(f64::abs).fold(0.0, f64::max)
}

/// Are degrees radians, or radians degrees?
fn unit_of_angles(scan: &RawScan, unit: Angles) -> Result<(), Error> {
    // What an option, a remark or a head gives has a unit of its own.
    let polar = match (scan.about.one_angle, scan.about.angle_of_heads) {
        (true, _) | (_, Some(Polar::Incidence)) => largest(scan.rows.iter().map(|row| row.theta_s)),
        (_, Some(Polar::Scattering)) => largest(scan.rows.iter().map(|row| row.theta_i)),
        (false, None) => largest(scan.rows.iter().flat_map(|row| [row.theta_i, row.theta_s])),
    };
    let Some(first) = scan.rows.first() else { return Ok(()) };
    let at = |error: Error| error.at(first.line, None);
    match unit {
        Angles::Rad if polar > RIGHT_ANGLE && polar <= 180.0 => Err(at(Error::new(format!(
            "an angle is {polar} radians, beyond the horizon; are they degrees?"
        ))
        .help("say --angles deg if they are, and --angles rad if not"))),
        Angles::Deg => {
            let azimuths = scan.rows.iter().filter_map(|row| row.delta_phi);
            degrees(polar, scan.rows.len(), azimuths).map_err(at)
        }
        Angles::Rad => Ok(()),
    }
}

/// Asks whether angles that are taken for degrees are radians: `polar` is the largest of so many samples without its sign.
///
/// # Errors
/// They may be, which an option settles.
pub fn degrees(polar: f64, samples: usize, azimuths: impl Iterator<Item = f64> + Clone) -> Result<(), Error> {
    if samples > 2 && polar > 0.0 && polar <= RIGHT_ANGLE {
        return Err(Error::new(format!(
            "all angles are within {} degrees; are they radians?",
            shortest(polar)
        ))
        .help("say --angles rad if they are, and --angles deg if not"));
    }
    let turn = std::f64::consts::TAU;
    let half = |phi: f64| [0.5 * turn, turn].iter().any(|angle| (phi.abs() - angle).abs() < 5e-3);
    if largest(azimuths.clone()) <= turn + 5e-3 && azimuths.clone().any(half) {
        return Err(
            Error::new("the azimuths are within 6.3 degrees and one is pi; are they radians?")
                .help("give all angles in one unit, or say --angles deg if all are degrees"),
        );
    }
    Ok(())
}

/// Turns what is beyond three quarters of a turn to negative angles, and refuses scattering angles over more than half a turn.
fn full_turn(scan: &mut RawScan, unit: Angles) -> Result<(), Error> {
    // Rounding of a file in radians must not make a right angle more than one.
    let degrees = |angle: f64| (unit.degrees(angle) * 1e6).round() / 1e6;
    let back = |angle: f64| match unit {
        Angles::Deg => angle - 360.0,
        Angles::Rad => angle - std::f64::consts::TAU,
    };
    let mut turned = false;
    let all = scan.rows.iter().flat_map(|row| [row.theta_i, row.theta_s]);
    // Most scans have no such angle, and need no search.
    if degrees(all.fold(0.0, f64::max)) >= 270.0 {
        for angle in scan
            .rows
            .iter_mut()
            .flat_map(|row| [&mut row.theta_i, &mut row.theta_s])
        {
            if (270.0..=360.0).contains(&degrees(*angle)) {
                *angle = back(*angle);
                turned = true;
            }
        }
    }
    if turned {
        scan.about
            .notes
            .push("angles above 270 degrees are negative ones: 280 is -80".to_string());
    }
    let angles = || scan.rows.iter().filter(|row| row.theta_s.is_finite());
    let low = degrees(angles().map(|row| row.theta_s).fold(f64::INFINITY, f64::min));
    let high = degrees(angles().map(|row| row.theta_s).fold(f64::NEG_INFINITY, f64::max));
    if high - low <= 180.0 {
        return from_the_surface(scan, low, angles().filter(|row| degrees(row.theta_s) > 90.0).count());
    }
    let beyond = |row: &&Row| degrees(row.theta_s).abs() > 90.0;
    let error = Error::new(format!(
        "theta_s goes from {} to {} degrees, over more than half a turn, as azimuths do",
        shortest(low),
        shortest(high)
    ))
    .help("if these are azimuths, name the columns with --columns phi_s=...,theta_s=...; if they are of light that goes through the sample too, leave its rows out of the file");
    let line = angles().find(beyond).map_or(0, |row| row.line);
    Err(error.at(line, scan.places.theta_s))
}

/// Refuses scattering angles that begin at 0 and of which many are beyond the normal: they are counted from the surface.
fn from_the_surface(scan: &RawScan, low: f64, beyond: usize) -> Result<(), Error> {
    if low < 0.0 || 4 * beyond < scan.rows.len() {
        return Ok(());
    }
    let error = Error::new(format!(
        "theta_s begins at {} degrees and {beyond} of {} rows are beyond 90: is it counted from the surface?",
        shortest(low),
        scan.rows.len()
    ))
    .help("theta_s is counted from the normal, negative on the side of incidence: subtract 90 degrees if so");
    Err(error.at(0, scan.places.theta_s))
}

/// Refuses values which, over a wide range of angles, are all brighter than any surface.
fn size_of_values(scan: &RawScan, unit: Angles, options: &ReadOptions) -> Result<(), Error> {
    let quantity = options.quantity.unwrap_or(scan.quantity);
    let (mut low, mut high, mut least) = (f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY);
    let mut valid = 0;
    let wanted = |row: &&Row| options.max_value.is_none_or(|largest| row.value < largest);
    for row in scan.rows.iter().filter(wanted) {
        let theta_s = unit.degrees(row.theta_s);
        if let Ok(brdf) = quantity.brdf(row.value / scan.about.divisor, unit.radians(row.theta_s)) {
            (low, high) = (low.min(theta_s), high.max(theta_s));
            least = least.min(brdf * std::f64::consts::PI);
            valid += 1;
        }
    }
    // What is known to be in percent is right.
    if valid < FEW || scan.about.divisor != 1.0 || !(high - low >= WIDE && least >= BRIGHTEST) {
        return Ok(());
    }
    let what = match quantity {
        Quantity::Brf | Quantity::BrfCos => "a reflectance factor",
        _ => "pi times the BRDF",
    };
    let error = Error::new(format!(
        "{what} is {} or more in all directions, brighter than any surface; are the values in percent, or not calibrated?",
        if least < 1e6 { format!("{least:.3}") } else { shortest(least) }
    ))
    .help("say --value-unit percent if so, give the --quantity, or take them as they are with --value-unit plain");
    let first = scan.rows.first().map_or(0, |row| row.line);
    Err(error.at(first, None))
}
