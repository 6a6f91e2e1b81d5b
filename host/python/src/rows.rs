//! Rows of arrays as samples of scans. Degrees become radians here, in the way of the program's files.

use brdfit::engine::Until;
use brdfit::input::left_out::{Counts, Reason};
use brdfit::input::weight::{self, Deviation, Source};
use brdfit::input::{azimuth, doubt};
use brdfit::number::shortest;
use brdfit_core::geometry::{Observation, Sample};
use numpy::ndarray::{ArrayView, ArrayView2, Dimension};
use numpy::{Element, PyArrayMethods, PyReadonlyArray, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Arrays of the same shape (scans, samples).
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Arrays<'py> {
    theta_i: PyReadonlyArray2<'py, f64>,
    theta_s: PyReadonlyArray2<'py, f64>,
    delta_phi: PyReadonlyArray2<'py, f64>,
    brdf: PyReadonlyArray2<'py, f64>,
    sigma: Option<PyReadonlyArray2<'py, f64>>,
    mask: Option<PyReadonlyArray2<'py, bool>>,
    /// Which angles have no unit of their own: that they are degrees is the caller's word alone.
    asked: Vec<String>,
}

/// The numbers of an array.
///
/// # Errors
/// They are not at whole steps, where another library would read between them.
pub fn whole<'a, T: Element, D: Dimension>(
    name: &str,
    array: &'a PyReadonlyArray<'_, T, D>,
) -> PyResult<ArrayView<'a, T, D>> {
    let size = size_of::<T>();
    let aligned = (array.data() as usize).is_multiple_of(align_of::<T>());
    if !aligned || array.strides().iter().any(|&step| step % size as isize != 0) {
        return Err(PyValueError::new_err(format!(
            "{name} is not at whole steps in memory; give a copy of it"
        )));
    }
    Ok(array.as_array())
}

impl Arrays<'_> {
    /// What can be read without the interpreter.
    ///
    /// # Errors
    /// As [`whole`].
    pub fn scans(&self) -> PyResult<Scans<'_>> {
        let sigma = self.sigma.as_ref().map(|sigma| whole("sigma", sigma));
        let mask = self.mask.as_ref().map(|mask| whole("mask", mask));
        Ok(Scans {
            theta_i: whole("theta_i", &self.theta_i)?,
            theta_s: whole("theta_s", &self.theta_s)?,
            delta_phi: whole("delta_phi", &self.delta_phi)?,
            brdf: whole("brdf", &self.brdf)?,
            sigma: sigma.transpose()?,
            mask: mask.transpose()?,
            asked: ["theta_i", "theta_s", "delta_phi"].map(|name| self.asked.iter().any(|one| one == name)),
        })
    }
}

/// Angles in degrees, BRDF and its standard deviation in sr^-1; shape (scans, samples).
#[derive(Clone, Copy)]
pub struct Scans<'a> {
    theta_i: ArrayView2<'a, f64>,
    theta_s: ArrayView2<'a, f64>,
    delta_phi: ArrayView2<'a, f64>,
    brdf: ArrayView2<'a, f64>,
    sigma: Option<ArrayView2<'a, f64>>,
    mask: Option<ArrayView2<'a, bool>>,
    asked: [bool; 3],
}

/// What is seen of a scan.
pub struct Seen {
    /// The samples, weighted as the program weights those of a file.
    pub samples: Vec<Sample<f64>>,
    /// The standard deviation of ln f that a weight of 1 stands for.
    pub sigma_ln: Option<f64>,
    /// The standard deviations, one a sample; none if none were given.
    pub deviations: Vec<Deviation>,
    /// What is not seen.
    pub left_out: Counts,
}

