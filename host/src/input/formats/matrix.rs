//! A plain matrix: angles of incidence in the first row, scattering angles in the first column, values between them, or what else the corner cell says.

mod axes;
mod corner;
mod incidence;
mod names;
mod side;

use corner::Corner;
use names::Axis;
use side::{Side, add_angle, angle};

use crate::error::Error;
use crate::input::format::{Format, Reader};
use crate::input::kind::Kind;
use crate::input::options::ReadOptions;
use crate::input::raw::{RawScan, Row, Weight};
use crate::input::repeats;
use crate::input::rows::{self, Decimal, number_in};
use crate::input::units::Angles;

/// This format.
pub const FORMAT: Format = Format {
    name: "matrix",
    title: "matrix",
    about: "Angles of incidence in the first row, scattering angles in the first column",
    reader: Reader::Text { is, read },
};

/// True if the first row has angles in all cells but the first, and the second row is as long.
fn is(text: &str) -> bool {
    let mut lengths = Vec::new();
    // Two rows are enough, and the error stops there.
    let _ = rows::for_each(text, |_, cells| {
        let is_number = |cell: &&str| rows::parse(cell, Decimal::Unknown).is_some_and(f64::is_finite);
        // Beyond a full turn they are wavelengths.
        let is_angle = |cell: &&str| angle(cell).is_some_and(|degrees| degrees.abs() <= 360.0);
        let (corner, angles) = cells.split_first().unwrap_or((&"", &[]));
        // `Incident Angle: 20` stands above other tables.
        let is_remark = corner.ends_with([':', '=']);
        let is_head = !is_remark && !is_number(corner) && !angles.is_empty() && angles.iter().all(is_angle);
        if is_head && lengths.is_empty() {
            lengths.push(cells.len());
        } else if !lengths.is_empty() {
            // Pairs such as `AOI,20` and `Wavelength,550` may stand above a table.
            lengths.push(if angle(corner).is_some() { cells.len() } else { 0 });
        }
        if is_head && lengths.len() == 1 {
            Ok(())
        } else {
            Err(Error::new("enough"))
        }
    });
    // With one row alone, what is missing is said by the reader.
    matches!(lengths[..], [head] if head > 2)
        || matches!(lengths[..], [head, row] if head == row || head > 3 && row > 0)
}

