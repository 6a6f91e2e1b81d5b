//! Several scans of one material fitted together: m comes out better by the root of their number.

use brdfit_core::brdf::{ALL, Brdf, NAMES, Params};
use brdfit_core::geometry::{Block, Geometry, LANES, Observation, Sample};
use brdfit_core::joint::Joint;
use brdfit_core::lm::{self, Bounds, Options, Problem};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_suite::tolerance::{self, check};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

const SCANS: usize = 3;
/// Coordinates at most: three scans of six parameters.
const Q: usize = 18;

fn bounds() -> Bounds<f64, 6> {
    Scan::<f64, ALL, 6>::bounds(
        &Params::from_array([0.0, 0.0, 0.0, 1e-5, 1.0, 0.0]),
        &Params::from_array([1.0, 100.0, 100.0, 10.0, 100.0, 100.0]),
    )
}

/// A scan with noise of 10 % in ln f: a sum of twelve uniform numbers is near enough to normal.
fn scan(params: &Params<f64>, random: &mut Xoshiro256PlusPlus) -> Vec<Block<f64>> {
    let brdf = Brdf::<f64, ALL>::new(params);
    let mut observations = Vec::new();
    for theta_i in [20.0f64, 50.0] {
        for theta_s in (-80..=80).step_by(4) {
            let sample = Sample::in_plane(theta_i.to_radians(), f64::from(theta_s).to_radians(), 1.0);
            let geometry = Geometry::new(sample.theta_i, sample.theta_s, sample.delta_phi).expect("valid directions");
            let noise: f64 = (0..12).map(|_| f64::unit(random.next_u64())).sum::<f64>() - 6.0;
            let mut observation = Observation::new(&sample).expect("a valid sample");
            observation.ln_f = brdf.ln_f(&geometry) + 0.1 * noise;
            observations.push(observation);
        }
    }
    observations.chunks(LANES).map(Block::new).collect()
}

/// Root mean square error of ln m over many seeds: of separate fits, and of joint ones that share `shared`.
fn errors_of_m(materials: [[f64; 6]; SCANS], shared: [bool; 6]) -> [f64; 2] {
    let one = bounds();
    let (mut separate, mut joint) = (0.0, 0.0);
    const SEEDS: u64 = 200;
    for seed in 0..SEEDS {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let blocks = materials.map(|m| scan(&Params::from_array(m), &mut random));
        let scans = [0, 1, 2].map(|s| Scan::<f64, ALL, 6>::new(&blocks[s]));
        let truth = |s: usize| Scan::<f64, ALL, 6>::coordinates(&Params::from_array(materials[s]));
        let options = Options::default();
        for s in 0..SCANS {
            let fit = lm::fit(&scans[s], &one, truth(s), &options);
            separate += square(fit.x[3] / materials[s][3] - 1.0) / SCANS as f64;
        }
        let problem = Joint::new(&scans, shared);
        let fit = lm::fit(
            &problem,
            &problem.bounds::<f64, Q>(&one),
            problem.join((0..SCANS).map(truth)),
            &options,
        );
        joint += square(problem.of(&fit.x, 0)[3] / materials[0][3] - 1.0);
    }
    [separate, joint].map(|sum| (sum / SEEDS as f64).sqrt())
}

fn square(x: f64) -> f64 {
    x * x
}

const MATERIAL: [f64; 6] = [0.1, 10.0, 0.5, 0.2, 3.0, 1.0];

#[test]
fn m_is_better_by_the_root_of_the_number_of_scans() {
    // Three wavelengths share m; three repeats share everything but the weights.
    let wavelengths = [
        MATERIAL,
        [0.2, 12.0, 0.4, 0.2, 2.5, 1.5],
        [0.05, 8.0, 0.6, 0.2, 3.5, 0.5],
    ];
    let cases = [
        (wavelengths, std::array::from_fn(|i| NAMES[i] == "m")),
        ([MATERIAL; SCANS], std::array::from_fn(|i| !NAMES[i].starts_with("rho"))),
    ];
    let off = cases.map(|(materials, shared)| {
        let [separate, joint] = errors_of_m(materials, shared);
        println!(
            "error of m: separate {separate:.5}, joint {joint:.5}, gain {:.3}",
            separate / joint
        );
        (separate / joint / 3f64.sqrt() - 1.0).abs()
    });
    check(off[0].max(off[1]), tolerance::JOINT_GAIN);
}

#[test]
fn sums_are_those_of_the_scans() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let blocks = [0, 1, 2].map(|_| scan(&Params::from_array(MATERIAL), &mut random));
    let scans = [0, 1, 2].map(|s| Scan::<f64, ALL, 6>::new(&blocks[s]));
    let problem = Joint::new(&scans, [false, false, false, true, true, true]);
    assert_eq!(problem.coordinates(), 12);
    let x: [f64; Q] = problem.join([MATERIAL; SCANS].into_iter());
    let joint = problem.linearize(&x);
    let each = [0, 1, 2].map(|s| scans[s].linearize(&problem.of(&x, s)));
    assert_eq!(joint.cost, each[0].cost + each[1].cost + each[2].cost);
    assert_eq!(
        joint.gradient[0],
        each[0].gradient[3] + each[1].gradient[3] + each[2].gradient[3]
    );
    // The second scan's rho_s against the shared m.
    assert_eq!(joint.hessian[problem.place(1, 1)][0], each[1].hessian[1][3]);
    // Two scans' own parameters do not meet.
    assert_eq!(joint.hessian[problem.place(0, 1)][problem.place(1, 1)], 0.0);
    assert_eq!(joint.hessian[Q - 1][Q - 1], 0.0);
}
