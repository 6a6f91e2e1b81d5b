//! Errors of ln f along one angle of incidence.

use std::f64::consts::TAU;

use brdfit::analysis::bootstrap::Noise as Random;

/// Standard deviation of the errors of ln f, but for [`Noise::Uniform`].
const SIGMA: f64 = 0.05;
/// What a factor of f is apart from 1 at most.
const UNIFORM: f64 = 0.3;
/// Cosines of random frequency that make a smooth error.
const WAVES: usize = 60;

/// Of which kind; lengths in degrees.
#[derive(Clone, Copy)]
pub enum Noise {
    /// Independent, normal.
    White,
    /// f is multiplied by a number between 0.7 and 1.3, each as likely; with `--correct-ln-bias` or without.
    Uniform { corrected: bool },
    /// Of first order, with this correlation length, beside independent ones of this part of the variance.
    Wandering(f64, f64),
    /// Smooth, with this length, beside 2 % independent ones: an instrument that drifts.
    Smooth(f64),
}

impl Noise {
    pub fn name(self) -> String {
        match self {
            Noise::White => "independent".into(),
            Noise::Uniform { corrected: false } => "+-30 % of f".into(),
            Noise::Uniform { corrected: true } => "+-30 % of f, bias of ln corrected".into(),
            Noise::Wandering(length, 0.0) => format!("AR, {length} deg"),
            Noise::Wandering(length, part) => format!("AR, {length} deg, and {:.0} % white", 100.0 * part),
            Noise::Smooth(length) => format!("smooth, {length} deg"),
        }
    }

    /// At ascending angles, `size` times as large as usual.
    pub fn along(self, angles: &[f64], size: f64, random: &mut Random) -> Vec<f64> {
        let sigma = size * SIGMA;
        let mix = |own: f64, white: f64, part: f64| (1.0 - part).sqrt() * own + part.sqrt() * white;
        match self {
            Noise::White => angles.iter().map(|_| sigma * random.normal()).collect(),
            Noise::Uniform { .. } => {
                let one = |_| libm::log1p(UNIFORM * (2.0 * random.unit() - 1.0));
                angles.iter().map(one).collect()
            }
            Noise::Wandering(length, part) => {
                let (mut own, mut before) = (random.normal(), angles[0]);
                let next = |&angle: &f64| {
                    let kept = libm::exp((before - angle) / length);
                    before = angle;
                    own = kept * own + (1.0 - kept * kept).sqrt() * random.normal();
                    sigma * mix(own, random.normal(), part)
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
                let one = |&angle: &f64| sigma * mix(own(angle), random.normal(), 0.02);
                angles.iter().map(one).collect()
            }
        }
    }
}
