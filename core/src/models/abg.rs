use super::FLOOR;
use crate::dual::Number;
use crate::formula::{Directions, Formula};
use crate::model::{Parameter, Role};
use crate::real::Real;

/// ABg of the optical design programs (Pfisterer, "Approximated scatter models for stray light analysis", Opt. Photon. News 22(10), 2011): `f = rho_d / pi + A / (B + |beta - beta_0|^g)`.
#[derive(Clone, Copy, Debug)]
pub struct Abg;

impl Formula<4> for Abg {
    const PARAMETERS: [Parameter; 4] = [
        FLOOR,
        Parameter::new("A", "A", Role::Weight, 1e6)
            .unit("sr^-1")
            .what("height far from the peak, times |beta - beta_0|^g"),
        Parameter::new("B", "B", Role::Shape, 10.0)
            .what("|beta - beta_0|^g at the shoulder of the peak")
            .bounds(1e-15, 10.0)
            .domain(1e-30, 1e6)
            .spread(1e-9, 1.0),
        Parameter::new("g", "g", Role::Shape, 6.0)
            .what("slope of the wings")
            .bounds(0.0, 6.0)
            .domain(0.0, 20.0)
            .spread(0.5, 4.0),
    ];

    fn brdf<R: Real, N: Number<R>>([rho_d, a, b, g]: &[N; 4], at: &Directions<R>) -> N {
        // At the peak itself ln has no value, and the power none that counts.
        let shift = N::of(at.shift.max(R::TINY));
        *rho_d / R::PI + *a / (*b + shift.pow(*g))
    }
}
