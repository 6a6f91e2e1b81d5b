//! ln f and its gradient at ordinary and extreme points.

use core::fmt::{self, Write};

use brdfit_core::brdf::{ALL, Brdf, NAMES, Params};
use brdfit_core::geometry::Geometry;
use brdfit_core::real::Real;

use super::number;

/// theta_i, theta_s, delta phi in degrees; rho_d, rho_s, rho_v, m, n, kappa.
const POINTS: [([f64; 3], [f64; 6]); 8] = [
    // Test data 1 at the specular peak, at the retro peak, between, and near grazing.
    ([45.0, 45.0, 180.0], [0.1, 10.0, 0.01, 0.1, 3.0, 1.0]),
    ([45.0, -45.0, 180.0], [0.1, 10.0, 0.01, 0.1, 3.0, 1.0]),
    ([45.0, 37.0, 180.0], [0.1, 10.0, 0.01, 0.1, 3.0, 1.0]),
    ([45.0, 85.0, 180.0], [0.1, 10.0, 0.01, 0.1, 3.0, 1.0]),
    // Out of plane.
    ([30.0, 55.0, 120.0], [0.05, 2.0, 0.3, 0.4, 1.5, 0.0]),
    // A needle without a diffuse term: D_b underflows, ln f does not.
    ([30.0, 40.0, 180.0], [0.0, 1.0, 0.001, 0.005, 1.1, 0.86]),
    // n = 1, kappa = 0: the lobes drop out.
    ([20.0, 25.0, 180.0], [0.2, 1.0, 1.0, 0.2, 1.0, 0.0]),
    // The far corner of Table 1.
    ([80.0, 80.0, 180.0], [1.0, 100.0, 100.0, 10.0, 100.0, 100.0]),
];

pub fn run(out: &mut dyn Write) -> fmt::Result {
    writeln!(out, "f64")?;
    points::<f64>(out)?;
    writeln!(out, "f32")?;
    points::<f32>(out)
}

fn points<R: Real>(out: &mut dyn Write) -> fmt::Result {
    for (degrees, params) in POINTS {
        let [theta_i, theta_s, delta_phi] = degrees;
        writeln!(
            out,
            " theta_i {theta_i_} theta_s {theta_s_} delta_phi {delta_phi_}",
            theta_i_ = theta_i as i32,
            theta_s_ = theta_s as i32,
            delta_phi_ = delta_phi as i32
        )?;
        let [theta_i, theta_s, delta_phi] = degrees.map(|angle| R::of(angle * (core::f64::consts::PI / 180.0)));
        match Geometry::new(theta_i, theta_s, delta_phi) {
            Err(_) => writeln!(out, "  no geometry")?,
            Ok(geometry) => {
                let brdf = Brdf::<R, ALL>::new(&Params::from_array(params.map(R::of)));
                let (ln_f, gradient) = brdf.gradient(&geometry);
                number(out, "ln_f", ln_f)?;
                for (name, value) in NAMES.into_iter().zip(gradient) {
                    number(out, name, value)?;
                }
            }
        }
    }
    Ok(())
}
