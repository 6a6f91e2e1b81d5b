//! Azimuths that cannot be what they are taken for: radians beside degrees, and the plane of incidence taken for one across it.

use std::collections::HashMap;
use std::f64::consts::TAU;

use super::head::Head;
use super::options::ReadOptions;
use super::part::Part;
use super::raw::{RawScan, Row};
use super::role::Role;
use super::units::Angles;
use crate::error::Error;

/// Values in the same direction differ by less.
const SAME: f64 = 1.2;
/// How many times brighter one side of the plane of incidence must be, and in how many directions.
const CLEARLY: f64 = 1.5;
const FEW: usize = 3;

/// Refuses azimuths that may be in another unit than the other angles, or count from another plane.
///
/// # Errors
/// They may, with the option that settles it.
pub fn doubt(scan: &RawScan, unit: Angles, options: &ReadOptions) -> Result<(), Error> {
    let Some(column) = scan.places.phi else { return Ok(()) };
    let used = scan.about.columns.iter().find(|used| used.number as u64 == column);
    let has_unit = used.is_some_and(|used| Head::new(&used.name).unit.is_some());
    let found = if unit == Angles::Deg && options.angles.is_none() && !has_unit && may_be_radians(scan) {
        Some((
            "all azimuths are within 6.3 degrees, and some are no whole number; are they radians?".to_string(),
            "give all angles in one unit, or say --angles deg if all are degrees".to_string(),
        ))
    } else {
        let is_phi = |role: &Role| matches!(role, Role::PhiS | Role::PhiI | Role::Phi | Role::DeltaPhi);
        let given = options
            .columns
            .iter()
            .any(|(part, _)| matches!(part, Part::Role(role) if is_phi(role)));
        sides(scan, unit).filter(|_| !given).map(|times| {
            (
                format!(
                    "at azimuths of 90 degrees one side is {times:.2} times as bright as the other, where an isotropic sample has both alike: is this the plane of incidence?"
                ),
                format!("if so, leave the azimuth out with --ignore {column}, or subtract that of incidence; if not, say --columns delta_phi={column}"),
            )
        })
    };
    match found {
        None => Ok(()),
        Some((what, help)) => {
            let line = scan.rows.first().map_or(0, |row| row.line);
            Err(Error::new(what).help(help).at(line, Some(column)))
        }
    }
}

/// True of azimuths within a turn of radians, not all whole, over which the values differ.
fn may_be_radians(scan: &RawScan) -> bool {
    let azimuths = || {
        scan.rows
            .iter()
            .filter_map(|row| row.delta_phi)
            .filter(|phi| phi.is_finite())
    };
    if azimuths().any(|phi| phi.abs() > TAU + 5e-3) || azimuths().all(|phi| phi.fract() == 0.0) {
        return false;
    }
    let (low, high) = azimuths().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), phi| {
        (low.min(phi), high.max(phi))
    });
    if high - low < 1.0 {
        return false;
    }
    let mut ranges: HashMap<[u64; 2], (f64, f64, usize)> = HashMap::new();
    for row in scan.rows.iter().filter(|row| row.value > 0.0) {
        let range = ranges
            .entry([row.theta_i, row.theta_s].map(f64::to_bits))
            .or_insert((row.value, row.value, 0));
        *range = (range.0.min(row.value), range.1.max(row.value), range.2 + 1);
    }
    let mut several = ranges.values().filter(|(.., count)| *count > 1).peekable();
    several.peek().is_none() || several.any(|(low, high, _)| *high > SAME * low)
}

