//! Tables of columns: their rows as scans, one for each column of values and for each wavelength, polarisation and sample.

mod about;
mod means;
mod numbered;
mod remarks;
mod sorter;
mod texts;
mod unused;

use super::columns::Value;
use super::facts::Facts;
use super::format::{self, Format};
use super::options::ReadOptions;
use super::raw::RawScan;
use super::role::Role;
use super::sheet::Sheet;
use super::unit::Unit;
use super::units::{Angles, Polarisation};
use super::{find, repeats, rows, wide};
use crate::error::Error;
use crate::number::shortest;
use sorter::{Scan, Sorter};

/// This format, which is what no other is.
pub const FORMAT: Format = Format {
    name: "table",
    title: "table with named columns",
    about: "Columns: CSV, TSV, semicolons or spaces",
    reader: format::Reader::Text { is: |_| true, read },
};

/// The scans in a table.
///
/// # Errors
/// There is no header, no row, or a cell that is no number; a column that is not used could matter; a direction repeats at another value.
pub fn read(text: &str, options: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let sheet = Sheet::find(text, options)?;
    let columns = wide::find(sheet.heads.clone(), options).map_err(|error| error.at_line(sheet.line))?;
    let remarks = remarks_of(text, &sheet);
    let theta_i = match columns.theta_i {
        None if options.theta_i.is_empty() => remarks.one_theta_i()?,
        _ => None,
    };
    if let (Some(degrees), true) = (theta_i, columns.values.iter().any(Value::gives_theta_i)) {
        return Err(Error::new(format!(
            "the columns give angles of incidence, and a remark says theta_i is {} degrees",
            shortest(degrees)
        ))
        .at_line(sheet.line)
        .help("remove the remark; if the columns are of wavelengths, say so with --wavelength-unit um"));
    }
    let angles = options.angles.unwrap_or(columns.angles);
    let may_be_radians = |degrees: &f64| angles == Angles::Rad && *degrees > 0.0 && *degrees < 1.6;
    if let (Some(number), Some(line)) = (theta_i.filter(may_be_radians), remarks.theta_i_without_unit) {
        return Err(Error::new(format!(
            "a remark says that theta_i is {} without a unit, and the angles are in radians",
            shortest(number)
        ))
        .at_line(line)
        .help("name the unit there, as in '45 deg', or give theta_i in degrees with --theta-i"));
    }
    remarks::refuse_renamed(&sheet)?;
    numbered::refuse(&sheet)?;
    let mut sorter = Sorter::new(&columns, &sheet.facts, theta_i, options);
    sheet.for_each(|line, cells| sorter.row(line, cells))?;
    let (unused, unit) = (std::mem::take(&mut sorter.unused), sorter.unit.take());
    let mut scans = sorter.finish();
    if scans.is_empty() {
        return Err(Error::new("there are no rows below the header").help("give one row a sample"));
    }
    for seen in &unused {
        seen.refuse().map_err(|error| error.at_line(sheet.line))?;
    }
    if options.value_unit.is_none()
        && let Some((column, unit)) = unit
    {
        let text = format!("{} {unit}", columns.heads[column].text);
        let divisor = find::of_unit(Unit::parse(&unit), &text).map_err(|error| error.at_line(sheet.first_line))?;
        if divisor != 1.0 {
            scans.iter_mut().for_each(|scan| scan.raw.about.divisor = divisor);
        }
    }
    if !options.repeats && !sheet.facts.own {
        let tells_apart = unused
            .iter()
            .filter(|seen| seen.role == Role::Repeat)
            .map(|seen| seen.column);
        let tells_apart: Vec<usize> = tells_apart.collect();
        for scan in &scans {
            repeats::refuse(&scan.raw, &sheet, &columns, &tells_apart)?;
        }
    }
    let not_taken = remarks::not_taken(&remarks, &columns, &scans, options);
    for scan in &mut scans {
        scan.raw.about.notes.extend(not_taken.iter().cloned());
        scan.raw.about.doubts.extend(not_taken.iter().cloned());
    }
    if options.polarisation == Polarisation::Mean {
        scans = means::means(scans)?;
    }
    // The name of the only sample tells nothing apart.
    let single = |k: usize| scans.iter().all(|scan| scan.splits.get(k) == scans[0].splits.get(k));
    let telling: Vec<bool> = (0..columns.splits.len()).map(|k| !single(k)).collect();
    let finish = |scan: Scan| {
        let splits = scan.splits.into_iter().zip(&telling).filter(|(_, telling)| **telling);
        let mut raw = scan.raw;
        raw.names.splice(0..0, splits.map(|(name, _)| name));
        if raw.names.is_empty() {
            raw.names.extend(sheet.facts.scan.clone());
        }
        raw
    };
    Ok(scans.into_iter().map(finish).collect())
}

