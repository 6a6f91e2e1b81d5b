use super::FLOOR;
use crate::dual::Number;
use crate::formula::{Directions, Formula};
use crate::model::{Parameter, Role};
use crate::real::Real;

/// Roughness with the K-correlation spectrum (Church and Takacs 1986; Dittman, "K-correlation power spectral density and surface scatter model", Proc. SPIE 6291, 2006) in the smooth-surface limit of Rayleigh and Rice with Q taken into the weight: `f = rho_d / pi + a cos theta_i cos theta_s / (1 + (b |beta - beta_0|)^2)^(c / 2)`.
///
/// With f_x = |beta - beta_0| / wavelength, b is 2 pi times the correlation length over the wavelength, and a is 16 pi^2 Q / wavelength^4 times the spectrum at 0.
#[derive(Clone, Copy, Debug)]
pub struct KCorrelation;

/// The same with two terms, a coarse and a fine roughness.
#[derive(Clone, Copy, Debug)]
pub struct KCorrelation2;

const fn height(name: &'static str) -> Parameter {
    Parameter::new(name, name, Role::Weight, 1e6)
        .unit("sr^-1")
        .what("BRDF at the peak at normal incidence")
}

const fn length(name: &'static str) -> Parameter {
    Parameter::new(name, name, Role::Shape, 1e7)
        .what("2 pi times the correlation length over the wavelength")
        .bounds(0.1, 1e7)
        .domain(1e-6, 1e12)
        .spread(1.0, 1e4)
}

const fn fall(name: &'static str) -> Parameter {
    Parameter::new(name, name, Role::Shape, 6.0)
        .what("size of the slope of the spectrum")
        .bounds(0.0, 6.0)
        .domain(0.0, 20.0)
        .spread(0.5, 4.0)
}

/// One term at a = 1.
fn term<R: Real, N: Number<R>>(b: N, c: N, at: &Directions<R>) -> N {
    ((b * at.shift).squared() + R::ONE).pow(-(c * R::of(0.5))) * (at.cos_i * at.cos_s)
}

impl Formula<4> for KCorrelation {
    const PARAMETERS: [Parameter; 4] = [FLOOR, height("a"), length("b"), fall("c")];

    fn brdf<R: Real, N: Number<R>>([rho_d, a, b, c]: &[N; 4], at: &Directions<R>) -> N {
        *rho_d / R::PI + *a * term(*b, *c, at)
    }
}

impl Formula<7> for KCorrelation2 {
    const PARAMETERS: [Parameter; 7] = [
        FLOOR,
        height("a"),
        length("b"),
        fall("c"),
        height("a_2"),
        length("b_2"),
        fall("c_2"),
    ];

    fn brdf<R: Real, N: Number<R>>([rho_d, a, b, c, a_2, b_2, c_2]: &[N; 7], at: &Directions<R>) -> N {
        *rho_d / R::PI + *a * term(*b, *c, at) + *a_2 * term(*b_2, *c_2, at)
    }
}
