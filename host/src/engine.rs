//! Fits one scan: chooses the compiled set of terms and the instructions, runs the search.

use std::marker::PhantomData;

use brdfit_core::brdf::{ABSORBING, ALL, DIFFUSE, NAMES, Params, SURFACE, VOLUME, has, slot};
use brdfit_core::geometry::{Block, LANES, Observation, Sample, SampleError};
use brdfit_core::lm::{self, Bounds, Options, Stop};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::search::{self, CANDIDATES, Evaluations, Found, PAPER_STARTS};
use rayon::prelude::*;

use crate::robust::{self, Robust};
use crate::simd::{FastScan, Simd};
use crate::uncertainty::{self, Uncertainty};

/// How the global optimum is searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Candidates, short fits, convergence of the best.
    Default,
    /// Uniform starts over the bounds, each fitted to convergence (section 3 of the paper).
    Paper,
}

/// The number type of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Double.
    F64,
    /// Single, as firmware does.
    F32,
}

/// What to fit and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitOptions {
    /// How to search.
    pub method: Method,
    /// Seed of the starts.
    pub seed: u64,
    /// Number of starts (`paper`) or candidates (`default`); `None` for the method's own.
    pub starts: Option<u32>,
    /// One of [`TERM_SETS`].
    pub terms: u8,
    /// Let the scan choose among the sets of [`crate::choose`] in place of `terms`; [`fit`] does not look at it, [`crate::choose::fit`] does.
    pub choose_terms: bool,
    /// Least parameters; Table 1 by default.
    pub lower: Params<f64>,
    /// Largest parameters.
    pub upper: Params<f64>,
    /// The number type.
    pub precision: Precision,
    /// Leave out samples far from the fit ([`robust`]).
    pub robust: bool,
    /// The vector instructions; they change speed and no bit.
    pub simd: Simd,
}

impl PartialEq for Simd {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Default for FitOptions {
    fn default() -> Self {
        FitOptions {
            method: Method::Default,
            seed: 0,
            starts: None,
            terms: ALL,
            choose_terms: false,
            lower: Params {
                rho_d: 0.0,
                rho_s: 0.0,
                rho_v: 0.0,
                m: 1e-5,
                n: 1.0,
                kappa: 0.0,
            },
            upper: Params {
                rho_d: 1.0,
                rho_s: 100.0,
                rho_v: 100.0,
                m: 10.0,
                n: 100.0,
                kappa: 100.0,
            },
            precision: Precision::F64,
            robust: false,
            simd: Simd::best(),
        }
    }
}

impl FitOptions {
    /// The number of starts or candidates that will be used.
    pub fn starts(&self) -> u32 {
        self.starts.unwrap_or(match self.method {
            Method::Default => CANDIDATES,
            Method::Paper => PAPER_STARTS,
        })
    }
}

/// The sets of terms that are compiled in.
pub const TERM_SETS: [u8; 8] = [
    DIFFUSE,
    DIFFUSE | SURFACE,
    DIFFUSE | SURFACE | ABSORBING,
    DIFFUSE | SURFACE | VOLUME,
    ALL,
    SURFACE,
    SURFACE | ABSORBING,
    SURFACE | VOLUME | ABSORBING,
];

/// One distinct minimum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Minimum {
    /// Sum of squared ln residuals over samples squared (Eq. 17).
    pub mse2: f64,
    /// Its parameters.
    pub params: Params<f64>,
    /// How many fits ended here.
    pub hits: u32,
    /// The least index of a start that led here.
    pub first_start: u64,
}

/// The result of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Number of samples.
    pub samples: usize,
    /// Sum of squared residuals of ln f.
    pub cost: f64,
    /// Eq. 17.
    pub mse2: f64,
    /// Root of the mean squared residual of ln f.
    pub rms_ln: f64,
    /// The best parameters.
    pub params: Params<f64>,
    /// Names of the parameters that ended on a bound.
    pub at_bound: Vec<&'static str>,
    /// How the best fit ended.
    pub stop: Stop,
    /// Distinct minima, best first.
    pub minima: Vec<Minimum>,
    /// (high - low) / high over them (Table 3).
    pub improvement_potential: f64,
    /// How many passes were made.
    pub evaluations: Evaluations,
    /// What a robust fit left out; all else here is of the other samples.
    pub robust: Option<Robust>,
    /// What the scan tells about the parameters; computed in `f64` whatever the number type of the fit.
    pub uncertainty: Uncertainty,
}

