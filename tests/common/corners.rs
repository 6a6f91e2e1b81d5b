//! What must hold at every corner of a formula's domain.

use brdfit_core::formula::{Formula, Own};
use brdfit_core::model::Model;
use brdfit_core::real::Real;
use brdfit_core::residuals::ln_f;

/// Has every corner of the domain a finite ln f with finite derivatives?
///
/// `directions` are theta_i, theta_s and delta_phi in radians.
///
/// # Panics
/// One is not.
pub fn corners<R: Real, F: Formula<P>, const P: usize>(directions: &[[f64; 3]]) {
    for corner in 0..1u32 << P {
        let x = std::array::from_fn(|k| {
            let (least, most) = F::PARAMETERS[k].domain;
            R::of(if corner >> k & 1 == 0 { least } else { most })
        });
        for angles in directions {
            let [theta_i, theta_s, delta_phi] = angles.map(R::of);
            let at = <Own<F> as Model<R, P, 8>>::geometry(theta_i, theta_s, delta_phi.min(R::PI));
            let (value, gradient) = ln_f::<R, Own<F>, P, 8>(&x, at.expect("above the horizon"));
            let finite = value.is_finite() && gradient.iter().all(|slope| slope.is_finite());
            assert!(finite, "{x:?} {angles:?}: {value:?} {gradient:?}");
        }
    }
}
