//! A plain matrix: angles of incidence in the first row, scattering angles in the first column, values between them; in plane, degrees.

use crate::error::{Error, shown};
use crate::input::about::ThetaI;
use crate::input::facts;
use crate::input::format::{Format, Reader};
use crate::input::kind::Kind;
use crate::input::options::ReadOptions;
use crate::input::raw::{RawScan, Row, Weight};
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

/// The angle in a cell, degrees: `20`, `22,5`, `20°`, `20 deg`, `AOI = 20`.
fn angle(cell: &str) -> Option<f64> {
    rows::parse(cell, Decimal::Unknown)
        .filter(|angle| angle.is_finite())
        .or_else(|| facts::angle_in(cell))
}

/// The one scan in the matrix; cells that are empty or NaN were not measured.
///
/// Where one axis has azimuths, the options must give the one angle of incidence.
///
/// # Errors
/// A cell is no number, a row is of another length, or there are azimuths and no angle of incidence.
fn read(text: &str, options: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let mut head: Vec<f64> = Vec::new();
    let mut body: Vec<(u64, f64, Vec<f64>)> = Vec::new();
    let mut decimal = Decimal::Unknown;
    rows::for_each(text, |line, cells| {
        let angle = |column: usize| {
            angle(cells[column]).ok_or_else(|| {
                Error::new(format!("'{}' is not an angle", shown(cells[column])))
                    .at_line(line)
                    .at_column(column as u64 + 1)
                    .help("write it in degrees, like 20 or 20 deg")
            })
        };
        if head.is_empty() {
            head = (1..cells.len()).map(angle).collect::<Result<_, _>>()?;
            return Ok(());
        }
        if cells.len() != head.len() + 1 {
            let (have, first) = (cells.len(), head.len() + 1);
            return Err(Error::new(format!("the row has {have} cells, the first row {first}"))
                .at_line(line)
                .help("leave a cell empty where nothing was measured"));
        }
        let values = (1..cells.len()).map(|column| number_in(cells, column, &mut decimal));
        let values = values.collect::<Result<_, _>>().map_err(|error| error.at_line(line))?;
        body.push((line, angle(0)?, values));
        Ok(())
    })?;
    if body.is_empty() {
        return Err(Error::new("there are no rows below the angles").help("give one row a scattering angle"));
    }
    let axes = Axes::of(&head, &body, options)?;
    let mut scan = RawScan::new(Vec::new(), Angles::Deg);
    scan.about.kind = Kind::Matrix;
    scan.about.angles_named = false;
    if let Axes::Azimuths { .. } = axes {
        scan.about.theta_i = ThetaI::Missing {
            remark: None,
            names: [].into(),
        };
        scan.about
            .notes
            .push("one axis of the matrix has azimuths, 180 being forward".to_string());
    }
    for (line, side, values) in body {
        for (&top, value) in head.iter().zip(values) {
            let (theta_i, theta_s, delta_phi) = match axes {
                Axes::Incidence { above: true } => (top, side, None),
                Axes::Incidence { above: false } => (side, top, None),
                Axes::Azimuths { above: true } => (f64::NAN, side, Some(top)),
                Axes::Azimuths { above: false } => (f64::NAN, top, Some(side)),
            };
            scan.rows.push(Row {
                theta_i,
                theta_s,
                delta_phi,
                value,
                weight: Weight::Unknown,
                line,
            });
        }
    }
    scan.rows.retain(|row| !row.value.is_nan());
    Ok(vec![scan])
}

/// What the two axes of a matrix are.
enum Axes {
    /// Angles of incidence, in the first row or else in the first column, and scattering angles.
    Incidence { above: bool },
    /// Azimuths, in the first row or else in the first column, and scattering angles; the angle of incidence is one.
    Azimuths { above: bool },
}

impl Axes {
    /// Angles of incidence are in the first row, unless that has negative angles and the first column has none, for an angle of incidence is seldom negative.
    ///
    /// # Errors
    /// There are azimuths, and no angle of incidence is given.
    fn of(head: &[f64], body: &[(u64, f64, Vec<f64>)], options: &ReadOptions) -> Result<Axes, Error> {
        // A polar angle is within 90 degrees, or beyond 270 where a file counts from 0 to 360.
        let is_azimuth = |angle: &f64| (angle.abs() + 1e-9) % 360.0 > 90.1 && angle.abs() % 360.0 < 269.9;
        let above = head.iter().any(is_azimuth);
        let Some(first) = body.iter().find(|row| above || is_azimuth(&row.1)) else {
            let turned = head.iter().any(|&angle| angle < 0.0) && body.iter().all(|row| row.1 >= 0.0);
            return Ok(Axes::Incidence { above: !turned });
        };
        if !options.theta_i.is_empty() {
            return Ok(Axes::Azimuths { above });
        }
        let side = if above { "columns" } else { "rows" };
        Err(Error::new(format!("the {side} are at angles of more than 90 degrees, so they are azimuths and the matrix is of one angle of incidence"))
            .at_line(if above { first.0.saturating_sub(1).max(1) } else { first.0 })
            .help("give it in degrees with --theta-i 20; an azimuth of 180 is forward, or 0 with --forward negative"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            "t/p -180 0 180\n0 1 2 3\n10 4 5 6\n",
            "t/p 0 10\n0 1 2\n120 3 4\n240 5 6\n",
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
        assert_eq!(read("a 10 20\n280 1 2\n0 3 4\n80 5 6\n").unwrap()[0].rows.len(), 6);
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
}
