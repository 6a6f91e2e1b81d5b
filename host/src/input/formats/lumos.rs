//! The text of LUMOS and ScatterWorks: rows `phi_i theta_i phi_o theta_o brdf` in degrees, where phi is the zenith angle and theta the azimuth.

use crate::error::Error;
use crate::input::format::{Format, Reader};
use crate::input::options::ReadOptions;
use crate::input::raw::{Places, RawScan, Row, Weight};
use crate::input::rows::{self, number};
use crate::input::units::Angles;

/// This format.
pub const FORMAT: Format = Format {
    name: "lumos",
    title: "LUMOS text",
    about: "LUMOS or ScatterWorks text",
    reader: Reader::Text { is, read },
};

/// True if a remark names the columns in that order.
fn is(text: &str) -> bool {
    let remarks = text.lines().take_while(|line| rows::is_remark(line));
    let mut names = remarks.map(|line| line.trim_start_matches(['#', ' ']).split_whitespace());
    names.any(|names| names.eq(["phi_i", "theta_i", "phi_o", "theta_o", "brdf"]))
}

/// The one scan in the file.
///
/// # Errors
/// A row has other than five numbers, or there is none.
fn read(text: &str, _: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let mut scan = RawScan {
        places: Places {
            theta_i: Some(1),
            theta_s: Some(3),
            phi: Some(4),
            value: Some(5),
            weight: None,
        },
        ..RawScan::new(Vec::new(), Angles::Deg)
    };
    rows::for_each(text, |line, cells| {
        let number = |column| number(cells, column).map_err(|error| error.at_line(line));
        if cells.len() != 5 {
            return Err(Error::new(format!("the row has {} numbers, and not 5", cells.len()))
                .at_line(line)
                .help("give phi_i theta_i phi_o theta_o brdf"));
        }
        scan.rows.push(Row {
            theta_i: number(0)?,
            theta_s: number(2)?,
            delta_phi: Some(number(3)? - number(1)?),
            value: number(4)?,
            weight: Weight::Unknown,
            line,
        });
        Ok(())
    })?;
    Ok(vec![scan])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<RawScan>, Error> {
        super::read(text, &ReadOptions::default())
    }

    #[test]
    fn phi_is_the_zenith_angle() {
        let text = "# about\n#\n# phi_i     theta_i     phi_o  theta_o   brdf\n75.0  -180.0  -80.0 0.0 1.5e-2\n75 -180 10 90 2\n";
        assert!(is(text));
        let rows = &read(text).unwrap()[0].rows;
        assert_eq!(
            (rows[0].theta_i, rows[0].theta_s, rows[0].delta_phi),
            (75.0, -80.0, Some(180.0))
        );
        assert_eq!((rows[1].delta_phi, rows[1].value, rows[1].line), (Some(270.0), 2.0, 5));
        let error = read("75 1 2\n").unwrap_err();
        assert_eq!((error.line, error.what.contains("3 numbers")), (Some(1), true));
        let error = read("75 -180 x 0 1\n").unwrap_err();
        assert_eq!((error.line, error.column), (Some(1), Some(3)));
        assert!(!is("phi_i theta_i phi_o theta_o brdf\n"));
    }
}
