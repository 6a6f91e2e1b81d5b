//! From a scan as it stands in the file to samples: units, masks, validity, weights.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::about::Missing;
use super::format::Format;
use super::kind::Kind;
use super::left_out::Reason;
use super::measurement::Measurement;
use super::options::{ReadOptions, Weights};
use super::raw::{Places, RawScan, Row, Weight};
use super::read_as::ReadAs;
use super::side;
use super::units::{Angles, Forward, Quantity};
use super::weight::{self, Deviation, OnDeviations};
use crate::error::{Error, shown};
use crate::number::shortest;

/// The measurement in a scan of `file`.
///
/// # Errors
/// Rows that are not valid, if they are not to be left out; no row is left; the peak is on the other side.
pub fn measurement(file: &str, format: Format, scan: RawScan, options: &ReadOptions) -> Result<Measurement, Error> {
    let read_as = ReadAs {
        format,
        angles: options.angles.unwrap_or(scan.angles),
        quantity: options.quantity.unwrap_or(scan.quantity),
        forward: options.forward.unwrap_or_default(),
        weighted: false,
    };
    let divisor = scan.about.divisor;
    let mut masked = Vec::new();
    let mut names = scan.names;
    let count = scan.rows.len();
    let (mut samples, mut lines) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let (mut counts, mut faults) = (scan.left_out, Faults::default());
    let mut weights = weight::Count::default();
    // Most files tell no deviations, and a million rows of none are much.
    let (mut deviations, mut told) = (Vec::new(), true);
    for row in &scan.rows {
        let row = &turned_round(row, read_as.angles);
        match sample(row, &scan.places, &read_as, divisor, options) {
            Seen::Valid(sample, (kind, deviation)) => {
                weights.add(kind);
                told &= deviation != Deviation::default();
                if told {
                    deviations.push(deviation);
                }
                samples.push(sample);
                lines.push(row.line);
            }
            Seen::Masked(reason, sample) => {
                counts.add(reason, degrees(row, &read_as));
                masked.extend(sample.map(|sample| (reason, sample)));
            }
            Seen::Invalid { what, column } => {
                let here = |cell: &&Missing| cell.line == row.line && Some(cell.column) == column;
                let what = match scan.about.missing.as_ref().filter(here) {
                    Some(cell) if cell.text.is_empty() => what.replacen(" is NaN", " is an empty cell", 1),
                    Some(cell) => what.replacen(" is NaN", &format!(" is '{}'", shown(&cell.text)), 1),
                    None => what,
                };
                counts.add(Reason::NotValid, degrees(row, &read_as));
                faults.add(row.line, column, what);
                faults.near_retro += usize::from(is_near_retro(row, &read_as));
                faults.negative += usize::from(row.value < 0.0);
                faults.no_angle += usize::from(row.theta_i.is_nan());
            }
        }
    }
    if faults.count > 0 && !options.drop_invalid {
        return Err(faults.error(count));
    }
    if samples.is_empty() {
        return Err(Error::new(format!("none of the {count} rows is a valid sample"))
            .help("check the columns, units and masks"));
    }
    if options.forward.is_none() && scan.about.kind != Kind::Own && !scan.about.settled {
        side::refuse(&samples)?;
    }
    let of_file = weights.normalise(&mut samples);
    let sigma_ln = of_file.or(scan.about.sigma_ln);
    // Weights alone tell no more; a table of the program's own has the deviations beside them.
    if !told || sigma_ln.is_none() {
        deviations = Vec::new();
    }
    let on_deviations = OnDeviations {
        absolute: options.absolute_sigma,
        correct_ln_bias: options.correct_ln_bias,
    };
    if on_deviations.absolute && sigma_ln.is_none() {
        return Err(
            Error::new("no standard deviations were read, which --absolute-sigma takes the errors from")
                .help("leave it out, or name their column with --columns"),
        );
    }
    Ok(Measurement {
        file: file.to_string(),
        name: match names.len() {
            0 | 1 => names.pop(),
            _ => Some(names.join(" ")),
        },
        read_as: ReadAs {
            weighted: samples.iter().any(|sample| sample.weight != samples[0].weight),
            ..read_as
        },
        samples,
        lines,
        sigma_ln,
        deviations,
        on_deviations,
        left_out: counts.list(),
        masked,
        about: scan.about,
    })
}

