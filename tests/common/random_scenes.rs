//! Random scans of many kinds, and a brute-force search to judge others by.

use brdfit_core::brdf::{ALL, Brdf, Params};
use brdfit_core::geometry::{Geometry, Sample};
use brdfit_core::lm::{Bounds, Fit, Options};
use brdfit_core::real::Real;
use brdfit_core::search::{Region, Scene};
use brdfit_core::start;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

/// What a scan was made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The model, with noise uniform in a range.
    Uniform,
    /// The model, with log-normal noise.
    LogNormal,
    /// The surface lobe has GGX's long tails, so no parameters fit.
    Ggx,
    /// A second surface lobe with a wider slope.
    TwoSlopes,
    /// Every 5 degrees only, upon a noise floor.
    Sparse,
}

/// All kinds; scene k is of kind k modulo their number.
pub const KINDS: [Kind; 5] = [Kind::Uniform, Kind::LogNormal, Kind::Ggx, Kind::TwoSlopes, Kind::Sparse];

/// The numbers that a scene is made of.
pub(crate) struct Random(Xoshiro256PlusPlus);

impl Random {
    /// The same numbers for the same seed.
    pub(crate) fn new(seed: u64) -> Self {
        Random(Xoshiro256PlusPlus::seed_from_u64(seed))
    }
    pub(crate) fn unit(&mut self) -> f64 {
        f64::unit(self.0.next_u64())
    }
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
    pub(crate) fn log_between(&mut self, low: f64, high: f64) -> f64 {
        Real::portable_exp(self.between(Real::portable_ln(low), Real::portable_ln(high)))
    }
    pub(crate) fn one_in(&mut self, share: f64) -> bool {
        self.unit() < share
    }
    /// Standard normal (Box and Muller 1958).
    pub(crate) fn normal(&mut self) -> f64 {
        let radius = Real::sqrt(-2.0 * Real::portable_ln(1.0 - self.unit()));
        radius * Real::portable_sin_cos(std::f64::consts::TAU * self.unit()).1
    }
}

/// Scene `k`: one to five incident angles, noise of 0.5 to 20 %.
pub fn scene(k: u64) -> Vec<Sample<f64>> {
    let kind = KINDS[(k % KINDS.len() as u64) as usize];
    let random = &mut Random::new(0x1234 + 7919 * k);
    let angles = 1 + (random.unit() * 5.0) as usize;
    let theta_i: Vec<f64> = (0..angles).map(|_| random.between(0.0, 80.0).round()).collect();
    let rho_d = random.log_between(1e-3, 0.9);
    let rho_s = random.log_between(0.01, 20.0);
    let no_volume = random.one_in(0.3);
    let rho_v = random.log_between(1e-4, 1.0);
    let m = random.log_between(0.005, 0.6);
    let n = random.between(1.05, 4.0);
    let dielectric = random.one_in(0.4);
    let kappa = random.log_between(0.05, 8.0);
    let params = Params {
        rho_d,
        rho_s,
        rho_v: if no_volume { 0.0 } else { rho_v },
        m,
        n,
        kappa: if dielectric { 0.0 } else { kappa },
    };
    let noise = random.log_between(0.005, 0.2);
    let wide = Params {
        rho_d: 0.0,
        rho_v: 0.0,
        m: m * random.log_between(1.5, 4.0),
        rho_s: rho_s * random.log_between(0.05, 1.0),
        ..params
    };
    let step = match kind {
        Kind::Sparse => 5,
        _ if random.one_in(0.5) => 1,
        _ => 2,
    };
    let mut samples = Vec::new();
    for &angle in &theta_i {
        for theta_s in (-85..=85).step_by(step) {
            let (theta_i, theta_s) = (angle.to_radians(), f64::from(theta_s).to_radians());
            let geometry = Geometry::new(theta_i, theta_s, f64::PI).expect("angles are above the horizon");
            let clean = clean(kind, &params, &wide, &geometry);
            let mut f = match kind {
                Kind::Uniform | Kind::TwoSlopes => clean * (1.0 + noise * random.between(-1.0, 1.0)),
                _ => clean * Real::portable_exp(noise * random.normal()),
            };
            if kind == Kind::Sparse {
                f += 1e-4 + 1e-3 * rho_d * random.unit();
            }
            samples.push(Sample::in_plane(theta_i, theta_s, f));
        }
    }
    samples
}

fn clean(kind: Kind, params: &Params<f64>, wide: &Params<f64>, geometry: &Geometry<f64>) -> f64 {
    let ln_f = |params: &Params<f64>| Brdf::<f64, ALL>::new(params).ln_f(geometry);
    match kind {
        Kind::Ggx => {
            // D of GGX over that of Beckmann is exp(x) / (1 + x)^2, where x = (tan theta_h / m)^2.
            let x = geometry.surface().tan2_theta_h / (params.m * params.m);
            let surface = Params {
                rho_d: 0.0,
                rho_v: 0.0,
                ..*params
            };
            let rest = Params { rho_s: 0.0, ..*params };
            Real::portable_exp(ln_f(&rest)) + Real::portable_exp(ln_f(&surface) + x) / ((1.0 + x) * (1.0 + x))
        }
        Kind::TwoSlopes => Real::portable_exp(ln_f(params)) + Real::portable_exp(ln_f(wide)),
        _ => Real::portable_exp(ln_f(params)),
    }
}

/// The least cost from `starts` starts: a third uniform over the bounds, the others candidates of the default search under another seed.
///
/// Each makes 25 passes, and goes on to convergence if it is then within 30 % of the best.
pub fn brute<const P: usize>(scene: &impl Scene<f64, P>, bounds: &Bounds<f64, P>, starts: u64, seed: u64) -> f64 {
    let options = Options::default();
    let mut best = f64::INFINITY;
    for i in 0..starts {
        let x = if i % 3 == 0 {
            start::uniform(seed, i, bounds)
        } else {
            scene.candidate(bounds, !seed, i, Region::Everywhere).x
        };
        let mut fit = Fit::begin(scene, bounds, x, &options);
        fit.run(scene, bounds, &options, 25);
        if fit.at.cost < 1.3 * best {
            fit.run(scene, bounds, &options, u32::MAX);
        }
        best = best.min(fit.at.cost);
    }
    best
}
