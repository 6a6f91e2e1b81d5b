//! Samples that the user does not want: near the direction of incidence, at large angles, of large values.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use crate::input::left_out::Reason;
use crate::input::options::ReadOptions;
use crate::input::raw::Row;
use crate::input::read_as::ReadAs;
use crate::input::units::Forward;

/// The reason for which the user does not want a sample.
pub(super) fn masked(sample: &Sample<f64>, value: f64, options: &ReadOptions) -> Option<Reason> {
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
pub(super) fn is_near_retro(row: &Row, read_as: &ReadAs) -> bool {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Error;
    use crate::input::{Measurement, parse};

    fn read(text: &str, options: &ReadOptions) -> Result<Measurement, Error> {
        parse("scan.csv", text.as_bytes(), options).map(|mut scans| scans.remove(0))
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
}