/// A row with its angle of incidence not negative: the plane of incidence is seen from its other side.
fn turned_round(row: &Row, angles: Angles) -> Row {
    if !(row.theta_i < 0.0) {
        return *row;
    }
    let half_a_turn = match angles {
        Angles::Deg => 180.0,
        Angles::Rad => f64::PI,
    };
    Row {
        theta_i: -row.theta_i,
        theta_s: if row.delta_phi.is_some() {
            row.theta_s
        } else {
            -row.theta_s
        },
        delta_phi: row.delta_phi.map(|phi| phi + half_a_turn),
        ..*row
    }
}

/// The error with its line, if the file has lines.
fn at_line(error: Error, line: u64) -> Error {
    if line > 0 { error.at_line(line) } else { error }
}

fn degrees(row: &Row, read_as: &ReadAs) -> f64 {
    read_as.angles.degrees(row.theta_i)
}

/// What a row holds.
enum Seen {
    /// A sample whose weight is not normalised, where that is from, and its standard deviation.
    Valid(Sample<f64>, Known),
    /// What the user does not want; with a sample if it is one.
    Masked(Reason, Option<Sample<f64>>),
    /// Numbers that are no sample.
    Invalid { what: String, column: Option<u64> },
}

fn sample(row: &Row, places: &Places, read_as: &ReadAs, divisor: f64, options: &ReadOptions) -> Seen {
    let invalid = |column: Option<u64>, what: String| Seen::Invalid { what, column };
    for (column, name, angle) in [
        (places.theta_i, "theta_i", row.theta_i),
        (places.theta_s, "theta_s", row.theta_s),
        (places.phi, "the azimuth", row.delta_phi.unwrap_or(0.0)),
    ] {
        if angle.is_nan() {
            return invalid(column, format!("{name} is not an angle"));
        }
        if !angle.is_finite() {
            return invalid(column, format!("{name} is {}, which is not an angle", shortest(angle)));
        }
    }
    let mut sample = Sample {
        theta_i: read_as.angles.radians(row.theta_i),
        theta_s: read_as.angles.radians(row.theta_s),
        delta_phi: row.delta_phi.map_or(f64::PI, |phi| read_as.angles.azimuth(phi)),
        brdf: 0.0,
        weight: 1.0,
    };
    if read_as.forward == Forward::Negative {
        sample.theta_s = -sample.theta_s;
    }
    if let Some(reason) = masked(&sample, row.value, options) {
        let brdf = read_as.quantity.brdf(row.value / divisor, sample.theta_s).ok();
        return Seen::Masked(reason, brdf.map(|brdf| Sample { brdf, ..sample }));
    }
    for (column, name, angle, radians) in [
        (places.theta_i, "theta_i", row.theta_i, sample.theta_i),
        (places.theta_s, "theta_s", row.theta_s, sample.theta_s),
    ] {
        if radians.abs() >= f64::PI / 2.0 {
            let unit = match read_as.angles {
                Angles::Deg => "degrees",
                Angles::Rad => "radians",
            };
            return invalid(
                column,
                format!("{name} is {} {unit}, at or beyond the horizon", shortest(angle)),
            );
        }
    }
    sample.brdf = match read_as.quantity.brdf(row.value / divisor, sample.theta_s) {
        Ok(brdf) => brdf,
        Err(what) => return invalid(places.value, what),
    };
    let (weight, source) = match weight(row, read_as.quantity, options, sample.brdf) {
        Ok(known) => known,
        Err(what) => return invalid(places.weight, what),
    };
    let factors = options.weight_angle.iter();
    let here = factors.filter(|(theta_i, _)| (theta_i.to_radians() - sample.theta_i).abs() < 1e-6);
    sample.weight = here.fold(weight, |weight, (_, factor)| weight * factor);
    if sample.weight == 0.0 {
        return Seen::Masked(Reason::NoWeight, Some(sample));
    }
    if !sample.weight.is_finite() {
        return invalid(places.weight, "the weight is too large to compute with".into());
    }
    Seen::Valid(sample, source)
}

