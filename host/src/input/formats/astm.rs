//! ASTM E1392 and E2387 text: `KEY value` lines up to `VARS`, then rows of comma-separated numbers, angles in radians.

mod angles;
mod values;

use crate::error::{Error, shown};
use crate::input::columns::WeightKind;
use crate::input::format::{Format, Reader};
use crate::input::head::{Head, plain};
use crate::input::options::ReadOptions;
use crate::input::raw::{Places, RawScan, Row, Weight};
use crate::input::rows::number;
use angles::{PHI_I, PHI_S, THETA_I, THETA_S, name_forgotten};

/// This format.
pub const FORMAT: Format = Format {
    name: "astm",
    title: "ASTM E1392",
    about: "ASTM E1392 or E2387 text",
    reader: Reader::Text { is, read },
};

/// True if the text begins as these files do.
fn is(text: &str) -> bool {
    vars(text).is_some()
}

/// The line of `VARS` and the names in it.
fn vars(text: &str) -> Option<(usize, &str)> {
    let lines = text.lines().enumerate();
    lines
        .take_while(|(_, line)| line.is_empty() || line.starts_with(|c: char| c.is_ascii_uppercase()))
        .find_map(|(place, line)| Some((place, line.strip_prefix("VARS")?.trim())))
}

/// One scan for each column of values; `MEAS_NAME` and their names say what they are.
///
/// # Errors
/// A variable or a number is missing, one is not understood, or there are other than `NUM_POINTS` rows.
fn read(text: &str, options: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let Some((header, vars)) = vars(text) else {
        return Err(Error::new("there is no line VARS").help("name the columns in it, such as VARS theta_i,theta_s,R"));
    };
    let mut names: Vec<&str> = vars.split(',').map(str::trim).collect();
    let rows = || {
        (1..)
            .zip(text.lines())
            .skip(header + 1)
            .filter(|(_, row)| !row.trim().is_empty())
    };
    if let Some((_, row)) = rows().next() {
        name_forgotten(&mut names, row.split(',').count());
    }
    let place = |wanted: &[&str]| names.iter().position(|name| wanted.contains(&plain(name).as_str()));
    let missing = |name: &str| {
        Error::new(format!("VARS has no {name}"))
            .at_line(header as u64 + 1)
            .help("it must name theta_i, theta_s and a value")
    };
    let theta_i = place(&THETA_I).ok_or_else(|| missing("theta_i"))?;
    let theta_s = place(&THETA_S).ok_or_else(|| missing("theta_s"))?;
    let (phi_i, phi_s) = (place(&PHI_I), place(&PHI_S));
    let angles: Vec<usize> = [Some(theta_i), Some(theta_s), phi_i, phi_s]
        .into_iter()
        .flatten()
        .collect();
    let heads: Vec<Head> = names.iter().map(|name| Head::new(name)).collect();
    let values =
        values::of(&heads, &angles, values::said(text)?, options).map_err(|error| error.at_line(header as u64 + 1))?;
    if values.is_empty() {
        return Err(missing("column of values"));
    }
    let unit = angles::unit(&heads, &angles).map_err(|error| error.at_line(header as u64 + 1))?;
    let mut scans: Vec<RawScan> = values
        .iter()
        .map(|value| {
            let column = |place: usize| place as u64 + 1;
            let mut scan = RawScan::new(vec![names[value.column].to_string()], unit);
            scan.quantity = value.quantity;
            scan.about.divisor = value.divisor;
            scan.places = Places {
                theta_i: Some(column(theta_i)),
                theta_s: Some(column(theta_s)),
                phi: phi_s.map(column),
                value: Some(column(value.column)),
                weight: value.weight.map(|(place, _)| column(place)),
            };
            scan
        })
        .collect();
    for (line, row) in rows() {
        let cells: Vec<&str> = row.split(',').map(str::trim).collect();
        let read = || {
            if cells.len() != names.len() {
                return Err(Error::new(format!(
                    "the row has {} numbers, VARS names {}",
                    cells.len(),
                    names.len()
                ))
                .help("give every row the numbers that VARS names"));
            }
            let angle = |place: Option<usize>| place.map_or(Ok(0.0), |place| number(&cells, place));
            let delta_phi = match phi_s {
                Some(_) => Some(angle(phi_s)? - angle(phi_i)?),
                None => None,
            };
            for (scan, value) in scans.iter_mut().zip(&values) {
                scan.rows.push(Row {
                    theta_i: number(&cells, theta_i)?,
                    theta_s: number(&cells, theta_s)?,
                    delta_phi,
                    value: number(&cells, value.column)?,
                    weight: match value.weight {
                        Some((place, kind)) => weight(kind, number(&cells, place)?),
                        None => Weight::Unknown,
                    },
                    line,
                });
            }
            Ok(())
        };
        let mut read = read;
        read().map_err(|error: Error| error.at_line(line))?;
    }
    check_count(text, header, scans[0].rows.len())?;
    Ok(scans)
}

