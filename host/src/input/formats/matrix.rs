//! A plain matrix: angles of incidence in the first row, scattering angles in the first column, values between them; in plane, degrees.

use crate::error::Error;
use crate::input::format::{Format, Reader};
use crate::input::options::ReadOptions;
use crate::input::raw::{RawScan, Row, Weight};
use crate::input::rows::{self, number};
use crate::input::units::Angles;

/// This format.
pub const FORMAT: Format = Format {
    name: "matrix",
    title: "matrix",
    about: "Angles of incidence in the first row, scattering angles in the first column",
    reader: Reader::Text { is, read },
};

/// True if the first row has numbers in all cells but the first.
fn is(text: &str) -> bool {
    let mut found = None;
    // The first row is enough, and the error stops there.
    let _ = rows::for_each(text, |_, cells| {
        let is_number = |cell: &&str| cell.parse::<f64>().is_ok_and(f64::is_finite);
        let (corner, angles) = cells.split_first().unwrap_or((&"", &[]));
        found.get_or_insert(!is_number(corner) && !angles.is_empty() && angles.iter().all(is_number));
        Err(Error::new("enough"))
    });
    found == Some(true)
}

/// The one scan in the matrix; cells that are empty or NaN were not measured.
///
/// If the first row has negative angles and the first column has none, they change places, for an angle of incidence is never negative.
///
/// # Errors
/// A cell is no number, or a row is of another length.
fn read(text: &str, _: &ReadOptions) -> Result<Vec<RawScan>, Error> {
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
    let turned = head.iter().any(|&angle| angle < 0.0) && body.iter().all(|row| row.1 >= 0.0);
    let mut scan = RawScan::new(Vec::new(), Angles::Deg);
    for (line, side, values) in body {
        for (&top, value) in head.iter().zip(values) {
            let (theta_i, theta_s) = if turned { (side, top) } else { (top, side) };
            scan.rows.push(Row {
                theta_i,
                theta_s,
                delta_phi: None,
                value,
                weight: Weight::Unknown,
                line,
            });
        }
    }
    scan.rows.retain(|row| !row.value.is_nan());
    Ok(vec![scan])
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
        let turned = read(",-80,80\n10,0.5,nan\n60,0.25,1\n").unwrap().remove(0).rows;
        let seen: Vec<_> = turned.iter().map(|row| (row.theta_i, row.theta_s, row.value)).collect();
        assert_eq!(seen, [(10.0, -80.0, 0.5), (60.0, -80.0, 0.25), (60.0, 80.0, 1.0)]);
    }

    #[test]
    fn a_header_of_names_or_no_header_is_no_matrix() {
        assert!(!is("theta_i,theta_s,brdf\n1,2,3\n") && !is("45,-85,0.03\n") && !is("") && !is("word\n"));
        assert!(is("NaN 10 60\n1 2 3\n"));
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
