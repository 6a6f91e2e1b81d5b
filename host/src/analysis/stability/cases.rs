//! The built-in cases: the paper's synthetic sets, and scenes at the ends of what the model can be.

use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

use crate::analysis::paper_sets;
use crate::engine::Material;

/// Relative noise of the generated scenes, uniform within +- this.
const NOISE: f64 = 0.01;

/// A scan with its name.
pub struct Case {
    /// What is difficult about it.
    pub name: &'static str,
    /// The scan.
    pub samples: Vec<Sample<f64>>,
}

struct Recipe {
    name: &'static str,
    theta_i_deg: f64,
    /// Half width in degrees and step of a fan around the specular direction, besides -85 to 85 by 1.
    fan: Option<(f64, f64)>,
    /// In the order of [`brdfit_core::brdf::NAMES`].
    params: [f64; 6],
}

const RECIPES: [Recipe; 9] = [
    Recipe {
        name: "dielectric, one angle",
        theta_i_deg: 45.0,
        fan: None,
        params: [0.1, 3.0, 0.02, 0.2, 1.5, 0.0],
    },
    Recipe {
        name: "n -> 1, kappa -> 0",
        theta_i_deg: 60.0,
        fan: None,
        params: [1e-3, 50.0, 20.0, 0.1, 1.002, 1e-3],
    },
    Recipe {
        name: "m at its lower bound",
        theta_i_deg: 45.0,
        fan: Some((2e-3, 1e-4)),
        params: [0.1, 1.0, 0.01, 1e-5, 1.5, 0.5],
    },
    Recipe {
        name: "m at its upper bound",
        theta_i_deg: 45.0,
        fan: None,
        params: [0.1, 10.0, 1.0, 10.0, 1.5, 0.5],
    },
    Recipe {
        name: "rho_d and rho_v at 0",
        theta_i_deg: 30.0,
        fan: None,
        params: [0.0, 2.0, 0.0, 0.4, 1.6, 0.3],
    },
    Recipe {
        name: "the same down to 1e-17 sr^-1",
        theta_i_deg: 30.0,
        fan: None,
        params: [0.0, 2.0, 0.0, 0.25, 1.6, 0.3],
    },
    Recipe {
        name: "rho_s and rho_v at 0",
        theta_i_deg: 30.0,
        fan: None,
        params: [0.3, 0.0, 0.0, 0.1, 1.5, 0.0],
    },
    Recipe {
        name: "lobes that coincide",
        theta_i_deg: 2.0,
        fan: None,
        params: [0.05, 2.0, 0.5, 0.2, 1.5, 0.1],
    },
    Recipe {
        name: "eight decades of BRDF",
        theta_i_deg: 45.0,
        fan: Some((1.0, 0.02)),
        params: [1e-3, 10.0, 1e-3, 2e-3, 2.0, 1.0],
    },
];

macro_rules! file {
    ($name:literal) => {
        paper_sets::samples(include_str!(concat!("../../../data/testdata", $name, ".csv")))
    };
}

/// All of them, in the order of the table.
pub fn all() -> Vec<Case> {
    let sets = [
        ("test data 1, no noise", file!("1_ideal")),
        ("test data 2, no noise", file!("2_ideal")),
        ("test data 3, no noise", file!("3_ideal")),
        ("test data 1, noise 10 %", file!("1_sym_seed1")),
        ("test data 2, noise 10 %", file!("2_sym_seed1")),
        ("test data 3, noise 10 %", file!("3_sym_seed1")),
    ];
    let sets = sets.into_iter().map(|(name, samples)| Case { name, samples });
    let scenes = RECIPES.iter().map(|scene| Case {
        name: scene.name,
        samples: generate(scene),
    });
    sets.chain(scenes).collect()
}

/// The model with noise of a fixed seed.
fn generate(scene: &Recipe) -> Vec<Sample<f64>> {
    let material = Material::paper(scene.params);
    let mut degrees: Vec<f64> = (-85..=85).map(f64::from).collect();
    if let Some((width, step)) = scene.fan {
        let steps = (width / step).round() as i32;
        let fan = (-steps..=steps).filter(|&k| k != 0);
        degrees.extend(fan.map(|k| scene.theta_i_deg + f64::from(k) * step));
    }
    let mut noise = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut sample = |degrees: f64| {
        let (theta_i, theta_s) = (scene.theta_i_deg.to_radians(), degrees.to_radians());
        let sample = Sample::in_plane(theta_i, theta_s, 1.0);
        let factor = 1.0 + NOISE * (2.0 * f64::unit(noise.next_u64()) - 1.0);
        let brdf = Real::portable_exp(material.ln_f(&sample)?) * factor;
        Some(Sample { brdf, ..sample })
    };
    degrees.into_iter().filter_map(&mut sample).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_widest_case_has_eight_decades() {
        let cases = all();
        let widest = cases.last().expect("there are cases");
        let values = widest.samples.iter().map(|sample| sample.brdf);
        let (least, most) = values.fold((f64::MAX, 0.0f64), |(a, b), x| (a.min(x), b.max(x)));
        assert!((1e8..1e10).contains(&(most / least)), "{least:e} to {most:e}");
    }

    #[test]
    fn all_samples_are_numbers_of_single_precision() {
        let ok = |sample: &Sample<f64>| sample.brdf > 1e-30 && sample.brdf < 1e30;
        assert!(all().iter().all(|case| case.samples.iter().all(ok)));
    }
}
