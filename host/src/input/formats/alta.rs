//! Text of ALTA: a header of `#KEY value`, then rows of the directions and the values, radians.
//!
//! Source: "Data File Formats" in the documentation of ALTA, and its `core/params.h` for what the names of directions mean.
//! Azimuths of light and view are those of the directions as seen from the sample: forward is half a turn from incidence.

use crate::error::{Error, shown};
use crate::input::format::{Format, Reader};
use crate::input::formats::grid;
use crate::input::options::ReadOptions;
use crate::input::raw::{Places, RawScan, Row, Weight};
use crate::input::rows::number;
use crate::input::units::{Angles, Quantity};

/// This format.
pub const FORMAT: Format = Format {
    name: "alta",
    title: "ALTA text",
    about: "ALTA text",
    reader: Reader::Text { is, read },
};

/// Columns of a row at most: no parametrization of a BRDF has more than 6, no values more than those of a spectrum.
const MOST: usize = 4096;

/// True if the first setting is the number of columns, as the header begins.
fn is(text: &str) -> bool {
    text.lines()
        .find_map(setting)
        .is_some_and(|(key, value)| key == "DIM" && value.split_whitespace().count() == 2)
}

/// The key and the value of `#KEY value`; a mark with a space behind is a remark.
fn setting(line: &str) -> Option<(&str, &str)> {
    let line = line.strip_prefix('#')?;
    let (key, value) = line.split_once([' ', '\t']).unwrap_or((line, ""));
    key.starts_with(|c: char| c.is_ascii_alphabetic())
        .then(|| (key, value.trim()))
}

/// How the two directions are given.
type Directions = fn(&[f64]) -> (f64, f64, f64);

/// What the header says.
#[derive(Default)]
struct Header {
    inputs: usize,
    outputs: usize,
    directions: Option<Directions>,
    values: Option<(Quantity, &'static [&'static str])>,
    /// Numbers behind the values, which tell what they may lie between.
    segments: usize,
}

/// One scan a value.
///
/// # Errors
/// The header lacks what rows are understood by, the directions or values are of another kind, a row has other numbers, or there is none.
fn read(text: &str, _: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let mut header = Header::default();
    let mut scans: Vec<RawScan> = Vec::new();
    for (line, row) in (1..).zip(text.lines()) {
        let at = |error: Error| error.at_line(line);
        if row.starts_with('#') {
            if let Some((key, value)) = setting(row).filter(|_| scans.is_empty()) {
                set(&mut header, key, value).map_err(at)?;
            }
            continue;
        }
        let cells: Vec<&str> = row.split_whitespace().collect();
        if cells.is_empty() {
            continue;
        }
        let directions = header
            .directions
            .ok_or_else(|| at(Error::new("no #PARAM_IN says what the directions are").help("it follows #DIM")))?;
        if scans.is_empty() {
            scans = of_values(&header);
        }
        let want = header.inputs + header.outputs + header.segments;
        if cells.len() != want {
            return Err(
                Error::new(format!("the row has {} numbers, and not {want}", cells.len()))
                    .at_line(line)
                    .help("#DIM and #VS promise the directions, the values, and their segments"),
            );
        }
        let numbers: Result<Vec<f64>, Error> = (0..header.inputs).map(|column| number(&cells, column)).collect();
        let (theta_i, theta_s, delta_phi) = directions(&numbers.map_err(at)?);
        for (column, scan) in scans.iter_mut().enumerate() {
            let row = Row {
                theta_i,
                theta_s,
                delta_phi: Some(delta_phi),
                value: number(&cells, header.inputs + column).map_err(at)?,
                weight: Weight::Unknown,
                line,
            };
            grid::add(scan, row);
        }
    }
    if scans.is_empty() {
        return Err(Error::new("there are no rows below the header").help("give one row a pair of directions"));
    }
    Ok(scans)
}

/// A scan for each value of a row.
fn of_values(header: &Header) -> Vec<RawScan> {
    let several = header.outputs > 1;
    let (quantity, names) = header.values.unwrap_or((Quantity::Brdf, &[]));
    let one = |place: usize| {
        let name = names.get(place).map(|name| name.to_string());
        let name = name.unwrap_or_else(|| format!("value {}", place + 1));
        RawScan {
            quantity,
            places: Places {
                value: Some((header.inputs + place + 1) as u64),
                ..Places::default()
            },
            ..RawScan::new(several.then_some(name).into_iter().collect(), Angles::Rad)
        }
    };
    (0..header.outputs).map(one).collect()
}

