//! The reflectance of Eq. 14 in every corner, against integrals over the facets in polar coordinates, cut where numbers show a kink.
#![allow(
    clippy::disallowed_methods,
    reason = "oracles may use std's functions; the code under test may not"
)]

use std::f64::consts::PI;

use brdfit::analysis::reflectance::reflectance;
use brdfit::engine::Material;
use brdfit_suite::literal;
use brdfit_suite::tolerance::{self, check};

/// Abscissas and weights of Gauss's rule of eight on -1 to 1, those of one side.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
];

fn gauss(f: &mut impl FnMut(f64) -> f64, ends: &[f64]) -> f64 {
    let mut sum = 0.0;
    for part in ends.windows(2) {
        let (middle, half) = (0.5 * (part[0] + part[1]), 0.5 * (part[1] - part[0]));
        for (x, weight) in GAUSS {
            sum += weight * half * (f(middle - x * half) + f(middle + x * half));
        }
    }
    sum
}

/// From 0 to `end`, ever denser towards both ends, in `parts` for each halving.
fn graded(end: f64, parts: u32) -> Vec<f64> {
    let mut list = vec![0.0, end];
    for k in parts..=24 * parts {
        let x = 0.5 * end * (-f64::from(k - parts) / f64::from(parts)).exp2();
        list.extend([x, end - x]);
    }
    list.sort_by(f64::total_cmp);
    list.dedup();
    list
}

/// A facet, by the tangent of its tilt and its azimuth, 0 towards the forward direction.
struct Facet {
    theta_h: f64,
    cos_d: f64,
    cos_s: f64,
}

impl Facet {
    fn new(theta_i: f64, tangent: f64, azimuth: f64) -> Self {
        let theta_h = tangent.atan();
        let cos_d = theta_i.cos() * theta_h.cos() - theta_i.sin() * theta_h.sin() * azimuth.cos();
        Facet {
            theta_h,
            cos_d,
            cos_s: 2.0 * cos_d * theta_h.cos() - theta_i.cos(),
        }
    }

    /// Numbers that change sign where the horizon, or a kink of Eq. 9, is.
    fn signs(&self, theta_i: f64) -> [f64; 5] {
        let twice = 2.0 * self.theta_h.cos();
        [
            self.cos_d,
            self.cos_s,
            self.cos_s - theta_i.cos(),
            twice * self.cos_s - self.cos_d,
            twice * theta_i.cos() - self.cos_d,
        ]
    }
}

/// The reflectance of the surface or of the volume lobe, of weight 1.
fn of_lobe(volume: bool, m: f64, n: f64, kappa: f64, theta_i: f64, parts: u32) -> f64 {
    let part = |tangent: f64, azimuth: f64| {
        let facet = Facet::new(theta_i, tangent, azimuth);
        let Facet { theta_h, cos_d, cos_s } = facet;
        if cos_d <= 0.0 || cos_s <= 0.0 {
            return 0.0;
        }
        let (theta_d, theta_s) = (cos_d.min(1.0).acos(), cos_s.min(1.0).acos());
        let lobe = literal::beckmann(theta_h, m) * literal::fresnel(theta_d, n, kappa);
        let f = if volume {
            lobe
        } else {
            lobe * literal::sigma(theta_i, theta_s) * literal::blinn(theta_i, theta_s, theta_h, theta_d)
        };
        // d omega_s = 4 cos theta_d d omega_h, and d omega_h = cos^3 theta_h tan theta_h d tan theta_h d azimuth.
        f * cos_s * 4.0 * cos_d * theta_h.cos().powi(3) * tangent
    };
    let radii = graded(6.0 * m, parts);
    let mut ray = |azimuth: f64| {
        let signs = |tangent: f64| Facet::new(theta_i, tangent, azimuth).signs(theta_i);
        let mut ends = radii.clone();
        for pair in radii.windows(2) {
            let (low, high) = (signs(pair[0]), signs(pair[1]));
            for k in (0..5).filter(|&k| low[k] * high[k] < 0.0) {
                let (mut a, mut b) = (pair[0], pair[1]);
                for _ in 0..60 {
                    let middle = 0.5 * (a + b);
                    if signs(middle)[k] * low[k] > 0.0 {
                        a = middle
                    } else {
                        b = middle
                    }
                }
                ends.push(0.5 * (a + b));
            }
        }
        ends.sort_by(f64::total_cmp);
        gauss(&mut |tangent| part(tangent, azimuth), &ends)
    };
    // At grazing incidence kinks come together where the facet is tilted across the plane.
    let quarter = graded(0.5 * PI, parts);
    let half = quarter.iter().chain(&quarter[1..]).zip(0..);
    let half: Vec<f64> = half
        .map(|(azimuth, place)| azimuth + if place < quarter.len() { 0.0 } else { 0.5 * PI })
        .collect();
    2.0 * gauss(&mut ray, &half)
}

#[test]
fn corners_of_the_reflectance() {
    // Where the oracle is worst, with more parts.
    let worst_of_oracle = [(85.0f64, 2.0), (89.5, 2.0), (89.5, 0.3)].map(|(theta_i, m)| {
        let of = |parts| of_lobe(false, m, 1.5, 0.0, theta_i.to_radians(), parts);
        (of(2) / of(3) - 1.0).abs()
    });
    check(
        worst_of_oracle.into_iter().fold(0.0, f64::max),
        tolerance::REFLECTANCE_ORACLE,
    );
    let mut worst = 0.0f64;
    let all: &[f64] = &[1e-5, 1e-3, 0.02, 0.3, 2.0, 10.0];
    // Between, where wide facets see all kinks.
    let wide = [(19.0, 1.15), (28.65, 0.49), (54.3, 0.62)];
    let corners = [0.0f64, 85.0, 89.5].map(|theta_i| (theta_i, all));
    for (theta_i, slopes) in corners
        .into_iter()
        .chain(wide.iter().map(|(theta_i, m)| (*theta_i, std::slice::from_ref(m))))
    {
        let theta_i = theta_i.to_radians();
        for &m in slopes {
            for (n, kappa) in [(1.5, 0.0), (1.01, 3.0)] {
                for volume in [false, true] {
                    let slow = of_lobe(volume, m, n, kappa, theta_i, 2);
                    let rho = if volume { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] };
                    let material = Material::paper([rho[0], rho[1], rho[2], m, n, kappa]);
                    let off = (reflectance(&material, theta_i).0 / slow - 1.0).abs();
                    println!(
                        "{:.1} deg, m {m:e}, n {n}, volume {volume}: {slow:.9}, off {off:.1e}",
                        theta_i.to_degrees()
                    );
                    worst = worst.max(off);
                }
            }
        }
    }
    check(worst, tolerance::REFLECTANCE_CORNERS);
}
