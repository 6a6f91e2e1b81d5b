//! Tabular BSDF of Zemax ("BSDF Data Interchange"): angles from the specular ray, blocks of numbers for each rotation and angle of incidence.

use crate::error::{Error, shown};
use crate::input::direction;
use crate::input::format::{Format, Reader};
use crate::input::options::ReadOptions;
use crate::input::raw::{Places, RawScan, Row, Weight};
use crate::input::rows::is_remark;
use crate::input::units::{Angles, Quantity};

/// This format.
pub const FORMAT: Format = Format {
    name: "zemax",
    title: "Zemax tabular BSDF",
    about: "Zemax tabular BSDF",
    reader: Reader::Text { is, read },
};

/// True if the text has the keywords that other `.bsdf` files lack.
fn is(text: &str) -> bool {
    let begins = |word: &str| text.lines().any(|line| line.split_whitespace().next() == Some(word));
    begins("AngleOfIncidence") && begins("ScatterRadial") && begins("DataBegin")
}

/// A word with its line.
type Word<'a> = (u64, &'a str);

/// The words of the file, without remarks, from here on.
struct Words<'a>(std::vec::IntoIter<Word<'a>>);

impl<'a> Words<'a> {
    fn next(&mut self, wanted: &str) -> Result<Word<'a>, Error> {
        self.0.next().ok_or_else(|| {
            Error::new(format!("the file ends where {wanted} should follow")).help("is the file cut off?")
        })
    }

    fn expect(&mut self, keyword: &str) -> Result<(), Error> {
        match self.next(keyword)? {
            (_, word) if word.eq_ignore_ascii_case(keyword) => Ok(()),
            (line, word) => Err(Error::new(format!("'{}' stands where {keyword} should", shown(word)))
                .at_line(line)
                .help("keep the order of the keywords, and the counts of numbers that the header promises")),
        }
    }

    fn number(&mut self, wanted: &str) -> Result<(u64, f64), Error> {
        let (line, word) = self.next(wanted)?;
        let number = word.parse().map_err(|_| {
            Error::new(format!(
                "'{}' is not a number, where {wanted} should stand",
                shown(word)
            ))
            .at_line(line)
            .help("do the counts in the header agree with the numbers?")
        })?;
        Ok((line, number))
    }

    /// A keyword, a count and as many numbers.
    fn list(&mut self, keyword: &str) -> Result<Vec<f64>, Error> {
        const MOST: f64 = 1e5;
        self.expect(keyword)?;
        let (line, count) = self.number("a count")?;
        if !(1.0..=MOST).contains(&count) || count.fract() != 0.0 {
            return Err(Error::new(format!("{keyword} has {count} angles"))
                .at_line(line)
                .help("give their number, from 1 on"));
        }
        let each = (0..count as usize).map(|_| Ok(self.number("an angle")?.1));
        each.collect()
    }
}

/// One scan, or one for each sample rotation and each of X, Y and Z.
///
/// A value of 0 says that there was no measurement; that of the specular ray stands in each azimuth, and is taken once.
///
/// # Errors
/// A keyword or a number is missing, or the data are of transmission.
fn read(text: &str, _: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let lines = (1..).zip(text.lines()).filter(|(_, line)| !is_remark(line));
    let words: Vec<Word> = lines
        .flat_map(|(number, line)| line.split_whitespace().map(move |word| (number, word)))
        .collect();
    let mut words = Words(words.into_iter());
    let mut setting = |keyword: &str, permitted: &[&'static str]| -> Result<&'static str, Error> {
        words.expect(keyword)?;
        let (line, word) = words.next("a setting")?;
        let known = permitted.iter().find(|known| known.eq_ignore_ascii_case(word));
        known.copied().ok_or_else(|| {
            Error::new(format!("{keyword} is '{}'", shown(word)))
                .at_line(line)
                .help(format!("this reads {}", permitted.join(" or ")))
        })
    };
    setting("Source", &["Measured"])?;
    setting("Symmetry", &["PlaneSymmetrical", "ASymmetrical", "ASymmetrical4D"])?;
    let content = setting("SpectralContent", &["Monochrome", "XYZ"])?;
    setting("ScatterType", &["BRDF"])?;
    let rotations = words.list("SampleRotation")?;
    let incidences = words.list("AngleOfIncidence")?;
    let azimuths = words.list("ScatterAzimuth")?;
    let radials = words.list("ScatterRadial")?;
    let channels: &[&str] = match content {
        "XYZ" => &["TristimulusX", "TristimulusY", "TristimulusZ"],
        _ => &["Monochrome"],
    };
    let mut scans = Vec::new();
    for &channel in channels {
        words.expect(channel)?;
        words.expect("DataBegin")?;
        for rotation in &rotations {
            let mut scan = RawScan {
                names: channel
                    .strip_prefix("Tristimulus")
                    .map(String::from)
                    .into_iter()
                    .collect(),
                angles: Angles::Deg,
                quantity: Quantity::Brdf,
                places: Places::default(),
                rows: Vec::new(),
            };
            if rotations.len() > 1 {
                scan.names.push(format!("rotation {rotation}"));
            }
            for &theta_i in &incidences {
                words.expect("TIS")?;
                words.number("the TIS")?;
                for (place, &azimuth) in azimuths.iter().enumerate() {
                    for &radial in &radials {
                        let (line, value) = words.number("a value")?;
                        let again = radial == 0.0 && place > 0;
                        if value == 0.0 || again {
                            continue;
                        }
                        let (theta_s, delta_phi) = direction::angles(direction(theta_i, azimuth, radial));
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
            }
            scans.push(scan);
        }
        words.expect("DataEnd")?;
    }
    Ok(scans)
}

/// The direction at `radial` from the specular ray; azimuth 0 leads from there to the normal.
fn direction(theta_i: f64, azimuth: f64, radial: f64) -> [f64; 3] {
    let [(sin_i, cos_i), (sin_a, cos_a), (sin_r, cos_r)] = [theta_i, azimuth, radial].map(direction::sin_cos);
    [
        sin_i * cos_r - cos_i * sin_r * cos_a,
        sin_r * sin_a,
        cos_i * cos_r + sin_i * sin_r * cos_a,
    ]
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