/// Notes a setting.
fn set(header: &mut Header, key: &str, value: &str) -> Result<(), Error> {
    match key {
        "DIM" => {
            let mut counts = value.split_whitespace().map(str::parse::<usize>);
            match (counts.next(), counts.next()) {
                (Some(Ok(inputs)), Some(Ok(outputs))) if inputs > 0 && outputs > 0 && inputs + outputs <= MOST => {
                    // What was said of other columns does not hold for these.
                    *header = Header {
                        inputs,
                        outputs,
                        ..Header::default()
                    };
                }
                _ => {
                    return Err(Error::new(format!("#DIM is '{}'", shown(value)))
                        .help("it needs how many numbers of directions and how many values a row has"));
                }
            }
        }
        "PARAM_IN" => {
            let (numbers, directions) = directions(value)?;
            if numbers != header.inputs {
                return Err(
                    Error::new(format!("#DIM has {} numbers for {}", header.inputs, shown(value)))
                        .help(format!("these directions have {numbers}")),
                );
            }
            header.directions = Some(directions);
        }
        "PARAM_OUT" => header.values = Some(values(value)?),
        "VS" => {
            let segments = value.split_whitespace().map(str::parse::<usize>);
            let segments = segments
                .map(|size| size.ok().filter(|&size| size <= 2))
                .sum::<Option<usize>>();
            header.segments = segments.ok_or_else(|| {
                Error::new(format!("#VS is '{}'", shown(value))).help("it needs 0, 1 or 2 for each value")
            })?;
        }
        "FORMAT" if value != "text" => {
            return Err(Error::new(format!(
                "this is data of ALTA as '{}', which are not read",
                shown(value)
            ))
            .help("convert it to ALTA's text"));
        }
        _ => {}
    }
    Ok(())
}

/// How many numbers a kind of directions has, and what makes theta_i, theta_s and delta_phi of them.
fn directions(name: &str) -> Result<(usize, Directions), Error> {
    Ok(match name {
        "SPHERICAL_TL_PL_TV_PV" => (4, |x| (x[0], x[2], x[3] - x[1])),
        "ISOTROPIC_TV_TL_DPHI" => (3, |x| (x[1], x[0], x[2])),
        "ISOTROPIC_TL_TV_PROJ_DPHI" => (3, |x| (x[0], libm::hypot(x[1], x[2]), libm::atan2(x[2], x[1]))),
        // The view first.
        "CARTESIAN" => (6, |x| {
            let theta = |v: &[f64]| libm::atan2(libm::hypot(v[0], v[1]), v[2]);
            let phi = |v: &[f64]| libm::atan2(v[1], v[0]);
            (theta(&x[3..]), theta(x), phi(x) - phi(&x[3..]))
        }),
        _ => {
            return Err(
                Error::new(format!("the directions are '{}', which are not read", shown(name))).help(
                    "this reads SPHERICAL_TL_PL_TV_PV, ISOTROPIC_TV_TL_DPHI, ISOTROPIC_TL_TV_PROJ_DPHI and CARTESIAN",
                ),
            );
        }
    })
}

