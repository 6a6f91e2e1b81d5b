use super::FLOOR;
use crate::dual::Number;
use crate::formula::{Directions, Formula};
use crate::model::{Parameter, Role};
use crate::real::Real;

/// Maxwell, Beard, Weiner, Ladd and Ladd 1973 (ERIM, AD-913816), with the shadowing and the volume of the NEF database (Westlund and Meyer, "A BRDF database employing the Beard-Maxwell reflection model", Graphics Interface 2002, Eq. 10), for paints: kappa = 0.
///
/// With theta_h the tilt of the facet and theta_d the angle of incidence on it,
/// `f = rho_d / pi + 2 rho_v / (cos theta_i + cos theta_s) + rho_s F(theta_d) / F(0) exp(-(theta_h / m)^2) cos^2 theta_h / (cos theta_i cos theta_s) S`,
/// where `S = (1 + theta_h / Omega exp(-2 theta_d / tau)) / (1 + theta_h / Omega)` is shadowing and obscuration.
#[derive(Clone, Copy, Debug)]
pub struct BeardMaxwell;

const fn angle(name: &'static str, symbol: &'static str) -> Parameter {
    Parameter::new(name, symbol, Role::Shape, 10.0)
        .unit("rad")
        .bounds(0.01, 10.0)
        .domain(1e-3, 1e3)
        .spread(0.05, 3.0)
}

impl Formula<7> for BeardMaxwell {
    const PARAMETERS: [Parameter; 7] = [
        FLOOR,
        Parameter::new("rho_s", "ρ_s", Role::Weight, 1e6)
            .unit("sr^-1")
            .what("BRDF of the first surface at normal incidence, seen from the source"),
        Parameter::new("rho_v", "ρ_v", Role::Weight, 100.0)
            .unit("sr^-1")
            .what("BRDF of the volume at normal incidence, seen from the source"),
        Parameter::new("m", "m", Role::Slope, 3.0)
            .what("tilt of the facets in radians, where their density has fallen to 1/e")
            .bounds(1e-4, 3.0)
            .domain(1e-6, 1e3),
        Parameter::new("n", "n", Role::Index, 100.0)
            .what("index of refraction")
            .bounds(1.0, 100.0)
            .domain(1.0, crate::model::LARGEST)
            .spread(1.0, 10.0),
        angle("tau", "τ").what("angle of incidence on the facets over which shadowing sets in"),
        angle("Omega", "Ω").what("tilt of the facets from which they are obscured"),
    ];

    fn brdf<R: Real, N: Number<R>>([rho_d, rho_s, rho_v, m, n, tau, omega]: &[N; 7], at: &Directions<R>) -> N {
        let cosines = at.cos_i * at.cos_s;
        let volume = R::of(2.0) / (at.cos_i + at.cos_s);
        let theta_h = at.tan2_theta_h.sqrt().portable_atan();
        let c = at.cos_theta_d;
        let theta_d = ((R::ONE - c * c).max(R::ZERO).sqrt() / c).portable_atan();
        let cos2_theta_h = R::ONE / (R::ONE + at.tan2_theta_h);
        // What is too low for the exponential of this type counts as 0.
        let exponent = N::of(-theta_h * theta_h) / m.squared();
        let density = if exponent.value() < R::LEAST_EXPONENT {
            N::of(R::ZERO)
        } else {
            exponent.exp()
        };
        let tilt = N::of(theta_h) / *omega;
        let shadowing = (tilt * (N::of(-R::of(2.0) * theta_d) / *tau).exp() + R::ONE) / (tilt + R::ONE);
        let surface = density * over_normal(*n, c) * shadowing * (cos2_theta_h / cosines);
        *rho_d / R::PI + *rho_v * volume + *rho_s * surface
    }
}

/// F(theta) / F(0) of a dielectric: with p = sqrt(n^2 - sin^2 theta) and c = cos theta, `((n + 1) / (c + p))^4 (1 + t^2) / 2`, `t = (p c - sin^2 theta) / (p c + sin^2 theta)`, which holds at n = 1 too.
fn over_normal<R: Real, N: Number<R>>(n: N, c: R) -> N {
    let s2 = (R::ONE - c * c).max(R::ZERO);
    let p = (n.squared() - s2).sqrt();
    let t = (p * c - s2) / (p * c + s2);
    let amplitude = ((n + R::ONE) / (p + c)).squared();
    amplitude.squared() * (t.squared() + R::ONE) * R::of(0.5)
}
