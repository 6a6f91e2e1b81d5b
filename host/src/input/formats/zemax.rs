//! Tabular BSDF of Zemax ("BSDF Data Interchange"): angles from the specular ray, blocks of numbers for each rotation and angle of incidence.

use super::grid;
use super::words::{Words, begins_line};
use crate::error::Error;
use crate::input::direction;
use crate::input::format::{Format, Reader};
use crate::input::options::ReadOptions;
use crate::input::raw::{RawScan, Row, Weight};
use crate::input::units::Angles;

/// This format.
pub const FORMAT: Format = Format {
    name: "zemax",
    title: "Zemax tabular BSDF",
    about: "Zemax tabular BSDF",
    reader: Reader::Text { is, read },
};

/// True if the text has the keywords that other `.bsdf` files lack.
fn is(text: &str) -> bool {
    ["DataBegin", "ScatterRadial", "AngleOfIncidence"]
        .iter()
        .all(|word| begins_line(text, word))
}

/// One scan, or one for each sample rotation and each of X, Y and Z.
///
/// A value of 0 says that there was no measurement; that of the specular ray stands in each azimuth, and is taken once.
///
/// # Errors
/// A keyword or a number is missing, or the data are of transmission.
fn read(text: &str, _: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let mut words = Words::new(text);
    setting(&mut words, "Source", &["Measured"])?;
    setting(
        &mut words,
        "Symmetry",
        &["PlaneSymmetrical", "ASymmetrical", "ASymmetrical4D"],
    )?;
    let content = setting(&mut words, "SpectralContent", &["Monochrome", "XYZ"])?;
    let line = words.line();
    if setting(&mut words, "ScatterType", &["BRDF", "BTDF"])? == "BTDF" {
        return Err(
            Error::new("ScatterType is 'BTDF': this holds transmission, and no reflection")
                .at_line(line)
                .help("measure the BRDF"),
        );
    }
    let rotations = list(&mut words, "SampleRotation")?;
    let incidences = list(&mut words, "AngleOfIncidence")?;
    let azimuths = list(&mut words, "ScatterAzimuth")?;
    let radials = list(&mut words, "ScatterRadial")?;
    let channels: &[&str] = match content {
        "XYZ" => &["TristimulusX", "TristimulusY", "TristimulusZ"],
        _ => &["Monochrome"],
    };
    let mut scans = Vec::new();
    for &channel in channels {
        words.keyword(channel)?;
        words.keyword("DataBegin")?;
        for rotation in &rotations {
            let names = channel.strip_prefix("Tristimulus").map(String::from);
            let mut scan = RawScan::new(names.into_iter().collect(), Angles::Deg);
            if rotations.len() > 1 {
                scan.names.push(format!("rotation {rotation}"));
            }
            for &theta_i in &incidences {
                words.keyword("TIS")?;
                words.number("the TIS")?;
                for (place, &azimuth) in azimuths.iter().enumerate() {
                    for &radial in &radials {
                        let (line, value) = words.number("a value")?;
                        let again = radial == 0.0 && place > 0;
                        if again {
                            continue;
                        }
                        let (theta_s, delta_phi) = direction::of_specular(theta_i, radial, azimuth);
                        let row = Row {
                            theta_i,
                            theta_s,
                            delta_phi,
                            value,
                            weight: Weight::Unknown,
                            line,
                        };
                        grid::add(&mut scan, row);
                    }
                }
            }
            scans.push(scan);
        }
        words.keyword("DataEnd")?;
    }
    Ok(scans)
}

