//! The text of FRED: two header lines, then for each direction of incidence a line with its specular direction, and rows `theta_s phi_s bsdf`.

use crate::error::{Error, shown};
use crate::input::format::{Format, Reader};
use crate::input::options::ReadOptions;
use crate::input::raw::{Places, RawScan, Row, Weight};
use crate::input::rows::{self, number};
use crate::input::units::{Angles, Quantity};

/// This format.
pub const FORMAT: Format = Format {
    name: "fred",
    title: "FRED text",
    about: "FRED text",
    reader: Reader::Text { is, read },
};

/// True if the first line is theirs.
fn is(text: &str) -> bool {
    let words = text.lines().next().unwrap_or("").split_whitespace();
    words.eq(["type", "bsdf_data"])
}

/// The one scan in the file.
///
/// # Errors
/// Angles are not in degrees, a row has other than two or three numbers, or no specular direction stands before it.
fn read(text: &str, _: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let mut scan = RawScan {
        places: Places {
            theta_i: Some(1),
            theta_s: Some(1),
            phi: Some(2),
            value: Some(3),
            weight: None,
        },
        ..RawScan::new(Vec::new(), Angles::Deg)
    };
    let mut scale = 1.0;
    let mut specular = None;
    rows::for_each(text, |line, cells| {
        let number = |column| number(cells, column).map_err(|error| error.at_line(line));
        match cells {
            ["type", "bsdf_data"] => {}
            ["format", settings @ ..] => {
                (scan.quantity, scale) = format(settings).map_err(|error| error.at_line(line))?;
            }
            [_, _] => specular = Some((number(0)?, number(1)?)),
            [_, _, _] => {
                let Some((theta_i, phi)) = specular else {
                    return Err(Error::new("no specular direction stands before this row")
                        .at_line(line)
                        .help("begin each block with a line of theta and phi of its specular direction"));
                };
                scan.rows.push(Row {
                    theta_i,
                    theta_s: number(0)?,
                    // From the specular direction, which is opposite to that of incidence.
                    delta_phi: Some(180.0 + number(1)? - phi),
                    value: number(2)? * scale,
                    weight: Weight::Unknown,
                    line,
                });
            }
            _ => {
                return Err(
                    Error::new(format!("the row has {} numbers, and not 2 or 3", cells.len()))
                        .at_line(line)
                        .help("give theta phi bsdf, or theta phi of a specular direction"),
                );
            }
        }
        Ok(())
    })?;
    Ok(vec![scan])
}

/// Quantity and scale of the values.
fn format(settings: &[&str]) -> Result<(Quantity, f64), Error> {
    let (mut quantity, mut scale) = (Quantity::Brdf, 1.0);
    for setting in settings {
        match setting.split_once('=') {
            Some(("angles", "deg")) => {}
            Some(("bsdf", "value")) => quantity = Quantity::Brdf,
            Some(("bsdf", "log")) => quantity = Quantity::Log10Brdf,
            Some(("scale", number)) if number.parse::<f64>().is_ok_and(|x| x > 0.0 && x.is_finite()) => {
                scale = number.parse().unwrap_or(1.0);
            }
            _ => {
                return Err(Error::new(format!("'{}' is not understood", shown(setting)))
                    .help("this reads angles=deg, bsdf=value or log, and a positive scale"));
            }
        }
    }
    if quantity == Quantity::Log10Brdf && scale != 1.0 {
        return Err(Error::new("a scale of logarithms is not understood").help("give scale=1 with bsdf=log"));
    }
    Ok((quantity, scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<RawScan>, Error> {
        super::read(text, &ReadOptions::default())
    }

    const TEXT: &str =
        "type bsdf_data\nformat angles=deg bsdf=value scale=2\n10\t0\n-80\t0\t0.25\n10 0 1\n30 5\n20 45 3\n";

    #[test]
    fn blocks_begin_with_the_specular_direction() {
        assert!(is(TEXT));
        let rows = &read(TEXT).unwrap()[0].rows;
        assert_eq!(
            (rows[0].theta_i, rows[0].theta_s, rows[0].delta_phi),
            (10.0, -80.0, Some(180.0))
        );
        assert_eq!((rows[0].value, rows[0].line), (0.5, 4));
        assert_eq!(
            (rows[2].theta_i, rows[2].delta_phi, rows[2].value),
            (30.0, Some(220.0), 6.0)
        );
        let log = TEXT.replace("bsdf=value scale=2", "bsdf=log scale=1");
        assert_eq!(read(&log).unwrap()[0].quantity, Quantity::Log10Brdf);
    }

    #[test]
    fn what_is_not_understood_is_refused() {
        for (from, to, line) in [
            ("angles=deg", "angles=sin", 2),
            ("bsdf=value", "bsdf=log", 2),
            ("scale=2", "scale=x", 2),
            ("10\t0\n", "", 3),
            ("10 0 1", "10 0 1 4", 5),
            ("10 0 1", "10 0 y", 5),
        ] {
            let error = read(&TEXT.replacen(from, to, 1)).unwrap_err();
            assert_eq!(error.line, Some(line), "{error}");
        }
    }
}