/// What a number of this kind says of the uncertainty.
fn weight(kind: WeightKind, x: f64) -> Weight {
    match kind {
        WeightKind::Sigma(coverage) => Weight::Sigma(x / coverage),
        WeightKind::RelativeSigma(coverage) => Weight::RelativeSigma(x / coverage),
        WeightKind::PercentSigma(coverage) => Weight::RelativeSigma(x / coverage / 100.0),
        WeightKind::Factor => Weight::Factor(x),
    }
}

/// Are there as many rows as the header promises?
fn check_count(text: &str, header: usize, rows: usize) -> Result<(), Error> {
    for (line, row) in (1..).zip(text.lines()).take(header) {
        let Some(count) = row.strip_prefix("NUM_POINTS").map(str::trim) else {
            continue;
        };
        match count.parse::<usize>() {
            Ok(count) if count == rows => {}
            Ok(count) => {
                return Err(
                    Error::new(format!("NUM_POINTS promises {count} rows, and there are {rows}"))
                        .at_line(line)
                        .help("is the file cut off? If not, correct the number"),
                );
            }
            Err(_) => {
                return Err(Error::new(format!("NUM_POINTS '{}' is no count", shown(count)))
                    .at_line(line)
                    .help("give the number of rows"));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::units::{Angles, Quantity};

    fn read(text: &str) -> Result<Vec<RawScan>, Error> {
        super::read(text, &ReadOptions::default())
    }

    const TEXT: &str = "LAB_NAME nowhere\r\n\r\nNUM_POINTS 2\r\nVARS theta_i,phi_i,theta_s,phi_s,R,G\r\n\r\n\
        0.5,0.25,0.4,3.391593,0.1,0.2\r\n0.5,0.25,0.3,0.75,0.3,-0.4\r\n";

    #[test]
    fn columns_are_scans_and_azimuths_differences() {
        assert!(is(TEXT));
        let scans = read(TEXT).unwrap();
        assert_eq!((scans[0].names[0].as_str(), scans[1].names[0].as_str()), ("R", "G"));
        let second = scans[1].rows[1];
        assert_eq!(
            (second.theta_i, second.theta_s, second.delta_phi),
            (0.5, 0.3, Some(0.5))
        );
        assert_eq!((second.value, second.line), (-0.4, 7));
        assert_eq!(
            scans[0].angles.azimuth(scans[0].rows[0].delta_phi.unwrap()),
            std::f64::consts::PI
        );
    }

    #[test]
    fn a_file_that_is_cut_off_is_refused() {
        let cut = TEXT.replace("NUM_POINTS 2", "NUM_POINTS 3");
        let error = read(&cut).unwrap_err();
        assert_eq!(
            (error.line, error.what.contains("promises 3 rows, and there are 2")),
            (Some(3), true)
        );
        let error = read(&TEXT.replace(",-0.4", "")).unwrap_err();
        assert_eq!(
            (error.line, error.what.contains("5 numbers, VARS names 6")),
            (Some(7), true)
        );
        let error = read(&TEXT.replace("-0.4", "oops")).unwrap_err();
        assert_eq!((error.line, error.column), (Some(7), Some(6)));
        assert!(
            read(&TEXT.replace("theta_s", "x"))
                .unwrap_err()
                .what
                .contains("no theta_s")
        );
        assert!(!is("theta_i,theta_s,brdf\n1,2,3\n"));
    }

    #[test]
    fn azimuths_that_vars_forgets_stand_behind_their_polar_angles() {
        let rows = read(TEXT).unwrap()[0].rows.clone();
        for vars in ["theta_i,phi_i,theta_s", "theta_i,theta_s,phi_s", "theta_i,theta_s"] {
            let text = TEXT.replace("theta_i,phi_i,theta_s,phi_s", vars);
            assert_eq!(read(&text).unwrap()[0].rows, rows, "{vars}");
        }
        // In plane nothing is forgotten; one number more could be either azimuth.
        let in_plane = "VARS theta_i,theta_s,R\n0.5,-0.4,0.1\n";
        assert_eq!(read(in_plane).unwrap()[0].rows[0].delta_phi, None);
        assert!(read(&in_plane.replace("0.1", "0.1,2")).is_err());
    }

    #[test]
    fn angles_are_in_degrees_if_vars_says_so() {
        let read = |vars: &str| read(&TEXT.replace("theta_i,phi_i,theta_s,phi_s", vars)).map(|scans| scans[0].angles);
        let degrees = "theta_i (deg),phi_i (deg),theta_s (deg),phi_s (deg)";
        assert_eq!(read(degrees).unwrap(), Angles::Deg);
        assert_eq!(read("theta_i,phi_i,theta_s,phi_s").unwrap(), Angles::Rad);
        let error = read(&degrees.replace("phi_s (deg)", "phi_s (rad)")).unwrap_err();
        assert_eq!((error.line, error.column), (Some(4), Some(1)), "{error}");
    }

    #[test]
    fn names_say_what_the_values_are() {
        let first = |vars: &str, name: &str| {
            let text = TEXT.replace("LAB_NAME nowhere", name).replace("R,G", vars);
            read(&text).map(|scans| {
                let scan = &scans[0];
                (scan.quantity, scan.about.divisor, scan.rows[0].weight, scans.len())
            })
        };
        let plain = |quantity, divisor| (quantity, divisor, Weight::Unknown, 2);
        assert_eq!(first("R,G", "MEAS_NAME BRDF").unwrap(), plain(Quantity::Brdf, 1.0));
        assert_eq!(first("525nm,650nm", "MEAS_NAME x").unwrap(), plain(Quantity::Brdf, 1.0));
        assert_eq!(first("R,G", "MEAS_NAME CCBRDF").unwrap(), plain(Quantity::BrdfCos, 1.0));
        assert_eq!(
            first("R (%),G (%)", "MEAS_NAME BRDF").unwrap(),
            plain(Quantity::Brdf, 100.0)
        );
        assert_eq!(
            first("R,G", "MEAS_NAME BRDF (%)").unwrap(),
            plain(Quantity::Brdf, 100.0)
        );
        assert_eq!(first("R,G", "MEAS_NAME BRF [%]").unwrap(), plain(Quantity::Brf, 100.0));
        let weighted = first("R,sigma", "MEAS_NAME BRDF").unwrap();
        assert_eq!((weighted.2, weighted.3), (Weight::Sigma(0.2), 1));
        assert_eq!(first("BRF,u (%)", "NOTE x").unwrap().2, Weight::RelativeSigma(0.002));
        for (vars, name, line, column, what) in [
            ("R,G", "MEAS_NAME BRDF (mV)", 4, Some(5), "not in sr^-1"),
            ("R,BTDF", "MEAS_NAME BRDF", 4, Some(6), "transmission"),
            ("R,G", "MEAS_NAME BTDF", 1, None, "transmission"),
            (
                "BRDF,G",
                "MEAS_NAME CCBRDF",
                4,
                Some(5),
                "MEAS_NAME says that the values are",
            ),
            ("lambda,R", "MEAS_NAME BRDF", 4, Some(5), "no value"),
            ("R (%),G", "NOTE x", 4, Some(5), "in percent"),
            ("R,signal (mV)", "NOTE x", 4, Some(6), "not in sr^-1"),
            (
                "R,log(BRDF)",
                "NOTE x",
                4,
                Some(6),
                "natural logarithm or that to base 10",
            ),
        ] {
            let error = first(vars, name).unwrap_err();
            assert!(error.what.contains(what) && error.help.is_some(), "{error}");
            assert_eq!((error.line, error.column), (Some(line), column), "{error}");
        }
    }
}
