//! Models of renderers as formulas, which a fitted model is fitted with again: GGX facets on a diffuse base.
//!
//! D and G of all but [`Native`] are those of Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, with alpha = roughness^2.

use brdfit_core::dual::Number;
use brdfit_core::formula::{Directions, Formula, Own};
use brdfit_core::model::{Parameter, Role};
use brdfit_core::real::Real;

use crate::engine::Model;

/// glTF 2.0, Appendix B.3, with the index of refraction of KHR_materials_ior: base colour, metallic, roughness and index.
#[derive(Clone, Copy, Debug)]
pub struct Gltf;

/// Mitsuba 3's `principled` (Burley, "Physically Based Shading at Disney", 2012): base colour, metallic, roughness and index.
#[derive(Clone, Copy, Debug)]
pub struct Principled;

/// Mitsuba 3's `diffuse` and `roughconductor` with Beckmann's facets: rho_d, rho_s, m, n and kappa.
#[derive(Clone, Copy, Debug)]
pub struct Native;

/// The glTF material.
pub static GLTF: Model = Model::own::<Own<Gltf>, 4, 8>("gltf", "glTF 2.0 material", "glTF 2.0, Appendix B.3");
/// The principled BSDF.
pub static PRINCIPLED: Model = Model::own::<Own<Principled>, 4, 8>("principled", "Mitsuba's principled", "Burley 2012");
/// The rough conductor on a diffuse base.
pub static NATIVE: Model =
    Model::own::<Own<Native>, 5, 8>("roughconductor", "Mitsuba's roughconductor and diffuse", "Mitsuba 3");

pub(super) const BASE: Parameter = Parameter::new("base", "c", Role::Shape, 1.0).spread(0.01, 1.0);
pub(super) const METALLIC: Parameter = Parameter::new("metallic", "M", Role::Shape, 1.0).spread(0.05, 1.0);
/// Mitsuba holds alpha at 0.001 at least.
pub(super) const ROUGHNESS: Parameter = Parameter::new("roughness", "r", Role::Shape, 1.0)
    .bounds(0.032, 1.0)
    .domain(0.032, 1.0)
    .spread(0.05, 1.0);

impl Formula<4> for Gltf {
    const PARAMETERS: [Parameter; 4] = [BASE, METALLIC, ROUGHNESS, index(10.0)];

    fn brdf<R: Real, N: Number<R>>([base, metallic, roughness, n]: &[N; 4], at: &Directions<R>) -> N {
        let lobe = ggx(*roughness, at);
        let grazing = power5(R::ONE - at.cos_theta_d);
        let root = (*n - R::ONE) / (*n + R::ONE);
        let dielectric = schlick(root.squared(), grazing);
        let diffuse = *base / R::PI;
        let plastic = diffuse + dielectric * (lobe - diffuse);
        let metal = schlick(*base, grazing) * lobe;
        plastic + *metallic * (metal - plastic)
    }
}

impl Formula<4> for Principled {
    /// An index of 1.7888 is a `specular` of 1, the largest.
    const PARAMETERS: [Parameter; 4] = [BASE, METALLIC, ROUGHNESS, index(1.788_854)];

    fn brdf<R: Real, N: Number<R>>([base, metallic, roughness, n]: &[N; 4], at: &Directions<R>) -> N {
        let grazing = power5(R::ONE - at.cos_theta_d);
        let metal = schlick(*base, grazing);
        let plastic = fresnel(*n, N::of(R::ZERO), at.cos_theta_d);
        let (out, into) = (power5(R::ONE - at.cos_s), power5(R::ONE - at.cos_i));
        let half = R::of(0.5);
        let smooth = (R::ONE - half * into) * (R::ONE - half * out);
        let retro = *roughness * (R::of(2.0) * at.cos_theta_d * at.cos_theta_d);
        let retro = retro * ((retro - R::ONE) * (out * into) + (out + into));
        let not_metallic = -*metallic + R::ONE;
        (*metallic * metal + not_metallic * plastic) * ggx(*roughness, at)
            + not_metallic * *base / R::PI * (retro + smooth)
    }
}

impl Formula<5> for Native {
    const PARAMETERS: [Parameter; 5] = [
        Parameter::new("rho_d", "ρ_d", Role::Weight, 1.0),
        Parameter::new("rho_s", "ρ_s", Role::Weight, 100.0),
        Parameter::new("m", "m", Role::Slope, 3.0)
            .bounds(1e-4, 3.0)
            .domain(1e-6, 1e3),
        index(100.0),
        Parameter::new("kappa", "κ", Role::Absorption, 100.0).spread(0.0, 25.0),
    ];

    fn brdf<R: Real, N: Number<R>>([rho_d, rho_s, m, n, kappa2]: &[N; 5], at: &Directions<R>) -> N {
        let m2 = m.squared();
        let tan2 = at.tan2_theta_h;
        let stretch = (R::ONE + tan2) * (R::ONE + tan2);
        let beckmann = (N::of(-tan2) / m2).exp() * stretch / (m2 * R::PI);
        let masking = beckmann_masking(*m, at.cos_i, at.sin_i) * beckmann_masking(*m, at.cos_s, at.sin_s.abs());
        let lobe = beckmann * masking / (R::of(4.0) * at.cos_i * at.cos_s);
        *rho_d / R::PI + *rho_s * fresnel(*n, *kappa2, at.cos_theta_d) * lobe
    }
}

pub(super) const fn index(most: f64) -> Parameter {
    let largest = if most < 5.0 { most } else { 5.0 };
    Parameter::new("n", "n", Role::Index, most)
        .bounds(1.0, most)
        .domain(1.0, most)
        .spread(1.02, largest)
}

