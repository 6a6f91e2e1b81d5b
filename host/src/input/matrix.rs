//! A plain matrix: angles of incidence in the first row, scattering angles in the first column, values between them; in plane, degrees.

use super::about::{About, ThetaI};
use super::options::ReadOptions;
use super::raw::{Places, RawScan, Row, Weight};
use super::rows::{self, number};
use super::units::{Angles, Quantity};
use crate::error::Error;

/// True if the first row has numbers in all cells but the first, and the second row is as long.
pub fn is(text: &str) -> bool {
    let mut lengths = Vec::new();
    // Two rows are enough, and the error stops there.
    let _ = rows::for_each(text, |_, cells| {
        let is_number = |cell: &&str| cell.parse::<f64>().is_ok_and(f64::is_finite);
        let (corner, angles) = cells.split_first().unwrap_or((&"", &[]));
        // `Incident Angle: 20` stands above other tables.
        let is_remark = corner.ends_with([':', '=']);
        let is_head = !is_remark && !is_number(corner) && !angles.is_empty() && angles.iter().all(is_number);
        if is_head || !lengths.is_empty() {
            lengths.push(cells.len());
        }
        if is_head && lengths.len() == 1 {
            Ok(())
        } else {
            Err(Error::new("enough"))
        }
    });
    // With one row alone, what is missing is said by the reader.
    matches!(lengths[..], [head] if head > 2) || matches!(lengths[..], [head, row] if head == row || head > 3)
}

/// The one scan in the matrix; cells that are empty or NaN were not measured.
///
/// Where one axis has azimuths, the options must give the one angle of incidence.
///
/// # Errors
/// A cell is no number, a row is of another length, or there are azimuths and no angle of incidence.
pub fn read(text: &str, options: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let mut head: Vec<f64> = Vec::new();
    let mut body: Vec<(u64, f64, Vec<f64>)> = Vec::new();
    rows::for_each(text, |line, cells| {
        let number = |column| number(cells, column).map_err(|error| error.at_line(line));
        if head.is_empty() {
            head = (1..cells.len()).map(number).collect::<Result<_, _>>()?;
            return Ok(());
        }
        if cells.len() != head.len() + 1 {
            let (have, first) = (cells.len(), head.len() + 1);
            return Err(Error::new(format!("the row has {have} cells, the first row {first}"))
                .at_line(line)
                .help("leave a cell empty where nothing was measured"));
        }
        let value = |column: usize| {
            if cells[column].is_empty() {
                Ok(f64::NAN)
            } else {
                number(column)
            }
        };
        let values = (1..cells.len()).map(value).collect::<Result<_, _>>()?;
        body.push((line, number(0)?, values));
        Ok(())
    })?;
    if body.is_empty() {
        return Err(Error::new("there are no rows below the angles").help("give one row a scattering angle"));
    }
    let axes = Axes::of(&head, &body, options)?;
    let mut scan = RawScan {
        names: Vec::new(),
        angles: Angles::Deg,
        quantity: Quantity::Brdf,
        places: Places::default(),
        rows: Vec::new(),
        about: About::default(),
    };
    if let Axes::Azimuths { .. } = axes {
        scan.about.theta_i = ThetaI::Missing {
            remark: None,
            names: Vec::new(),
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

    #[test]
    fn the_first_row_has_the_angles_of_incidence() {
        let text = "# x\ntheta_s\\theta_i;10;60\n-80;0.5;0.25\n\n80;;1\n";
        assert!(is(text));
        let rows = read(text, &ReadOptions::default()).unwrap().remove(0).rows;
        let seen: Vec<_> = rows
            .iter()
            .map(|row| (row.theta_i, row.theta_s, row.value, row.line))
            .collect();
        assert_eq!(
            seen,
            [(10.0, -80.0, 0.5, 3), (60.0, -80.0, 0.25, 3), (60.0, 80.0, 1.0, 5)]
        );
        let turned = read(",-80,80\n10,0.5,nan\n60,0.25,1\n", &ReadOptions::default())
            .unwrap()
            .remove(0)
            .rows;
        let seen: Vec<_> = turned.iter().map(|row| (row.theta_i, row.theta_s, row.value)).collect();
        assert_eq!(seen, [(10.0, -80.0, 0.5), (60.0, -80.0, 0.25), (60.0, 80.0, 1.0)]);
    }

    #[test]
    fn a_header_of_names_or_no_header_is_no_matrix() {
        assert!(!is("theta_i,theta_s,brdf\n1,2,3\n") && !is("45,-85,0.03\n") && !is("") && !is("word\n"));
        assert!(is("NaN 10 60\n1 2 3\n"));
        let error = read(",10,20\n1,2\n", &ReadOptions::default()).unwrap_err();
        assert_eq!(
            (error.line, error.what.contains("2 cells, the first row 3")),
            (Some(2), true)
        );
        let error = read(",10,20\n1,2,x\n", &ReadOptions::default()).unwrap_err();
        assert_eq!((error.line, error.column), (Some(2), Some(3)));
        assert!(read(",10,20\n", &ReadOptions::default()).is_err());
    }
}
