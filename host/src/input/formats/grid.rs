//! What formats have in common that must fill a grid of directions: nodes without a measurement, and directions that stand there twice.

use std::collections::HashMap;

use crate::input::left_out::Reason;
use crate::input::raw::{RawScan, Row};

/// Degrees from the normal from which on there is no BRDF; angles in radians have about six decimals.
const HORIZON: f64 = 90.0 - 1e-4;

/// Adds a node to a scan, or counts it as left out: where its value is 0 nothing was measured, and the horizon has no BRDF.
pub fn add(scan: &mut RawScan, row: Row) {
    let theta_i = scan.angles.degrees(row.theta_i);
    if theta_i >= HORIZON || scan.angles.degrees(row.theta_s.abs()) >= HORIZON {
        scan.left_out.add(Reason::Horizon, theta_i);
    } else if row.value == 0.0 {
        scan.left_out.add(Reason::NotMeasured, theta_i);
    } else {
        scan.rows.push(row);
    }
}

/// Azimuths of a grid, and which of them are the same direction.
pub struct Azimuths {
    /// As they stand in the file, degrees.
    pub degrees: Vec<f64>,
    /// For each the place of the first that is the same direction.
    first: Vec<usize>,
}

impl Azimuths {
    /// Finds those that differ by whole turns.
    pub fn new(degrees: Vec<f64>) -> Azimuths {
        let mut places = HashMap::new();
        let turned = degrees
            .iter()
            .map(|azimuth| (azimuth.rem_euclid(360.0) + 0.0).to_bits());
        let first = turned
            .enumerate()
            .map(|(place, bits)| *places.entry(bits).or_insert(place))
            .collect();
        Azimuths { degrees, first }
    }

    /// True if an earlier azimuth has this direction, at `polar` from its pole, with the same value already.
    pub fn repeats(&self, polar: f64, place: usize, values: &[f64]) -> bool {
        let first = if polar == 0.0 { 0 } else { self.first[place] };
        first < place && values[first] == values[place]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::raw::Weight;
    use crate::input::units::Angles;

    #[test]
    fn directions_that_stand_there_twice_are_taken_once() {
        let azimuths = Azimuths::new(vec![0.0, 180.0, 360.0, -180.0]);
        let same = [1.0; 4];
        let repeats = |polar: f64, values: &[f64]| [0, 1, 2, 3].map(|place| azimuths.repeats(polar, place, values));
        assert_eq!(repeats(30.0, &same), [false, false, true, true]);
        assert_eq!(repeats(0.0, &same), [false, true, true, true]);
        assert_eq!(repeats(30.0, &[1.0, 1.0, 2.0, 1.0]), [false, false, false, true]);
    }

    #[test]
    fn nodes_without_a_measurement_are_counted() {
        let horizon: f64 = "1.570796".parse().unwrap();
        let mut scan = RawScan::new(Vec::new(), Angles::Rad);
        for (theta_s, value) in [(0.5, 0.0), (horizon, 1.0), (0.5, 2.0), (-0.5, -1.0)] {
            let row = Row {
                theta_i: 0.25,
                theta_s,
                delta_phi: None,
                value,
                weight: Weight::Unknown,
                line: 1,
            };
            add(&mut scan, row);
        }
        let values: Vec<f64> = scan.rows.iter().map(|row| row.value).collect();
        assert_eq!(values, [2.0, -1.0]);
        let left_out = scan.left_out.list();
        let reasons: Vec<_> = left_out.iter().map(|one| (one.reason, one.samples)).collect();
        assert_eq!(reasons, [(Reason::NotMeasured, 1), (Reason::Horizon, 1)]);
    }
}
