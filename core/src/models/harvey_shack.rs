use super::FLOOR;
use crate::dual::Number;
use crate::formula::{Directions, Formula};
use crate::model::{Parameter, Role};
use crate::real::Real;

/// Harvey and Shack's shift-invariant scatter with a shoulder (Harvey 1976; Pfisterer 2011): `f = rho_d / pi + b_0 (1 + (|beta - beta_0| / l)^2)^(s / 2)`, with the slope s given as its size.
#[derive(Clone, Copy, Debug)]
pub struct HarveyShack;

impl Formula<4> for HarveyShack {
    const PARAMETERS: [Parameter; 4] = [
        FLOOR,
        Parameter::new("b_0", "b_0", Role::Weight, 1e6)
            .unit("sr^-1")
            .what("BRDF at the peak"),
        Parameter::new("l", "l", Role::Slope, 2.0)
            .what("|beta - beta_0| at the shoulder of the peak")
            .bounds(1e-7, 2.0)
            .domain(1e-12, 1e6)
            .spread(0.0, 1.0),
        Parameter::new("s", "s", Role::Shape, 6.0)
            .what("size of the slope of the wings, which is negative")
            .bounds(0.0, 6.0)
            .domain(0.0, 20.0)
            .spread(0.5, 4.0),
    ];

    fn brdf<R: Real, N: Number<R>>([rho_d, b_0, l, s]: &[N; 4], at: &Directions<R>) -> N {
        let ratio = N::of(at.shift) / *l;
        *rho_d / R::PI + *b_0 * (ratio.squared() + R::ONE).pow(-(*s * R::of(0.5)))
    }
}