/// What the remarks of the whole file say: one between rows would be of those below.
fn remarks_of(text: &str, sheet: &Sheet) -> Facts {
    // Most files have none between their rows, and many rows.
    if sheet.facts.own || memchr::memchr(b'#', sheet.rows.as_bytes()).is_none() {
        return sheet.facts.clone();
    }
    let is_one = |number: u64, line: &str| number < sheet.first_line || line.trim_start().starts_with('#');
    let all = rows::lines(text).filter(|&(number, _, line)| is_one(number, line));
    Facts::of(all.map(|(number, _, line)| (number, line)))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use brdfit_core::geometry::Sample;

    use super::super::{Measurement, parse};
    use super::*;

    fn read(text: &str, options: &ReadOptions) -> Result<Vec<Measurement>, Error> {
        parse("scan.csv", text.as_bytes(), options)
    }

    fn one(text: &str) -> Measurement {
        let mut scans = read(text, &ReadOptions::default()).unwrap();
        assert_eq!(scans.len(), 1);
        scans.remove(0)
    }

    #[test]
    fn counts_lines_over_remarks_blanks_and_line_ends() {
        for end in ["\n", "\r\n"] {
            for mark in ["", "\u{feff}"] {
                let lines = [
                    "# remark",
                    "",
                    "theta_i,theta_s,brdf",
                    "",
                    "1,2,3",
                    "# x",
                    "  # y",
                    "",
                    "4,5,6",
                    ",,",
                    "7,8,9",
                ];
                let scan = one(&format!("{mark}{}{end}", lines.join(end)));
                assert_eq!(scan.lines, [5, 9, 11], "{end:?}");
                assert_eq!(scan.samples[2].brdf, 9.0);
                assert_eq!(scan.samples[0].theta_i, 1f64.to_radians());
            }
        }
    }

    #[test]
    fn takes_any_delimiter_and_quotes() {
        for text in [
            "theta_i;theta_s;brdf\n45;-85;0.5\n",
            "theta_i\ttheta_s\tbrdf\n45\t-85\t0.5",
            "\"theta_i\",\"theta_s\",\"brdf\"\n\"45\", -85 ,\"5e-1\"\n",
            "  theta_i theta_s  brdf\n# x\n\n 45   -85 0.5",
        ] {
            let sample = Sample::in_plane(45f64.to_radians(), (-85f64).to_radians(), 0.5);
            assert_eq!(one(text).samples, [sample], "{text}");
        }
    }

    #[test]
    fn takes_azimuths() {
        let scan = one("theta_i,theta_s,delta_phi,brdf\n45,40,180,1\n45,40,-180,1\n45,40,0,1\n45,40,270,1\n");
        let azimuths: Vec<f64> = scan.samples.iter().map(|sample| sample.delta_phi).collect();
        assert_eq!(azimuths, [PI, PI, 0.0, (-90f64).to_radians()]);
        let scan = one("theta_i,phi_i,theta_s,phi_s,brdf\n45,90,40,270,1\n");
        assert_eq!(scan.samples[0].delta_phi, PI);
        let scan = one("theta_i_rad,theta_s_rad,brdf\n0.5,0.25,1\n");
        assert_eq!(scan.samples, [Sample::in_plane(0.5, 0.25, 1.0)]);
    }

    #[test]
    fn refuses_what_rows_and_remarks_leave_open() {
        let rows = "20,-40,0.11\n20,0,0.12\n20,40,0.13\n";
        for (text, line, column, words) in [
            // An angle without a unit beside radians, and the number of one in a list.
            (
                "# theta_i: 0.7854\nangle [rad],brdf\n-0.8,0.1\n0.4,0.2\n".to_string(),
                Some(1),
                None,
                "--theta-i",
            ),
            (
                "# AOI # 3\nangle,brdf\n-40,0.1\n40,0.2\n".to_string(),
                None,
                None,
                "--theta-i",
            ),
            (
                format!("theta_i,theta_s,brdf\n1,2,3\n{rows}"),
                Some(2),
                None,
                "counts the columns",
            ),
            (
                format!("theta_i,theta_s,brdf\n\n0,1,2\n{rows}"),
                Some(3),
                None,
                "counts the columns",
            ),
            (
                format!("theta_i,theta_s,brdf\n{rows}# theta_s,theta_i,brdf\n0,40,0.1\n"),
                Some(5),
                None,
                "# theta_s,theta_i,brdf",
            ),
            (
                "theta_i,theta_s,brdf,type\n20,0,0.1,BRDF\n20,10,0.1,BTDF\n".to_string(),
                Some(1),
                Some(4),
                "--ignore 4",
            ),
        ] {
            let error = read(&text, &ReadOptions::default()).unwrap_err();
            assert_eq!((error.line, error.column), (line, column), "{error}");
            assert!(error.to_string().contains(words), "{error}");
        }
        for text in [
            "# theta_i: 45 deg\nangle [rad],brdf\n-0.8,0.1\n0.4,0.2\n".to_string(),
            format!("theta_i,theta_s,brdf\n{rows}# Theta_i [deg],theta_r,BRDF\n20,50,0.1\n"),
            "theta_i,theta_s,brdf\n1,2,3\n4,5,6\n7,8,9\n".to_string(),
            "theta_i,theta_s,brdf,type\n20,0,0.1,BRDF\n20,10,0.1,BRDF\n".to_string(),
        ] {
            one(&text);
        }
        let ignore = ReadOptions {
            ignore: vec!["type".to_string()],
            ..ReadOptions::default()
        };
        assert!(read("theta_i,theta_s,brdf,type\n20,0,0.1,BTDF\n", &ignore).is_ok());
    }

    #[test]
    fn says_which_column_is_meant() {
        for (text, words) in [
            ("theta_i,theta_s,BRDF normalised\n20,0,0.1\n", "--columns brdf=3 says"),
            (
                "theta_i,theta_s,BRDF_raw,BRDF_cleaned\n20,0,0.1,0.1\n",
                "--columns brdf=N says",
            ),
        ] {
            let error = read(text, &ReadOptions::default()).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }

    #[test]
    fn columns_and_wavelengths_are_scans() {
        let text = "theta_i,theta_s,wavelength_nm,R,G\n45,1,550,1,2\n45,1,650,3,4\n45,2,550,5,6\n";
        let scans = read(text, &ReadOptions::default()).unwrap();
        let names: Vec<_> = scans.iter().map(|scan| scan.name.as_deref().unwrap()).collect();
        assert_eq!(names, ["R 550 nm", "G 550 nm", "R 650 nm", "G 650 nm"]);
        assert_eq!(
            (scans[1].samples[1].brdf, scans[1].lines.as_slice()),
            (6.0, [2, 4].as_slice())
        );
        let chosen = |column: &str| ReadOptions {
            column: column.split(',').map(String::from).collect(),
            ..ReadOptions::default()
        };
        let brdf = |column| -> Vec<f64> {
            let scans = read(text, &chosen(column)).unwrap();
            scans.iter().map(|scan| scan.samples[0].brdf).collect()
        };
        assert_eq!(brdf("r"), [1.0, 3.0]);
        assert_eq!(brdf("650nm"), [3.0, 4.0]);
        assert_eq!(brdf("R 650 nm"), [3.0]);
        let error = read(text, &chosen("X")).unwrap_err().to_string();
        assert!(error.contains("no scan 'X'") && error.contains("G 650 nm"), "{error}");
        let other = "theta_i,theta_s,brdf,mine\n45,1,1,7\n";
        assert_eq!(read(other, &chosen("mine")).unwrap()[0].samples[0].brdf, 7.0);
    }
}