/// D G / (4 cos theta_i cos theta_s).
fn ggx<R: Real, N: Number<R>>(roughness: N, at: &Directions<R>) -> N {
    let alpha2 = roughness.squared().squared();
    let one = at.tan2_theta_h + R::ONE;
    let spread = alpha2 + at.tan2_theta_h;
    // With cos^4 theta_h = 1 / one^2.
    let d = alpha2 * (one * one) / (spread.squared() * R::PI);
    let side = |cos: R| (alpha2 * (R::ONE - cos * cos) + cos * cos).sqrt() + cos;
    d / (side(at.cos_i) * side(at.cos_s))
}

/// Smith's masking for Beckmann's facets in the rational form that Mitsuba has.
fn beckmann_masking<R: Real, N: Number<R>>(m: N, cos: R, sin: R) -> N {
    if sin == R::ZERO {
        return N::of(R::ONE);
    }
    let a = N::of(cos / sin) / m;
    if a.value() >= R::of(1.6) {
        return N::of(R::ONE);
    }
    (a * R::of(2.181) + R::of(3.535)) * a / ((a * R::of(2.577) + R::of(2.276)) * a + R::ONE)
}

/// Fresnel's reflectance of unpolarised light at an index n - i kappa.
pub(super) fn fresnel<R: Real, N: Number<R>>(n: N, kappa2: N, cos: R) -> N {
    let (c2, s2) = (cos * cos, R::ONE - cos * cos);
    let n2 = n.squared();
    let real = n2 - kappa2 - s2;
    let modulus = (real.squared() + n2 * kappa2 * R::of(4.0)).sqrt();
    let a = ((modulus + real) * R::of(0.5)).sqrt() * (R::of(2.0) * cos);
    let perpendicular = (modulus - a + c2) / (modulus + a + c2);
    let parallel = (modulus * c2 - a * s2 + s2 * s2) / (modulus * c2 + a * s2 + s2 * s2);
    perpendicular * (parallel + R::ONE) * R::of(0.5)
}

/// Schlick's rise from `normal` to 1.
pub(super) fn schlick<R: Real, N: Number<R>>(normal: N, grazing: R) -> N {
    normal * (R::ONE - grazing) + grazing
}

pub(super) fn power5<R: Real>(x: R) -> R {
    let x2 = x * x;
    x2 * x2 * x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// theta_i, theta_s and Delta phi in degrees.
    const DIRECTIONS: [[f64; 3]; 4] = [
        [30.0, 30.0, 180.0],
        [60.0, 20.0, 90.0],
        [75.0, 70.0, 180.0],
        [10.0, 50.0, 0.0],
    ];

    fn at([theta_i, theta_s, delta_phi]: [f64; 3]) -> Directions<f64> {
        Directions::new(theta_i.to_radians(), theta_s.to_radians(), delta_phi.to_radians()).unwrap()
    }

    /// Values that Mitsuba 3.9.1 gave in single precision.
    #[test]
    fn mitsubas_models_are_those_that_mitsuba_computes() {
        let principled = [0.339_601_58, 0.102_911_562, 3.139_085_1, 0.102_248_51];
        let conductor = [1.102_208_7, 1.017_657_5e-4, 10.820_193, 5.570_623_5e-4];
        for (directions, (principled, conductor)) in DIRECTIONS.into_iter().zip(principled.into_iter().zip(conductor)) {
            let own: f64 = Principled::brdf(&[0.4, 0.3, 0.5, 1.5], &at(directions));
            assert!((own / principled - 1.0).abs() < 2e-6, "{directions:?} {own}");
            let own: f64 = Native::brdf(&[0.0, 1.0, 0.2, 1.5, 4.0], &at(directions));
            assert!((own / conductor - 1.0).abs() < 2e-5, "{directions:?} {own}");
        }
    }

    /// The formulas of glTF 2.0, Appendix B.3, with vectors, as they are printed there.
    #[test]
    fn gltf_is_the_printed_one() {
        let [base, metallic, roughness, ior] = [0.4, 0.3, 0.5, 1.4];
        for directions in DIRECTIONS {
            let vector = |theta: f64, phi: f64| {
                let [(sin, cos), (sin_phi, cos_phi)] = [theta, phi].map(|angle| libm::sincos(angle.to_radians()));
                [sin * cos_phi, sin * sin_phi, cos]
            };
            let (v, l) = (vector(directions[0], 0.0), vector(directions[1], directions[2]));
            let sum: [f64; 3] = std::array::from_fn(|k| v[k] + l[k]);
            let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
            let h = sum.map(|x| x / length);
            let v_h: f64 = (0..3).map(|k| v[k] * h[k]).sum();
            let (n_h, n_v, n_l, alpha) = (h[2], v[2], l[2], roughness * roughness);
            let a2 = alpha * alpha;
            let d = a2 / (std::f64::consts::PI * libm::pow(n_h * n_h * (a2 - 1.0) + 1.0, 2.0));
            let side = |cos: f64| 1.0 / (cos + (a2 + (1.0 - a2) * cos * cos).sqrt());
            let specular = d * side(n_v) * side(n_l);
            let rise = libm::pow(1.0 - v_h, 5.0);
            let f0 = libm::pow((1.0 - ior) / (1.0 + ior), 2.0);
            let fresnel = f0 + (1.0 - f0) * rise;
            let dielectric = (1.0 - fresnel) * base / std::f64::consts::PI + fresnel * specular;
            let metal = specular * (base + (1.0 - base) * rise);
            let expected = (1.0 - metallic) * dielectric + metallic * metal;
            let own: f64 = Gltf::brdf(&[base, metallic, roughness, ior], &at(directions));
            assert!((own / expected - 1.0).abs() < 1e-13, "{directions:?} {own} {expected}");
        }
    }
}