/// The one scan in the matrix; cells that are empty or NaN were not measured.
///
/// What the corner cell says is obeyed: which angle is along which side, their unit, what the values are.
/// Where one side has azimuths, a remark or the options must give the one angle of incidence.
///
/// # Errors
/// A cell is no number, a row is of another length, the corner is not understood, a direction occurs twice, or the angle of incidence is missing or given twice.
fn read(text: &str, options: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let mut first: Option<(Corner, Side)> = None;
    let mut side = Side::new(0);
    let mut body: Vec<(u64, Vec<f64>)> = Vec::new();
    let mut decimal = Decimal::Unknown;
    rows::for_each(text, |line, cells| {
        let Some((corner, top)) = &first else {
            let corner = Corner::of(cells[0], options).map_err(|error| error.at_line(line))?;
            let mut top = Side::new(line);
            for column in 1..cells.len() {
                add_angle(&mut top, corner.angles, cells, column, line)?;
            }
            first = Some((corner, top));
            return Ok(());
        };
        if cells.len() != top.angles.len() + 1 {
            let (have, first) = (cells.len(), top.angles.len() + 1);
            return Err(Error::new(format!("the row has {have} cells, the first row {first}"))
                .at_line(line)
                .help("leave a cell empty where nothing was measured"));
        }
        let values = (1..cells.len()).map(|column| number_in(cells, column, &mut decimal));
        let values = values.collect::<Result<_, _>>().map_err(|error| error.at_line(line))?;
        if body.is_empty() {
            side.line = line;
        }
        add_angle(&mut side, corner.angles, cells, 0, line)?;
        body.push((line, values));
        Ok(())
    })?;
    let Some((corner, top)) = first.filter(|_| !body.is_empty()) else {
        return Err(Error::new("there are no rows below the angles").help("give one row a scattering angle"));
    };
    let axes = axes::of(corner.names, corner.angles, &side, &top, options)?;
    incidence::refuse_sides(text, axes)?;
    let mut scan = RawScan::new(
        corner.channel.into_iter().collect(),
        corner.angles.unwrap_or(Angles::Deg),
    );
    scan.quantity = corner.quantity;
    scan.about.kind = Kind::Matrix;
    scan.about.divisor = corner.divisor;
    scan.about.angles_named = corner.angles.is_some();
    if axes.contains(&Axis::Azimuth) {
        scan.about.theta_i = incidence::one_theta_i(text, axes, [&side, &top], scan.angles, options)?;
        let note = "one axis of the matrix has azimuths, 180 being forward";
        scan.about.notes.push(note.to_string());
    } else {
        let along = if axes[0] == Axis::Incidence { &side } else { &top };
        incidence::refuse_remark(text, along, scan.angles)?;
    }
    for (&side, (line, values)) in side.angles.iter().zip(body) {
        for (&top, value) in top.angles.iter().zip(values) {
            let at = |axis: Axis| {
                let found = axes.iter().zip([side, top]).find(|(known, _)| **known == axis);
                found.map(|(_, angle)| angle)
            };
            scan.rows.push(Row {
                theta_i: at(Axis::Incidence).unwrap_or(f64::NAN),
                theta_s: at(Axis::Scattering).unwrap_or(f64::NAN),
                delta_phi: at(Axis::Azimuth),
                value,
                weight: Weight::Unknown,
                line,
            });
        }
    }
    scan.rows.retain(|row| !row.value.is_nan());
    if !options.repeats
        && let Some(twice) = repeats::twice(&scan, !axes.contains(&Axis::Azimuth))
    {
        return Err(twice.error("leave one out, or take them as repeated measurements with --repeats"));
    }
    Ok(vec![scan])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::about::ThetaI;
    use crate::input::units::Quantity;

    fn read(text: &str) -> Result<Vec<RawScan>, Error> {
        super::read(text, &ReadOptions::default())
    }

    #[test]
    fn the_first_row_has_the_angles_of_incidence() {
        let text = "# x\ntheta_s\\theta_i;10;60\n-80;0.5;0.25\n\n80;;1\n";
        assert!(is(text));
        let rows = read(text).unwrap().remove(0).rows;
        let seen: Vec<_> = rows
            .iter()
            .map(|row| (row.theta_i, row.theta_s, row.value, row.line))
            .collect();
        assert_eq!(
            seen,
            [(10.0, -80.0, 0.5, 3), (60.0, -80.0, 0.25, 3), (60.0, 80.0, 1.0, 5)]
        );
        // Heads with units or names, and decimal commas.
        for head in [
            "theta_s;10,0;60",
            "theta_s;10°;60 deg",
            "theta_s;AOI=10;AOI = 60 deg",
            ";AOI 10;theta_i: 60",
        ] {
            let text = format!("{head}\n-80;0,5;0,25\n\n80;;1\n");
            assert!(is(&text), "{head}");
            let again = read(&text).unwrap().remove(0).rows;
            assert!(
                again
                    .iter()
                    .zip(&rows)
                    .all(|(a, b)| (a.theta_i, a.value) == (b.theta_i, b.value)),
                "{head}"
            );
        }
        let turned = read(",-80,80\n10,0.5,nan\n60,0.25,1\n").unwrap().remove(0).rows;
        let seen: Vec<_> = turned.iter().map(|row| (row.theta_i, row.theta_s, row.value)).collect();
        assert_eq!(seen, [(10.0, -80.0, 0.5), (60.0, -80.0, 0.25), (60.0, 80.0, 1.0)]);
    }

    #[test]
    fn azimuths_are_told_from_angles_of_incidence() {
        for text in [
            "theta/phi -180 0 180\n0 1 2 3\n10 4 5 6\n",
            "angle 0 10\n0 1 2\n120 3 4\n240 5 6\n",
        ] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.contains("azimuths") && error.contains("--theta-i"), "{error}");
            let given = ReadOptions {
                theta_i: vec![20.0],
                ..ReadOptions::default()
            };
            let rows = super::read(text, &given).unwrap().remove(0).rows;
            assert_eq!((rows[0].theta_s, rows.len()), (0.0, 6));
            assert!(
                rows.iter()
                    .any(|row| row.delta_phi.is_some_and(|phi| phi > 100.0) && row.theta_s == 10.0)
            );
        }
        // Scattering angles of a full turn are none.
        assert_eq!(
            read("theta_s 10 20\n280 1 2\n0 3 4\n80 5 6\n").unwrap()[0].rows.len(),
            6
        );
    }

    #[test]
    fn a_header_of_names_or_no_header_is_no_matrix() {
        assert!(!is("theta_i,theta_s,brdf\n1,2,3\n") && !is("45,-85,0.03\n") && !is("") && !is("word\n"));
        assert!(is("NaN 10 60\n1 2 3\n"));
        // Wavelengths, angles of scattering, and what stands above a table.
        assert!(!is("AOI,20\nWavelength,550\ntheta_s,brdf\n1,2\n"));
        assert!(!is("theta_s,450,550\n1,2,3\n") && !is("AOI,theta_s=10,theta_s=20\n1,2,3\n"));
        let error = read(",10,20\n1,2\n").unwrap_err();
        assert_eq!(
            (error.line, error.what.contains("2 cells, the first row 3")),
            (Some(2), true)
        );
        let error = read(",10,20\n1,2,x\n").unwrap_err();
        assert_eq!((error.line, error.column), (Some(2), Some(3)));
        assert!(read(",10,20\n").is_err());
    }

    #[test]
    fn the_corner_is_obeyed() {
        let rows = |text: &str| {
            let scan = read(text).unwrap().remove(0);
            let rows = scan.rows.iter().map(|row| (row.theta_i, row.theta_s, row.value));
            (scan.quantity, scan.about.divisor, rows.collect::<Vec<_>>())
        };
        let turned = rows("theta_i\\theta_s,5,70\n10,1,2\n30,3,4\n").2;
        assert_eq!(
            turned,
            [(10.0, 5.0, 1.0), (10.0, 70.0, 2.0), (30.0, 5.0, 3.0), (30.0, 70.0, 4.0)]
        );
        let (quantity, divisor, first) = rows("BRF (%),10,60\n-80,50,25\n80,10,20\n");
        assert_eq!(
            (quantity, divisor, first[0]),
            (Quantity::Brf, 100.0, (10.0, -80.0, 50.0))
        );
        let radians = read("theta_s [rad],0.2,0.8\n-1.2,1,2\n1.2,3,4\n").unwrap().remove(0);
        assert_eq!((radians.angles, radians.about.angles_named), (Angles::Rad, true));
        let azimuths = read("# AOI: 45\nphi,-80,80\n0,1,2\n30,3,4\n").unwrap().remove(0);
        assert_eq!(
            (azimuths.rows[3].theta_s, azimuths.rows[3].delta_phi),
            (80.0, Some(30.0))
        );
        assert!(matches!(
            azimuths.about.theta_i,
            ThetaI::Missing { remark: Some(45.0), .. }
        ));
        for (text, line, column, what) in [
            ("# x\nrun,-80,80\n1,1,2\n2,1,2\n", 2, Some(1), "no angle"),
            (
                "theta_s (rad),10 deg,60 deg\n-1,1,2\n1,1,2\n",
                1,
                Some(2),
                "some in radians",
            ),
            (
                "# AOI: 45\ntheta_s,20,60\n-80,1,2\n80,1,2\n",
                1,
                None,
                "a remark says that theta_i is 45",
            ),
            (",-80,80\n550,1,2\n650,1,2\n", 2, Some(1), "'550' is not an angle"),
            ("theta_s,1,2,3\n-80,1,1,1\n80,1,1,1\n", 1, None, "wavelengths or count"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.what.contains(what) && error.help.is_some(), "{error}");
            assert_eq!((error.line, error.column), (Some(line), column), "{error}");
        }
        let sides = "# rows: theta_i, columns: theta_s\n,10,30\n20,1,2\n45,3,4\n";
        let error = read(sides).unwrap_err();
        assert!(
            error.line == Some(1) && error.what.contains("other way round"),
            "{error}"
        );
        let named = sides.replace(",10", r"theta_i\theta_s,10");
        assert_eq!(read(&named).unwrap()[0].rows[1].theta_s, 30.0);
        // A remark that says the same is none too many.
        assert!(read("# AOI: 45\ntheta_s,45\n-80,1\n80,1\n").is_ok());
    }

    #[test]
    fn a_direction_that_occurs_twice_is_refused() {
        for text in [
            "theta_s,20,20\n-80,1,2\n80,1,1\n",
            "theta_s,20,60\n0,1,2\n80,1,1\n0,2,2\n",
        ] {
            let error = read(text).unwrap_err();
            assert!(
                error
                    .what
                    .contains("a direction occurs twice at different values, 1 on line 2"),
                "{error}"
            );
            let repeats = ReadOptions {
                repeats: true,
                ..ReadOptions::default()
            };
            assert!(super::read(text, &repeats).is_ok());
        }
        assert!(read("theta_s,20,20\n-80,1,1\n80,1,1\n").is_ok());
    }
}
