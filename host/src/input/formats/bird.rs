//! EURAMET BiRD universal BRDF JSON: named arrays with units, one value each for each sample, and uncertainties.

mod file;
mod refuse;
mod uncertainty;

use std::collections::HashMap;

use serde_json::value::RawValue;

use crate::error::{Error, shown};
use crate::input::bytes::Lines;
use crate::input::format::{Format, Reader};
use crate::input::options::ReadOptions;
use crate::input::raw::{RawScan, Row};
use crate::input::unit::Unit;
use crate::input::units::Angles;
use file::{Data, File, Variable, in_degrees, number};
use uncertainty::uncertainty;

/// This format.
pub const FORMAT: Format = Format {
    name: "bird",
    title: "BiRD JSON",
    about: "EURAMET BiRD universal BRDF JSON",
    reader: Reader::Text { is, read },
};

/// True of a JSON object with data of this name.
fn is(text: &str) -> bool {
    text.trim_start().starts_with('{') && text.contains("\"data\"") && text.contains("\"BRDF\"")
}

/// One scan for each wavelength and polarisation; uncertainties of the BRDF are standard deviations.
///
/// # Errors
/// It is no JSON, a required array is missing, arrays differ in length, or a unit or a number is not understood.
fn read(text: &str, _: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let file: File = serde_json::from_str(text).map_err(|error| {
        let what = error.to_string();
        let what = what.split(" at line ").next().unwrap_or(&what).to_string();
        Error::new(format!("as BiRD JSON: {what}"))
            .at_line(error.line() as u64)
            .at_column(error.column() as u64)
            .help("data needs theta_i, phi_i, theta_r, phi_r and BRDF, each with unit and values")
    })?;
    let data = &file.data;
    let lines = Lines::new(text);
    refuse::transmission(file.metadata, text, &lines)?;
    let variables = [
        ("theta_i", Some(&data.theta_i)),
        ("phi_i", Some(&data.phi_i)),
        ("theta_r", Some(&data.theta_r)),
        ("phi_r", Some(&data.phi_r)),
        ("uBRDF", data.u_brdf.as_ref()),
        ("wavelength_i", data.wavelength_i.as_ref()),
        ("wavelength_r", data.wavelength_r.as_ref()),
        ("polarization_i", data.polarization_i.as_ref()),
        ("polarization_r", data.polarization_r.as_ref()),
    ];
    let count = data.brdf.values.len();
    for (name, variable) in variables {
        if let Some(variable) = variable.filter(|variable| variable.values.len() != count) {
            let have = variable.values.len();
            return Err(Error::new(format!("{name} has {have} values, BRDF {count}"))
                .help("give each array one value for each sample"));
        }
    }
    // A file without the unit has that of a BRDF.
    if !data.brdf.unit.is_empty() && Unit::parse(&data.brdf.unit) != Some(Unit::PerSr) {
        return Err(Error::new(format!("the unit of BRDF is '{}'", shown(&data.brdf.unit)))
            .help("give values in sr^-1, and say so"));
    }
    refuse::fluorescence(data, text, &lines)?;
    let weight = uncertainty(data, text, &lines)?;
    let mut scans: Vec<RawScan> = Vec::new();
    let mut places: HashMap<Vec<String>, usize> = HashMap::new();
    let theta_i = in_degrees("theta_i", &data.theta_i)?;
    let theta_r = in_degrees("theta_r", &data.theta_r)?;
    let phi_i = in_degrees("phi_i", &data.phi_i)?;
    let phi_r = in_degrees("phi_r", &data.phi_r)?;
    for k in 0..count {
        let number = |variable: &Variable| number(variable.values[k], text, &lines);
        let row = Row {
            theta_i: theta_i(number(&data.theta_i)?),
            theta_s: theta_r(number(&data.theta_r)?),
            delta_phi: Some(phi_r(number(&data.phi_r)?) - phi_i(number(&data.phi_i)?)),
            value: number(&data.brdf)?,
            weight: weight(k)?,
            line: lines.place(text, data.brdf.values[k].get()).0,
        };
        let names = names(data, k);
        let place = *places.entry(names).or_insert_with_key(|names| {
            scans.push(RawScan::new(names.clone(), Angles::Deg));
            scans.len() - 1
        });
        scans[place].rows.push(row);
    }
    if scans.is_empty() {
        return Err(Error::new("BRDF has no values").help("give one for each sample"));
    }
    Ok(scans)
}

