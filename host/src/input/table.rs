//! Tables with named columns.

use super::columns::{self, Columns, Value, WeightKind};
use super::format::{Format, Reader};
use super::options::ReadOptions;
use super::raw::{Places, RawScan, Row, Weight};
use super::rows::{self, number};
use crate::error::Error;

/// This format, which is what no other is.
pub const FORMAT: Format = Format {
    name: "table",
    title: "table with named columns",
    about: "Named columns: CSV, TSV, semicolons or spaces",
    reader: Reader::Text { is: |_| true, read },
};

/// The scans in a table: one for each column of values, and for each wavelength if the rows have one.
///
/// # Errors
/// There is no header, no row, or a cell that is no number.
fn read(text: &str, options: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let mut columns: Option<Columns> = None;
    let mut wavelengths: Vec<String> = Vec::new();
    let mut scans: Vec<RawScan> = Vec::new();
    rows::for_each(text, |line, cells| {
        let Some(columns) = &columns else {
            columns = Some(columns::find(cells, options).map_err(|error| error.at_line(line))?);
            return Ok(());
        };
        if cells.len() != columns.count {
            return Err(Error::new(format!(
                "the row has {} cells, the header {}",
                cells.len(),
                columns.count
            ))
            .at_line(line)
            .help("give every row the cells that the header names"));
        }
        let wavelength = columns.wavelength.map_or("", |column| cells[column]);
        let group = match wavelengths.iter().position(|known| known == wavelength) {
            Some(group) => group,
            None => {
                wavelengths.push(wavelength.to_string());
                let named = |value: &Value| scan(columns, value, wavelength);
                scans.extend(columns.values.iter().map(named));
                wavelengths.len() - 1
            }
        };
        for (place, value) in columns.values.iter().enumerate() {
            let row = row(cells, line, columns, value).map_err(|error| error.at_line(line))?;
            scans[group * columns.values.len() + place].rows.push(row);
        }
        Ok(())
    })?;
    if columns.is_none() {
        return Err(Error::new("there is no header line, only remarks").help("name the columns in the first line"));
    }
    if scans.is_empty() {
        return Err(Error::new("there are no rows below the header").help("give one row a sample"));
    }
    Ok(scans)
}

/// An empty scan of one column at one wavelength.
fn scan(columns: &Columns, value: &Value, wavelength: &str) -> RawScan {
    let place = |column: usize| column as u64 + 1;
    let wavelength = (!wavelength.is_empty()).then(|| format!("{wavelength} nm"));
    RawScan {
        quantity: value.quantity,
        places: Places {
            theta_i: Some(place(columns.theta_i)),
            theta_s: Some(place(columns.theta_s)),
            phi: columns.phi_s.or(columns.phi_i).map(place),
            value: Some(place(value.column)),
            weight: value.weight.map(|(column, _)| place(column)),
        },
        ..RawScan::new(
            value.name.clone().into_iter().chain(wavelength).collect(),
            columns.angles,
        )
    }
}

fn row(cells: &[&str], line: u64, columns: &Columns, value: &Value) -> Result<Row, Error> {
    let phi = |column: Option<usize>| column.map(|column| number(cells, column)).transpose();
    let (phi_s, phi_i) = (phi(columns.phi_s)?, phi(columns.phi_i)?);
    Ok(Row {
        theta_i: number(cells, columns.theta_i)?,
        theta_s: number(cells, columns.theta_s)?,
        delta_phi: phi_s.map(|phi_s| phi_s - phi_i.unwrap_or(0.0)),
        value: number(cells, value.column)?,
        weight: match value.weight {
            None => Weight::Unknown,
            Some((column, kind)) => {
                let x = number(cells, column)?;
                match kind {
                    WeightKind::Sigma => Weight::Sigma(x),
                    WeightKind::RelativeSigma => Weight::RelativeSigma(x),
                    WeightKind::PercentSigma => Weight::RelativeSigma(x / 100.0),
                    WeightKind::Factor => Weight::Factor(x),
                }
            }
        },
        line,
    })
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
