//! BRDF look-up table of ASAM OpenMATERIAL 3D (`.xompt`), JSON: rows of wavelength in m, angle of incidence, scattering angle, azimuth from incidence in radians, and BRDF.

use std::collections::HashMap;

use serde::Deserialize;
use serde_json::value::RawValue;

use super::grid;
use crate::error::{Error, shown};
use crate::input::bytes::Lines;
use crate::input::format::{Format, Reader};
use crate::input::options::ReadOptions;
use crate::input::raw::{RawScan, Row, Weight};
use crate::input::units::Angles;

/// This format.
pub const FORMAT: Format = Format {
    name: "openmaterial",
    title: "OpenMATERIAL BRDF",
    about: "ASAM OpenMATERIAL 3D BRDF, .xompt",
    reader: Reader::Text { is, read },
};

/// True of a JSON object with a table of this name.
fn is(text: &str) -> bool {
    text.trim_start().starts_with('{') && text.contains("\"lookupTable\"") && text.contains("\"brdf\"")
}

#[derive(Deserialize)]
struct File<'a> {
    #[serde(borrow)]
    brdf: Brdf<'a>,
}

#[derive(Deserialize)]
struct Brdf<'a> {
    #[serde(borrow, rename = "lookupTable")]
    table: Vec<&'a RawValue>,
}

/// One scan for each wavelength.
///
/// # Errors
/// It is no JSON, there is no such table, or a row has other than five numbers.
fn read(text: &str, _: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let file: File = serde_json::from_str(text).map_err(|error| {
        let what = error.to_string();
        let what = what.split(" at line ").next().unwrap_or(&what).to_string();
        Error::new(format!("as OpenMATERIAL BRDF: {what}"))
            .at_line(error.line() as u64)
            .at_column(error.column() as u64)
            .help("brdf needs a lookupTable of rows [wavelength, theta_i, theta_s, azimuth, BRDF]")
    })?;
    let lines = Lines::new(text);
    let mut scans: Vec<RawScan> = Vec::new();
    let mut places: HashMap<u64, usize> = HashMap::new();
    for row in file.brdf.table {
        let (line, column) = lines.place(text, row.get());
        let numbers: [Option<f64>; 5] = serde_json::from_str(row.get()).map_err(|_| {
            Error::new(format!("'{}' is no row of the look-up table", shown(row.get())))
                .at_line(line)
                .at_column(column)
                .help("give five numbers: wavelength in m, theta_i, theta_s and azimuth in radians, BRDF")
        })?;
        let [wavelength, theta_i, theta_s, azimuth, value] = numbers.map(|number| number.unwrap_or(f64::NAN));
        let place = *places.entry(wavelength.to_bits()).or_insert_with(|| {
            scans.push(RawScan::new(name(wavelength), Angles::Rad));
            scans.len() - 1
        });
        let row = Row {
            theta_i,
            theta_s,
            delta_phi: Some(azimuth),
            value,
            weight: Weight::Unknown,
            line,
        };
        grid::add(&mut scans[place], row);
    }
    if scans.is_empty() {
        return Err(Error::new("the lookupTable is empty").help("give one row a sample"));
    }
    Ok(scans)
}

/// A wavelength in m as people name it: 12 digits, so that 9.05e-7 m are 905 nm.
fn name(wavelength: f64) -> Vec<String> {
    let nanometres = format!("{:.11e}", wavelength * 1e9).parse::<f64>();
    let known = nanometres.ok().filter(|length| length.is_finite());
    known.map(|length| format!("{length} nm")).into_iter().collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::input::left_out::Reason;

    fn read(text: &str) -> Result<Vec<RawScan>, Error> {
        super::read(text, &ReadOptions::default())
    }

    const TEXT: &str = r#"{"metadata": {"name": "x"}, "brdf": {"wavelengths": [9.05e-07, 1.55e-6], "lookupTable": [
[9.05e-07, 0.5, 0.25, 0.0, 1],
[9.05e-07, 0.5, 0.25, 3.14159, 2], [1.55e-6, 0.5, 0.25, 1.5, null],
[9.05e-07, 0.5, 0, 0, 0.0], [9.05e-07, 0.5, 1.570796, 0, 3]]}}"#;

    #[test]
    fn wavelengths_are_scans_and_half_a_turn_is_forward() {
        assert!(is(TEXT));
        let scans = read(TEXT).unwrap();
        assert_eq!(
            (scans[0].names.join(" "), scans[1].names.join(" ")),
            ("905 nm".into(), "1550 nm".into())
        );
        let half_a_turn: f64 = "3.14159".parse().unwrap();
        let seen: Vec<_> = scans[0]
            .rows
            .iter()
            .map(|row| (row.theta_s, row.delta_phi, row.value, row.line))
            .collect();
        assert_eq!(seen, [(0.25, Some(0.0), 1.0, 2), (0.25, Some(half_a_turn), 2.0, 3)]);
        assert_eq!(scans[0].angles.azimuth(half_a_turn), PI);
        assert!(scans[1].rows[0].value.is_nan());
        let reasons: Vec<Reason> = scans[0].left_out.clone().list().iter().map(|one| one.reason).collect();
        assert_eq!(reasons, [Reason::NotMeasured, Reason::Horizon]);
    }

    #[test]
    fn errors_name_the_place() {
        for (from, to, line, what) in [
            ("0.25, 0.0, 1]", "0.25, 0.0]", Some(2), "no row of the look-up table"),
            ("3.14159", "\"x\"", Some(3), "no row of the look-up table"),
            ("}}", "}", Some(4), "EOF"),
            ("lookupTable", "lookup", None, "missing field `lookupTable`"),
        ] {
            let error = read(&TEXT.replacen(from, to, 1)).unwrap_err();
            assert!(
                error.what.contains(what) && line.is_none_or(|line| error.line == Some(line)),
                "{error}"
            );
        }
        assert!(!is("{\"data\": {}}"));
    }
}
