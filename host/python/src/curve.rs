//! The BRDF of a model.

use brdfit::engine::{Material, Model, Values, View};
use brdfit::input::azimuth;
use brdfit::number::shortest;
use brdfit::parameters::{self, check};
use brdfit_core::geometry::{Geometry, Sample};
use brdfit_core::real::Real;
use numpy::ndarray::{ArrayView1, ArrayView2};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::options::refuse;
use crate::rows::whole;
use crate::watch::scoped;

/// Angles in degrees, and parameters, of shapes (samples) and (samples, parameters).
#[derive(Clone, Copy)]
struct Points<'a> {
    theta_i: ArrayView1<'a, f64>,
    theta_s: ArrayView1<'a, f64>,
    delta_phi: ArrayView1<'a, f64>,
    x: ArrayView2<'a, f64>,
    /// Half-angle of the detector and offset of theta_s, radians.
    seen: (f64, f64),
}

/// The BRDF in sr^-1, or ln of it, at theta_i, theta_s and delta_phi in degrees, each of shape (samples), with parameters of shape (samples, parameters), through an aperture of some half-angle and with an offset of theta_s in degrees; NaN where a parameter is NaN, and where an offset leads out of the plane of incidence or beyond the horizon.
#[pyfunction]
pub fn brdf<'py>(
    py: Python<'py>,
    model: &str,
    angles: [PyReadonlyArray1<'py, f64>; 3],
    x: PyReadonlyArray2<'py, f64>,
    ln: bool,
    seen: (f64, f64),
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let model = parameters::model(model).map_err(|error| refuse(&error))?;
    let points = Points {
        theta_i: whole("theta_i", &angles[0])?,
        theta_s: whole("theta_s", &angles[1])?,
        delta_phi: whole("delta_phi", &angles[2])?,
        x: whole("parameters", &x)?,
        seen: (seen.0.to_radians(), seen.1.to_radians()),
    };
    let all = |until: brdfit::engine::Until| {
        let mut values = Vec::with_capacity(points.theta_i.len());
        for index in 0..points.theta_i.len() {
            if until.is_over() {
                break;
            }
            values.push(points.value(model, index, ln)?);
        }
        Ok(values)
    };
    let values: Result<Vec<f64>, String> = scoped(py, all, |_| Ok(()))?;
    Ok(values.map_err(PyValueError::new_err)?.into_pyarray(py))
}

impl Points<'_> {
    fn value(&self, model: &'static Model, index: usize, ln: bool) -> Result<f64, String> {
        // Below this the exponential is not a normal number.
        const LEAST_LN: f64 = -708.0;
        let (angle_i, angle_s) = (self.theta_i[index], self.theta_s[index]);
        let sample = Sample {
            theta_i: angle_i.to_radians(),
            theta_s: angle_s.to_radians(),
            delta_phi: azimuth(self.delta_phi[index]),
            brdf: 1.0,
            weight: 1.0,
        };
        Geometry::new(sample.theta_i, sample.theta_s, sample.delta_phi).map_err(|error| {
            let at = format!("theta_i = {}, theta_s = {}", shortest(angle_i), shortest(angle_s));
            format!("{error} at {at} degrees; take 0 <= theta_i < 90 and -90 < theta_s < 90")
        })?;
        let values: Values = self.x.row(index).iter().copied().collect();
        if values.iter().any(|value| value.is_nan()) {
            return Ok(f64::NAN);
        }
        for (place, value) in values.iter().enumerate() {
            check(model, place, *value).map_err(|error| error.message())?;
        }
        let (aperture, offset) = self.seen;
        let view = View {
            material: Material { model, values },
            aperture,
            offset,
        };
        let ln_f = view.ln_f(&sample).unwrap_or(f64::NAN);
        Ok(match ln {
            true => ln_f,
            false if ln_f < LEAST_LN => 0.0,
            false => Real::portable_exp(ln_f),
        })
    }
}
