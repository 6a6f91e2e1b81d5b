//! A slow oracle of the least cost in a box: plain interval arithmetic of Eq. 14 as it is written, and nothing but halving of boxes.
//!
//! It shares no formula with the proof: F is that of the complex amplitudes, ends are moved outward by the next numbers, and functions are those of std.

use std::ops::{Add, Div, Mul, Sub};

use brdfit::engine::certify::{Region, Scene};
use brdfit_core::geometry::{Geometry, Sample};

#[derive(Clone, Copy, Debug)]
struct Range(f64, f64);

impl Range {
    fn outward(lo: f64, hi: f64) -> Self {
        assert!(lo <= hi, "{lo} > {hi}");
        Range(lo.next_down(), hi.next_up())
    }

    /// std's functions are within one unit of the last place.
    fn of(self, f: fn(f64) -> f64) -> Self {
        Range(f(self.0).next_down().next_down(), f(self.1).next_up().next_up())
    }

    fn square(self) -> Self {
        let (a, b) = (self.0 * self.0, self.1 * self.1);
        let least = if self.0 <= 0.0 && self.1 >= 0.0 { 0.0 } else { a.min(b) };
        Range(least.next_down().max(0.0), a.max(b).next_up())
    }

    fn root(self) -> Self {
        Range(
            self.0.max(0.0).sqrt().next_down().max(0.0),
            self.1.max(0.0).sqrt().next_up(),
        )
    }
}

impl Add for Range {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Range::outward(self.0 + other.0, self.1 + other.1)
    }
}

impl Sub for Range {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Range::outward(self.0 - other.1, self.1 - other.0)
    }
}

impl Mul for Range {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let all = [self.0 * other.0, self.0 * other.1, self.1 * other.0, self.1 * other.1];
        let least = all.into_iter().fold(f64::INFINITY, f64::min);
        let most = all.into_iter().fold(f64::NEG_INFINITY, f64::max);
        Range::outward(least, most)
    }
}

/// By positive numbers.
impl Div for Range {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        assert!(other.0 > 0.0, "{other:?} contains 0");
        self * Range::outward(1.0 / other.1, 1.0 / other.0)
    }
}

/// F = |r_s|^2 (1 + |t|^2) / 2, r_s = (c - p)/(c + p), t = (c p - s^2)/(c p + s^2), p = sqrt(eps - s^2).
fn reflectance(c: f64, n: Range, kappa: Range) -> Range {
    let (c, half) = (Range(c, c), Range(0.5, 0.5));
    let (one, two) = (Range(1.0, 1.0), Range(2.0, 2.0));
    let s2 = one - c.square();
    let re = n.square() - kappa.square() - s2;
    let size = (re.square() + (two * n * kappa).square()).root();
    let (p, q) = (((size + re) * half).root(), ((size - re) * half).root());
    let r_s = ((c - p).square() + q.square()) / ((c + p).square() + q.square());
    let t = ((c * p - s2).square() + (c * q).square()) / ((c * p + s2).square() + (c * q).square());
    r_s * (one + t) * half
}

/// What the oracle says of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// No cost in it is below the target.
    Above,
    /// Some cost in it is.
    Below,
    /// Not known after so many halvings.
    Open,
}

/// Whether the cost of `samples`, all of weight 1, can be below `target` in a box that is open on no side.
pub fn verdict(scene: &Scene, samples: &[Sample<f64>], region: &Region, target: f64, most: usize) -> Verdict {
    let geometries: Vec<_> = samples
        .iter()
        .map(|sample| Geometry::new(sample.theta_i, sample.theta_s, sample.delta_phi).expect("a valid sample"))
        .collect();
    let mut open = vec![(region.lo, region.hi)];
    for _ in 0..most {
        let Some((lo, hi)) = open.pop() else {
            return Verdict::Above;
        };
        let (least, largest, spread) = cost(scene, samples, &geometries, &lo, &hi);
        if largest < target {
            return Verdict::Below;
        }
        if least >= target {
            continue;
        }
        let widest = (0..6)
            .max_by(|&a, &b| spread[a].total_cmp(&spread[b]))
            .expect("six coordinates");
        let middle = 0.5 * (lo[widest] + hi[widest]);
        let (mut below, mut above) = ((lo, hi), (lo, hi));
        below.1[widest] = middle;
        above.0[widest] = middle;
        open.extend([below, above]);
    }
    Verdict::Open
}

/// The least and the largest cost, and how far each coordinate moves ln f.
fn cost(
    scene: &Scene,
    samples: &[Sample<f64>],
    geometries: &[Geometry<f64>],
    lo: &[f64; 6],
    hi: &[f64; 6],
) -> (f64, f64, [f64; 6]) {
    let at = |i: usize| Range(lo[i], hi[i]);
    // An absent part has two ends of minus infinity.
    let width = |i: usize| if lo[i] == hi[i] { 0.0 } else { hi[i] - lo[i] };
    let n = at(4).of(f64::exp);
    let kappa = (at(5).of(f64::exp) - Range(1.0, 1.0)).root();
    let reference = scene.reference_cosines().map(|c| reflectance(c, n, kappa));
    if reference.iter().any(|f| f.0 <= 0.0) {
        // Too wide a range of indices for the oracle to say anything.
        return (0.0, f64::INFINITY, [0.0, 0.0, 0.0, 0.0, width(4), width(5)]);
    }
    let (mut least, mut most, mut spread) = (Range(0.0, 0.0), Range(0.0, 0.0), [0.0; 6]);
    for (sample, geometry) in samples.iter().zip(geometries) {
        let pi = Range(std::f64::consts::PI.next_down(), std::f64::consts::PI.next_up());
        let lambert = at(0).of(f64::exp) / pi;
        let mut f = lambert;
        for (k, lobe) in geometry.lobes.iter().enumerate() {
            let slope = Range(lobe.tan2_theta_h, lobe.tan2_theta_h);
            let ratio = reflectance(lobe.cos_theta_d, n, kappa) / reference[k];
            let factor = Range(lobe.factor, lobe.factor);
            let part = (at(1 + k) - slope * at(3)).of(f64::exp) * ratio * factor;
            f = f + part;
            spread[1 + k] += (part.1 / f.0) * width(1 + k);
            spread[3] += (part.1 / f.0).min(1.0) * lobe.tan2_theta_h * width(3);
            let index = (part.1 / f.0).min(1.0) * (ratio.1 / ratio.0).ln().min(20.0);
            let (a, b) = (width(4), width(5));
            spread[4] += index * a / (a + b).max(1e-300);
            spread[5] += index * b / (a + b).max(1e-300);
        }
        spread[0] += (lambert.1 / f.0).min(1.0) * width(0);
        let residual = f.of(f64::ln) - Range(sample.brdf, sample.brdf).of(f64::ln);
        let square = residual.square();
        least = least + Range(square.0, square.0);
        most = most + Range(square.1, square.1);
    }
    (least.0, most.1, spread)
}
