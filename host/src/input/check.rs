//! From a scan as it stands in the file to samples: units, masks, validity, weights.

mod faults;
mod masks;
mod weigh;

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::about::{About, Counts, Missing};
use super::format::Format;
use super::kind::Kind;
use super::left_out::Reason;
use super::measurement::Measurement;
use super::options::ReadOptions;
use super::raw::{Places, RawScan, Row};
use super::read_as::ReadAs;
use super::side;
use super::units::{Angles, Forward};
use super::weight::{self, Deviation, OnDeviations};
use crate::engine::instrument::signed;
use crate::error::{Error, shown};
use crate::number::shortest;
use faults::Faults;

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
    let mut sides = Sides::default();
    for in_file in &scan.rows {
        let row = &turned_round(in_file, read_as.angles);
        match sample(row, &scan.places, &read_as, divisor, options) {
            Seen::Valid(sample, (kind, deviation)) => {
                weights.add(kind);
                told &= deviation != Deviation::default();
                if told {
                    deviations.push(deviation);
                }
                sides.add(in_file, &sample);
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
                faults.near_retro += usize::from(masks::is_near_retro(row, &read_as));
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
        about: About {
            counts: sides.counts(),
            ..scan.about
        },
    })
}

/// The signs that theta_s of samples has against that of their rows.
#[derive(Default)]
struct Sides {
    same: bool,
    mirrored: bool,
    /// A row has no azimuth, or a negative theta_s beside it: theta_s has a sign.
    signed: bool,
}

impl Sides {
    /// One more sample in the plane of incidence; one at the normal does not tell.
    fn add(&mut self, row: &Row, sample: &Sample<f64>) {
        let Some(theta_s) = signed(sample) else { return };
        self.same |= theta_s * row.theta_s > 0.0;
        self.mirrored |= theta_s * row.theta_s < 0.0;
        self.signed |= row.delta_phi.is_none() || row.theta_s < 0.0;
    }

    fn counts(&self) -> Counts {
        match (self.same, self.mirrored) {
            (true, true) if self.signed => Counts::Both,
            (false, true) if self.signed => Counts::Backward,
            _ => Counts::Forward,
        }
    }
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

fn degrees(row: &Row, read_as: &ReadAs) -> f64 {
    read_as.angles.degrees(row.theta_i)
}

/// What a row holds.
enum Seen {
    /// A sample whose weight is not normalised, where that is from, and its standard deviation.
    Valid(Sample<f64>, weigh::Known),
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
    if let Some(reason) = masks::masked(&sample, row.value, options) {
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
    let (weight, source) = match weigh::weight(row, read_as.quantity, options, sample.brdf) {
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

#[cfg(test)]
mod tests {
    use super::super::parse;
    use super::*;

    fn read(text: &str, options: &ReadOptions) -> Result<Measurement, Error> {
        parse("scan.csv", text.as_bytes(), options).map(|mut scans| scans.remove(0))
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
