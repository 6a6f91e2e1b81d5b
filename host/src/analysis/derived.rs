//! What a fit determines at each angle of incidence, also where the parameters themselves are not determined.

pub mod from_data;
mod shape;

use std::f64::consts::{LN_2, PI};

use brdfit_core::brdf::fresnel;
use brdfit_core::geometry::Sample;
use brdfit_core::real::Real;

use super::misfit::coverage_factor;
use super::reflectance::reflectance;
use super::unseen::without_errors;
use crate::engine::uncertainty::Uncertainty;
use crate::engine::{Material, Values, View};
use from_data::{Line, Read};
pub use shape::Value;
use shape::{HORIZON, crossing, tops};

/// The surface lobe in the plane of incidence, without the other terms.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Peak {
    /// Where it is brightest, radians, positive forward; at most 89.9 degrees.
    pub theta_s: f64,
    /// Its BRDF there, sr^-1.
    pub f: Value,
    /// Its full width at half of that, radians; `None` where it does not fall to half before the horizon.
    pub width: Option<Value>,
    /// What the samples say of both where residuals are correlated, which is in the errors; none where they say nothing.
    pub from_data: Option<Read>,
}

impl Peak {
    /// A value of it with the part of its error that is the model's, and that more samples or runs do not take away.
    pub fn of_model(&self, value: Value, read: impl Fn(&Read) -> Option<Value>) -> (Value, f64) {
        let read = self.from_data.as_ref().and_then(read);
        (value, read.map_or(0.0, |read| read.stderr))
    }
}

/// The derived quantities of one angle of incidence.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Derived {
    /// The angle, radians.
    pub theta_i: f64,
    /// rho_s F at theta_d = theta_i, which is the specular direction; `None` without a surface lobe.
    pub rho_s_f: Option<Value>,
    /// rho_v F at theta_de = theta_i, which is the retro direction; `None` without a volume lobe.
    pub rho_v_f: Option<Value>,
    /// The surface lobe; `None` if there is none.
    pub peak: Option<Peak>,
    /// Directional-hemispherical reflectance, dimensionless; above 1 the model makes energy.
    pub reflectance: Value,
}

impl Derived {
    /// Does no more light leave than arrives? None where the reflectance is not [`determined`].
    pub fn conserves_energy(&self, known: &Uncertainty) -> Option<bool> {
        conserve_energy(&[determined(self.reflectance, known)])
    }
}

/// Does no more light leave than arrives, by all reflectances? None where those that are not determined decide.
pub fn conserve_energy(reflectances: &[Option<f64>]) -> Option<bool> {
    let above = reflectances.iter().flatten().any(|reflectance| !(*reflectance <= 1.0));
    (above || reflectances.iter().all(Option::is_some)).then_some(!above)
}

/// A value that the fit determines; where it tells no errors at all nothing is known to be undetermined.
pub fn determined(value: Value, known: &Uncertainty) -> Option<f64> {
    let told = value.stderr.is_finite() || known.degrees_of_freedom == 0 || without_errors(known);
    told.then_some(value.value)
}

/// A value whose 95 % interval, of `factor` standard errors to each side, is wider than `range` to each side has none: its standard error is infinite.
fn told(value: Value, range: f64, factor: f64) -> Value {
    match factor * value.stderr < range {
        true => value,
        false => Value {
            stderr: f64::INFINITY,
            ..value
        },
    }
}

/// At each angle of incidence of `samples`, in ascending order; angles within a hundredth of a degree count as one.
pub fn at_each_angle(samples: &[Sample<f64>], view: impl Into<View>, known: &Uncertainty) -> Vec<Derived> {
    let view = view.into();
    // Student's t of thousands of degrees of freedom takes longer than all the rest.
    let factor = coverage_factor(known);
    let lines = from_data::of(samples, &view, known);
    let one = |theta_i: f64| with_factor(theta_i, &view.material, known, factor, Line::at(&lines, theta_i));
    angles(samples).into_iter().map(one).collect()
}

/// [`Derived::reflectance`] at each of the same angles.
pub fn reflectances(samples: &[Sample<f64>], material: &Material, known: &Uncertainty) -> Vec<Value> {
    let factor = coverage_factor(known);
    let one = |theta_i: f64| reflectance_at(theta_i, material, known, factor);
    angles(samples).into_iter().map(one).collect()
}

fn reflectance_at(theta_i: f64, material: &Material, known: &Uncertainty, factor: f64) -> Value {
    let (sum, gradient) = reflectance(material, theta_i);
    with_error((sum, gradient), material, known, factor)
}

/// A quantity with its gradient, of which no surface has more than it receives.
fn with_error((value, mut gradient): (f64, Values), material: &Material, known: &Uncertainty, factor: f64) -> Value {
    for (slope, parameter) in gradient.iter_mut().zip(material.values.iter()) {
        // What a parameter of its own size does not change does not depend on it, however unknown that is.
        if slope.abs() * parameter.abs().max(1.0) <= f64::EPSILON * value {
            *slope = 0.0;
        }
    }
    let stderr = known.stderr_of(&gradient);
    told(Value { value, stderr }, value.max(1.0), factor)
}