/// The reason for which the user does not want a sample.
fn masked(sample: &Sample<f64>, value: f64, options: &ReadOptions) -> Option<Reason> {
    // An angle on the edge of a mask is masked, whatever the rounding of radians.
    const ROUNDING: f64 = 1e-9;
    let beyond = |largest: f64| sample.theta_i.max(sample.theta_s.abs()) > largest.to_radians() + ROUNDING;
    if options.max_angle.is_some_and(beyond) {
        return Some(Reason::MaxAngle);
    }
    let near = |window: f64| from_retro(sample) <= Real::portable_sin_cos(window.to_radians() / 2.0).0 + ROUNDING;
    if options.mask_retro.is_some_and(near) {
        return Some(Reason::Retro);
    }
    if options.max_value.is_some_and(|largest| value >= largest) {
        return Some(Reason::MaxValue);
    }
    None
}

/// Is a row within 8 degrees of the direction of incidence?
fn is_near_retro(row: &Row, read_as: &ReadAs) -> bool {
    let sign = if read_as.forward == Forward::Negative {
        -1.0
    } else {
        1.0
    };
    let delta_phi = row.delta_phi.map_or(f64::PI, |phi| read_as.angles.azimuth(phi));
    let sample = Sample {
        delta_phi,
        ..Sample::in_plane(
            read_as.angles.radians(row.theta_i),
            sign * read_as.angles.radians(row.theta_s),
            0.0,
        )
    };
    from_retro(&sample) <= Real::portable_sin_cos(8f64.to_radians() / 2.0).0
}

/// Sine of half the angle between the directions of incidence and of scattering.
fn from_retro(sample: &Sample<f64>) -> f64 {
    let half = |angle: f64| Real::portable_sin_cos(angle / 2.0).0;
    // Signed theta_s with the azimuth of retro, 0.
    let (across, turned) = (half(sample.theta_i - sample.theta_s), half(sample.delta_phi));
    let (sin_i, sin_s) = (
        Real::portable_sin_cos(sample.theta_i).0,
        Real::portable_sin_cos(sample.theta_s).0,
    );
    (across * across + sin_i * sin_s * turned * turned).max(0.0).sqrt()
}

/// Where a weight is from, and what the file says of the value's standard deviation.
type Known = (weight::Source, Deviation);
const UNIT: Known = (
    weight::Source::Unit,
    Deviation {
        absolute: 0.0,
        relative: 0.0,
    },
);

/// The weight of a row, not normalised, and where it is from.
fn weight(row: &Row, quantity: Quantity, options: &ReadOptions, brdf: f64) -> Result<(f64, Known), String> {
    let known = match options.weights {
        Weights::File => row.weight,
        Weights::Equal => Weight::Unknown,
    };
    let sigma = match known {
        Weight::Unknown => return Ok((1.0, UNIT)),
        Weight::Factor(factor) if factor >= 0.0 && factor.is_finite() => return Ok((factor, UNIT)),
        Weight::Own(factor, deviation) if factor >= 0.0 && factor.is_finite() => {
            return Ok((factor, (weight::Source::Unit, deviation)));
        }
        Weight::Factor(factor) | Weight::Own(factor, _) => {
            return Err(format!(
                "the weight is {}, and must be a number from 0 on",
                shortest(factor)
            ));
        }
        Weight::RelativeSigma(sigma) => sigma,
        Weight::Sigma(sigma) => match quantity.is_logarithm() {
            Some(factor) => sigma * factor,
            None => sigma / row.value,
        },
    };
    let whole = (sigma * sigma + options.sigma_floor * options.sigma_floor).sqrt();
    if sigma >= 0.0 && whole >= f64::MIN_POSITIVE && whole.is_finite() {
        let is_absolute = matches!(known, Weight::Sigma(_)) && quantity.is_logarithm().is_none();
        let deviation = if is_absolute {
            Deviation {
                absolute: sigma * brdf,
                relative: options.sigma_floor,
            }
        } else {
            Deviation {
                absolute: 0.0,
                relative: whole,
            }
        };
        Ok((1.0 / whole, (weight::Source::Sigma, deviation)))
    } else {
        let (name, number) = match known {
            Weight::Sigma(sigma) => ("the standard deviation", sigma),
            _ => ("the relative standard deviation", sigma),
        };
        let what = format!("{name} is {}, which gives no weight", shortest(number));
        Err(what + " (--sigma-floor 0.01 or --weights equal would)")
    }
}

