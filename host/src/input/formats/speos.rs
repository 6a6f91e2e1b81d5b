//! Text of Ansys Speos, formerly Optis: `.brdf`, a table for each angle of incidence and wavelength, and `.anisotropicbsdf`, one for each rotation of the sample and angle of incidence.
//!
//! Angles are from the normal, degrees; azimuth 0 is that of the specular ray.
//! The values of a table are proportional to the BRDF or to the intensity; what makes them absolute is the reflectance that the file gives, and that Speos makes their integral.
//! Source: "Structure of BRDF Files" and "Structure of Anisotropic BSDF Files" in the manual of Speos.

use super::grid::{self, Azimuths};
use super::words::Words;
use crate::error::{Error, shown};
use crate::input::direction::sin_cos;
use crate::input::format::{Format, Reader};
use crate::input::left_out::Reason;
use crate::input::options::ReadOptions;
use crate::input::raw::{RawScan, Row, Weight};
use crate::input::units::Angles;

/// This format.
pub const FORMAT: Format = Format {
    name: "speos",
    title: "Speos BSDF",
    about: "Ansys Speos text: .brdf and .anisotropicbsdf",
    reader: Reader::Text { is, read },
};

const ISOTROPIC: &str = "OPTIS - brdf surface file";
const ANISOTROPIC: &str = "OPTIS - Anisotropic BSDF surface file";

/// True if the first line is theirs.
fn is(text: &str) -> bool {
    starts_with(text, ISOTROPIC) || starts_with(text, ANISOTROPIC)
}

fn starts_with(text: &str, head: &str) -> bool {
    text.get(..head.len())
        .is_some_and(|begin| begin.eq_ignore_ascii_case(head))
}

/// One scan for each wavelength and rotation of the sample.
///
/// # Errors
/// The file is binary, of an old version, has only transmission, or a number is missing.
fn read(text: &str, _: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    if !is(text) {
        return Err(Error::new("this is no BSDF of Speos")
            .at_line(1)
            .help(format!("the first line begins with '{ISOTROPIC}' or '{ANISOTROPIC}'")));
    }
    let mut words = Words::new(text);
    version(words.rest_of_line())?;
    if words.setting("the mode", &["0", "1"])? == "1" {
        return Err(Error::new("this is a binary file of Speos")
            .at_line(2)
            .help("save it as text with the BSDF viewer of Speos"));
    }
    // The rest of the line of the mode, and a remark.
    words.rest_of_line();
    words.rest_of_line();
    let description = words.number("the length of the description")?.1;
    words.rest_of_line();
    words.characters(description.max(0.0) as usize);
    let mut scans = if starts_with(text, ISOTROPIC) {
        isotropic(&mut words)?
    } else {
        anisotropic(&mut words)?
    };
    if !ends(&mut words) {
        let (line, word) = words.word("the end")?;
        return Err(
            Error::new(format!("'{}' stands where the file should end", shown(word)))
                .at_line(line)
                .help("do the counts in the header agree with the numbers?"),
        );
    }
    scans.retain(|scan| !scan.rows.is_empty());
    if scans.is_empty() {
        return Err(Error::new("there is no value above 0 for reflection").help("measure the BRDF"));
    }
    Ok(scans)
}

/// True at the end of the file, which may say so.
fn ends(words: &mut Words) -> bool {
    words.peek().is_none_or(|word| word.eq_ignore_ascii_case("end"))
}

/// Refuses the versions that were laid out otherwise.
fn version(head: &str) -> Result<(), Error> {
    let number = head
        .rsplit(['v', 'V'])
        .next()
        .and_then(|number| number.parse::<f64>().ok());
    if number.is_some_and(|number| number >= 7.0) {
        return Ok(());
    }
    Err(Error::new(format!("'{}' is of an old version", shown(head)))
        .at_line(1)
        .help("open it with the BSDF viewer of Speos and save it again; this reads versions from 7 on"))
}

/// What the header says of the values.
struct Content {
    transmission: bool,
    quantity: Stored,
}

