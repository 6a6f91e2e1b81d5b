//! MERL `.binary`: reflectance of isotropic materials over half angle and difference angles, in three colours.

use crate::error::Error;
use crate::input::direction::of_half_angles;
use crate::input::format::{Format, Reader};
use crate::input::options::ReadOptions;
use crate::input::raw::{RawScan, Row, Weight};
use crate::input::units::Angles;

/// This format.
pub const FORMAT: Format = Format {
    name: "merl",
    title: "MERL binary",
    about: "MERL binary",
    reader: Reader::Bytes { is, read },
};

/// Bins of theta_h, theta_d and phi_d.
const BINS: [usize; 3] = [90, 90, 180];
const COUNT: usize = BINS[0] * BINS[1] * BINS[2];
const HEADER: usize = 12;
const COLOURS: [(&str, f64); 3] = [("R", 1.0 / 1500.0), ("G", 1.15 / 1500.0), ("B", 1.66 / 1500.0)];
/// One in so many bins is taken of a whole file; a prime, so that all rows of bins are met alike.
const THIN: u32 = 97;

/// True if the file begins with the numbers of its bins.
fn is(file: &[u8]) -> bool {
    let header = BINS.map(|bins| (bins as u32).to_le_bytes()).concat();
    file.starts_with(&header)
}

/// One scan for each of R, G and B: directions in plane at theta_i = 10, 20, ... 80 degrees, or one in 97 of all bins.
///
/// Bins that hold no positive number were not measured.
///
/// # Errors
/// The file is no MERL file, or has another size.
fn read(file: &[u8], options: &ReadOptions) -> Result<Vec<RawScan>, Error> {
    let size = HEADER + COLOURS.len() * COUNT * 8;
    if !is(file) || file.len() != size {
        let what = format!(
            "this is no MERL file: it has {} bytes, not {size} after 90, 90, 180",
            file.len()
        );
        return Err(Error::new(what).help("is the file cut off? Take --input-format for other formats"));
    }
    let places = if options.merl_whole {
        whole(options.thin.unwrap_or(THIN))
    } else {
        in_plane(options.thin.unwrap_or(1))
    };
    let scan = |(plane, (name, scale)): (usize, (&str, f64))| {
        let row = |place: &Place| {
            let at = HEADER + (plane * COUNT + place.bin) * 8;
            let raw = f64::from_le_bytes(file[at..at + 8].try_into().ok()?);
            (raw > 0.0).then_some(Row {
                theta_i: place.theta_i,
                theta_s: place.theta_s,
                delta_phi: place.delta_phi,
                value: raw * scale,
                weight: Weight::Unknown,
                line: 0,
            })
        };
        RawScan {
            rows: places.iter().filter_map(row).collect(),
            ..RawScan::new(vec![name.to_string()], Angles::Deg)
        }
    };
    Ok(COLOURS.into_iter().enumerate().map(scan).collect())
}

/// A bin and its angles in degrees.
struct Place {
    bin: usize,
    theta_i: f64,
    theta_s: f64,
    delta_phi: Option<f64>,
}

/// The middle of bin `i` of theta_h, whose width grows from the peak on.
fn theta_h(i: usize) -> f64 {
    let half = i as f64 + 0.5;
    half * half / BINS[0] as f64
}

/// In plane theta_h = |theta_s - theta_i| / 2 and theta_d = |theta_s + theta_i| / 2: theta_h is the middle of its bin, theta_d within half a degree of it.
fn in_plane(thin: u32) -> Vec<Place> {
    let mut places = Vec::new();
    for theta_i in (10..=80).step_by(10).map(f64::from) {
        let bins = (0..BINS[0])
            .rev()
            .map(|i| (i, -1.0))
            .chain((0..BINS[0]).map(|i| (i, 1.0)));
        for (i, side) in bins {
            let theta_s = theta_i + side * 2.0 * theta_h(i);
            let j = ((theta_s + theta_i).abs() / 2.0) as usize;
            if theta_s.abs() < 90.0 && j < BINS[1] {
                places.push(Place {
                    bin: BINS[2] * (j + BINS[1] * i),
                    theta_i,
                    theta_s,
                    delta_phi: None,
                });
            }
        }
    }
    places.into_iter().step_by(thin as usize).collect()
}

