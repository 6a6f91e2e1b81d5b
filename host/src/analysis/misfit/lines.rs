//! Samples in the order in which a scatterometer meets them: lines of one angle of incidence.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use brdfit_core::geometry::Sample;

/// Angles within this, radians, are one: a thousandth of a degree.
const SAME: f64 = 1.7e-5;

/// The lines of samples of weight above 0, each with the places of its samples and their angles in radians, ascending.
///
/// A line is what one angle of incidence has in one plane through the normal, with theta_s positive forward; or, where that leaves hardly two samples a line, what it has at one theta_s, with the azimuth.
pub fn of(samples: &[Sample<f64>]) -> Vec<Vec<(usize, f64)>> {
    let counted = samples.iter().filter(|sample| sample.weight != 0.0).count();
    let meridians = grouped(samples, |sample| {
        let azimuth = sample.delta_phi.rem_euclid(TAU);
        let forward = azimuth > FRAC_PI_2 - SAME && azimuth < PI + FRAC_PI_2 - SAME;
        let plane = (azimuth + SAME).rem_euclid(PI);
        // At the normal every plane is the same.
        let signed = if forward { sample.theta_s } else { -sample.theta_s };
        ([sample.theta_i, plane], signed)
    });
    if 3 * meridians.len() <= counted {
        return meridians;
    }
    let circles = grouped(samples, |sample| {
        let turned = sample.delta_phi.rem_euclid(TAU);
        (
            [sample.theta_i, sample.theta_s],
            turned * libm::sin(sample.theta_s.abs()),
        )
    });
    if circles.len() < meridians.len() {
        circles
    } else {
        meridians
    }
}

fn grouped(samples: &[Sample<f64>], key: impl Fn(&Sample<f64>) -> ([f64; 2], f64)) -> Vec<Vec<(usize, f64)>> {
    let counted = samples.iter().enumerate().filter(|(_, sample)| sample.weight != 0.0);
    let mut all: Vec<([i64; 2], f64, usize)> = counted
        .map(|(place, sample)| {
            let (line, angle) = key(sample);
            (line.map(|x| (x / SAME / 2.0).round() as i64), angle, place)
        })
        .collect();
    all.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
    let lines = all.chunk_by(|a, b| a.0 == b.0);
    lines
        .map(|line| line.iter().map(|&(_, angle, place)| (place, angle)).collect())
        .collect()
}
