//! What the two sides of a matrix are, by the corner and by their numbers.

use super::names::{Axis, Names};
use super::side::Side;
use crate::error::Error;
use crate::input::options::ReadOptions;
use crate::input::units::Angles;

/// A polar angle in radians is less than this; numbers that all are may be such.
const RIGHT_ANGLE: f64 = 1.6;
/// Smaller numbers than this may count.
const COUNT: f64 = 5.0;
/// Fractions below this may be wavelengths in micrometres.
const MICROMETRES: f64 = 30.0;

/// What the first column and the first row are.
///
/// Without names, angles of incidence are in the first row, unless that has negative angles and the first column has none, for an angle of incidence is seldom negative; angles of more than 90 degrees are azimuths.
///
/// # Errors
/// Which they are is not settled, or their numbers may be something else.
pub fn of(
    names: Names,
    unit: Option<Angles>,
    side: &Side,
    top: &Side,
    options: &ReadOptions,
) -> Result<[Axis; 2], Error> {
    let angles = options.angles.or(unit).unwrap_or(Angles::Deg);
    let azimuths = [side, top].map(|side| side.has_azimuths(angles));
    let axes = match names {
        _ if side.incidence || top.incidence => named_beside(names, side, top)?,
        Names::Both {
            side: first,
            top: second,
        } => {
            refuse_negative([first, second], [side, top])?;
            [first, second]
        }
        Names::One(Axis::Incidence) => one_of_incidence(side, top)?,
        Names::One(Axis::Azimuth) if azimuths[1] && !azimuths[0] => [Axis::Scattering, Axis::Azimuth],
        Names::One(Axis::Azimuth) => [Axis::Azimuth, Axis::Scattering],
        _ if azimuths[1] => [Axis::Scattering, Axis::Azimuth],
        Names::Neither if azimuths[0] => [Axis::Azimuth, Axis::Scattering],
        _ if top.has_negative() && !side.has_negative() => [Axis::Incidence, Axis::Scattering],
        _ => [Axis::Scattering, Axis::Incidence],
    };
    // Where all may be radians, that is asked later.
    let in_radians = side.largest().max(top.largest()) <= RIGHT_ANGLE;
    if options.angles.is_none() && unit != Some(Angles::Rad) && !in_radians {
        let named = |axis: Axis| matches!(names, Names::Both { .. }) || names == Names::One(axis);
        for (side, axis) in [top, side].into_iter().zip([axes[1], axes[0]]) {
            if !side.sure && !named(axis) {
                refuse_bare(side, axis)?;
            }
        }
    }
    Ok(axes)
}

/// The sides where the corner names angles of incidence alone, which may be those below it or beside it.
fn one_of_incidence(side: &Side, top: &Side) -> Result<[Axis; 2], Error> {
    match (side.has_negative(), top.has_negative()) {
        (false, true) => Ok([Axis::Incidence, Axis::Scattering]),
        (true, false) => Ok([Axis::Scattering, Axis::Incidence]),
        _ => Err(
            Error::new("the corner cell names theta_i, which may be the first column or the first row")
                .at_line(top.line)
                .at_column(1)
                .help(r"write theta_i\theta_s there if the first column is theta_i, and theta_s\theta_i if the first row is"),
        ),
    }
}

/// The sides where one has names such as `AOI=20` beside its angles.
fn named_beside(names: Names, side: &Side, top: &Side) -> Result<[Axis; 2], Error> {
    let axes = if top.incidence {
        [Axis::Scattering, Axis::Incidence]
    } else {
        [Axis::Incidence, Axis::Scattering]
    };
    let fits = match names {
        Names::Both { side, top } => [side, top] == axes,
        Names::One(axis) => axis != Axis::Azimuth,
        Names::Neither => true,
    };
    if fits && side.incidence != top.incidence {
        return Ok(axes);
    }
    Err(
        Error::new("angles of incidence are named along one side, and something else says that they are others")
            .at_line(top.line)
            .at_column(1)
            .help("name each side once, as one thing"),
    )
}

