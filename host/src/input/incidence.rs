//! The angle of incidence of a scan whose table has none.

use super::about::ThetaI;
use super::options::ReadOptions;
use super::raw::RawScan;
use super::units::Angles;
use super::{facts, file_name};
use crate::error::Error;

/// Gives the rows of a scan their angle of incidence, if the table has none: from the option, a remark, or the file's name.
///
/// # Errors
/// None of these has it, or the option gives what the table has too.
pub fn give_theta_i(file: &str, scan: &mut RawScan, options: &ReadOptions) -> Result<(), Error> {
    let given = options.theta_i.first().copied();
    let (named, names) = match (&scan.about.theta_i, given) {
        (ThetaI::Column, None) => return Ok(()),
        (ThetaI::Column, Some(_)) => {
            return Err(
                Error::new("--theta-i gives an angle of incidence, and the file has its own")
                    .help("leave one out: --ignore takes the number or name of a column"),
            );
        }
        (ThetaI::Missing { remark, names }, _) => (*remark, names),
    };
    let (degrees, from) = match (given, named) {
        (Some(degrees), _) => (degrees, "--theta-i"),
        (None, Some(degrees)) => (degrees, "a remark"),
        (None, None) => match file_name::theta_i(file)? {
            Some(degrees) => (degrees, "the name of the file"),
            None => return Err(facts::missing_theta_i(names)),
        },
    };
    let angle = match options.angles.unwrap_or(scan.angles) {
        Angles::Deg => degrees,
        Angles::Rad => degrees.to_radians(),
    };
    scan.rows.iter_mut().for_each(|row| row.theta_i = angle);
    scan.about.theta_i = ThetaI::Column;
    scan.about.one_angle = true;
    scan.about
        .notes
        .push(format!("theta_i is {degrees} degrees, from {from}"));
    Ok(())
}
