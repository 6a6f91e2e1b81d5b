use crate::dual::Number;
use crate::formula::{Directions, Formula};
use crate::model::{Parameter, Role};
use crate::real::Real;

/// After Sandford and Robertson, "Infrared reflectance properties of aircraft paints", Proc. IRIS Targets, Backgrounds and Discrimination, 1985: what a paint does not emit goes into a Lambert-like and an elliptical lobe, whose reflectances are exact.
///
/// Their paper is not public, and this form was not compared with it: what is tested is that the lobes and the emission together are all of the light (`tests/paints.rs`), which fixes G and H once g and h are given.
///
/// With `g(theta) = 1 / (1 + b^2 tan^2 theta)` and its mean over the hemisphere `G = (1 + b^2 / (1 - b^2) ln b^2) / (1 - b^2)`,
/// `f = rho_d g(theta_i) g(theta_s) / (pi G^2) + R(theta_i) h(theta_h) / (4 pi H(theta_i) cos theta_s)`, where
/// `h = 1 / (e^2 cos^2 theta_h + sin^2 theta_h)^2`, `H = ((1 - e^2) c + (2 e^2 + (1 - e^2)^2 c^2) / sqrt((1 - e^2)^2 c^2 + 4 e^2)) / (2 e^2)` with `c = cos theta_i` is its mean, and `R = 1 - (epsilon + rho_d) g(theta_i) / G` is the reflectance of the lobe.
/// In place of the emissivity epsilon stands `rho_s = R(0)`, so that no parameters make R negative: `epsilon = (1 - rho_s) G - rho_d`.
/// This f is not reciprocal.
#[derive(Clone, Copy, Debug)]
pub struct SandfordRobertson;

impl Formula<4> for SandfordRobertson {
    const PARAMETERS: [Parameter; 4] = [
        Parameter::new("rho_d", "ρ_d", Role::Shape, 1.0)
            .what("hemispherical reflectance of the diffuse lobe")
            .domain(0.0, 1.0)
            .spread(1e-3, 1.0),
        Parameter::new("rho_s", "ρ_s", Role::Shape, 1.0)
            .what("reflectance of the elliptical lobe at normal incidence")
            .domain(0.0, 1.0)
            .spread(1e-3, 1.0),
        Parameter::new("b_g", "b", Role::Shape, 0.8)
            .what("how early the emissivity falls towards grazing directions")
            .bounds(1e-3, 0.8)
            .domain(1e-3, 0.9)
            .spread(0.01, 0.8),
        Parameter::new("e", "e", Role::Slope, 1.0)
            .what("width of the elliptical lobe")
            .bounds(1e-4, 1.0)
            .domain(1e-6, 1.0),
    ];

    fn brdf<R: Real, N: Number<R>>([rho_d, rho_s, b, e]: &[N; 4], at: &Directions<R>) -> N {
        let (b2, e2) = (b.squared(), e.squared());
        let one = N::of(R::ONE);
        let rest = one - b2;
        let mean = (b2 / rest * b2.ln() + R::ONE) / rest;
        let g = |cos: R, sin: R| N::of(cos * cos) / (b2 * (sin * sin) + cos * cos);
        let g_i = g(at.cos_i, at.sin_i);
        let diffuse = g_i * g(at.cos_s, at.sin_s) / (mean.squared() * R::PI);
        // h times cos^4 theta_h, and what makes up for it.
        let inverse_cos2 = R::ONE + at.tan2_theta_h;
        let below = e2 + at.tan2_theta_h;
        let round = one - e2;
        let across = (round * at.cos_i).squared();
        let normal = (round * at.cos_i + (e2 + e2 + across) / (across + e2 * R::of(4.0)).sqrt()) / (e2 + e2);
        let lobe = N::of(inverse_cos2 * inverse_cos2) / (below.squared() * normal * (R::of(4.0) * R::PI * at.cos_s));
        *rho_d * diffuse + (one - (one - *rho_s) * g_i) * lobe
    }
}
