//! The program's own table of scans, which reads back to the same bits.

use brdfit_core::real::Real;

use super::facts::OWN;
use super::measurement::{Measurement, label};
use super::units::azimuth;
use crate::document::write_row;
use crate::number::shortest;
use crate::until::until;

/// The samples of scans as a table: angles in degrees where these read back to the same bits, and else in radians; BRDF in sr^-1.
///
/// Several scans have a column with their names, one has its name in a remark.
pub fn table(scans: &[Measurement]) -> String {
    let all = || scans.iter().flat_map(|scan| &scan.samples);
    let out_of_plane = all().any(|sample| sample.delta_phi != f64::PI);
    let until = until();
    let in_degrees = all().take_while(|_| !until.is_over()).all(|sample| {
        let polar = [sample.theta_i, sample.theta_s]
            .iter()
            .all(|&angle| degrees(angle, f64::to_radians).is_some());
        polar && degrees(sample.delta_phi, azimuth).is_some()
    });
    let weighted = all().any(|sample| sample.weight != 1.0);
    let sigma_ln = scans.iter().any(|scan| scan.sigma_ln.is_some());
    let deviations = scans.iter().any(|scan| !scan.deviations.is_empty());
    let unit = if in_degrees { "deg" } else { "rad" };

    let mut head: Vec<String> = Vec::new();
    head.extend((scans.len() > 1).then(|| "scan".to_string()));
    head.extend(["theta_i", "theta_s"].map(|name| format!("{name}_{unit}")));
    head.extend(out_of_plane.then(|| format!("delta_phi_{unit}")));
    head.push("brdf_per_sr".to_string());
    head.extend((weighted || deviations).then(|| "weight".to_string()));
    head.extend(sigma_ln.then(|| "sigma_ln".to_string()));
    let parts = ["own_absolute_sigma", "own_relative_sigma"];
    head.extend(parts.into_iter().filter(|_| deviations).map(String::from));

    let mut writer = csv::Writer::from_writer(Vec::new());
    // Writing to memory does not fail.
    let _ = write_row(&mut writer, &head);
    for scan in scans {
        for (place, sample) in scan.samples.iter().enumerate() {
            let angle = |radians: f64, back: fn(f64) -> f64| {
                let shown = if in_degrees { degrees(radians, back) } else { None };
                shortest(shown.unwrap_or(radians))
            };
            // Of millions of rows, which take seconds, nobody may wait any more.
            if until.is_over() {
                break;
            }
            let mut row: Vec<String> = Vec::new();
            row.extend((scans.len() > 1).then(|| scan.name.clone().unwrap_or_else(|| scan.file.clone())));
            row.push(angle(sample.theta_i, f64::to_radians));
            row.push(angle(sample.theta_s, f64::to_radians));
            row.extend(out_of_plane.then(|| angle(sample.delta_phi, azimuth)));
            row.push(shortest(sample.brdf));
            row.extend((weighted || deviations).then(|| shortest(sample.weight)));
            row.extend(sigma_ln.then(|| scan.sigma_ln.map_or(String::new(), shortest)));
            let own = scan.deviations.get(place);
            let parts = [own.map(|own| own.absolute), own.map(|own| own.relative)];
            let parts = parts.into_iter().filter(|_| deviations);
            row.extend(parts.map(|part| part.map_or(String::new(), shortest)));
            let _ = write_row(&mut writer, &row);
        }
    }
    let rows = String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default();
    let mut remarks = format!("{OWN}\n");
    for scan in scans {
        remarks += &format!("# from: {}\n", label(&scan.file, None));
    }
    if let [scan] = scans
        && let Some(name) = &scan.name
    {
        remarks += &format!("# scan: {}\n", label(name, None));
    }
    remarks + &rows
}

/// The shortest number of degrees that is read as this angle in radians, to the last bit, if there is any.
pub fn degrees(radians: f64, read: fn(f64) -> f64) -> Option<f64> {
    let near = radians.to_degrees();
    let short = (0..=15).filter_map(|decimals| format!("{near:.decimals$}").parse().ok());
    let beside = [near, near.next_up(), near.next_down()];
    short
        .chain(beside)
        .find(|&degrees| read(degrees).to_bits() == radians.to_bits())
}

#[cfg(test)]
mod tests {
    use super::super::{ReadOptions, parse};
    use super::*;

    fn read(text: &str, options: &ReadOptions) -> Vec<Measurement> {
        parse("scan.csv", text.as_bytes(), options).unwrap_or_else(|error| panic!("{error}\n{text}"))
    }

    /// Name, unit of the weights, and numbers of a scan.
    type Bits = (Option<String>, Option<u64>, Vec<[u64; 5]>);

    /// Everything that a fit sees.
    fn bits(scans: &[Measurement]) -> Vec<Bits> {
        let of = |scan: &Measurement| {
            let samples = scan.samples.iter();
            let all = samples.map(|sample| {
                [
                    sample.theta_i,
                    sample.theta_s,
                    sample.delta_phi,
                    sample.brdf,
                    sample.weight,
                ]
                .map(f64::to_bits)
            });
            (scan.name.clone(), scan.sigma_ln.map(f64::to_bits), all.collect())
        };
        scans.iter().map(of).collect()
    }

    #[test]
    fn reads_back_to_the_same_bits() {
        let odd = (1..60).map(|k| {
            let k = f64::from(k);
            format!("{},{},{},{}\n", 0.37 * k, 1.4 * k - 40.0 / 3.0, 0.1 / k, 5e-5 * k)
        });
        let odd: String = odd.collect();
        let drop = ReadOptions {
            drop_invalid: true,
            repeats: true,
            ..ReadOptions::default()
        };
        let near_normal = ReadOptions {
            angles: Some(super::super::units::Angles::Deg),
            ..drop.clone()
        };
        let radians = ReadOptions {
            angles: Some(super::super::units::Angles::Rad),
            ..drop.clone()
        };
        for (text, options) in [
            (format!("theta_i,theta_s,brdf,sigma\n{odd}"), &drop),
            (format!("theta_i,theta_s,brdf,weight\n{odd}"), &drop),
            (format!("theta_i,theta_s,azimuth,brdf\n{odd}"), &drop),
            (
                "theta_i,theta_s,brdf\n0.3,0.1,0.2\n0.7,1.1,0.3\n0.123456789,-0.987654321,0.4\n".to_string(),
                &radians,
            ),
            (
                "theta_i,theta_s,raa,brdf\n0.3,0.1,3.14159,0.2\n0.7,1.1,-2.5,0.3\n".to_string(),
                &radians,
            ),
            (
                "theta_i,theta_s,nm,R,G\n30,1,x,0.5,0.25\n30,2,y,0.125,0.1\n".replace("nm", "pol"),
                &drop,
            ),
            (
                "theta_i,theta_s,wavelength,brdf\n1,1.5,550,0.1\n1,0.5,550,0.2\n1,1.5,550,0.4\n".to_string(),
                &near_normal,
            ),
        ] {
            let scans = read(&text, options);
            let written = table(&scans);
            let again = read(&written, &ReadOptions::default());
            assert_eq!(bits(&again), bits(&scans), "{text}\n{written}");
            assert_eq!(table(&again).lines().count(), written.lines().count());
        }
        let plain = table(&read("theta_i,theta_s,brdf\n22.3,-80.5,0.1\n", &drop));
        assert!(
            plain.ends_with("theta_i_deg,theta_s_deg,brdf_per_sr\n22.3,-80.5,0.1\n"),
            "{plain}"
        );
    }
}
