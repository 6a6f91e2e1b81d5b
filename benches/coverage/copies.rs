//! Simulated scans with known truth, and the errors of their ln f.

use std::f64::consts::TAU;

use brdfit::analysis::bootstrap::Noise as Random;
use brdfit::engine::{FitOptions, Material, Model};
use brdfit_core::brdf::{DIFFUSE, SURFACE};
use brdfit_core::geometry::Sample;

/// Standard deviation of the errors of ln f.
const SIGMA: f64 = 0.05;
/// Cosines of random frequency that make a smooth error.
const WAVES: usize = 60;

/// Errors of ln f along one angle of incidence; lengths in degrees.
#[derive(Clone, Copy)]
pub enum Noise {
    /// Independent, normal.
    White,
    /// Of first order, with this correlation length, beside independent ones of this part of the variance.
    Wandering(f64, f64),
    /// Smooth, with this length, beside 2 % independent ones: a misfit.
    Smooth(f64),
}

impl Noise {
    pub fn name(self) -> String {
        match self {
            Noise::White => "independent".into(),
            Noise::Wandering(length, 0.0) => format!("AR, {length} deg"),
            Noise::Wandering(length, part) => format!("AR, {length} deg, and {:.0} % white", 100.0 * part),
            Noise::Smooth(length) => format!("smooth, {length} deg"),
        }
    }

    fn along(self, angles: &[f64], random: &mut Random) -> Vec<f64> {
        let mix = |own: f64, white: f64, part: f64| (1.0 - part).sqrt() * own + part.sqrt() * white;
        match self {
            Noise::White => angles.iter().map(|_| SIGMA * random.normal()).collect(),
            Noise::Wandering(length, part) => {
                let (mut own, mut before) = (random.normal(), angles[0]);
                let next = |&angle: &f64| {
                    let kept = libm::exp((before - angle) / length);
                    before = angle;
                    own = kept * own + (1.0 - kept * kept).sqrt() * random.normal();
                    SIGMA * mix(own, random.normal(), part)
                };
                angles.iter().map(next).collect()
            }
            Noise::Smooth(length) => {
                let waves: Vec<(f64, f64)> = (0..WAVES)
                    .map(|_| (random.normal() / length, TAU * random.unit()))
                    .collect();
                let own = |angle: f64| {
                    let sum: f64 = waves.iter().map(|(pace, phase)| libm::cos(pace * angle + phase)).sum();
                    sum * (2.0 / WAVES as f64).sqrt()
                };
                angles
                    .iter()
                    .map(|&angle| SIGMA * mix(own(angle), random.normal(), 0.02))
                    .collect()
            }
        }
    }
}

/// What is measured, and how it is fitted.
pub struct Scene {
    pub name: &'static str,
    /// The parameters of Eq. 14; none for a random surface with GGX's facets.
    truth: Option<[f64; 6]>,
    /// Only rho_d, rho_s and m are fitted.
    few: bool,
    /// Angles of incidence, degrees.
    pub angles: &'static [f64],
    step: f64,
    pub noises: &'static [Noise],
}

const ALL: &[Noise] = &[
    Noise::White,
    Noise::Wandering(3.0, 0.0),
    Noise::Wandering(15.0, 0.0),
    Noise::Wandering(15.0, 0.7),
    Noise::Smooth(12.0),
];

pub const SCENES: [Scene; 6] = [
    Scene {
        name: "paint, one angle",
        truth: Some([0.05, 1.0, 0.0, 0.2, 1.5, 0.0]),
        few: true,
        angles: &[45.0],
        step: 1.0,
        noises: ALL,
    },
    Scene {
        name: "paint, three angles",
        truth: Some([0.05, 1.0, 0.0, 0.2, 1.5, 0.0]),
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

impl Scene {
    /// The truth of one copy and its samples.
    pub fn copy(&self, noise: Noise, copy: u64) -> (Material, Vec<Sample<f64>>) {
        let mut random = Random::new(7, copy);
        let truth = self.truth.map_or_else(|| ggx(&mut random), Material::paper);
        // A misfit shows where noise is small.
        let size = if self.truth.is_some() { 1.0 } else { 0.2 };
        let count = (170.0 / self.step) as usize;
        let angles: Vec<f64> = (0..=count).map(|k| -85.0 + self.step * k as f64).collect();
        let mut samples = Vec::new();
        for &theta_i in self.angles {
            let errors = noise.along(&angles, &mut random);
            let pairs = angles.iter().zip(errors);
            samples.extend(pairs.map(|(&theta_s, error)| super::sample(&truth, theta_i, theta_s, size * error)));
        }
        (truth, samples)
    }

    /// How it is fitted.
    pub fn options(&self) -> FitOptions {
        let mut options = FitOptions::default();
        if self.few {
            options.terms = DIFFUSE | SURFACE;
            let place = options.model.place("n").expect("Eq. 14 has an index");
            (options.lower[place], options.upper[place]) = (1.5, 1.5);
        }
        options
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
