//! Random scans on which a search can go wrong, each kind for one reason.

use brdfit_core::brdf::{ALL, Brdf, Params};
use brdfit_core::geometry::{Geometry, Sample};
use brdfit_core::real::Real;

use crate::random_scenes::{self, Random};

/// Why a scan is hard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Not hard: [`random_scenes::scene`].
    Ordinary,
    /// Not hard: other numbers, directions out of the plane, weights.
    New,
    /// m of 1e-4 to 3e-3 on a grid of 1 degree.
    Mirror,
    /// m of 0.001 to 0.02, sampled finely around a peak that lies between the samples.
    Narrow,
    /// m of 1 to 10.
    Rough,
    /// A surface lobe with GGX's tails, two slopes, or a smooth ripple on the scan.
    Misfit,
    /// No model at all: a random walk, or white noise.
    Walk,
    /// Parameters held fixed, or within narrow bounds.
    Bounded,
    /// 8 to 30 samples.
    Sparse,
    /// Lobes that hardly rise above the diffuse term and the noise.
    Lambert,
    /// A few samples stand out by themselves.
    Needle,
    /// Any of these, fitted in single precision.
    Single,
}

/// All kinds.
pub const KINDS: [Kind; 12] = [
    Kind::Ordinary,
    Kind::New,
    Kind::Mirror,
    Kind::Narrow,
    Kind::Rough,
    Kind::Misfit,
    Kind::Walk,
    Kind::Bounded,
    Kind::Sparse,
    Kind::Lambert,
    Kind::Needle,
    Kind::Single,
];

/// A scan with the bounds of its fit.
#[derive(Clone, Debug)]
pub struct Task {
    /// The scan.
    pub samples: Vec<Sample<f64>>,
    /// Least parameters.
    pub lower: Params<f64>,
    /// Largest parameters.
    pub upper: Params<f64>,
}

/// Table 1.
const LOWER: [f64; 6] = [0.0, 0.0, 0.0, 1e-5, 1.0, 0.0];
const UPPER: [f64; 6] = [1.0, 100.0, 100.0, 10.0, 100.0, 100.0];

/// Task `k` of a kind; the same for the same numbers.
pub fn task(kind: Kind, k: u64) -> Task {
    let random = &mut Random::new(0x5eed_0000 + ((kind as u64) << 40) + k);
    let free = |samples| Task {
        samples,
        lower: Params::from_array(LOWER),
        upper: Params::from_array(UPPER),
    };
    match kind {
        Kind::Ordinary => free(random_scenes::scene(k)),
        Kind::New => free(new(random)),
        Kind::Mirror => free(mirror(random)),
        Kind::Narrow => free(narrow(random)),
        Kind::Rough => free(rough(random)),
        Kind::Misfit => free(misfit(random)),
        Kind::Walk => free(walk(random)),
        Kind::Bounded => bounded(random),
        Kind::Sparse => free(sparse(random)),
        Kind::Lambert => free(lambert(random)),
        Kind::Needle => free(needle(random)),
        Kind::Single => task(KINDS[(k % 11) as usize], 0x8000_0000 + k / 11),
    }
}

/// Parameters of an ordinary surface with a slope in this range.
fn params(random: &mut Random, m: [f64; 2]) -> Params<f64> {
    Params {
        rho_d: random.log_between(1e-4, 0.9),
        rho_s: random.log_between(0.01, 30.0),
        rho_v: if random.one_in(0.3) {
            0.0
        } else {
            random.log_between(1e-4, 2.0)
        },
        m: random.log_between(m[0], m[1]),
        n: 1.0 + random.log_between(0.03, 4.0),
        kappa: if random.one_in(0.4) {
            0.0
        } else {
            random.log_between(0.05, 10.0)
        },
    }
}

/// One to `most` angles of incidence, whole degrees.
fn angles(random: &mut Random, most: f64) -> Vec<f64> {
    let count = 1 + (random.unit() * most) as usize;
    (0..count).map(|_| random.between(0.0, 80.0).round()).collect()
}

/// Directions in the plane, degrees: each angle of incidence with theta_s in steps.
fn grid(theta_i: &[f64], step: f64) -> Vec<[f64; 3]> {
    let count = (170.0 / step) as usize;
    let row = |&theta_i: &f64| (0..=count).map(move |j| [theta_i, -85.0 + step * j as f64, 180.0]);
    theta_i.iter().flat_map(row).collect()
}