/// What values are proportional to.
#[derive(Clone, Copy, PartialEq)]
enum Stored {
    /// The BRDF.
    Brdf,
    /// The BRDF times the cosine of the scattering angle.
    Intensity,
}

/// Which sides there are, and what the values are.
fn content(words: &mut Words) -> Result<Content, Error> {
    let line = words.line();
    let reflection = words.setting("reflection", &["0", "1"])? == "1";
    let transmission = words.setting("transmission", &["0", "1"])? == "1";
    if !reflection {
        return Err(Error::new("this holds transmission (BTDF), and no reflection")
            .at_line(line)
            .help("measure the BRDF"));
    }
    let quantity = match words.setting("the type of value", &["0", "1"])? {
        "1" => Stored::Brdf,
        _ => Stored::Intensity,
    };
    Ok(Content { transmission, quantity })
}

/// The tables of a `.brdf` file: sides, then angles of incidence, then wavelengths.
fn isotropic(words: &mut Words) -> Result<Vec<RawScan>, Error> {
    let content = content(words)?;
    let incidences = words.count("the number of angles of incidence")?;
    let wavelengths = words.count("the number of wavelengths")?;
    let incidences = words.numbers(incidences, "an angle of incidence")?;
    let wavelengths = words.numbers(wavelengths, "a wavelength")?;
    let name = |wavelength: &f64| RawScan::new(vec![format!("{wavelength} nm")], Angles::Deg);
    let mut scans: Vec<RawScan> = wavelengths.iter().map(name).collect();
    for &theta_i in &incidences {
        for scan in &mut scans {
            let (line, percent) = words.number("the reflectance in percent")?;
            let table = table(words)?;
            let scale = percent / 100.0 / table.integral(content.quantity);
            table.take(scan, theta_i, scale, content.quantity, line)?;
        }
    }
    // Some files promise transmission and end before it.
    if content.transmission && !ends(words) {
        for &theta_i in &incidences {
            for scan in &mut scans {
                words.number("the transmittance in percent")?;
                let nodes = table(words)?.rows.len();
                scan.left_out.add_many(Reason::Transmission, theta_i, nodes);
            }
        }
    }
    Ok(scans)
}

/// Rotations of the sample, each with its angles of incidence.
type Incidences = Vec<(f64, Vec<f64>)>;

/// The tables of an `.anisotropicbsdf` file: sides, then rotations of the sample, then angles of incidence.
fn anisotropic(words: &mut Words) -> Result<Vec<RawScan>, Error> {
    words.numbers(3, "the anisotropy vector")?;
    let content = content(words)?;
    let reflection = incidences(words)?;
    let transmission = if content.transmission {
        incidences(words)?
    } else {
        Vec::new()
    };
    let reflectance = spectrum(words)?;
    if content.transmission {
        spectrum(words)?;
    }
    let percent = &reflectance.percent;
    // One table for all wavelengths: it is given once, or once for each that differs.
    let same = percent.iter().all(|(_, each)| *each == percent[0].1);
    let wavelengths = if same { &percent[..1] } else { &percent[..] };
    let mut scans = Vec::new();
    let mut unit = None;
    for (rotation, incidences) in &reflection {
        let mut tables = Vec::new();
        for &theta_i in incidences {
            let table = table(words)?;
            // The reflectance is that of the first rotation, at one angle of incidence or the first beyond it.
            if unit.is_none() && (theta_i >= reflectance.theta_i || incidences.last() == Some(&theta_i)) {
                unit = Some(table.integral(content.quantity));
            }
            tables.push((theta_i, table));
        }
        for (wavelength, percent) in wavelengths {
            let rotated = (reflection.len() > 1).then(|| format!("rotation {rotation}"));
            let coloured = (!same).then(|| format!("{wavelength} nm"));
            let mut scan = RawScan::new(rotated.into_iter().chain(coloured).collect(), Angles::Deg);
            for (theta_i, table) in &tables {
                let scale = percent / 100.0 / unit.unwrap_or(f64::NAN);
                table.take(&mut scan, *theta_i, scale, content.quantity, reflectance.line)?;
            }
            scans.push(scan);
        }
    }
    for (_, incidences) in transmission {
        for theta_i in incidences {
            let nodes = table(words)?.rows.len();
            if let Some(scan) = scans.first_mut() {
                scan.left_out.add_many(Reason::Transmission, theta_i, nodes);
            }
        }
    }
    Ok(scans)
}

