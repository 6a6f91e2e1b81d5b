//! BSDF text of LightTools: keywords, then blocks of numbers for each angle of incidence, side, wavelength and kind of scatter; angles from the normal, degrees.
//!
//! With a plane of symmetry azimuths are from that of incidence, else those of the surface, where incidence is at `POI`, 90 degrees if that is not given (as libbsdf takes it).

use std::collections::HashMap;

use super::grid::{self, Azimuths};
use super::words::{Words, begins_line};
use crate::error::{Error, shown};
use crate::input::format::{Format, Reader};
use crate::input::left_out::Reason;
use crate::input::options::ReadOptions;
use crate::input::raw::{RawScan, Row, Weight};
use crate::input::units::Angles;

/// This format.
pub const FORMAT: Format = Format {
    name: "lighttools",
    title: "LightTools BSDF",
    about: "LightTools BSDF text",
    reader: Reader::Text { is, read },
};

/// True if the text has its keywords, and not those of Zemax.
fn is(text: &str) -> bool {
    ["DataBegin", "ScatterRadial", "AOI"]
        .iter()
        .all(|word| begins_line(text, word))
        && !begins_line(text, "AngleOfIncidence")
}

/// What a block of numbers is of.
#[derive(Clone, Default)]
struct Block<'a> {
    theta_i: Option<f64>,
    plane: Option<f64>,
    side: Option<&'a str>,
    wavelength: Option<&'a str>,
    channel: Option<&'a str>,
    transmission: bool,
}

impl Block<'_> {
    /// What tells its scan from the others.
    fn names(&self, anisotropic: bool) -> Vec<String> {
        let plane = self.plane.filter(|_| anisotropic).map(|plane| format!("POI {plane}"));
        let side = self
            .side
            .filter(|side| side.eq_ignore_ascii_case("Back"))
            .map(String::from);
        let wavelength = self.wavelength.map(|wavelength| format!("{wavelength} nm"));
        let channel = self.channel.map(|name| name.trim_start_matches("Tris").to_string());
        [plane, side, wavelength, channel].into_iter().flatten().collect()
    }
}

/// One scan for each side, wavelength, tristimulus value and plane of incidence.
///
/// # Errors
/// A keyword or a number is missing, or all blocks are of transmission.
fn read(text: &str, _: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let mut words = Words::new(text);
    let (symmetrical, azimuths, thetas) = header(&mut words)?;
    let mut scans: Vec<RawScan> = Vec::new();
    let mut places: HashMap<Vec<String>, usize> = HashMap::new();
    let mut transmitted: Vec<f64> = Vec::new();
    let anisotropic = has_planes(words.clone());
    let mut block = Block::default();
    loop {
        let (line, word) = words.word("DataEnd")?;
        match word {
            "AOI" => block.theta_i = Some(angle_of_incidence(&mut words)?),
            "POI" => block.plane = Some(words.number("the plane of incidence")?.1),
            "Side" => block.side = Some(words.setting(word, &["Front", "Back"])?),
            "Wavelength" => block.wavelength = Some(words.word("a wavelength")?.1),
            "ScatterType" => block.transmission = words.setting(word, &["BRDF", "BTDF"])? == "BTDF",
            "TristimulusValue" => block.channel = Some(words.setting(word, &["TrisX", "TrisY", "TrisZ"])?),
            "TIS" => {
                words.number("the TIS")?;
                let theta_i = block.theta_i.ok_or_else(|| {
                    Error::new("no AOI stands before these values")
                        .at_line(line)
                        .help("begin each block with AOI and the angle of incidence")
                })?;
                let lines = values(&mut words, azimuths.degrees.len(), thetas.len())?;
                if block.transmission {
                    transmitted.push(theta_i);
                } else {
                    let names = block.names(anisotropic);
                    let place = *places.entry(names.clone()).or_insert_with(|| {
                        scans.push(RawScan::new(names, Angles::Deg));
                        scans.len() - 1
                    });
                    let origin = if symmetrical { 0.0 } else { block.plane.unwrap_or(90.0) };
                    take(&mut scans[place], theta_i, origin, (&azimuths, &thetas), &lines);
                }
                block = Block::default();
            }
            "DataEnd" => break,
            _ => {
                return Err(Error::new(format!("'{}' stands where a keyword should", shown(word)))
                    .at_line(line)
                    .help("do the counts of ScatterAzimuth and ScatterRadial agree with the numbers?"));
            }
        }
    }
    let Some(first) = scans.first_mut() else {
        let what = if transmitted.is_empty() {
            "there is no block of values"
        } else {
            "this holds transmission (BTDF), and no reflection"
        };
        return Err(Error::new(what).help("measure the BRDF"));
    };
    for theta_i in transmitted {
        let nodes = azimuths.degrees.len() * thetas.len();
        first.left_out.add_many(Reason::Transmission, theta_i, nodes);
    }
    Ok(scans)
}

