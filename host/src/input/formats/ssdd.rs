//! SSDD ("surface scattering distribution data") of libbsdf: blocks of keywords, each with a grid of values as text or as binary numbers.
//!
//! Source: "Surface scattering distribution data (SSDD) file format", version 0.2, in libbsdf.

mod block;
mod lines;

use super::words::Words;
use crate::error::{Error, shown};
use crate::input::format::{Format, Reader};
use crate::input::left_out::{Counts, Reason};
use crate::input::options::ReadOptions;
use crate::input::raw::RawScan;
use block::{Block, Values, brdf, colours};
use lines::Lines;

/// This format.
pub const FORMAT: Format = Format {
    name: "ssdd",
    title: "SSDD",
    about: "SSDD of libbsdf, as text or binary",
    reader: Reader::Bytes { is, read },
};

/// True if the first keyword is VERSION, and DATA_TYPE follows.
fn is(file: &[u8]) -> bool {
    const HEADER: usize = 4096;
    let mut lines = Lines::new(file);
    let mut first = None;
    while let Some((_, line)) = lines.next() {
        let keyword = line.split_whitespace().next().unwrap_or("");
        match (first, keyword) {
            (_, "") => {}
            (None, "VERSION") => first = Some(true),
            (Some(true), "DATA_TYPE") => return true,
            (None, _) => return false,
            _ if file.len() - lines.rest.len() > HEADER => return false,
            _ => {}
        }
    }
    false
}

/// One scan for each colour or wavelength, and for each azimuth of incidence if there are several.
///
/// # Errors
/// A keyword, a list or a number is missing, the directions are given in a way that is not read, or there is no BRDF.
fn read(file: &[u8], _: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    if !is(file) {
        return Err(Error::new("this is no SSDD file").help("it begins with VERSION, and DATA_TYPE follows"));
    }
    let mut lines = Lines::new(file);
    let mut block = Block::default();
    let (mut scans, mut others, mut kinds) = (Vec::new(), Counts::default(), Vec::new());
    while let Some((number, line)) = lines.next() {
        let (keyword, value) = line.split_once(char::is_whitespace).unwrap_or((&line, ""));
        let value = value.trim();
        match keyword {
            "DATA_TYPE" => {
                block = Block {
                    kind: value.to_string(),
                    line: number,
                    ..Block::default()
                }
            }
            "COLOR_MODEL" => block.colours = value.to_string(),
            "PARAM_TYPE" => block.parameters = value.to_string(),
            "WAVELENGTH_LIST" => block.wavelengths = list(keyword, value, number)?,
            _ if keyword.starts_with("PARAM") && keyword.ends_with("_LIST") => {
                let place = keyword[5..keyword.len() - 5].parse::<usize>().ok();
                let list = list(keyword, value, number)?;
                *place.and_then(|place| block.lists.get_mut(place)).ok_or_else(|| {
                    Error::new(format!("{} is no list of SSDD", shown(keyword)))
                        .at_line(number)
                        .help("there are PARAM0_LIST to PARAM4_LIST")
                })? = list;
            }
            "DATA" => {
                let values = values(&mut lines, &block, value, number)?;
                kinds.push(block.kind.clone());
                let reason = match block.kind.as_str() {
                    "brdf" => {
                        scans.extend(brdf(&block, &values)?);
                        continue;
                    }
                    "btdf" | "specular_transmittance" => Reason::Transmission,
                    "specular_reflectance" => Reason::Mirror,
                    kind => {
                        return Err(Error::new(format!("DATA_TYPE is '{}'", shown(kind)))
                            .at_line(block.line)
                            .help("this reads brdf, btdf, specular_reflectance or specular_transmittance"));
                    }
                };
                let [theta_i, rest @ ..] = &block.lists;
                let each: usize = rest[..3].iter().map(|list| list.len().max(1)).product();
                theta_i
                    .iter()
                    .for_each(|&theta_i| others.add_many(reason, theta_i, each));
            }
            // Names, dates and the like, and REDUCTION_TYPE, which says which half of the directions is there.
            _ => {}
        }
    }
    match scans.first_mut() {
        Some(first) => {
            first.left_out.merge(others);
            Ok(scans)
        }
        None => Err(Error::new(format!("this has no BRDF, but {}", kinds.join(" and ")))
            .help("measure the BRDF, or export it with DATA_TYPE brdf")),
    }
}

/// The numbers in a line.
fn list(keyword: &str, value: &str, line: u64) -> Result<Vec<f64>, Error> {
    let number = |word: &str| {
        word.parse::<f64>().map_err(|_| {
            Error::new(format!("'{}' in {keyword} is not a number", shown(word)))
                .at_line(line)
                .help("give numbers with blanks between them")
        })
    };
    value.split_whitespace().map(number).collect()
}

