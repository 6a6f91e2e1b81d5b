//! The models that are compared, each compiled as it is.

use brdfit_core::composed::{Composed, NAMES, OWN_SLOPE, SECOND, slot};
use brdfit_core::geometry::{Sample, SampleError};
use brdfit_core::lm::{Bounds, Options};
use brdfit_core::lobes::{Beckmann, Distribution, Facets, Ggx, Masking, NoMasking, Smith, VGroove};
use brdfit_core::real::Real;
use brdfit_core::search::{CANDIDATES, search};

use crate::FitError;

type Fit = fn(&Model, &[Sample<f64>], u64) -> Result<Fitted, FitError>;

/// A model that can be compared.
#[derive(Clone, Copy)]
pub struct Model {
    /// What `--models` calls it.
    pub name: &'static str,
    /// What it is made of.
    pub what: &'static str,
    /// Number of its parameters.
    pub parameters: usize,
    fit: Fit,
    ln_f: fn(&[f64], &Sample<f64>) -> Option<f64>,
}

/// A model's fit to a scan.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// The model's name.
    pub model: &'static str,
    /// Samples of weight above 0.
    pub samples: usize,
    /// Sum of squared residuals of ln f.
    pub cost: f64,
    /// Its distinct minima.
    pub minima: usize,
    /// Names and values of its parameters.
    pub parameters: Vec<(&'static str, f64)>,
}

impl Fitted {
    /// Eq. 17.
    pub fn mse2(&self) -> f64 {
        self.cost / (self.samples * self.samples) as f64
    }

    /// Root of the mean squared residual of ln f.
    pub fn rms_ln(&self) -> f64 {
        (self.cost / self.samples as f64).sqrt()
    }

    /// Akaike's criterion with Hurvich and Tsai's correction, the variance of the residuals counted as a parameter; infinite with too few samples.
    pub fn aicc(&self) -> f64 {
        let (samples, k) = (self.samples as f64, self.parameters.len() as f64 + 1.0);
        let room = samples - k - 1.0;
        if room > 0.0 {
            samples * Real::ln(self.cost / samples) + 2.0 * k + 2.0 * k * (k + 1.0) / room
        } else {
            f64::INFINITY
        }
    }
}

/// All of them, that of the paper first.
pub static MODELS: [Model; 9] = [
    model::<Beckmann, VGroove, 0, 6>("beckmann", "Eq. 14: Beckmann, V-groove masking"),
    model::<Beckmann, Smith, 0, 6>("beckmann-smith", "Beckmann, Smith masking"),
    model::<Beckmann, NoMasking, 0, 6>("beckmann-unmasked", "Beckmann, no masking"),
    model::<Beckmann, VGroove, OWN_SLOPE, 7>("beckmann-own-slope", "Eq. 14, the volume lobe with a slope of its own"),
    model::<Beckmann, VGroove, SECOND, 8>("beckmann-second", "Eq. 14 with a second surface lobe"),
    model::<Ggx, VGroove, 0, 6>("ggx", "GGX, V-groove masking"),
    model::<Ggx, Smith, 0, 6>("ggx-smith", "GGX, Smith masking"),
    model::<Ggx, VGroove, OWN_SLOPE, 7>("ggx-own-slope", "GGX, the volume lobe with a slope of its own"),
    model::<Ggx, VGroove, SECOND, 8>("ggx-second", "GGX with a second surface lobe"),
];

const fn model<D: Distribution, M: Masking<D>, const EXTRAS: u8, const P: usize>(
    name: &'static str,
    what: &'static str,
) -> Model {
    Model {
        name,
        what,
        parameters: P,
        fit: fit::<D, M, EXTRAS, P>,
        ln_f: ln_f::<D, M, EXTRAS, P>,
    }
}

impl Model {
    /// Searches the model's global optimum within the bounds of Table 1 (those of m and rho hold for every slope and weight).
    ///
    /// # Errors
    /// A sample that is not valid, or fewer samples than parameters.
    pub fn fit(&self, samples: &[Sample<f64>], seed: u64) -> Result<Fitted, FitError> {
        (self.fit)(self, samples, seed)
    }

    /// ln f in the directions of `sample`, f in sr^-1, with the values of [`Fitted::parameters`]; none beyond the horizon.
    pub fn ln_f(&self, parameters: &[f64], sample: &Sample<f64>) -> Option<f64> {
        (self.ln_f)(parameters, sample)
    }
}

fn facets(samples: &[Sample<f64>]) -> Result<Vec<Facets<f64>>, (usize, SampleError)> {
    let chunks = samples.chunks(8).enumerate();
    chunks
        .map(|(k, chunk)| Facets::new(chunk).map_err(|(place, error)| (8 * k + place, error)))
        .collect()
}

fn fit<D: Distribution, M: Masking<D>, const EXTRAS: u8, const P: usize>(
    model: &Model,
    samples: &[Sample<f64>],
    seed: u64,
) -> Result<Fitted, FitError> {
    let count = samples.iter().filter(|sample| sample.weight != 0.0).count();
    if count < P {
        return Err(FitError::TooFew(count, P));
    }
    let facets = facets(samples).map_err(|(index, error)| FitError::Sample(index, error))?;
    let scene = Composed::<f64, D, M, EXTRAS, P>::new(&facets);
    let found = search(&scene, &bounds(EXTRAS), seed, CANDIDATES, &Options::default());
    let best = found.minima.best().expect("a search makes at least one fit");
    let value = |index: usize| slot(EXTRAS, index).map(|k| best.x[k]);
    let named = NAMES.iter().enumerate().filter_map(|(index, &name)| {
        let value = value(index)?;
        Some((name, if name == "kappa" { Real::sqrt(value) } else { value }))
    });
    Ok(Fitted {
        model: model.name,
        samples: count,
        cost: best.cost,
        minima: found.minima.as_slice().len(),
        parameters: named.collect(),
    })
}

/// Table 1, in the solver's coordinates.
fn bounds<const P: usize>(extras: u8) -> Bounds<f64, P> {
    let mut bounds = Bounds {
        lower: [0.0; P],
        upper: [0.0; P],
    };
    for (index, name) in NAMES.into_iter().enumerate() {
        let (lower, upper) = match name {
            "rho_d" => (0.0, 1.0),
            "m" | "m_v" | "m_2" => (1e-5, 10.0),
            "n" => (1.0, 100.0),
            "kappa" => (0.0, 100.0 * 100.0),
            _ => (0.0, 100.0),
        };
        if let Some(k) = slot(extras, index) {
            (bounds.lower[k], bounds.upper[k]) = (lower, upper);
        }
    }
    bounds
}

fn ln_f<D: Distribution, M: Masking<D>, const EXTRAS: u8, const P: usize>(
    parameters: &[f64],
    sample: &Sample<f64>,
) -> Option<f64> {
    let sample = Sample {
        brdf: 1.0,
        weight: 1.0,
        ..*sample
    };
    let facets = [Facets::new(&[sample]).ok()?];
    let mut x: [f64; P] = parameters.try_into().ok()?;
    x[5] *= x[5];
    let mut value = None;
    Composed::<f64, D, M, EXTRAS, P>::new(&facets).each(&x, |ln_f, _| value = Some(ln_f));
    value
}