fn geometry([theta_i, theta_s, delta_phi]: [f64; 3]) -> Geometry<f64> {
    let delta_phi = if delta_phi == 180.0 {
        f64::PI
    } else {
        delta_phi.to_radians()
    };
    Geometry::new(theta_i.to_radians(), theta_s.to_radians(), delta_phi).expect("above the horizon")
}

fn ln_f(params: &Params<f64>, geometry: &Geometry<f64>) -> f64 {
    Brdf::<f64, ALL>::new(params).ln_f(geometry)
}

/// A scan of ln f in these directions; what a scatterometer could not tell from 0 is at its floor.
fn scan(directions: &[[f64; 3]], mut ln_f: impl FnMut([f64; 3], &Geometry<f64>) -> f64) -> Vec<Sample<f64>> {
    let sample = |&direction: &[f64; 3]| {
        let [theta_i, theta_s, delta_phi] = direction;
        Sample {
            theta_i: theta_i.to_radians(),
            theta_s: theta_s.to_radians(),
            delta_phi: if delta_phi == 180.0 {
                f64::PI
            } else {
                delta_phi.to_radians()
            },
            brdf: Real::portable_exp(ln_f(direction, &geometry(direction)).max(-30.0)),
            weight: 1.0,
        }
    };
    directions.iter().map(sample).collect()
}

/// The model with log-normal noise.
fn noisy(random: &mut Random, directions: &[[f64; 3]], params: &Params<f64>) -> Vec<Sample<f64>> {
    let noise = random.log_between(0.003, 0.2);
    scan(directions, |_, geometry| {
        ln_f(params, geometry) + noise * random.normal()
    })
}

fn new(random: &mut Random) -> Vec<Sample<f64>> {
    let params = params(random, [0.008, 0.9]);
    let mut directions = Vec::new();
    if random.one_in(0.3) {
        for _ in 0..60 + (random.unit() * 300.0) as usize {
            directions.push([
                random.between(0.0, 75.0),
                random.between(0.0, 80.0),
                random.between(0.0, 180.0),
            ]);
        }
    } else {
        let step = random.between(0.5, 3.0);
        directions = grid(&angles(random, 4.0), step);
        for direction in &mut directions {
            direction[1] += random.between(-0.3, 0.3);
        }
    }
    let mut samples = noisy(random, &directions, &params);
    if random.one_in(0.3) {
        for sample in &mut samples {
            sample.weight = random.log_between(0.2, 5.0);
        }
    }
    samples
}

fn mirror(random: &mut Random) -> Vec<Sample<f64>> {
    let params = params(random, [1e-4, 3e-3]);
    let directions = grid(&angles(random, 4.0), 1.0);
    noisy(random, &directions, &params)
}

fn narrow(random: &mut Random) -> Vec<Sample<f64>> {
    let params = params(random, [1e-3, 0.02]);
    let theta_i = random.between(5.0, 70.0);
    let step = random.log_between(0.05, 1.0);
    let mut directions = grid(&[theta_i], 2.0);
    directions.extend((-10..=10).map(|j| [theta_i, theta_i + step * (f64::from(j) + random.unit()), 180.0]));
    noisy(random, &directions, &params)
}

fn rough(random: &mut Random) -> Vec<Sample<f64>> {
    let params = params(random, [1.0, 10.0]);
    let step = if random.one_in(0.5) { 1.0 } else { 2.0 };
    let directions = grid(&angles(random, 4.0), step);
    noisy(random, &directions, &params)
}

fn misfit(random: &mut Random) -> Vec<Sample<f64>> {
    let params = params(random, [0.004, 0.6]);
    let directions = grid(&angles(random, 4.0), if random.one_in(0.5) { 1.0 } else { 2.0 });
    let noise = random.log_between(0.003, 0.1);
    let kind = (random.unit() * 3.0) as u32;
    let wide = Params {
        rho_d: 0.0,
        rho_v: 0.0,
        m: params.m * random.log_between(1.5, 10.0),
        rho_s: params.rho_s * random.log_between(0.02, 2.0),
        ..params
    };
    let surface = Params {
        rho_d: 0.0,
        rho_v: 0.0,
        ..params
    };
    let rest = Params { rho_s: 0.0, ..params };
    let (height, period, phase) = (
        random.log_between(0.05, 1.0),
        random.log_between(5.0, 80.0),
        random.unit(),
    );
    scan(&directions, |direction, geometry| {
        let clean = match kind {
            0 => {
                // D of GGX over that of Beckmann is exp(x) / (1 + x)^2.
                let x = geometry.surface().tan2_theta_h / (params.m * params.m);
                let ln_ggx = ln_f(&surface, geometry).max(-700.0 - x) + x - 2.0 * Real::portable_ln(1.0 + x);
                Real::portable_ln(Real::portable_exp(ln_f(&rest, geometry)) + Real::portable_exp(ln_ggx.min(700.0)))
            }
            1 => Real::portable_ln(
                Real::portable_exp(ln_f(&params, geometry)) + Real::portable_exp(ln_f(&wide, geometry)),
            ),
            _ => {
                let turns = direction[1] / period + phase;
                let ripple = Real::portable_sin_cos(std::f64::consts::TAU * (turns - turns.floor())).0;
                ln_f(&params, geometry) + height * ripple
            }
        };
        clean + noise * random.normal()
    })
}

