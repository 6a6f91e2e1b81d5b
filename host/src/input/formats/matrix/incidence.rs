//! What remarks and options say of the angle of incidence of a matrix, and of its sides.

use super::names::{self, Axis};
use super::side::Side;
use crate::error::Error;
use crate::input::about::ThetaI;
use crate::input::facts::Facts;
use crate::input::head::Head;
use crate::input::options::ReadOptions;
use crate::input::role;
use crate::input::rows;
use crate::input::units::Angles;
use crate::number::shortest;

/// Where the one angle of incidence of a matrix with azimuths is from.
///
/// # Errors
/// It is missing, or remarks say two.
pub fn one_theta_i(
    text: &str,
    axes: [Axis; 2],
    sides: [&Side; 2],
    unit: Angles,
    options: &ReadOptions,
) -> Result<ThetaI, Error> {
    let remark = remarks(text).one_theta_i()?;
    if options.theta_i.is_empty() && remark.is_none() {
        let at = usize::from(axes[1] == Axis::Azimuth);
        let place = ["rows", "columns"][at];
        let why = if sides[at].has_azimuths(options.angles.unwrap_or(unit)) {
            "at angles of more than 90 degrees, so they are azimuths"
        } else {
            "azimuths by the corner cell,"
        };
        return Err(Error::new(format!(
            "the {place} are {why} and the matrix is of one angle of incidence"
        ))
        .at_line(sides[at].line)
        .help("give it in degrees with --theta-i 20; an azimuth of 180 is forward, or 0 with --forward negative"));
    }
    Ok(ThetaI::Missing {
        remark,
        names: [].into(),
    })
}

/// What the remarks of a matrix say.
fn remarks(text: &str) -> Facts {
    Facts::of(remark_lines(text))
}

fn remark_lines(text: &str) -> impl Iterator<Item = (u64, &str)> {
    let lines = rows::lines(text).filter(|(_, _, line)| line.trim_start().starts_with('#'));
    lines.map(|(number, _, line)| (number, line))
}

/// Refuses a remark such as `rows: theta_i, columns: theta_s` that says other sides than these.
///
/// # Errors
/// There is one, with its line.
pub fn refuse_sides(text: &str, [side, top]: [Axis; 2]) -> Result<(), Error> {
    for (line, remark) in remark_lines(text) {
        let parts = remark.trim_start_matches(['#', ' ']).split([',', ';']);
        for (key, value) in parts.filter_map(|part| part.split_once([':', '='])) {
            let axis = match Head::new(key).plain.trim_end_matches('s') {
                "row" | "firstcolumn" => side,
                "column" | "col" | "firstrow" => top,
                _ => continue,
            };
            if names::axis(role::role(&Head::new(value))).is_some_and(|said| said != axis) {
                return Err(
                    Error::new("a remark says what the rows and the columns are, and they are taken the other way round")
                        .at_line(line)
                        .help(r"write in the corner what the first column is, then what the first row is, such as theta_i\theta_s"),
                );
            }
        }
    }
    Ok(())
}

/// Refuses a remark that says another angle of incidence than the matrix.
///
/// # Errors
/// There is one, with its line.
pub fn refuse_remark(text: &str, incidence: &Side, unit: Angles) -> Result<(), Error> {
    let said = remarks(text).theta_i;
    let has = |said: f64, angle: f64| (said - unit.degrees(angle)).abs() < 0.05;
    let all = |angle: f64| said.iter().any(|&(_, said)| has(said, angle));
    let Some(&(line, degrees)) = said
        .first()
        .filter(|_| !incidence.angles.iter().all(|&angle| all(angle)))
    else {
        return Ok(());
    };
    Err(Error::new(format!(
        "a remark says that theta_i is {} degrees, and the matrix has angles of incidence along one side",
        shortest(degrees)
    ))
    .at_line(line)
    .help("remove the remark if they are; else write a table, one value a row, with theta_s, brdf and a column for what they are"))
}