/// The values of a block, which stand below its line DATA.
fn values(lines: &mut Lines, block: &Block, mode: &str, line: u64) -> Result<Values, Error> {
    let cut_off = |have: usize, want: usize| {
        Error::new(format!("the lists promise {want} values, and there are {have}"))
            .at_line(line)
            .help("is the file cut off?")
    };
    let lists = block.lists[..4].iter().map(|list| list.len().max(1));
    let want = lists
        .chain([colours(block)?.len()])
        .try_fold(1usize, usize::checked_mul)
        .filter(|&count| count <= lines.rest.len());
    // Each value takes a byte or more.
    let want = want.ok_or_else(|| cut_off(0, usize::MAX))?;
    match mode {
        "ascii" => {
            let mut values = Vec::with_capacity(want);
            while values.len() < want {
                let Some((number, text)) = lines.next() else {
                    return Err(cut_off(values.len(), want));
                };
                let mut words = Words::new(&text);
                while words.peek().is_some() {
                    let value = words.number("a value").map_err(|error| error.at_line(number))?.1;
                    values.push((number, value));
                }
            }
            if values.len() > want {
                return Err(cut_off(values.len(), want).help("give each direction a line with a value for each colour"));
            }
            Ok(values)
        }
        "binary" => {
            let bytes = lines
                .bytes(4 * want)
                .ok_or_else(|| cut_off(lines.rest.len() / 4, want))?;
            let value = |four: &[u8]| Some((0, f64::from(f32::from_le_bytes(four.try_into().ok()?))));
            Ok(bytes.chunks_exact(4).filter_map(value).collect())
        }
        other => Err(Error::new(format!("DATA is '{}'", shown(other)))
            .at_line(line)
            .help("this reads ascii or binary")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::raw::Row;

    fn read(file: &[u8]) -> Result<Vec<RawScan>, Error> {
        super::read(file, &ReadOptions::default())
    }

    const HEAD: &str = "# remark\nVERSION 0.2\nSOFTWARE x\n\nDATA_TYPE brdf\nCOLOR_MODEL monochrome\n\
        PARAM_TYPE spherical_coordinate_system\nPARAM0_LIST 0 30\nPARAM2_LIST 0 45 90\nPARAM3_LIST 0 180 360\nNAME a b\n";
    /// theta_i within theta_s within the azimuth.
    const VALUES: [f64; 18] = [
        1.0, 2.0, 3.0, 4.0, 0.0, 0.0, 1.0, 2.0, 5.0, 6.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 0.0, 0.0,
    ];

    fn ascii() -> String {
        let values = VALUES.map(|value| format!("{value}\n")).concat();
        format!("{HEAD}DATA ascii\n# PARAM3: 0\n{values}")
    }

    fn rows(scan: &RawScan) -> Vec<(f64, f64, Option<f64>, f64)> {
        let row = |row: &Row| (row.theta_i, row.theta_s, row.delta_phi, row.value);
        scan.rows.iter().map(row).collect()
    }

    #[test]
    fn text_and_binary_are_the_same_grid() {
        let expected = [
            (0.0, 0.0, Some(0.0), 1.0),
            (0.0, 45.0, Some(0.0), 3.0),
            (0.0, 45.0, Some(180.0), 5.0),
            (30.0, 0.0, Some(0.0), 2.0),
            (30.0, 45.0, Some(0.0), 4.0),
            (30.0, 45.0, Some(180.0), 6.0),
        ];
        let scans = read(ascii().as_bytes()).unwrap();
        assert_eq!((scans.len(), rows(&scans[0]).as_slice()), (1, &expected[..]));
        assert_eq!((scans[0].rows[0].line, scans[0].rows[4].line), (14, 17));
        let binary = VALUES.map(|value| (value as f32).to_le_bytes()).concat();
        let file = [format!("{HEAD}DATA binary\n").as_bytes(), &binary].concat();
        assert!(is(&file));
        assert_eq!(rows(&read(&file).unwrap()[0]), expected);
        let error = read(&file[..file.len() - 1]).unwrap_err();
        assert!(error.what.contains("promise 18 values, and there are 17"), "{error}");
    }

    #[test]
    fn directions_from_the_specular_ray_and_half_angles_are_turned() {
        let one = |kind: &str, lists: &str| {
            let text = format!(
                "VERSION 0.2\nDATA_TYPE brdf\nCOLOR_MODEL monochrome\nPARAM_TYPE {kind}_coordinate_system\n{lists}\nDATA ascii\n7\n"
            );
            let row = read(text.as_bytes()).unwrap()[0].rows[0];
            (row.theta_i, row.theta_s, row.delta_phi)
        };
        let near = |(a, b, c): (f64, f64, Option<f64>), expected: (f64, f64, Option<f64>)| {
            let apart = |x: f64, y: f64| (x - y).abs() < 1e-12;
            let same = apart(a, expected.0) && apart(b, expected.1);
            assert!(same && c.is_some() == expected.2.is_some(), "{a} {b} {c:?}");
            assert!(
                apart(c.unwrap_or(0.0).rem_euclid(360.0), expected.2.unwrap_or(0.0)),
                "{c:?}"
            );
        };
        // Azimuth 0 is on the side of the normal, 180 beyond the specular ray.
        near(
            one("specular", "PARAM0_LIST 30\nPARAM2_LIST 10\nPARAM3_LIST 0"),
            (30.0, 20.0, None),
        );
        near(
            one("specular", "PARAM0_LIST 30\nPARAM2_LIST 10\nPARAM3_LIST 180"),
            (30.0, 40.0, None),
        );
        near(
            one(
                "specular",
                "PARAM0_LIST 30\nPARAM2_LIST 10\nPARAM3_LIST 180\nPARAM4_LIST -5",
            ),
            (30.0, 35.0, None),
        );
        // In plane theta_i = theta_d + theta_h at phi_d = 0, and scattering is forward.
        near(
            one("half_difference", "PARAM0_LIST 10\nPARAM2_LIST 40\nPARAM3_LIST 0"),
            (50.0, 30.0, Some(180.0)),
        );
        near(
            one("half_difference", "PARAM0_LIST 10\nPARAM2_LIST 40\nPARAM3_LIST 180"),
            (30.0, 50.0, Some(180.0)),
        );
        near(
            one("half_difference", "PARAM0_LIST 40\nPARAM2_LIST 10\nPARAM3_LIST 0"),
            (50.0, 30.0, Some(0.0)),
        );
    }

    #[test]
    fn colours_wavelengths_and_azimuths_are_scans() {
        let text = |model: &str, values: &str| {
            format!(
                "VERSION 0.2\nDATA_TYPE brdf\nCOLOR_MODEL {model}\nPARAM_TYPE spherical_coordinate_system\nPARAM0_LIST 10\nPARAM1_LIST 0 90\n\
                 PARAM2_LIST 20\nPARAM3_LIST 180\nDATA ascii\n{values}"
            )
        };
        let seen = |text: &str| -> Vec<(String, Option<f64>, f64)> {
            let scans = read(text.as_bytes()).unwrap();
            let each = scans
                .iter()
                .map(|scan| (scan.names.join(" "), scan.rows[0].delta_phi, scan.rows[0].value));
            each.collect()
        };
        let rgb = seen(&text("rgb", "1 2 3\n4 5 6\n"));
        assert_eq!(
            (rgb[1].clone(), rgb[3].clone()),
            (
                ("azimuth 0 G".into(), Some(180.0), 2.0),
                ("azimuth 90 R".into(), Some(90.0), 4.0)
            )
        );
        let spectrum = text("spectrum\nWAVELENGTH_LIST 400 500.5", "1 2\n3 4\n");
        let names: Vec<String> = seen(&spectrum).into_iter().map(|(name, _, _)| name).collect();
        assert_eq!(
            names,
            [
                "azimuth 0 400 nm",
                "azimuth 0 500.5 nm",
                "azimuth 90 400 nm",
                "azimuth 90 500.5 nm"
            ]
        );
    }

    #[test]
    fn other_data_are_left_out_and_alone_refused() {
        let others = "DATA_TYPE btdf\nCOLOR_MODEL monochrome\nPARAM_TYPE spherical_coordinate_system\nPARAM0_LIST 10\nPARAM2_LIST 0 1\n\
            PARAM3_LIST 0\nDATA ascii\n1\n2\nDATA_TYPE specular_reflectance\nCOLOR_MODEL monochrome\nPARAM0_LIST 0 5\nDATA ascii\n0.5\n0.5\n";
        let left_out = read(format!("{}{others}", ascii()).as_bytes()).unwrap()[0]
            .left_out
            .clone()
            .list();
        let of = |reason: Reason| -> usize {
            let these = left_out.iter().filter(|one| one.reason == reason);
            these.map(|one| one.samples).sum()
        };
        assert_eq!(
            (of(Reason::Transmission), of(Reason::Mirror), of(Reason::Horizon)),
            (2, 2, 4)
        );
        let error = read(format!("VERSION 0.2\n{others}").as_bytes()).unwrap_err();
        assert!(error.what.contains("btdf and specular_reflectance"), "{error}");
    }

    #[test]
    fn what_is_not_understood_is_refused() {
        for (from, to, line) in [
            ("spherical_c", "distorted_spherical_c", Some(5)),
            ("monochrome", "cmyk", Some(5)),
            (
                "PARAM0_LIST 0 30\nPARAM2_LIST 0 45 90\n",
                "PARAM0_LIST 0 30 60 70 80 85\n",
                Some(5),
            ),
            ("PARAM2_LIST 0 45 90\n", "PARAM2_LIST 0 x\n", Some(9)),
            ("PARAM2_LIST", "PARAM9_LIST", Some(9)),
            ("DATA ascii", "DATA hex", Some(12)),
            ("\n5\n", "\nx\n", Some(22)),
            ("\n5\n", "\n", Some(12)),
        ] {
            let text = ascii();
            assert!(text.contains(from), "{from}");
            let error = read(text.replacen(from, to, 1).as_bytes()).unwrap_err();
            assert_eq!(error.line, line, "{to}: {error}");
        }
        assert!(!is(b"VERSION 1\ntheta_i,theta_s,brdf\n") && !is(b"theta_i,theta_s,brdf\nVERSION 1\nDATA_TYPE x\n"));
    }
}