/// Why no fit was made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FitError {
    /// The sample of this index is not valid.
    Sample(usize, SampleError),
    /// Fewer samples than parameters: how many of each.
    TooFew(usize, usize),
    /// No compiled set has these terms.
    Terms(u8),
}

impl std::fmt::Display for FitError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            FitError::Sample(index, error) => write!(f, "sample {}: {error}", index + 1),
            FitError::TooFew(samples, parameters) => {
                write!(f, "{samples} samples can not determine {parameters} parameters")
            }
            FitError::Terms(terms) => write!(f, "no compiled model has the set of terms {terms:#b}"),
        }
    }
}
impl std::error::Error for FitError {}

/// Fits one scan; threads of the current rayon pool share the starts of the `paper` method, and change no bit.
///
/// # Errors
/// [`FitError`].
pub fn fit(samples: &[Sample<f64>], options: &FitOptions) -> Result<Outcome, FitError> {
    let plain = |samples: &[Sample<f64>], options: &FitOptions| match options.precision {
        Precision::F64 => with_terms(options.terms, Search::<f64>(samples, options, PhantomData))?,
        Precision::F32 => with_terms(options.terms, Search::<f32>(samples, options, PhantomData))?,
    };
    if options.robust {
        robust::fit(samples, options, plain)
    } else {
        plain(samples, options)
    }
}

/// Fits from given points to convergence, in `f64` and without a search: the best end, its cost and its parameters; `None` if no start has a finite cost.
///
/// # Errors
/// [`FitError::Terms`].
pub fn descend(
    blocks: &[Block<f64>],
    options: &FitOptions,
    starts: &[Params<f64>],
) -> Result<Option<(f64, Params<f64>)>, FitError> {
    with_terms(options.terms, Descent(blocks, options, starts))
}

/// A computation with one compiled set of terms; a closure can not be generic.
pub(crate) trait WithTerms {
    type Output;
    fn run<const TERMS: u8, const P: usize>(self) -> Self::Output;
}

pub(crate) fn with_terms<C: WithTerms>(terms: u8, computation: C) -> Result<C::Output, FitError> {
    const D: u8 = DIFFUSE;
    const S: u8 = SURFACE;
    const V: u8 = VOLUME;
    const A: u8 = ABSORBING;
    const DS: u8 = D | S;
    const DSA: u8 = D | S | A;
    const DSV: u8 = D | S | V;
    const SA: u8 = S | A;
    const SVA: u8 = S | V | A;
    Ok(match terms {
        D => computation.run::<D, 1>(),
        S => computation.run::<S, 3>(),
        SA => computation.run::<SA, 4>(),
        SVA => computation.run::<SVA, 5>(),
        DS => computation.run::<DS, 4>(),
        DSA => computation.run::<DSA, 5>(),
        DSV => computation.run::<DSV, 5>(),
        ALL => computation.run::<ALL, 6>(),
        other => return Err(FitError::Terms(other)),
    })
}

struct Search<'a, R>(&'a [Sample<f64>], &'a FitOptions, PhantomData<R>);
impl<R: Real> WithTerms for Search<'_, R> {
    type Output = Result<Outcome, FitError>;
    fn run<const TERMS: u8, const P: usize>(self) -> Self::Output {
        run::<R, TERMS, P>(self.0, self.1)
    }
}

struct Descent<'a>(&'a [Block<f64>], &'a FitOptions, &'a [Params<f64>]);
impl WithTerms for Descent<'_> {
    type Output = Option<(f64, Params<f64>)>;
    fn run<const TERMS: u8, const P: usize>(self) -> Self::Output {
        let Descent(blocks, options, starts) = self;
        let scene = FastScan {
            scan: Scan::<f64, TERMS, P>::new(blocks),
            simd: options.simd,
        };
        let bounds = Scan::<f64, TERMS, P>::bounds(&options.lower, &options.upper);
        let ends = starts.iter().map(|start| {
            let start = Scan::<f64, TERMS, P>::coordinates(start);
            lm::fit(&scene, &bounds, start, &Options::default())
        });
        let finite = ends.filter(|fit| fit.at.cost.is_finite());
        let best = finite.min_by(|a, b| a.at.cost.total_cmp(&b.at.cost))?;
        Some((best.at.cost, Scan::<f64, TERMS, P>::params(&best.x)))
    }
}

