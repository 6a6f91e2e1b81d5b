//! Text of the goniophotometers of pab advanced technologies: remarks with the direction of incidence and what the columns are, then rows `theta phi value`, degrees.
//!
//! Directions are those of light and detector as seen from the sample: forward is half a turn from incidence, and angles beyond 90 degrees are on the other side.
//! Source: `pabopto2bsdf` and `pabopto2xyz` of Radiance.

use super::grid;
use crate::error::{Error, shown};
use crate::input::format::{Format, Reader};
use crate::input::left_out::Reason;
use crate::input::options::ReadOptions;
use crate::input::raw::{Places, RawScan, Row, Weight};
use crate::input::rows::number;
use crate::input::units::{Angles, Quantity};

/// This format.
pub const FORMAT: Format = Format {
    name: "pabopto",
    title: "pab-opto text",
    about: "pab-opto goniophotometer text",
    reader: Reader::Text { is, read },
};

/// True if a remark says what the columns are.
fn is(text: &str) -> bool {
    let mut remarks = text
        .lines()
        .take_while(|line| line.starts_with('#') || line.trim().is_empty());
    remarks.any(|line| setting(line).is_some_and(|(key, value)| key == "format" && value.starts_with("theta phi")))
}

/// The key and the value of a remark: `#key value` or `#key: value`.
fn setting(line: &str) -> Option<(&str, &str)> {
    let (key, value) = line.strip_prefix('#')?.trim().split_once([' ', '\t'])?;
    Some((key.trim_end_matches(':'), value.trim()))
}

/// What the remarks say.
#[derive(Default)]
struct Header {
    theta_i: Option<f64>,
    phi_i: Option<f64>,
    quantity: Option<Quantity>,
    coloured: bool,
    /// Theta and phi as the remarks since the last row give them.
    fresh: [Option<f64>; 2],
}

impl Header {
    /// Takes theta or phi of incidence, which several remarks above the same rows may give.
    ///
    /// # Errors
    /// They differ.
    fn incidence(&mut self, is_phi: bool, angle: f64) -> Result<(), Error> {
        let known = &mut self.fresh[usize::from(is_phi)];
        if let Some(before) = known.filter(|before| (before - angle) % 360.0 != 0.0) {
            let name = if is_phi { "phi" } else { "theta" };
            let what =
                format!("the remarks give two directions of incidence: {name} is {before} above and {angle} here");
            return Err(Error::new(what).help("leave the wrong one out"));
        }
        *known = Some(angle);
        *(if is_phi { &mut self.phi_i } else { &mut self.theta_i }) = Some(angle);
        Ok(())
    }
}

/// One scan, or one for each of X, Y and Z.
///
/// # Errors
/// The direction of incidence or the format is missing, a row has other numbers, or all are of transmission.
fn read(text: &str, _: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let mut header = Header::default();
    let mut scans: Vec<RawScan> = Vec::new();
    for (line, row) in (1..).zip(text.lines()) {
        let at = |error: Error| error.at_line(line);
        if row.starts_with('#') {
            remark(row, &mut header).map_err(at)?;
            continue;
        }
        let cells: Vec<&str> = row.split_whitespace().collect();
        if cells.is_empty() {
            continue;
        }
        let (theta_i, phi_i, quantity) = known(&header).map_err(at)?;
        header.fresh = [None; 2];
        if scans.is_empty() {
            scans = channels(quantity, header.coloured);
        }
        if cells.len() != 2 + scans.len() {
            let (have, want) = (cells.len(), 2 + scans.len());
            return Err(Error::new(format!("the row has {have} numbers, and not {want}"))
                .at_line(line)
                .help("give theta, phi and the values that #colorimetry promises"));
        }
        let (theta, phi) = (number(&cells, 0).map_err(at)?, number(&cells, 1).map_err(at)?);
        // Light from below is scattered to below.
        let (from, to) = if theta_i > 90.0 {
            (180.0 - theta_i, 180.0 - theta)
        } else {
            (theta_i, theta)
        };
        for (column, scan) in scans.iter_mut().enumerate() {
            let value = number(&cells, 2 + column).map_err(at)?;
            if to > 90.0 {
                scan.left_out.add(Reason::Transmission, from);
                continue;
            }
            let row = Row {
                theta_i: from,
                theta_s: to,
                delta_phi: Some(phi - phi_i),
                value,
                weight: Weight::Unknown,
                line,
            };
            grid::add(scan, row);
        }
    }
    if scans.is_empty() {
        return Err(Error::new("there are no rows below the remarks").help("give one row a direction"));
    }
    if scans.iter().all(|scan| scan.rows.is_empty()) {
        return Err(
            Error::new("this holds no reflection: all directions are on the other side, at the horizon or 0")
                .help("measure the BRDF"),
        );
    }
    Ok(scans)
}

/// Notes what a remark says.
fn remark(line: &str, header: &mut Header) -> Result<(), Error> {
    let Some((key, value)) = setting(line) else {
        return Ok(());
    };
    let angle = |text: &str| {
        text.parse::<f64>()
            .map_err(|_| Error::new(format!("{key} is '{}', which is not an angle", shown(value))).help("give degrees"))
    };
    match key {
        "incident_angle" => {
            let (theta, phi) = value.split_once([' ', '\t']).unwrap_or((value, ""));
            header.incidence(false, angle(theta)?)?;
            match phi.trim() {
                "" => header.phi_i = header.fresh[1].or(Some(0.0)),
                phi => header.incidence(true, angle(phi)?)?,
            }
        }
        "intheta" => header.incidence(false, angle(value)?)?,
        "inphi" => header.incidence(true, angle(value)?)?,
        "colorimetry" => header.coloured = value.eq_ignore_ascii_case("CIE-XYZ"),
        "format" => header.quantity = Some(quantity(value)?),
        _ => {}
    }
    Ok(())
}