/// The rotations of one side and their angles of incidence.
fn incidences(words: &mut Words) -> Result<Incidences, Error> {
    let rotations = words.count("the number of anisotropy angles")?;
    let rotations = words.numbers(rotations, "an anisotropy angle")?;
    let each = rotations.into_iter().map(|rotation| {
        let count = words.count("the number of angles of incidence")?;
        Ok((rotation, words.numbers(count, "an angle of incidence")?))
    });
    each.collect()
}

/// The reflectances of a material at one angle of incidence.
struct Spectrum {
    line: u64,
    theta_i: f64,
    /// Wavelengths in nm with their percentages; at least one.
    percent: Vec<(f64, f64)>,
}

fn spectrum(words: &mut Words) -> Result<Spectrum, Error> {
    let (line, theta_i) = words.number("the angle of incidence of the spectrum")?;
    words.number("the azimuth of the spectrum")?;
    words.rest_of_line();
    // Its description, which may be blank.
    words.rest_of_line();
    let count = words.count("the number of wavelengths")?;
    let each = (0..count).map(|_| Ok((words.number("a wavelength")?.1, words.number("a percentage")?.1)));
    Ok(Spectrum {
        line,
        theta_i,
        percent: each.collect::<Result<_, Error>>()?,
    })
}

/// A table of values over the scattering angle and the azimuth from the specular side.
struct Table {
    azimuths: Azimuths,
    /// Line, scattering angle and a value for each azimuth.
    rows: Vec<(u64, f64, Vec<f64>)>,
}

fn table(words: &mut Words) -> Result<Table, Error> {
    let thetas = words.count("the number of theta angles")?;
    let phis = words.count("the number of phi angles")?;
    let azimuths = Azimuths::new(words.numbers(phis, "a phi angle")?);
    let rows = (0..thetas).map(|_| {
        let (line, theta) = words.number("a theta angle")?;
        Ok((line, theta, words.numbers(phis, "a value")?))
    });
    Ok(Table {
        rows: rows.collect::<Result<_, Error>>()?,
        azimuths,
    })
}

impl Table {
    /// The values times the cosine over the hemisphere, by the trapezoidal rule.
    fn integral(&self, quantity: Stored) -> f64 {
        let ring = |(_, theta, values): &(u64, f64, Vec<f64>)| {
            let (sin, cos) = sin_cos(*theta);
            let cos = if quantity == Stored::Brdf { cos } else { 1.0 };
            (*theta, around(&self.azimuths.degrees, values) * sin * cos)
        };
        let rings: Vec<(f64, f64)> = self.rows.iter().map(ring).collect();
        let steps = rings.windows(2);
        steps
            .map(|pair| 0.5 * (pair[0].1 + pair[1].1) * (pair[1].0 - pair[0].0).to_radians())
            .sum()
    }

    /// Adds its values to a scan, as BRDF.
    fn take(&self, scan: &mut RawScan, theta_i: f64, scale: f64, quantity: Stored, line: u64) -> Result<(), Error> {
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(Error::new(format!(
                "the reflectance at theta_i = {theta_i} cannot make its values absolute: both must be above 0"
            ))
            .at_line(line)
            .help("give the reflectance in percent, or delete the angle of incidence"));
        }
        for (line, theta, values) in &self.rows {
            let cos = match quantity {
                Stored::Brdf => 1.0,
                Stored::Intensity => sin_cos(*theta).1,
            };
            for (place, (&phi, &value)) in self.azimuths.degrees.iter().zip(values).enumerate() {
                if self.azimuths.repeats(*theta, place, values) {
                    continue;
                }
                let row = Row {
                    theta_i,
                    theta_s: *theta,
                    delta_phi: Some(180.0 + phi),
                    value: value * scale / cos,
                    weight: Weight::Unknown,
                    line: *line,
                };
                grid::add(scan, row);
            }
        }
        Ok(())
    }
}