fn setting(words: &mut Words, keyword: &str, known: &[&'static str]) -> Result<&'static str, Error> {
    words.keyword(keyword)?;
    words.setting(keyword, known)
}

/// A keyword, a count and as many angles.
fn list(words: &mut Words, keyword: &str) -> Result<Vec<f64>, Error> {
    words.keyword(keyword)?;
    let count = words.count("the number of angles")?;
    words.numbers(count, "an angle")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<RawScan>, Error> {
        super::read(text, &ReadOptions::default())
    }

    const TEXT: &str = "# remark\nSource Measured\nSymmetry  PlaneSymmetrical\nSpectralContent\tMonochrome\n\
        ScatterType BRDF\nSampleRotation 1\n0\nAngleOfIncidence 2\n10 70\nScatterAzimuth 3\n0 90\n180\n\
        ScatterRadial 2\n0 30\n\nMonochrome\nDataBegin\nTIS 0.1\n1 2\n1 3\n1 4\nTIS 0.2\n5 6\n5 7\n5 0\nDataEnd\n";

    #[test]
    fn angles_are_from_the_specular_ray() {
        assert!(is(TEXT));
        let rows = &read(TEXT).unwrap()[0].rows;
        let seen: Vec<_> = rows.iter().map(|row| (row.theta_i, row.value, row.line)).collect();
        assert_eq!(
            seen,
            [
                (10.0, 1.0, 19),
                (10.0, 2.0, 19),
                (10.0, 3.0, 20),
                (10.0, 4.0, 21),
                (70.0, 5.0, 23),
                (70.0, 6.0, 23),
                (70.0, 7.0, 24)
            ]
        );
        // In plane: theta_s = theta_i - radial at azimuth 0, theta_i + radial at 180.
        for (row, theta_s) in [(0, 10.0), (1, -20.0), (3, 40.0), (4, 70.0), (5, 40.0)] {
            assert!(
                (rows[row].theta_s - theta_s).abs() < 1e-13 && rows[row].delta_phi.is_none(),
                "{row}"
            );
        }
        // Across: spherical triangle with sides 10 and 30 and a right angle.
        let (cos, cos_s) = (
            direction::sin_cos(10.0).1 * direction::sin_cos(30.0).1,
            direction::sin_cos(rows[2].theta_s).1,
        );
        assert!((cos - cos_s).abs() < 1e-15);
        assert!((rows[2].delta_phi.unwrap() - 180.0).abs() > 60.0);
    }

    #[test]
    fn what_is_not_understood_is_refused() {
        for (from, to, line) in [
            ("ScatterType BRDF", "ScatterType BTDF", Some(5)),
            ("SampleRotation 1", "SampleRotation 0", Some(6)),
            ("ScatterRadial 2\n0 30", "ScatterRadial 3\n0 30", Some(16)),
            ("1 3\n", "1 x\n", Some(20)),
            ("1 3\n", "1\n", Some(22)),
            ("5 0\nDataEnd\n", "5", None),
            ("DataEnd", "8 DataEnd", Some(26)),
            ("Symmetry", "symmetrie", Some(3)),
        ] {
            let error = read(&TEXT.replacen(from, to, 1)).unwrap_err();
            assert_eq!(error.line, line, "{to}: {error}");
        }
    }

    #[test]
    fn rotations_and_colours_are_scans() {
        let text = TEXT
            .replace("SampleRotation 1\n0", "SampleRotation 2\n0 90")
            .replace("DataEnd", "TIS 0\n1 2 1 3 1 4 TIS 0 5 6 5 7 5 8 DataEnd");
        let names: Vec<_> = read(&text)
            .unwrap()
            .into_iter()
            .map(|scan| scan.names.join(" "))
            .collect();
        assert_eq!(names, ["rotation 0", "rotation 90"]);
        let (head, data) = TEXT
            .replace("SpectralContent\tMonochrome", "SpectralContent XYZ")
            .split_once("\nMonochrome")
            .map(|(a, b)| (a.to_string(), b.to_string()))
            .unwrap();
        let text = format!("{head}\nTristimulusX{data}TristimulusY{data}TristimulusZ{data}");
        let names: Vec<_> = read(&text)
            .unwrap()
            .into_iter()
            .map(|scan| scan.names.join(" "))
            .collect();
        assert_eq!(names, ["X", "Y", "Z"]);
    }
}