/// How many times as bright one side of the plane of incidence is as the other, at right angles to it, if it always is the same side.
fn sides(scan: &RawScan, unit: Angles) -> Option<f64> {
    // Thousandths of a degree.
    let key = |angle: f64| (unit.degrees(angle) * 1e3).round();
    let side = |row: &Row| -> Option<(i64, i64, bool)> {
        let phi = key(row.delta_phi?).rem_euclid(360e3);
        let is_left = match phi as i64 {
            90_000 => false,
            270_000 => true,
            _ => return None,
        };
        let theta_s = key(row.theta_s);
        let is_left = is_left != (theta_s < 0.0);
        let known = theta_s != 0.0 && row.value > 0.0 && row.theta_i.is_finite();
        known.then_some((key(row.theta_i) as i64, theta_s.abs() as i64, is_left))
    };
    let mut pairs: HashMap<(i64, i64), [f64; 2]> = HashMap::new();
    for row in &scan.rows {
        if let Some((theta_i, theta_s, is_left)) = side(row) {
            pairs.entry((theta_i, theta_s)).or_default()[usize::from(is_left)] = row.value;
        }
    }
    let pairs = pairs.into_values().filter(|[a, b]| *a > 0.0 && *b > 0.0);
    let ratios: Vec<f64> = pairs.map(|[a, b]| a / b).collect();
    let beyond = |turned: fn(f64) -> f64| ratios.iter().filter(|&&ratio| turned(ratio) > CLEARLY).count();
    let (right, left) = (beyond(|ratio| ratio), beyond(f64::recip));
    let most = ratios.iter().map(|ratio| ratio.max(ratio.recip())).fold(1.0, f64::max);
    (right.max(left) >= FEW && right.min(left) == 0).then_some(most)
}

#[cfg(test)]
mod tests {
    use super::super::{Error, ReadOptions, parse, part};

    fn read(text: &str, columns: &str) -> Result<usize, Error> {
        let options = ReadOptions {
            columns: columns
                .split_terminator(',')
                .map(|one| part::parse(one).unwrap())
                .collect(),
            ..ReadOptions::default()
        };
        parse("scan.csv", text.as_bytes(), &options).map(|scans| scans[0].samples.len())
    }

    #[test]
    fn radians_beside_degrees_are_asked_for() {
        let rows = |head: &str, value: fn(f64) -> f64| {
            let all = (0..31).flat_map(|k| [20.0, 40.0].map(|theta_s| (f64::from(k) / 10.0, theta_s)));
            let all = all.map(|(phi, theta_s)| format!("30,{theta_s},{phi},{}\n", value(phi)));
            format!("theta_i,theta_s,{head},brdf\n{}", all.collect::<String>())
        };
        let error = read(&rows("delta_phi", |phi| 0.1 + phi), "").unwrap_err();
        assert!(
            error.column == Some(3) && error.to_string().contains("are they radians"),
            "{error}"
        );
        assert_eq!(read(&rows("delta_phi_deg", |phi| 0.1 + phi), "").unwrap(), 62);
        assert_eq!(read(&rows("delta_phi", |_| 0.1), "").unwrap(), 62);
    }

    #[test]
    fn the_plane_of_incidence_at_an_azimuth_of_90_is_asked_for() {
        let scan = |phi: f64, value: fn(f64) -> f64| {
            let rows = (-8..=8).map(|k| f64::from(k) * 5.0);
            let rows = rows.map(|theta_s| format!("30,{theta_s},{phi},{}\n", value(theta_s)));
            rows.collect::<String>()
        };
        let one_sided: fn(f64) -> f64 = |theta_s| if theta_s > 15.0 { 0.4 } else { 0.1 };
        let both: fn(f64) -> f64 = |theta_s| if theta_s.abs() > 15.0 { 0.4 } else { 0.1 };
        let text = |value| format!("theta_i,theta_s,phi_s,brdf\n{}", scan(-90.0, value));
        let error = read(&text(one_sided), "").unwrap_err();
        assert!(
            error.column == Some(3) && error.to_string().contains("--ignore 3"),
            "{error}"
        );
        assert_eq!(read(&text(one_sided), "delta_phi=3").unwrap(), 17);
        assert_eq!(read(&text(both), "").unwrap(), 17);
        let apart = text(one_sided) + &scan(90.0, |theta_s| if theta_s < -15.0 { 0.4 } else { 0.1 });
        assert!(read(&apart, "").is_err());
    }
}