/// The integral over a whole turn, radians, by the trapezoidal rule: a turn that ends early is closed, and half a turn is mirrored.
fn around(degrees: &[f64], values: &[f64]) -> f64 {
    let span = degrees.last().unwrap_or(&0.0) - degrees[0];
    let steps = degrees.windows(2).zip(values.windows(2));
    let open: f64 = steps
        .map(|(angles, values)| 0.5 * (values[0] + values[1]) * (angles[1] - angles[0]).to_radians())
        .sum();
    if span == 180.0 {
        return 2.0 * open;
    }
    let ends = 0.5 * (values[0] + values.last().unwrap_or(&0.0));
    open + ends * (360.0 - span).to_radians()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn read(text: &str) -> Result<Vec<RawScan>, Error> {
        super::read(text, &ReadOptions::default())
    }

    /// A value that tells its place.
    fn value(theta_i: f64, theta: f64, phi: f64) -> f64 {
        1.0 + theta_i + theta / 100.0 + theta * phi / 1e7
    }

    fn node(scan: &RawScan, theta_i: f64, theta_s: f64, delta_phi: f64) -> f64 {
        let at = |row: &&Row| (row.theta_i, row.theta_s, row.delta_phi) == (theta_i, theta_s, Some(delta_phi));
        let found: Vec<&Row> = scan.rows.iter().filter(at).collect();
        assert_eq!(found.len(), 1, "{theta_i} {theta_s} {delta_phi}");
        found[0].value
    }

    fn table(theta_i: f64, cosine: bool) -> String {
        let phis = [0.0, 90.0, 180.0, 270.0, 360.0];
        let mut text = String::from("10 5\n\t0\t90\t180\t270\t360\n");
        for theta in (0..=90).step_by(10).map(f64::from) {
            let cos = if cosine { sin_cos(theta).1 } else { 1.0 };
            let cells = phis.map(|phi| (value(theta_i, theta, phi % 360.0) * cos).to_string());
            text += &format!("{theta}\t{}\n", cells.join("\t"));
        }
        text
    }

    /// 100 % of the reflectance of [`value`] by the same rule.
    fn percent(theta_i: f64) -> f64 {
        let text = table(theta_i, false);
        100.0 * super::table(&mut Words::new(&text)).unwrap().integral(Stored::Brdf)
    }

    fn brdf(cosine: bool) -> String {
        let mut text = format!(
            "{ISOTROPIC} v8.0\r\n0\na remark\n9\ntwo\nlines\n1 0\n{}\n2 1\n30 60\n550\n",
            u8::from(!cosine)
        );
        for theta_i in [30.0, 60.0] {
            text += &format!("{}\n{}", percent(theta_i), table(theta_i, cosine));
        }
        text + "End of file\n"
    }

    #[test]
    fn azimuth_0_is_forward_and_the_reflectance_makes_values_absolute() {
        for cosine in [false, true] {
            let scans = read(&brdf(cosine)).unwrap();
            assert_eq!((scans.len(), scans[0].names.join(" ")), (1, "550 nm".into()));
            for (theta_i, theta, phi) in [(30.0, 30.0, 0.0), (60.0, 80.0, 180.0), (30.0, 10.0, 270.0)] {
                let ratio = node(&scans[0], theta_i, theta, 180.0 + phi) / value(theta_i, theta, phi);
                assert!((ratio - 1.0).abs() < 1e-14, "{cosine} {theta_i} {theta} {phi}: {ratio}");
            }
            // The normal and azimuth 360 are there once; the horizon is left out.
            let left_out: usize = scans[0].left_out.clone().list().iter().map(|one| one.samples).sum();
            assert_eq!((scans[0].rows.len(), left_out), (2 * (1 + 8 * 4), 2 * 4));
        }
    }

    #[test]
    fn a_lambertian_reflectance_is_its_brdf_times_pi() {
        // One azimuth stands for all, half a turn for both sides.
        for (phis, span) in [("0", 1), ("0 180", 2), ("0 90 180 270", 4)] {
            let mut text = format!("{ISOTROPIC} v8.0\n0\n\n0\n\n1 0\n1\n1 1\n10\n633\n50\n91 {span}\n{phis}\n");
            for theta in 0..=90 {
                text += &format!("{theta} {}\n", "7 ".repeat(span));
            }
            let scans = read(&text).unwrap();
            // Steps of a degree leave the trapezoidal rule 1e-4.
            let f = scans[0].rows[40].value;
            assert!((f * PI / 0.5 - 1.0).abs() < 1.1e-4, "{phis}: {f}");
        }
    }

    fn anisotropic(spectrum: &str, tail: &str) -> String {
        let head = format!(
            "{ANISOTROPIC} v8.0\n0\nremark\n0\n\n0 1 0\n1 {}\n1\n2\n0 90\n",
            u8::from(!tail.is_empty())
        );
        let tables: String = [30.0, 60.0, 30.0, 60.0].map(|theta_i| table(theta_i, false)).concat();
        let transmission = if tail.is_empty() { "" } else { "1\n0\n1\n30\n" };
        let also = if tail.is_empty() { "" } else { "30 0\n\n1\n400 1\n" };
        format!("{head}2\n30 60\n2\n30 60\n{transmission}30 0\n\n{spectrum}{also}{tables}{tail}End of file\n")
    }

    #[test]
    fn rotations_and_wavelengths_are_scans() {
        let percent = percent(30.0);
        let scans = read(&anisotropic(&format!("2\n400 {percent}\n700 {percent}\n"), "")).unwrap();
        let names: Vec<String> = scans.iter().map(|scan| scan.names.join(" ")).collect();
        assert_eq!(names, ["rotation 0", "rotation 90"]);
        for scan in &scans {
            let ratio = node(scan, 60.0, 20.0, 270.0) / value(60.0, 20.0, 90.0);
            assert!((ratio - 1.0).abs() < 1e-14);
        }
        let scans = read(&anisotropic(&format!("2\n400 {percent}\n700 {}\n", percent / 2.0), "")).unwrap();
        let names: Vec<String> = scans.iter().map(|scan| scan.names.join(" ")).collect();
        assert_eq!(
            names,
            [
                "rotation 0 400 nm",
                "rotation 0 700 nm",
                "rotation 90 400 nm",
                "rotation 90 700 nm"
            ]
        );
        assert!((scans[0].rows[9].value / scans[1].rows[9].value - 2.0).abs() < 1e-14);
    }

    #[test]
    fn transmission_is_left_out_and_alone_refused() {
        let text = anisotropic(&format!("1\n400 {}\n", percent(30.0)), "2 1\n0\n90 1\n180 1\n");
        let left_out = read(&text).unwrap()[0].left_out.clone().list();
        assert!(
            left_out
                .iter()
                .any(|one| (one.reason, one.theta_i_deg, one.samples) == (Reason::Transmission, 30.0, 2))
        );
        let error = read(&brdf(false).replace("\n1 0\n", "\n0 1\n")).unwrap_err();
        assert!(error.what.contains("BTDF") && error.line == Some(7), "{error}");
    }

    #[test]
    fn what_is_not_understood_is_refused() {
        for (from, to, line) in [
            ("v8.0", "v5.1", Some(1)),
            ("\n0\na remark", "\n1\na remark", Some(2)),
            ("\n2 1\n", "\n2 0\n", Some(9)),
            ("\n2 1\n", "\n3 1\n", Some(14)),
            ("End", "7", Some(38)),
            ("\n550\n", "\nx\n", Some(11)),
        ] {
            let text = brdf(false);
            assert!(text.contains(from), "{from:?}");
            let error = read(&text.replacen(from, to, 1)).unwrap_err();
            assert_eq!(error.line, line, "{to:?}: {error}");
        }
        assert!(
            read("OPTIS - Scattering surface file v1.0\n")
                .unwrap_err()
                .what
                .contains("no BSDF of Speos")
        );
    }
}