/// Up to DataBegin: is there a plane of symmetry, and which are the azimuths and the scattering angles?
fn header(words: &mut Words) -> Result<(bool, Azimuths, Vec<f64>), Error> {
    let (mut symmetrical, mut azimuths, mut thetas) = (None, None, None);
    loop {
        let (line, word) = words.word("DataBegin")?;
        let mut list = || -> Result<Vec<f64>, Error> {
            let count = words.count("the number of angles")?;
            words.numbers(count, "an angle")
        };
        match word {
            "Symmetry" => {
                let known = ["PlaneSymmetrical", "Asymmetric", "Asymmetrical"];
                symmetrical = Some(words.setting(word, &known)? == known[0]);
            }
            "SpectralContent" => {
                words.setting(word, &["Monochrome", "XYZ"])?;
            }
            "ScatterAzimuth" => azimuths = Some(list()?),
            "ScatterRadial" => thetas = Some(list()?),
            "DataBegin" => break,
            _ => {
                return Err(Error::new(format!("'{}' is no keyword of the header", shown(word)))
                    .at_line(line)
                    .help("this reads Symmetry, SpectralContent, ScatterAzimuth, ScatterRadial and DataBegin"));
            }
        }
    }
    let missing =
        |keyword: &str| Error::new(format!("there is no {keyword} before DataBegin")).help("is the file whole?");
    Ok((
        symmetrical.ok_or_else(|| missing("Symmetry"))?,
        Azimuths::new(azimuths.ok_or_else(|| missing("ScatterAzimuth"))?),
        thetas.ok_or_else(|| missing("ScatterRadial"))?,
    ))
}

/// True if there is more than one plane of incidence.
fn has_planes(mut words: Words) -> bool {
    let mut first = None;
    while let Ok((_, word)) = words.word("") {
        if let ("POI", Some(plane)) = (word, words.peek())
            && *first.get_or_insert(plane) != plane
        {
            return true;
        }
    }
    false
}

fn angle_of_incidence(words: &mut Words) -> Result<f64, Error> {
    match words.number("the angle of incidence")? {
        (_, angle) if (0.0..=90.0).contains(&angle) => Ok(angle),
        (line, angle) => Err(Error::new(format!("AOI is {angle}"))
            .at_line(line)
            .help("give the angle from the normal of its side, 0 to 90 degrees")),
    }
}

/// A line and a value for each scattering angle, for each azimuth.
type Values = Vec<(Vec<u64>, Vec<f64>)>;

fn values(words: &mut Words, azimuths: usize, thetas: usize) -> Result<Values, Error> {
    let row = |words: &mut Words| -> Result<(Vec<u64>, Vec<f64>), Error> {
        (0..thetas).map(|_| words.number("a value")).collect()
    };
    (0..azimuths).map(|_| row(words)).collect()
}

