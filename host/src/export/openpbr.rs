//! OpenPBR's opaque base as MaterialX computes it: a dielectric over a diffuse base, mixed with a metal.
//!
//! The node graph is that of MaterialX 1.39.5 (`open_pbr_surface.mtlx`); everything that is not a parameter here has its default, which leaves coat, fuzz, transmission and subsurface out.
//! How much of the light a layer lets through is a fit to tabulated reflectances, which is MaterialX's default; renderers that have tables of their own differ by what the fit is off.

use brdfit_core::dual::Number;
use brdfit_core::formula::{Directions, Formula, Own};
use brdfit_core::model::Parameter;
use brdfit_core::real::Real;

use super::targets::{BASE, METALLIC, ROUGHNESS, fresnel, index, power5, schlick};
use crate::engine::Model;

/// Base colour, metalness, roughness and index of refraction; light comes from theta_i and is seen from theta_s, as the layers are not reciprocal.
#[derive(Clone, Copy, Debug)]
pub struct OpenPbr;

/// The OpenPBR surface.
pub static OPEN_PBR: Model = Model::own::<Own<OpenPbr>, 4, 8>("openpbr", "OpenPBR surface", "MaterialX 1.39.5");

impl Formula<4> for OpenPbr {
    const PARAMETERS: [Parameter; 4] = [BASE, METALLIC, ROUGHNESS, index(10.0)];

    fn brdf<R: Real, N: Number<R>>([base, metalness, roughness, n]: &[N; 4], at: &Directions<R>) -> N {
        let alpha = roughness.squared();
        let lobe = correlated_ggx(alpha, at);
        let [by_normal, by_grazing] = albedo(alpha, at.cos_s);
        let single = by_normal + by_grazing;
        // What is scattered between facets, as if it was reflected once more (Turquin, "Practical multiple scattering compensation for microfacet models", 2019, Eq. 16).
        let compensation = |reflected: N| reflected * (-single + R::ONE) / single + R::ONE;
        let metal = schlick(*base, power5(R::ONE - at.cos_theta_d));
        let metal = metal * compensation(metal) * lobe;
        let reflected = fresnel(*n, N::of(R::ZERO), at.cos_theta_d);
        let compensated = compensation(reflected);
        let normal = ((*n - R::ONE) / (*n + R::ONE)).squared();
        let through = -((normal * by_normal + by_grazing) * compensated) + R::ONE;
        let plastic = reflected * compensated * lobe + through * *base / R::PI;
        plastic + *metalness * (metal - plastic)
    }
}

/// D G / (4 cos theta_i cos theta_s) with Smith's masking of both directions together (Heitz, "Understanding the masking-shadowing function in microfacet-based BRDFs", JCGT 2014, Eq. 99).
fn correlated_ggx<R: Real, N: Number<R>>(alpha: N, at: &Directions<R>) -> N {
    let alpha2 = alpha.squared();
    let one = at.tan2_theta_h + R::ONE;
    let d = alpha2 * (one * one) / ((alpha2 + at.tan2_theta_h).squared() * R::PI);
    let side = |cos: R, other: R| (alpha2 * (R::ONE - cos * cos) + cos * cos).sqrt() * other;
    d / ((side(at.cos_i, at.cos_s) + side(at.cos_s, at.cos_i)) * R::of(2.0))
}

/// Coefficients of 1, x, y, x y, x^2, y^2, x^2 y, x y^2 and x^2 y^2, with x the cosine and y alpha: `mx_ggx_dir_albedo_analytic` of MaterialX 1.39.5.
const ALBEDO: [[f64; 9]; 4] = [
    [0.1003, -0.6303, 9.748, -2.038, 29.34, -8.245, -26.44, 19.99, -5.448],
    [0.9345, -2.323, 2.229, -3.748, 1.424, -0.7684, 1.436, 0.2913, 0.6286],
    [1.0, -1.765, 8.263, 11.53, 28.96, -7.507, -36.11, 15.86, 33.37],
    [1.0, 0.2281, 15.94, -55.83, 13.08, 41.26, 54.9, 300.2, -285.1],
];