/// What a kind of values is, and their names.
fn values(name: &str) -> Result<(Quantity, &'static [&'static str]), Error> {
    match name {
        "INV_STERADIAN" => Ok((Quantity::Brdf, &[])),
        "INV_STERADIAN_COSINE_FACTOR" => Ok((Quantity::BrdfCos, &[])),
        "RGB_COLOR" => Ok((Quantity::Brdf, &["R", "G", "B"])),
        "XYZ_COLOR" => Ok((Quantity::Brdf, &["X", "Y", "Z"])),
        _ => Err(
            Error::new(format!("the values are '{}', which are not read", shown(name)))
                .help("this reads INV_STERADIAN, INV_STERADIAN_COSINE_FACTOR, RGB_COLOR and XYZ_COLOR"),
        ),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    use super::*;

    fn read(text: &str) -> Result<Vec<RawScan>, Error> {
        super::read(text, &ReadOptions::default())
    }

    /// theta_i, theta_s, delta_phi and value of the rows of the first scan.
    fn rows(text: &str) -> Vec<[f64; 4]> {
        let scans = read(text).unwrap();
        let rows = scans[0].rows.iter();
        rows.map(|row| [row.theta_i, row.theta_s, row.delta_phi.unwrap(), row.value])
            .collect()
    }

    fn near(a: [f64; 4], b: [f64; 4]) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15)
    }

    #[test]
    fn each_kind_of_directions_is_understood() {
        // Light at 45 degrees, view at 30 degrees on the other side: forward.
        let (light, view) = (FRAC_PI_4, PI / 6.0);
        let (s, c) = (libm::sin, libm::cos);
        for (numbers, name, row) in [
            (4, "SPHERICAL_TL_PL_TV_PV", format!("{light} 0.5 {view} {}", PI + 0.5)),
            (3, "ISOTROPIC_TV_TL_DPHI", format!("{view}\t{light}\t{PI}")),
            (3, "ISOTROPIC_TL_TV_PROJ_DPHI", format!("{light} {} 0", -view)),
            (
                6,
                "CARTESIAN",
                format!("{} 0 {} {} 0 {}", -s(view), c(view), s(light), c(light)),
            ),
        ] {
            let text =
                format!("# a remark\n#DIM {numbers} 1\n#PARAM_IN {name}\n#PARAM_OUT INV_STERADIAN\n\n{row} 0.25\n");
            assert!(is(&text), "{name}");
            assert!(
                near(rows(&text)[0], [light, view, PI, 0.25]),
                "{name}: {:?}",
                rows(&text)
            );
        }
        // A quarter of a turn to the side.
        let side = "#DIM 3 1\n#PARAM_IN ISOTROPIC_TL_TV_PROJ_DPHI\n0.5 0 0.25 2\n";
        assert!(near(rows(side)[0], [0.5, 0.25, FRAC_PI_2, 2.0]));
    }

    #[test]
    fn values_are_scans_without_their_segments() {
        let text = "#DIM 3 3\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n#PARAM_OUT RGB_COLOR\n#VS 1 1 1\n#ALTA END HEADER\n0.1 0.2 0 1 2 3 .1 .1 .1\n0.1 0.2 1 0 2 3 .1 .1 .1\n";
        let scans = read(text).unwrap();
        let names: Vec<&str> = scans.iter().map(|scan| scan.names[0].as_str()).collect();
        assert_eq!(names, ["R", "G", "B"]);
        assert_eq!((scans[0].rows.len(), scans[1].rows.len()), (1, 2));
        assert_eq!(scans[2].rows[1].value, 3.0);
        let cos = "#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n#PARAM_OUT INV_STERADIAN_COSINE_FACTOR\n0.1 0.2 0 1\n";
        assert_eq!(read(cos).unwrap()[0].quantity, Quantity::BrdfCos);
    }

    #[test]
    fn what_is_not_read_is_named() {
        for (text, what) in [
            (
                "#DIM 2 1\n#PARAM_IN RUSIN_TH_TD\n1 2 3\n",
                "the directions are 'RUSIN_TH_TD'",
            ),
            (
                "#DIM 2 1\n#PARAM_IN CARTESIAN\n1 2 3\n",
                "#DIM has 2 numbers for CARTESIAN",
            ),
            ("#DIM 3 1\n#PARAM_OUT ENERGY\n1 2 3 4\n", "the values are 'ENERGY'"),
            ("#DIM 3 1\n1 2 3 4\n", "no #PARAM_IN"),
            ("#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n", "no rows"),
            (
                "#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n1 2 3\n",
                "3 numbers, and not 4",
            ),
            ("#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n0 0 0 x\n", "'x'"),
            (
                "#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n#DIM 1 1\n1 2\n",
                "no #PARAM_IN",
            ),
            ("#DIM 3 1\n#FORMAT binary\n", "as 'binary'"),
            ("#DIM 3 99999999999\n", "#DIM is"),
            ("#DIM 3 1\n#VS 3\n", "#VS is"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.what.contains(what) && error.help.is_some(), "{text}: {error}");
        }
        assert!(!is("#DIMENSION 3 1\n") && !is("# DIM 3 1\n1 2 3\n") && !is("theta_i\n"));
    }
}