/// The rows that are no sample, summed up.
#[derive(Default)]
struct Faults {
    count: usize,
    /// How many are close to the direction of incidence, where a detector blocks the beam.
    near_retro: usize,
    negative: usize,
    /// How many have no angle of incidence.
    no_angle: usize,
    first: Option<(u64, Option<u64>, String)>,
    lines: Vec<String>,
}

impl Faults {
    fn add(&mut self, line: u64, column: Option<u64>, what: String) {
        const LISTED: usize = 8;
        self.first.get_or_insert((line, column, what));
        if self.lines.len() < LISTED {
            self.lines.push(line.to_string());
        }
        self.count += 1;
    }

    /// One line for all of them, of so many rows, at the place of the first.
    fn error(self, rows: usize) -> Error {
        let Some((line, column, mut what)) = self.first else {
            return Error::new("no row is at fault");
        };
        if self.count > 1 {
            let more = if self.count > self.lines.len() { ", ..." } else { "" };
            let lines = self.lines.join(", ");
            what += &format!(" ({} rows are not valid, on lines {lines}{more})", self.count);
        }
        let help = if self.no_angle == self.count && self.count < rows {
            "write the angle in every row (of merged cells only the first has it), or use --drop-invalid to leave such rows out"
        } else if 2 * self.negative > rows {
            "most values are negative: are they logarithms? say so with --quantity ln-brdf or log10-brdf"
        } else if 2 * self.near_retro > self.count {
            "most are where a detector blocks the incident beam: use --mask-retro 6, or --drop-invalid to leave such rows out"
        } else {
            "use --drop-invalid to leave such rows out"
        };
        let error = Error::new(what).help(help);
        at_line(Error { column, ..error }, line)
    }
}

#[cfg(test)]
mod tests {
    use super::super::parse;
    use super::*;

    fn read(text: &str, options: &ReadOptions) -> Result<Measurement, Error> {
        parse("scan.csv", text.as_bytes(), options).map(|mut scans| scans.remove(0))
    }

    #[test]
    fn quotes_the_cell_that_is_no_number() {
        for (cells, words) in [
            ("n/a,0.1", "the BRDF is 'n/a', which"),
            (",0.1", "the BRDF is an empty cell, which"),
            ("#DIV/0!,0.1", "the BRDF is '#DIV/0!', which"),
            ("0.5,", "the standard deviation is an empty cell, which"),
            ("0.5,-0.1", "the standard deviation is -0.1, which"),
        ] {
            let text = format!("theta_i,theta_s,brdf,sigma\n45,0,1,0.1\n45,1,{cells}\n");
            let error = read(&text, &ReadOptions::default()).unwrap_err();
            assert!(error.line == Some(3) && error.what.contains(words), "{error}");
        }
    }

    #[test]
    fn drops_only_what_is_asked_for() {
        let text = "theta_i,theta_s,brdf\n45,1,-0.1\n45,2,1\n45,90,1\n45,4,nan\n30,5,0\n";
        let error = read(text, &ReadOptions::default()).unwrap_err();
        assert_eq!((error.line, error.column), (Some(2), Some(3)));
        assert!(
            error.what.contains("4 rows are not valid, on lines 2, 4, 5, 6"),
            "{error}"
        );
        let options = ReadOptions {
            drop_invalid: true,
            ..ReadOptions::default()
        };
        let scan = read(text, &options).unwrap();
        assert_eq!(scan.lines, [3]);
        let counts: Vec<_> = scan.left_out.iter().map(|one| (one.theta_i_deg, one.samples)).collect();
        assert_eq!(counts, [(30.0, 1), (45.0, 3)]);
    }