/// Refuses names that the signs contradict.
fn refuse_negative(axes: [Axis; 2], sides: [&Side; 2]) -> Result<(), Error> {
    let is_turned = |at: usize| {
        axes[at] == Axis::Incidence
            && axes[1 - at] == Axis::Scattering
            && sides[at].has_negative()
            && !sides[1 - at].has_negative()
    };
    let Some(at) = [0, 1].into_iter().find(|&at| is_turned(at)) else {
        return Ok(());
    };
    let place = ["column", "row"][at];
    Err(Error::new(format!(
        "the corner cell says that the first {place} is theta_i, and that has the negative angles: is it theta_s?"
    ))
    .at_line(sides[1].line)
    .at_column(1)
    .help(r"write what the first column is, then what the first row is, such as theta_s\theta_i"))
}

/// Refuses numbers without a name and a unit which may be wavelengths in micrometres or count.
fn refuse_bare(side: &Side, axis: Axis) -> Result<(), Error> {
    let largest = side.largest();
    let is_fine = match axis {
        Axis::Azimuth => true,
        Axis::Scattering => largest >= COUNT || side.has_negative(),
        Axis::Incidence => {
            largest >= COUNT && (largest >= MICROMETRES || side.angles.iter().all(|angle| (2.0 * angle).fract() == 0.0))
        }
    };
    // One angle alone, such as normal incidence, counts nothing.
    if is_fine || side.angles == [0.0] {
        return Ok(());
    }
    Err(Error::new(format!(
        "the numbers {} along one side of the matrix may be angles, wavelengths or count",
        side.shown()
    ))
    .at_line(side.line)
    .help(r"give them a unit, such as 20 deg, or write theta_s\theta_i in the corner, the first column before the first row, or say --angles deg"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(names: Names, side: &[f64], top: &[f64]) -> Result<[Axis; 2], Error> {
        let side_of = |angles: &[f64], line| Side {
            angles: angles.to_vec(),
            sure: false,
            ..Side::new(line)
        };
        super::of(
            names,
            None,
            &side_of(side, 2),
            &side_of(top, 1),
            &ReadOptions::default(),
        )
    }

    #[test]
    fn names_go_before_numbers() {
        use Axis::{Azimuth, Incidence, Scattering};
        let (up, both) = ([10.0, 30.0], [-80.0, 80.0]);
        let named = |side, top| Names::Both { side, top };
        for (names, side, top, axes) in [
            (Names::Neither, both, up, [Scattering, Incidence]),
            (Names::Neither, up, both, [Incidence, Scattering]),
            (Names::Neither, up, [0.0, 180.0], [Scattering, Azimuth]),
            (Names::Neither, [0.0, 180.0], up, [Azimuth, Scattering]),
            (Names::One(Scattering), up, up, [Scattering, Incidence]),
            (Names::One(Incidence), up, both, [Incidence, Scattering]),
            (Names::One(Incidence), both, up, [Scattering, Incidence]),
            (Names::One(Azimuth), up, both, [Azimuth, Scattering]),
            (Names::One(Azimuth), up, [0.0, 180.0], [Scattering, Azimuth]),
            (named(Incidence, Scattering), up, up, [Incidence, Scattering]),
            (named(Scattering, Incidence), up, up, [Scattering, Incidence]),
            (named(Scattering, Incidence), up, [1.0, 2.0], [Scattering, Incidence]),
        ] {
            assert_eq!(of(names, &side, &top).unwrap(), axes, "{names:?} {side:?} {top:?}");
        }
        assert!(of(Names::One(Incidence), &up, &up).is_err());
        let error = of(named(Incidence, Scattering), &both, &up).unwrap_err();
        assert_eq!((error.line, error.column), (Some(1), Some(1)));
    }

    #[test]
    fn bare_numbers_that_may_be_something_else_are_refused() {
        let angles = [-80.0, 80.0];
        for top in [&[1.0, 2.0, 3.0][..], &[0.55, 0.65], &[3.39, 10.6]] {
            let error = of(Names::One(Axis::Scattering), &angles, top).unwrap_err();
            assert!(error.what.contains("wavelengths or count"), "{error}");
        }
        assert_eq!(of(Names::Neither, &[1.0, 2.0], &angles).unwrap_err().line, Some(2));
        for top in [&[0.0][..], &[0.0, 7.5], &[19.98, 44.97]] {
            assert!(of(Names::Neither, &angles, top).is_ok(), "{top:?}");
        }
    }
}