/// The angles of incidence, ascending, without those that count as one with another.
fn angles(samples: &[Sample<f64>]) -> Vec<f64> {
    let mut angles: Vec<f64> = samples.iter().map(|sample| sample.theta_i).collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|b, a| *b - *a < 0.01f64.to_radians());
    angles
}

/// At one angle of incidence, radians, by the parameters alone.
pub fn at(theta_i: f64, material: &Material, known: &Uncertainty) -> Derived {
    with_factor(theta_i, material, known, coverage_factor(known), None)
}

/// The same where it is known how many standard errors are the half of a 95 % interval.
fn with_factor(theta_i: f64, material: &Material, known: &Uncertainty, factor: f64, line: Option<&Line>) -> Derived {
    let slopes = material.off_zero();
    let product = |rho: &str| {
        let place = |name: &str| material.model.place(name);
        let (rho, n, kappa) = (place(rho)?, place("n")?, place("kappa"));
        let cos_i = Real::portable_sin_cos(theta_i).1;
        let of = |material: &Material| {
            let at = |place: usize| material.values[place];
            let (f, d_n, d_kappa) = fresnel(cos_i, at(n), kappa.map_or(0.0, at));
            let mut gradient = Values::from_fn(material.values.len(), |_| 0.0);
            gradient[n] = at(rho) * d_n;
            if let Some(kappa) = kappa {
                gradient[kappa] = at(rho) * d_kappa;
            }
            gradient[rho] = f;
            (at(rho) * f, gradient)
        };
        let product = of(material).0;
        (product > 0.0).then(|| with_error((product, of(&slopes).1), material, known, factor))
    };
    let rho_s_f = product("rho_s");
    Derived {
        theta_i,
        rho_s_f,
        rho_v_f: product("rho_v"),
        peak: rho_s_f.and_then(|product| peak(theta_i, material, known, (product.value, factor), line)),
        reflectance: reflectance_at(theta_i, material, known, factor),
    }
}

fn peak(
    theta_i: f64,
    material: &Material,
    known: &Uncertainty,
    (product, factor): (f64, f64),
    line: Option<&Line>,
) -> Option<Peak> {
    // The other terms do not belong to the lobe.
    const OTHERS: [&str; 2] = ["rho_d", "rho_v"];
    let lobe = OTHERS.iter().fold(*material, |material, name| material.with(name, 0.0));
    let sample = |theta_s: f64| Sample::in_plane(theta_i, theta_s, 1.0);
    let slopes = lobe.off_zero();
    let ln_f = |theta_s: f64| lobe.ln_f(&sample(theta_s)).unwrap_or(f64::NEG_INFINITY);
    let gradient = |theta_s: f64| {
        let mut gradient = slopes.gradient(&sample(theta_s))?.1;
        for place in OTHERS.iter().filter_map(|name| material.model.place(name)) {
            gradient[place] = 0.0;
        }
        Some(gradient)
    };
    let of_top = |top: f64| {
        let (at_top, ln_top) = (gradient(top)?, ln_f(top));
        let half = |end: f64| {
            let theta_s = crossing(|theta_s| ln_f(theta_s) - (ln_top - LN_2), top, end)?;
            let step = 1e-4 * (theta_s - top);
            let slope = (ln_f(theta_s + step) - ln_f(theta_s - step)) / (2.0 * step);
            let here = gradient(theta_s)?;
            Some((theta_s, Values::from_fn(here.len(), |k| (at_top[k] - here[k]) / slope)))
        };
        let width = half(HORIZON).zip(half(-HORIZON));
        let width = width.map(|((right, d_right), (left, d_left))| {
            let gradient = Values::from_fn(d_right.len(), |k| d_right[k] - d_left[k]);
            Value {
                value: right - left,
                stderr: known.stderr_of(&gradient),
            }
        });
        Some((ln_top, at_top, width))
    };
    let (top, others) = tops(&ln_f, theta_i, lobe.width());
    let (ln_top, at_top, mut width) = of_top(top)?;
    let f = Real::portable_exp(ln_top);
    let mut of_ln = known.stderr_of(&at_top);
    // Another maximum that may be the brightest one changes otherwise with the parameters.
    for (ln_other, at_other, other) in others.into_iter().filter_map(of_top) {
        let apart = Values::from_fn(at_top.len(), |k| at_top[k] - at_other[k]);
        if ln_top - ln_other < factor * known.stderr_of(&apart) {
            of_ln = of_ln.max(known.stderr_of(&at_other));
            width = width.zip(other).map(|(width, other)| Value {
                stderr: width
                    .stderr
                    .max(other.stderr)
                    .max((width.value - other.value).abs() / factor),
                ..width
            });
        }
    }
    let value = Value {
        value: f,
        stderr: f * of_ln,
    };
    let mut peak = Peak {
        theta_s: top,
        f: value,
        width,
        from_data: None,
    };
    peak.from_data = line.and_then(|line| line.peak(material, &lobe, value, width));
    let read = peak.from_data;
    // As high as with all the light.
    peak.f = told(
        value.with(read.map(|read| read.f)),
        f * product.recip().max(1.0),
        factor,
    );
    let of_width = read.and_then(|read| read.width);
    peak.width = width.map(|width| told(width.with(of_width), PI, factor));
    Some(peak)
}
