//! A model of one's own, fitted: Oren and Nayar's rough diffuse reflection, with Ward's lobe for its gloss.
//!
//! `cargo run --release -p brdfit-engine --example own_model`; a crate of one's own needs `brdfit-core` and `brdfit-engine`.

use brdfit_core::dual::Number;
use brdfit_core::formula::{Directions, Formula, Own, worst_slope};
use brdfit_core::geometry::Sample;
use brdfit_core::model::{Parameter, Role};
use brdfit_core::real::Real;
use brdfit_engine::{FitOptions, Model, fit};

/// Oren and Nayar 1994 (their qualitative model), with the lobe of Ward 1992.
#[derive(Clone, Copy)]
struct Plaster;

impl Formula<4> for Plaster {
    const PARAMETERS: [Parameter; 4] = [
        Parameter::new("rho_d", "ρ_d", Role::Weight, 1.0).what("albedo of the facets"),
        Parameter::new("rho_s", "ρ_s", Role::Weight, 10.0).what("weight of the lobe"),
        Parameter::new("m", "m", Role::Slope, 3.0)
            .bounds(1e-3, 3.0)
            .domain(1e-6, 1e3),
        Parameter::new("sigma", "σ", Role::Shape, 1.0)
            .unit("rad")
            .what("roughness"),
    ];

    fn brdf<R: Real, N: Number<R>>([rho_d, rho_s, m, sigma]: &[N; 4], at: &Directions<R>) -> N {
        let (m2, sigma2) = (m.squared(), sigma.squared());
        let a = -(sigma2 * R::of(0.5)) / (sigma2 + R::of(0.33)) + R::ONE;
        let b = sigma2 * R::of(0.45) / (sigma2 + R::of(0.09));
        let retro = (at.sin_i * at.sin_s * at.cos_phi).max(R::ZERO) / at.cos_i.max(at.cos_s);
        let lobe = (N::of(-at.tan2_theta_h) / m2).exp() / (m2 * (R::of(4.0) * R::PI));
        *rho_d / R::PI * (a + b * retro) + *rho_s * lobe / (at.cos_i * at.cos_s).sqrt()
    }
}

static PLASTER: Model = Model::own::<Own<Plaster>, 4, 8>(
    "plaster",
    "rough diffuse reflection with a lobe",
    "Oren and Nayar 1994; Ward 1992",
);

fn main() {
    let truth = [0.6, 0.05, 0.2, 0.4];
    // A formula that gives its own derivatives is checked against dual numbers like this.
    let at = Directions::new(0.5, 0.2, f64::PI).expect("above the horizon");
    let (place, off) = worst_slope::<f64, Plaster, 4>(&truth, &at);
    println!(
        "derivatives: off by {off:.1e} at most, by {}",
        Plaster::PARAMETERS[place].name
    );

    let angles = [20.0f64, 60.0].into_iter();
    let directions = angles.flat_map(|theta_i| (-80..=80).step_by(5).map(move |theta_s| (theta_i, f64::from(theta_s))));
    let samples: Vec<Sample<f64>> = directions
        .enumerate()
        .map(|(k, (theta_i, theta_s))| {
            let empty = Sample::in_plane(theta_i.to_radians(), theta_s.to_radians(), 1.0);
            // Measured 1 % too high and too low in turn.
            let noise = if k % 2 == 0 { 0.01 } else { -0.01 };
            let ln_f = PLASTER.ln_f(&truth, &empty).expect("above the horizon");
            Sample {
                brdf: Real::portable_exp(ln_f + noise),
                ..empty
            }
        })
        .collect();
    let outcome = fit(&samples, &FitOptions::of(&PLASTER)).expect("a valid scan");
    println!("{} minima, rms of ln f {:.4}", outcome.minima.len(), outcome.rms_ln);
    let errors = &outcome.uncertainty.stderr;
    for ((name, value), (error, truth)) in PLASTER.named(&outcome.params).zip(errors.iter().zip(truth)) {
        println!("{name:<6} {value:.4} +- {error:.4}, made with {truth}");
        assert!((value - truth).abs() < 3.0 * error, "{name} is not found again");
    }
}