/// Middles of bins, of which those with a direction below the surface are left out.
fn whole(thin: u32) -> Vec<Place> {
    let middle = |bin: usize| {
        let (k, j, i) = (bin % BINS[2], bin / BINS[2] % BINS[1], bin / BINS[2] / BINS[1]);
        let (theta_i, theta_s, delta_phi) = of_half_angles(theta_h(i), j as f64 + 0.5, k as f64 + 0.5);
        (theta_i < 90.0 && theta_s < 90.0).then_some(Place {
            bin,
            theta_i,
            theta_s,
            delta_phi: Some(delta_phi),
        })
    };
    (0..COUNT).step_by(thin as usize).filter_map(middle).collect()
}

#[cfg(test)]
mod tests {
    use libm::{atan2, sqrt};

    use super::*;
    use crate::input::direction::vectors;

    /// A file whose value in each bin is `value` of theta_h, theta_d and phi_d, the middles in degrees; G has twice and B three times as much as R.
    fn file(value: impl Fn(f64, f64, f64) -> f64) -> Vec<u8> {
        let mut file = BINS.map(|bins| (bins as u32).to_le_bytes()).concat();
        for (colour, (_, scale)) in (1..).map(f64::from).zip(COLOURS) {
            for bin in 0..COUNT {
                let (k, j, i) = (bin % 180, bin / 180 % 90, bin / 180 / 90);
                let raw = colour * value(theta_h(i), j as f64 + 0.5, k as f64 + 0.5) / scale;
                file.extend(raw.to_le_bytes());
            }
        }
        file
    }

    /// theta_h, theta_d and phi_d in degrees of two directions, by vectors (Rusinkiewicz 1998).
    fn half_angles(row: &Row) -> [f64; 3] {
        let [i, s] = vectors(row.theta_i, row.theta_s, row.delta_phi);
        let sum: [f64; 3] = std::array::from_fn(|k| i[k] + s[k]);
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let length = sqrt(dot(sum, sum));
        let h = sum.map(|x| x / length);
        let degrees = |x: f64, y: f64| atan2(y, x).to_degrees();
        let across = sqrt(h[0] * h[0] + h[1] * h[1]);
        let (east, north) = if across > 0.0 {
            let (cos, sin) = (h[0] / across, h[1] / across);
            ([cos * h[2], sin * h[2], -across], [-sin, cos, 0.0])
        } else {
            ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
        };
        let (x, y, z) = (dot(i, east), dot(i, north), dot(i, h));
        [
            degrees(h[2], across),
            degrees(z, sqrt(x * x + y * y)),
            degrees(x, y).rem_euclid(180.0),
        ]
    }

    #[test]
    fn directions_fall_into_the_bins_that_they_are_read_from() {
        // The value tells the bin.
        let file = file(|h, d, p| 1.0 + h + 100.0 * d + 1e5 * p);
        assert!(is(&file));
        for merl_whole in [false, true] {
            let options = ReadOptions {
                merl_whole,
                ..ReadOptions::default()
            };
            let scans = read(&file, &options).unwrap();
            assert_eq!(
                scans.iter().map(|scan| scan.names[0].as_str()).collect::<Vec<_>>(),
                ["R", "G", "B"]
            );
            assert!(scans[0].rows.len() > 900, "{}", scans[0].rows.len());
            for (row, green) in scans[0].rows.iter().zip(&scans[1].rows) {
                assert!((green.value / row.value - 2.0).abs() < 1e-12);
                let [h, d, p] = half_angles(row);
                let rest = row.value - 1.0 - 1e5 * (p.floor() + 0.5);
                let in_bin = |rest: f64| (rest - 100.0 * (d.floor() + 0.5) - h).abs() < 1e-6;
                assert!(in_bin(rest), "{row:?} {h} {d} {p}");
            }
        }
    }
    #[test]
    fn what_was_not_measured_is_left_out_and_other_sizes_refused() {
        let whole = file(|h, _, _| if h < 10.0 { 1.0 } else { -1.0 });
        let scans = read(&whole, &ReadOptions::default()).unwrap();
        assert!(
            scans[0]
                .rows
                .iter()
                .all(|row| (row.theta_s - row.theta_i).abs() < 20.0 && row.value > 0.0)
        );
        assert!(read(&whole[..whole.len() - 1], &ReadOptions::default()).is_err());
        assert!(!is(b"theta_i,theta_s,brdf"));
    }
}