impl Scans<'_> {
    /// How many scans there are.
    pub fn count(&self) -> usize {
        self.brdf.nrows()
    }

    /// The samples of a scan that no mask covers; fewer where nobody waits for them any more.
    ///
    /// # Errors
    /// The angles may be radians; with `drop_invalid` false, what is wrong with the first sample that is not valid.
    pub fn seen(&self, scan: usize, drop_invalid: bool, until: Until) -> Result<Seen, String> {
        self.in_degrees(scan)?;
        let mut samples = Vec::with_capacity(self.brdf.ncols());
        let (mut weights, mut left_out) = (weight::Count::default(), Counts::default());
        let mut deviations = Vec::new();
        for index in 0..self.brdf.ncols() {
            if until.is_over() {
                break;
            }
            let at = [scan, index];
            let theta_i = self.theta_i[at];
            if self.mask.is_some_and(|mask| mask[at]) {
                left_out.add(Reason::Masked, theta_i);
                continue;
            }
            let sample = Sample {
                theta_i: theta_i.to_radians(),
                theta_s: self.theta_s[at].to_radians(),
                delta_phi: azimuth(self.delta_phi[at]),
                brdf: self.brdf[at],
                weight: self.weight(at),
            };
            if Observation::new(&sample).is_ok() && sample.weight > 0.0 {
                weights.add(Source::Sigma);
                samples.push(sample);
                // In the order of the reader's operations, for its bits.
                deviations.extend(self.sigma.as_ref().map(|sigma| Deviation {
                    absolute: sigma[at] / self.brdf[at] * self.brdf[at],
                    relative: 0.0,
                }));
            } else if drop_invalid {
                left_out.add(Reason::NotValid, theta_i);
            } else {
                return Err(self.fault(scan, index));
            }
        }
        let sigma_ln = match self.sigma {
            Some(_) => weights.normalise(&mut samples),
            None => None,
        };
        Ok(Seen {
            samples,
            sigma_ln,
            deviations,
            left_out,
        })
    }

    /// The reader's question whether degrees are radians, of the angles that may be asked.
    fn in_degrees(&self, scan: usize) -> Result<(), String> {
        let [theta_i, theta_s, delta_phi] = self.asked;
        let row = |angles: &ArrayView2<'_, f64>, asked: bool| match asked {
            true => doubt::largest(angles.row(scan).iter().copied()),
            false => 0.0,
        };
        let polar = row(&self.theta_i, theta_i).max(row(&self.theta_s, theta_s));
        let azimuths = self.delta_phi.row(scan);
        let azimuths = azimuths.iter().copied().filter(|_| delta_phi);
        doubt::degrees(polar, self.brdf.ncols(), azimuths).map_err(|error| error.in_exception())
    }

    /// One over the standard deviation of ln f; 0 or not finite where that is not a number above 0.
    fn weight(&self, at: [usize; 2]) -> f64 {
        match &self.sigma {
            Some(sigma) => 1.0 / (sigma[at] / self.brdf[at]),
            None => 1.0,
        }
    }

    /// One line on a sample that is not valid.
    fn fault(&self, scan: usize, index: usize) -> String {
        // The cosine of what is nearer to 90 degrees is rounding.
        const HORIZON: f64 = 90.0 - 1e-13;
        let at = [scan, index];
        let place = |name: &str| match self.count() {
            1 => format!("{name}[{index}]"),
            _ => format!("scan {scan}: {name}[{index}]"),
        };
        let angles = [
            ("theta_i", self.theta_i[at], 0.0..=HORIZON),
            ("theta_s", self.theta_s[at], -HORIZON..=HORIZON),
            ("delta_phi", self.delta_phi[at], f64::MIN..=f64::MAX),
        ];
        for (name, degrees, range) in angles {
            if !range.contains(&degrees) {
                let help = "take degrees, 0 <= theta_i < 90 and -90 < theta_s < 90, or drop_invalid=True";
                return format!(
                    "{} is {}, which is not an angle above the horizon; {help}",
                    place(name),
                    shortest(degrees)
                );
            }
        }
        let brdf = self.brdf[at];
        let weight = self.weight(at);
        if let Some(sigma) = &self.sigma
            && (f64::MIN_POSITIVE..f64::INFINITY).contains(&brdf)
            && !(weight > 0.0 && weight.is_finite())
        {
            let help = "leave the sample out, or take drop_invalid=True";
            let value = shortest(sigma[at]);
            return format!(
                "{} is {value}, which is not a standard deviation; {help}",
                place("sigma")
            );
        }
        let why = if brdf.is_finite() && brdf <= 0.0 {
            "which has no logarithm"
        } else {
            "which is not a number to compute with"
        };
        format!(
            "{} is {}, {why}; leave the sample out, or take drop_invalid=True",
            place("brdf"),
            shortest(brdf)
        )
    }
}
