//! Chooses the compiled set of terms and the instructions, and runs the search.

use std::marker::PhantomData;

use brdfit_core::brdf::{ABSORBING, ALL, DIFFUSE, NAMES, Params, SURFACE, VOLUME, has, slot};
use brdfit_core::geometry::{Block, LANES, Observation, Sample};
use brdfit_core::lm::{self, Bounds, Options, Stop};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::search::{self, Found};
use rayon::prelude::*;

use crate::options::{FitOptions, Method, Precision};
use crate::outcome::{FitError, Minimum, Outcome};
use crate::simd::FastScan;
use crate::{robust, uncertainty};

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
