//! What is measured in simulation, with known truth, and how it is fitted.

use brdfit::analysis::bootstrap::Noise as Random;
use brdfit::engine::{FitOptions, Material, Model};
use brdfit::input::Measurement;
use brdfit_core::brdf::{DIFFUSE, SURFACE};
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use crate::case::{Case, Copy};
use crate::noise::Noise;

/// A material at some angles of incidence, degrees.
pub struct Scene {
    pub name: &'static str,
    /// The parameters of Eq. 14; none for a random surface with GGX's facets.
    truth: Option<[f64; 6]>,
    /// Only rho_d, rho_s and m are fitted.
    few: bool,
    angles: &'static [f64],
    step: f64,
    noises: &'static [Noise],
}

const PAINT: [f64; 6] = [0.05, 1.0, 0.0, 0.2, 1.5, 0.0];

const ALL: &[Noise] = &[
    Noise::White,
    Noise::Uniform { corrected: false },
    Noise::Uniform { corrected: true },
    Noise::Wandering(3.0, 0.0),
    Noise::Wandering(15.0, 0.0),
    Noise::Wandering(15.0, 0.7),
    Noise::Smooth(12.0),
];

pub const SCENES: [Scene; 7] = [
    Scene {
        name: "paint, one angle",
        truth: Some(PAINT),
        few: true,
        angles: &[45.0],
        step: 1.0,
        noises: ALL,
    },
    Scene {
        name: "paint, 35 samples",
        truth: Some(PAINT),
        few: true,
        angles: &[45.0],
        step: 5.0,
        noises: ALL,
    },
    Scene {
        name: "paint, three angles",
        truth: Some(PAINT),
        few: true,
        angles: &[20.0, 45.0, 60.0],
        step: 2.0,
        noises: ALL,
    },
    Scene {
        name: "test data 1",
        truth: Some([0.1, 10.0, 0.01, 0.1, 3.0, 1.0]),
        few: false,
        angles: &[45.0],
        step: 1.0,
        noises: ALL,
    },
    Scene {
        name: "test data 2",
        truth: Some([0.2, 1.5, 0.02, 0.15, 1.15, 0.9]),
        few: false,
        angles: &[30.0],
        step: 1.0,
        noises: ALL,
    },
    Scene {
        name: "GGX, one angle",
        truth: None,
        few: true,
        angles: &[45.0],
        step: 1.0,
        noises: &[Noise::White],
    },
    Scene {
        name: "GGX, three angles",
        truth: None,
        few: true,
        angles: &[20.0, 45.0, 60.0],
        step: 2.0,
        noises: &[Noise::White],
    },
];

/// Every scene with each of its noises.
pub fn cases() -> Vec<Case> {
    let of = |scene: &'static Scene| scene.noises.iter().map(move |&noise| case(scene, noise));
    SCENES.iter().flat_map(of).collect()
}

fn case(scene: &'static Scene, noise: Noise) -> Case {
    Case {
        scene: scene.name.into(),
        errors: noise.name(),
        beside: true,
        make: Box::new(move |copy| scene.copy(noise, copy)),
    }
}

impl Scene {
    fn copy(&self, noise: Noise, copy: u64) -> Copy {
        let mut random = Random::new(7, copy);
        let truth = self.truth.map_or_else(|| ggx(&mut random), Material::paper);
        // A misfit shows where noise is small.
        let size = if self.truth.is_some() { 1.0 } else { 0.2 };
        let count = (170.0 / self.step) as usize;
        let angles: Vec<f64> = (0..=count).map(|k| -85.0 + self.step * k as f64).collect();
        let mut samples = Vec::new();
        for &theta_i in self.angles {
            let errors = noise.along(&angles, size, &mut random);
            let pairs = angles.iter().zip(errors);
            samples.extend(pairs.map(|(&theta_s, error)| sample(&truth, theta_i, theta_s, error)));
        }
        let mut measurement = Measurement::of_samples(self.name, samples, None);
        measurement.on_deviations.correct_ln_bias = matches!(noise, Noise::Uniform { corrected: true });
        Copy {
            truth,
            measurement,
            options: if self.few { few() } else { FitOptions::default() },
            theta_i: self.angles[self.angles.len() / 2].to_radians(),
        }
    }
}

/// rho_d, rho_s and m alone, of a surface with n = 1.5.
pub fn few() -> FitOptions {
    let mut options = FitOptions {
        terms: DIFFUSE | SURFACE,
        ..FitOptions::default()
    };
    let place = options.model.place("n").expect("Eq. 14 has an index");
    (options.lower[place], options.upper[place]) = (1.5, 1.5);
    options
}

/// A sample of a material in plane, with this error of ln f; angles in degrees.
pub fn sample(material: &Material, theta_i: f64, theta_s: f64, error: f64) -> Sample<f64> {
    let sample = Sample::in_plane(theta_i.to_radians(), theta_s.to_radians(), 1.0);
    let ln_f = material.ln_f(&sample).expect("above the horizon") + error;
    Sample {
        brdf: Real::portable_exp(ln_f),
        ..sample
    }
}

fn ggx(random: &mut Random) -> Material {
    let model = Model::find("ggx").expect("GGX is a model");
    let mut material = Material {
        model,
        values: model.lower(),
    };
    let values = [
        ("rho_d", 0.03 + 0.2 * random.unit()),
        ("rho_s", 0.5 + 1.5 * random.unit()),
        ("m", 0.1 + 0.3 * random.unit()),
        ("n", 1.5),
    ];
    for (name, value) in values {
        material = material.with(name, value);
    }
    material
}