/// Adds a block to its scan; `origin` is the azimuth of incidence.
fn take(scan: &mut RawScan, theta_i: f64, origin: f64, (azimuths, thetas): (&Azimuths, &[f64]), values: &Values) {
    for (column, &theta_s) in thetas.iter().enumerate() {
        let ring: Vec<f64> = values.iter().map(|(_, row)| row[column]).collect();
        for (place, &azimuth) in azimuths.degrees.iter().enumerate() {
            if azimuths.repeats(theta_s, place, &ring) {
                continue;
            }
            let row = Row {
                theta_i,
                theta_s,
                delta_phi: Some(azimuth - origin),
                value: ring[place],
                weight: Weight::Unknown,
                line: values[place].0[column],
            };
            grid::add(scan, row);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<RawScan>, Error> {
        super::read(text, &ReadOptions::default())
    }

    const TEXT: &str = "# remark\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterAzimuth 3\n0 90 180\n\
        ScatterRadial 3\n0 30\n90\nDataBegin\nAOI 30\nPOI 90\nSide Front\nWavelength 550\nScatterType BRDF\nTIS 0.5\n\
        1 2 3\n1 4 5\n1 6 0\nAOI 60\nPOI 90\nSide Front\nWavelength 550\nScatterType BTDF\nTIS 0.1\n1 1 1 1 1 1 1 1 1\nDataEnd\n";

    #[test]
    fn with_a_plane_of_symmetry_azimuth_180_is_forward() {
        assert!(is(TEXT) && !is(&TEXT.replace("AOI", "AngleOfIncidence")));
        let scans = read(TEXT).unwrap();
        assert_eq!((scans.len(), scans[0].names.join(" ")), (1, "550 nm".into()));
        let seen: Vec<_> = scans[0]
            .rows
            .iter()
            .map(|row| (row.theta_i, row.theta_s, row.delta_phi, row.value, row.line))
            .collect();
        assert_eq!(
            seen,
            [
                (30.0, 0.0, Some(0.0), 1.0, 16),
                (30.0, 30.0, Some(0.0), 2.0, 16),
                (30.0, 30.0, Some(90.0), 4.0, 17),
                (30.0, 30.0, Some(180.0), 6.0, 18)
            ]
        );
        let left_out: Vec<_> = scans[0].left_out.clone().list();
        let left_out: Vec<_> = left_out
            .iter()
            .map(|one| (one.reason, one.theta_i_deg, one.samples))
            .collect();
        assert_eq!(left_out, [(Reason::Horizon, 30.0, 3), (Reason::Transmission, 60.0, 9)]);
    }

    #[test]
    fn without_one_incidence_is_at_poi() {
        let text = TEXT.replace("PlaneSymmetrical", "Asymmetric");
        let azimuths = |text: &str| -> Vec<f64> {
            let scans = read(text).unwrap();
            scans[0].rows[1..].iter().filter_map(|row| row.delta_phi).collect()
        };
        assert_eq!(azimuths(&text), [-90.0, 0.0, 90.0]);
        assert_eq!(azimuths(&text.replace("POI 90\n", "")), [-90.0, 0.0, 90.0]);
        assert_eq!(azimuths(&text.replace("POI 90\n", "POI 0\n")), [0.0, 90.0, 180.0]);
    }

    #[test]
    fn sides_wavelengths_colours_and_planes_are_scans() {
        let (head, block) = TEXT.split_once("AOI 30").unwrap();
        let block = format!("AOI 30{}", block.split_once("AOI 60").unwrap().0);
        let others = [
            block.clone(),
            block.replace("Front", "Back"),
            block.replace("550", "650"),
            block.replace("POI 90", "POI 0"),
            block.replace("TIS", "TristimulusValue TrisX\nTIS"),
        ];
        let scans = read(&format!("{head}{}DataEnd\n", others.concat())).unwrap();
        let names: Vec<String> = scans.iter().map(|scan| scan.names.join(" ")).collect();
        assert_eq!(
            names,
            [
                "POI 90 550 nm",
                "POI 90 Back 550 nm",
                "POI 90 650 nm",
                "POI 0 550 nm",
                "POI 90 550 nm X"
            ]
        );
    }

    #[test]
    fn what_is_not_understood_is_refused() {
        for (from, to, line) in [
            ("ScatterType BRDF", "ScatterType BSDF", Some(14)),
            ("AOI 30\n", "AOI 120\n", Some(10)),
            ("AOI 30\n", "", Some(14)),
            ("1 4 5\n", "1 x 5\n", Some(17)),
            ("1 4 5\n", "1 4\n", Some(19)),
            ("1 6 0\n", "1 6 0 9\n", Some(18)),
            ("DataEnd\n", "", None),
            ("ScatterRadial 3\n0 30\n90\n", "", None),
            ("SpectralContent", "Spectrum", Some(3)),
        ] {
            let error = read(&TEXT.replacen(from, to, 1)).unwrap_err();
            assert_eq!(error.line, line, "{to}: {error}");
        }
        let error = read(&TEXT.replace("BRDF", "BTDF")).unwrap_err();
        assert!(error.what.contains("transmission (BTDF)"), "{error}");
    }
}