/// The samples of a scan in the number type of the fit, as blocks.
///
/// # Errors
/// [`FitError::Sample`].
pub fn blocks<R: Real>(samples: &[Sample<f64>]) -> Result<Vec<Block<R>>, FitError> {
    let mut observations = Vec::with_capacity(samples.len());
    for (index, sample) in samples.iter().enumerate() {
        let sample = Sample {
            theta_i: R::of(sample.theta_i),
            theta_s: R::of(sample.theta_s),
            delta_phi: R::of(sample.delta_phi),
            brdf: R::of(sample.brdf),
            weight: R::of(sample.weight),
        };
        observations.push(Observation::new(&sample).map_err(|error| FitError::Sample(index, error))?);
    }
    Ok(observations.chunks(LANES).map(Block::new).collect())
}

fn run<R: Real, const TERMS: u8, const P: usize>(
    samples: &[Sample<f64>],
    options: &FitOptions,
) -> Result<Outcome, FitError> {
    if samples.len() < P {
        return Err(FitError::TooFew(samples.len(), P));
    }
    let blocks = blocks::<R>(samples)?;
    let scene = FastScan {
        scan: Scan::<R, TERMS, P>::new(&blocks),
        simd: options.simd,
    };
    let to_real = |p: &Params<f64>| Params::from_array(p.to_array().map(R::of));
    let bounds = Scan::<R, TERMS, P>::bounds(&to_real(&options.lower), &to_real(&options.upper));
    let lm = Options::default();
    let starts = options.starts();
    let found: Found<R, P> = match options.method {
        Method::Default => search::search(&scene, &bounds, options.seed, starts, &lm),
        Method::Paper => {
            let fits: Vec<_> = (0..u64::from(starts))
                .into_par_iter()
                .map(|i| search::paper_fit(&scene, &bounds, options.seed, i, &lm))
                .collect();
            search::paper(&scene, &bounds, fits, &lm)
        }
    };
    let count = samples.len() as f64;
    let mse2 = |cost: R| cost.f64() / (count * count);
    let params = |x: &[R; P]| Params::from_array(Scan::<R, TERMS, P>::params(x).to_array().map(R::f64));
    let minima: Vec<Minimum> = found
        .minima
        .as_slice()
        .iter()
        .map(|minimum| Minimum {
            mse2: mse2(minimum.cost),
            params: params(&minimum.x),
            hits: minimum.hits,
            first_start: minimum.first_start,
        })
        .collect();
    let best = found.best;
    let at_bound = (0..NAMES.len())
        .filter(|&index| has(TERMS, index))
        .filter(|&index| {
            let k = slot(TERMS, index);
            bounds.lower[k] < bounds.upper[k] && (best.x[k] == bounds.lower[k] || best.x[k] == bounds.upper[k])
        })
        .map(|index| NAMES[index])
        .collect();
    let blocks = self::blocks::<f64>(samples)?;
    let exact = FastScan {
        scan: Scan::<f64, TERMS, P>::new(&blocks),
        simd: options.simd,
    };
    let counted = samples.iter().filter(|sample| sample.weight != 0.0).count();
    let box64 = Bounds {
        lower: bounds.lower.map(R::f64),
        upper: bounds.upper.map(R::f64),
    };
    Ok(Outcome {
        uncertainty: uncertainty::at(&exact, &best.x.map(R::f64), &box64, counted),
        samples: samples.len(),
        cost: best.at.cost.f64(),
        mse2: mse2(best.at.cost),
        rms_ln: (best.at.cost.f64() / count).sqrt(),
        params: params(&best.x),
        at_bound,
        stop: best.stop.unwrap_or(Stop::Passes),
        minima,
        improvement_potential: found.minima.improvement_potential().f64(),
        evaluations: found.evaluations,
        robust: None,
    })
}