/// What `theta phi NAME` says of the values.
fn quantity(format: &str) -> Result<Quantity, Error> {
    let name = format.strip_prefix("theta phi").unwrap_or("").split_whitespace().next();
    match name.unwrap_or("").to_ascii_uppercase().as_str() {
        "BSDF" | "BRDF" => Ok(Quantity::Brdf),
        "DSF" => Ok(Quantity::BrdfCos),
        "BTDF" => Err(Error::new("this holds transmission (BTDF), and no reflection").help("measure the BRDF")),
        _ => Err(Error::new(format!("the format is '{}'", shown(format)))
            .help("this reads theta phi BSDF, BRDF or DSF, the BSDF times the cosine")),
    }
}

/// The direction of incidence and the quantity, without which no row is understood.
fn known(header: &Header) -> Result<(f64, f64, Quantity), Error> {
    let theta_i = header.theta_i.ok_or_else(|| {
        Error::new("no remark gives the direction of incidence").help("write #incident_angle THETA PHI")
    })?;
    let quantity = header
        .quantity
        .ok_or_else(|| Error::new("no remark says what the columns are").help("write #format: theta phi BSDF"))?;
    Ok((theta_i, header.phi_i.unwrap_or(0.0), quantity))
}

/// The scans without rows.
fn channels(quantity: Quantity, coloured: bool) -> Vec<RawScan> {
    let names: &[&[&str]] = if coloured { &[&["X"], &["Y"], &["Z"]] } else { &[&[]] };
    let scan = |(place, names): (u64, &&[&str])| RawScan {
        quantity,
        places: Places {
            theta_s: Some(1),
            phi: Some(2),
            value: Some(place),
            ..Places::default()
        },
        ..RawScan::new(names.iter().map(|name| (*name).to_string()).collect(), Angles::Deg)
    };
    (3..).zip(names).map(scan).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<RawScan>, Error> {
        super::read(text, &ReadOptions::default())
    }

    const TEXT: &str = "#data written using x\n#sample_name \"paint\"\n#format: theta phi BSDF\n#incident_angle 30 90\n\
        #intheta 30\n#inphi 90\n#upphi 0\n10 270 1\n20.5\t90  2\n\n30 180 0\n100 0 4\n";

    fn rows(scan: &RawScan) -> Vec<(f64, f64, Option<f64>, f64, u64)> {
        let row = |row: &Row| (row.theta_i, row.theta_s, row.delta_phi, row.value, row.line);
        scan.rows.iter().map(row).collect()
    }

    #[test]
    fn forward_is_half_a_turn_from_incidence() {
        assert!(is(TEXT) && !is("# phi_i theta_i phi_o theta_o brdf\n1 2 3 4 5\n"));
        let scans = read(TEXT).unwrap();
        let expected = [(30.0, 10.0, Some(180.0), 1.0, 8), (30.0, 20.5, Some(0.0), 2.0, 9)];
        assert_eq!(rows(&scans[0]), expected);
        assert_eq!(scans[0].quantity, Quantity::Brdf);
        let left_out: Vec<_> = scans[0].left_out.clone().list();
        let left_out: Vec<_> = left_out.iter().map(|one| (one.reason, one.samples)).collect();
        assert_eq!(left_out, [(Reason::NotMeasured, 1), (Reason::Transmission, 1)]);
        let below = TEXT
            .replace("angle 30 ", "angle 150 ")
            .replace("intheta 30", "intheta 150");
        assert_eq!(rows(&read(&below).unwrap()[0]), [(30.0, 80.0, Some(-90.0), 4.0, 12)]);
    }

    #[test]
    fn dsf_is_times_the_cosine_and_colours_are_scans() {
        let scans = read(&TEXT.replace("BSDF", "DSF")).unwrap();
        assert_eq!(scans[0].quantity, Quantity::BrdfCos);
        let text = "#colorimetry: CIE-XYZ\n#format: theta phi BRDF\n#incident_angle 10 0\n20 180 1 2 3\n";
        let scans = read(text).unwrap();
        let seen: Vec<_> = scans
            .iter()
            .map(|scan| (scan.names.join(" "), scan.rows[0].value))
            .collect();
        assert_eq!(
            seen,
            [("X".to_string(), 1.0), ("Y".to_string(), 2.0), ("Z".to_string(), 3.0)]
        );
    }

    #[test]
    fn several_directions_of_incidence_may_stand_in_one_file() {
        let text = format!("{TEXT}#incident_angle 60 0\n20 180 5\n");
        let scans = read(&text).unwrap();
        assert_eq!(rows(&scans[0])[2], (60.0, 20.0, Some(180.0), 5.0, 14));
    }

    #[test]
    fn what_is_not_understood_is_refused() {
        for (from, to, line) in [
            ("BSDF", "BTDF", Some(3)),
            ("BSDF", "counts", Some(3)),
            ("angle 30", "angle x", Some(4)),
            ("intheta 30", "intheta 60", Some(5)),
            ("inphi 90", "inphi 0", Some(6)),
            ("#incident_angle 30 90\n#intheta 30\n", "", Some(6)),
            ("10 270 1", "10 270", Some(8)),
            ("10 270 1", "10 270 y", Some(8)),
            ("10 270 1\n20.5\t90  2\n\n", "", None),
        ] {
            let error = read(&TEXT.replacen(from, to, 1)).unwrap_err();
            assert_eq!(error.line, line, "{to}: {error}");
        }
    }
}