    #[test]
    fn masks_count_by_angle_of_incidence() {
        let mut text = String::from("theta_i,theta_s,brdf\n");
        for theta_i in [30, 60] {
            for theta_s in -90..=90 {
                text += &format!("{theta_i},{theta_s},{}\n", if theta_s == theta_i { 5 } else { -1 });
            }
        }
        let options = ReadOptions {
            mask_retro: Some(6.0),
            max_angle: Some(85.0),
            max_value: Some(5.0),
            drop_invalid: true,
            ..ReadOptions::default()
        };
        assert!(read(&text, &options).unwrap_err().what.contains("none of the 362 rows"));
        let text = text.replace(",-1\n", ",0.1\n");
        let scan = read(&text, &options).unwrap();
        let counts: Vec<_> = scan
            .left_out
            .iter()
            .map(|one| (one.reason, one.theta_i_deg, one.samples))
            .collect();
        let expected = [(Reason::Retro, 13), (Reason::MaxAngle, 10), (Reason::MaxValue, 1)];
        let expected = expected.map(|(reason, count)| [(reason, 30.0, count), (reason, 60.0, count)]);
        assert_eq!(counts, expected.concat());
        assert_eq!(scan.samples.len(), 2 * (181 - 24));
    }

    #[test]
    fn the_window_of_retro_is_round() {
        let angle = |theta_s: f64, delta_phi: f64| {
            let at = Sample::in_plane(30f64.to_radians(), theta_s.to_radians(), 1.0);
            from_retro(&Sample {
                delta_phi: delta_phi.to_radians(),
                ..at
            })
        };
        let sine = |degrees: f64| Real::portable_sin_cos(degrees.to_radians()).0;
        assert!((angle(33.0, 0.0) - sine(1.5)).abs() < 1e-15);
        assert!((angle(-33.0, 180.0) - sine(1.5)).abs() < 1e-15);
        // At one elevation the azimuth counts by its sine.
        assert!((angle(30.0, 6.0) - sine(30.0) * sine(3.0)).abs() < 1e-15);
    }

    #[test]
    fn weights_are_normalised() {
        let text = "theta_i,theta_s,brdf,sigma\n45,1,2,0.2\n45,2,1,0.05\n60,3,1,0.1\n";
        let scan = read(text, &ReadOptions::default()).unwrap();
        let sigma_ln = [0.1, 0.05, 0.1];
        let unit = scan.sigma_ln.unwrap();
        for (sample, sigma) in scan.samples.iter().zip(sigma_ln) {
            assert!((sample.weight * sigma / unit - 1.0).abs() < 1e-15);
        }
        let mean = scan
            .samples
            .iter()
            .map(|sample| sample.weight * sample.weight)
            .sum::<f64>()
            / 3.0;
        assert!((mean - 1.0).abs() < 1e-15 && scan.read_as.weighted);
        let equal = ReadOptions {
            weights: Weights::Equal,
            ..ReadOptions::default()
        };
        let scan = read(text, &equal).unwrap();
        assert!(scan.samples.iter().all(|sample| sample.weight == 1.0));
        assert_eq!((scan.sigma_ln, scan.read_as.weighted), (None, false));
        let by_angle = ReadOptions {
            weight_angle: vec![(60.0, 0.0), (45.0, 3.0)],
            ..equal
        };
        let scan = read(text, &by_angle).unwrap();
        assert_eq!((scan.samples.len(), scan.samples[0].weight), (2, 1.0));
        assert_eq!(scan.left_out[0].reason, Reason::NoWeight);
    }

    #[test]
    fn a_standard_deviation_of_zero_is_refused() {
        let text = "theta_i,theta_s,brdf,sd\n45,1,2,0.2\n45,2,1,0\n";
        let error = read(text, &ReadOptions::default()).unwrap_err();
        assert_eq!((error.line, error.column), (Some(3), Some(4)));
        assert!(error.what.contains("--sigma-floor"), "{error}");
        let floor = ReadOptions {
            sigma_floor: 0.1,
            ..ReadOptions::default()
        };
        let scan = read(text, &floor).unwrap();
        let ratio = scan.samples[1].weight / scan.samples[0].weight;
        assert!((ratio - 2f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn the_other_sign_is_turned_round() {
        let negative = ReadOptions {
            forward: Some(Forward::Negative),
            ..ReadOptions::default()
        };
        let scan = read("theta_i,theta_s,brdf\n45,-44,2\n", &negative).unwrap();
        assert_eq!(scan.samples[0].theta_s, 44f64.to_radians());
    }
}