fn walk(random: &mut Random) -> Vec<Sample<f64>> {
    let directions = grid(&angles(random, 3.0), if random.one_in(0.5) { 1.0 } else { 2.0 });
    let height = random.log_between(0.05, 3.0);
    let white = random.one_in(0.3);
    let mut level = random.between(-5.0, 1.0);
    scan(&directions, |_, _| {
        let step = height * random.normal();
        if white {
            level + step
        } else {
            level = (level + 0.3 * step).clamp(-20.0, 5.0);
            level
        }
    })
}

fn bounded(random: &mut Random) -> Task {
    let truth = params(random, [1e-3, 1.0]);
    let step = if random.one_in(0.5) { 1.0 } else { 2.0 };
    let directions = grid(&angles(random, 3.0), step);
    let samples = noisy(random, &directions, &truth);
    let (mut lower, mut upper) = (LOWER, UPPER);
    let truth = truth.to_array();
    for _ in 0..1 + (random.unit() * 2.5) as usize {
        let index = ((random.unit() * 6.0) as usize).min(5);
        let off = if random.one_in(0.4) {
            1.0
        } else {
            random.log_between(0.3, 3.0)
        };
        let least = if index == 4 { 1.0 } else { LOWER[index] };
        let centre = (truth[index] * off).clamp(least, UPPER[index]);
        let width = if random.one_in(0.5) {
            1.0
        } else {
            random.log_between(1.01, 2.0)
        };
        lower[index] = (centre / width).max(LOWER[index]);
        upper[index] = (centre * width).min(UPPER[index]);
    }
    Task {
        samples,
        lower: Params::from_array(lower),
        upper: Params::from_array(upper),
    }
}

fn sparse(random: &mut Random) -> Vec<Sample<f64>> {
    let params = params(random, [0.01, 1.0]);
    let count = 8 + (random.unit() * 23.0) as usize;
    let theta_i = angles(random, 2.0);
    let regular = random.one_in(0.5);
    let direction = |j: usize, random: &mut Random| {
        let even = -80.0 + 160.0 * j as f64 / (count - 1) as f64;
        let theta_s = if regular { even } else { random.between(-80.0, 80.0) };
        [theta_i[j % theta_i.len()], theta_s, 180.0]
    };
    let directions: Vec<_> = (0..count).map(|j| direction(j, random)).collect();
    noisy(random, &directions, &params)
}

fn lambert(random: &mut Random) -> Vec<Sample<f64>> {
    let mut params = params(random, [0.005, 3.0]);
    params.rho_d = random.log_between(0.05, 0.99);
    params.rho_s = random.log_between(1e-4, 0.1);
    params.rho_v *= 0.02;
    params.n = random.between(1.1, 2.0);
    let directions = grid(&angles(random, 4.0), if random.one_in(0.5) { 1.0 } else { 2.0 });
    noisy(random, &directions, &params)
}

fn needle(random: &mut Random) -> Vec<Sample<f64>> {
    let params = params(random, [0.01, 1.0]);
    let directions = grid(&angles(random, 3.0), if random.one_in(0.5) { 1.0 } else { 2.0 });
    let mut samples = noisy(random, &directions, &params);
    for _ in 0..1 + (random.unit() * 4.0) as usize {
        let mut place = (random.unit() * samples.len() as f64) as usize;
        // Half of them where a narrow peak would be.
        if random.one_in(0.5) {
            let off = |sample: &Sample<f64>| (sample.theta_s - sample.theta_i).abs();
            let nearest = (0..samples.len()).min_by(|&a, &b| off(&samples[a]).total_cmp(&off(&samples[b])));
            place = nearest.unwrap_or(place);
        }
        let height = random.log_between(1.5, 300.0);
        if let Some(sample) = samples.get_mut(place) {
            sample.brdf *= height;
        }
    }
    samples
}
