//! Options that nothing in the files has a use for.

use super::measurement::Measurement;
use super::options::ReadOptions;
use crate::error::Error;
use crate::number::six;
use crate::plain::some_of;

/// Angles that differ by less are equal, degrees.
const SAME: f64 = 1e-4;

/// Refuses options that have done nothing to any of these scans, which were read together.
///
/// # Errors
/// The first of them, with what the scans have instead.
pub fn refuse(scans: &[Measurement], options: &ReadOptions) -> Result<(), Error> {
    let mut files: Vec<&str> = scans.iter().map(|scan| scan.file.as_str()).collect();
    files.dedup();
    let at = |error: Error| match files[..] {
        [file] => error.in_file(file),
        _ => error,
    };
    let angles = angles(scans);
    let missing = |&&(wanted, _): &&(f64, f64)| !angles.iter().any(|angle| (angle - wanted).abs() < SAME);
    if let Some((wanted, factor)) = options.weight_angle.iter().find(missing) {
        let there: Vec<String> = angles.iter().map(|&angle| six(angle)).collect();
        return Err(at(Error::new(format!(
            "there is no theta_i of {wanted} degrees, which --weight-angle {wanted}={factor} is for"
        ))
        .help(format!("leave it out, or give one that is there: {}", some_of(&there)))));
    }
    if options.coverage.is_some() && scans.iter().all(|scan| scan.sigma_ln.is_none()) {
        return Err(at(Error::new("no uncertainties are read, which --coverage is for")
            .help("leave it out, or name their column with --columns sigma=N")));
    }
    Ok(())
}

/// The angles of incidence of all rows, also of those that are left out; degrees, ascending.
fn angles(scans: &[Measurement]) -> Vec<f64> {
    let mut all = Vec::new();
    for scan in scans {
        let runs = scan.samples.chunk_by(|a, b| a.theta_i == b.theta_i);
        all.extend(runs.map(|run| run[0].theta_i.to_degrees()));
        all.extend(scan.left_out.iter().map(|one| one.theta_i_deg));
    }
    all.retain(|angle| angle.is_finite());
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() < SAME);
    all
}

#[cfg(test)]
mod tests {
    use super::super::{ReadOptions, parse, read_named};

    const ROWS: &str = "theta_i,theta_s,brdf\n20,-10,0.1\n20,30,0.2\n45,0,0.1\n45,95,0.3\n60,80,-1\n";

    fn refused(files: &[&str], options: &ReadOptions) -> Option<String> {
        let named = |(place, text): (usize, &&str)| (format!("{place}.csv"), text.as_bytes().to_vec());
        let files: Vec<_> = files.iter().enumerate().map(named).collect();
        let given: Vec<_> = files.iter().collect();
        read_named(&given, options).err().map(|error| error.to_string())
    }

    #[test]
    fn a_weight_of_an_angle_that_is_not_there_is_refused() {
        let weights = |weight_angle: &[(f64, f64)]| ReadOptions {
            drop_invalid: true,
            weight_angle: weight_angle.to_vec(),
            ..ReadOptions::default()
        };
        // Also those whose rows are left out are there.
        for there in [20.0, 45.0, 60.0] {
            assert_eq!(refused(&[ROWS], &weights(&[(there, 0.5)])), None);
        }
        let asked = weights(&[(20.0, 0.5), (30.0, 2.0)]);
        let error = refused(&[ROWS], &asked).unwrap();
        assert!(error.starts_with("0.csv: there is no theta_i of 30 degrees"), "{error}");
        assert!(error.ends_with("give one that is there: 20, 45, 60"), "{error}");
        assert!(parse("scan.csv", ROWS.as_bytes(), &asked).is_err());
        // Of several files one may have it.
        let other = ROWS.replace("\n20,", "\n30,");
        assert_eq!(refused(&[ROWS, &other], &asked), None);
        let error = refused(&[ROWS, &other], &weights(&[(25.0, 0.5)])).unwrap();
        assert!(error.starts_with("error: there is no theta_i of 25"), "{error}");
    }

    #[test]
    fn a_coverage_factor_of_no_uncertainties_is_refused() {
        let options = ReadOptions {
            drop_invalid: true,
            coverage: Some(2.0),
            ..ReadOptions::default()
        };
        let error = refused(&[ROWS], &options).unwrap();
        assert!(error.contains("no uncertainties are read"), "{error}");
        let weighted = "theta_i,theta_s,brdf,U\n20,-10,0.1,0.01\n20,30,0.2,0.02\n20,35,0.2,0.02\n";
        assert_eq!(refused(&[weighted], &options), None);
        assert_eq!(refused(&[ROWS, weighted], &options), None);
    }
}