/// The wavelength and the polarisations of sample `k`.
fn names(data: &Data, k: usize) -> Vec<String> {
    let word = |raw: &RawValue| raw.get().replace(['"', '[', ']'], "").replace(',', " ");
    let tidy = |text: String| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let wavelength = data
        .wavelength_i
        .iter()
        .map(|variable| format!("{} {}", word(variable.values[k]), variable.unit));
    let polarisations = [("", &data.polarization_i), ("to ", &data.polarization_r)];
    let polarisations = polarisations
        .into_iter()
        .filter_map(|(before, variable)| Some(format!("{before}{}", word(variable.as_ref()?.values[k]))));
    wavelength.chain(polarisations).map(tidy).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::raw::Weight;

    fn read(text: &str) -> Result<Vec<RawScan>, Error> {
        super::read(text, &ReadOptions::default())
    }

    const TEXT: &str = r#"{"metadata": {"any": [1]}, "data": {
"wavelength_i": {"unit": "nm", "values": [550, 650, 550]},
"polarization_i": {"notation": "sp", "values": ["s", "s", "s"]},
"theta_i": {"unit": "rad", "values": [0.5, 0.5, 0.5]}, "phi_i": {"unit": "deg", "values": [10, 10, 10]},
"theta_r": {"unit": "°", "values": [1, 2, 3]}, "phi_r": {"unit": "deg", "values": [190, 10, 100]},
"BRDF": {"unit": "sr^-1", "values": [0.5, 0.25,
 null]},
"uBRDF": {"unit": "%", "values": [1, 2, 3]}
}}"#;

    #[test]
    fn wavelengths_and_polarisations_are_scans() {
        assert!(is(TEXT));
        let scans = read(TEXT).unwrap();
        assert_eq!(scans.len(), 2);
        assert_eq!(
            (scans[0].names.join(" "), scans[1].names.join(" ")),
            ("550 nm s".into(), "650 nm s".into())
        );
        let [first, second] = scans[0].rows[..] else { panic!() };
        assert_eq!(
            (first.theta_i, first.theta_s, first.delta_phi),
            (0.5f64.to_degrees(), 1.0, Some(180.0))
        );
        assert_eq!(
            (first.value, first.weight, first.line),
            (0.5, Weight::RelativeSigma(0.01), 6)
        );
        assert!(second.value.is_nan() && second.delta_phi == Some(90.0) && second.line == 7);
        let stokes = TEXT.replace(r#"["s", "s", "s"]"#, "[[1,1,0,0], [1, -1, 0, 0], [1,1,0,0]]");
        assert_eq!(read(&stokes).unwrap()[1].names, ["650 nm", "1 -1 0 0"]);
    }

    #[test]
    fn one_uncertainty_may_hold_for_all() {
        let (head, _) = TEXT.split_once(",\n\"uBRDF\"").unwrap();
        let weight = |uncertainty: &str| {
            let text = head.replace(" null]}", &format!(" 1], \"uncertainty\": {uncertainty}}}")) + "}}";
            read(&text).map(|scans| scans[0].rows[0].weight)
        };
        assert_eq!(
            weight(r#"{"value": 0.01, "unit": "sr^-1"}"#).unwrap(),
            Weight::Sigma(0.01)
        );
        assert_eq!(
            weight(r#"{"value": 2, "unit": "%"}"#).unwrap(),
            Weight::RelativeSigma(0.02)
        );
        assert!(weight(r#"{"value": 2, "unit": "dB"}"#).is_err() && weight("3").is_err());
    }

    #[test]
    fn units_are_spelt_as_in_tables() {
        // Numbers alone, which are equal to themselves.
        let text = TEXT.replace(" null", " 1");
        let expected = read(&text).unwrap();
        for (from, to) in [
            ("\"rad\"", "\"radians\""),
            ("\"rad\"", "\"Radian\""),
            ("\"deg\"", "\"degree\""),
            ("\"deg\"", "\"Degrees\""),
            ("\"°\"", "\"deg\""),
            ("\"sr^-1\"", "\"1/sr\""),
            ("\"sr^-1\"", "\"sr⁻¹\""),
            ("\"%\"", "\"percent\""),
        ] {
            assert_eq!(read(&text.replace(from, to)).unwrap(), expected, "{to}");
        }
    }

    #[test]
    fn errors_name_the_place() {
        for (from, to, line, column, what) in [
            ("0.25", "\"x\"", Some(6), Some(43), "is not a number"),
            ("\"theta_r\"", "\"theta_x\"", None, None, "missing field `theta_r`"),
            ("[190, 10, 100]", "[190, 10]", None, None, "phi_r has 2 values, BRDF 3"),
            ("\"rad\"", "\"grad\"", None, None, "unit of theta_i is 'grad'"),
            ("\"sr^-1\"", "\"mV\"", None, None, "unit of BRDF is 'mV'"),
            ("}}", "}", Some(9), None, "EOF"),
        ] {
            let error = read(&TEXT.replacen(from, to, 1)).unwrap_err();
            assert!(error.what.contains(what), "{error}");
            assert!(line.is_none_or(|line| error.line == Some(line)), "{error}");
            assert!(column.is_none_or(|column| error.column == Some(column)), "{error}");
        }
    }

    #[test]
    fn transmission_and_fluorescence_are_refused() {
        let typed = |kind: &str| read(&TEXT.replace(r#"{"any": [1]}"#, &format!(r#"{{"type": "{kind}"}}"#)));
        assert!(typed("BRDF").is_ok() && typed("BSDF").is_ok());
        let error = typed("BTDF").unwrap_err();
        assert!(error.line == Some(1) && error.what.contains("goes through"), "{error}");
        let scattered = |values: &str| {
            let both = format!("\"wavelength_r\": {{\"unit\": \"um\", \"values\": {values}}},\n\"polarization_i\"");
            read(&TEXT.replacen("\"polarization_i\"", &both, 1))
        };
        assert!(scattered("[0.55, 0.65, 0.55]").is_ok());
        let error = scattered("[0.55, 0.65, 0.6]").unwrap_err();
        assert!(error.line == Some(3) && error.what.contains("fluorescence"), "{error}");
    }
}