/// The part of the light towards one direction that facets reflect: for each unit of reflectance at normal and at grazing incidence.
fn albedo<R: Real, N: Number<R>>(alpha: N, cos: R) -> [N; 2] {
    let alpha2 = alpha.squared();
    let polynomial = |k: usize| {
        let [c, x, y, xy, x2, y2, x2y, xy2, x2y2] = ALBEDO[k].map(R::of);
        let of_x = |c: R, x: R, x2: R| c + cos * (x + cos * x2);
        alpha * of_x(y, xy, x2y) + alpha2 * of_x(y2, xy2, x2y2) + of_x(c, x, x2)
    };
    [0, 1].map(|k| {
        let part = polynomial(k) / polynomial(k + 2);
        match part.value() {
            value if value < R::ZERO => N::of(R::ZERO),
            value if value > R::ONE => N::of(R::ONE),
            _ => part,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn brdf(parameters: [f64; 4], [theta_i, theta_s, delta_phi]: [f64; 3]) -> f64 {
        let at = Directions::new(theta_i.to_radians(), theta_s.to_radians(), delta_phi.to_radians()).unwrap();
        OpenPbr::brdf(&parameters, &at)
    }

    /// The functions of MaterialX 1.39.5 with vectors, written out as its shaders have them.
    #[test]
    fn it_is_what_materialx_computes() {
        for parameters in [[0.4, 0.3, 0.5, 1.5], [0.8, 0.0, 0.3, 1.3], [0.6, 1.0, 0.9, 2.0]] {
            for directions in [
                [30.0, 30.0, 180.0],
                [60.0, 20.0, 90.0],
                [75.0, 70.0, 180.0],
                [10.0, 50.0, 0.0],
            ] {
                let (own, expected) = (brdf(parameters, directions), literal(parameters, directions));
                assert!((own / expected - 1.0).abs() < 1e-13, "{directions:?} {own} {expected}");
            }
        }
    }

    fn literal([color, metalness, roughness, ior]: [f64; 4], [theta_i, theta_s, delta_phi]: [f64; 3]) -> f64 {
        let pi = std::f64::consts::PI;
        let vector = |theta: f64, phi: f64| {
            let [(sin, cos), (sin_phi, cos_phi)] = [theta, phi].map(|angle| libm::sincos(angle.to_radians()));
            [sin * cos_phi, sin * sin_phi, cos]
        };
        let (l, v) = (vector(theta_i, 0.0), vector(theta_s, delta_phi));
        let sum: [f64; 3] = std::array::from_fn(|k| v[k] + l[k]);
        let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
        let h = sum.map(|x| x / length);
        let v_h: f64 = (0..3).map(|k| v[k] * h[k]).sum();
        let (n_l, n_v, alpha) = (l[2], v[2], roughness * roughness);
        let d =
            1.0 / (pi * alpha * alpha * libm::pow((h[0] * h[0] + h[1] * h[1]) / (alpha * alpha) + h[2] * h[2], 2.0));
        let lambda = |cos: f64| (alpha * alpha + (1.0 - alpha * alpha) * cos * cos).sqrt();
        let g = 2.0 / (lambda(n_l) / n_l + lambda(n_v) / n_v);
        let [x, y] = [n_v, alpha];
        let monomials = [1.0, x, y, x * y, x * x, y * y, x * x * y, x * y * y, x * x * y * y];
        let r = ALBEDO.map(|row| row.iter().zip(monomials).map(|(a, b)| a * b).sum::<f64>());
        let (a, b) = ((r[0] / r[2]).clamp(0.0, 1.0), (r[1] / r[3]).clamp(0.0, 1.0));
        let comp = |f: f64| 1.0 + f * (1.0 - (a + b)) / (a + b);
        let g2 = ior * ior + v_h * v_h - 1.0;
        let (minus, plus) = (g2.sqrt() - v_h, g2.sqrt() + v_h);
        let y = (plus * v_h - 1.0) / (minus * v_h + 1.0);
        let f = 0.5 * libm::pow(minus / plus, 2.0) * (1.0 + y * y);
        let f0 = libm::pow((ior - 1.0) / (ior + 1.0), 2.0);
        // The responses have cos theta_i in them.
        let reflection = |f: f64| d * f * g * comp(f) / (4.0 * n_v);
        let dielectric = reflection(f) + color * n_l / pi * (1.0 - (f0 * a + b) * comp(f));
        let metal = reflection(color + (1.0 - color) * libm::pow(1.0 - v_h, 5.0));
        (metal * metalness + dielectric * (1.0 - metalness)) / n_l
    }

    /// A white metal reflects all light: the fit of reflectances and the lobe belong together.
    #[test]
    fn a_white_metal_reflects_nearly_all() {
        for roughness in [0.3, 0.6, 1.0] {
            let steps = 400;
            let mut sum = 0.0;
            for k in 0..steps {
                let theta = 90.0 * (f64::from(k) + 0.5) / f64::from(steps);
                for j in 0..steps {
                    let phi = 360.0 * (f64::from(j) + 0.5) / f64::from(steps);
                    let (sin, cos) = libm::sincos(theta.to_radians());
                    sum += brdf([1.0, 1.0, roughness, 1.5], [theta, 40.0, phi]) * sin * cos;
                }
            }
            let step = std::f64::consts::PI / 2.0 / f64::from(steps) * 2.0 * std::f64::consts::PI / f64::from(steps);
            // At most 1.03 % measured, at roughness 1.
            assert!((sum * step - 1.0).abs() < 0.011, "{roughness}: {}", sum * step);
        }
    }
}
