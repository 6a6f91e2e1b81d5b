//! Several scans of one material fitted together, of which chosen parameters are the same.

use brdfit_core::geometry::Sample;
use brdfit_core::joint::Joint;
use brdfit_core::lm::{self, Bounds, Fit, Options};
use brdfit_core::model::Parameter;
use brdfit_core::search::{Found, search, search_from};
use brdfit_core::uncertainty::Uncertainty;
use rayon::prelude::*;

use crate::compiled::Kernel;
use crate::layout::Layout;
use crate::search::single;
use crate::until::Watched;
use crate::{FitError, FitOptions, Values};

/// Scans at most.
pub const SCANS: usize = 8;

/// A fit of several scans.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Fitted {
    /// Which of the model's parameters are shared.
    pub shared: Vec<bool>,
    /// The parameters of each scan.
    pub scans: Vec<Values>,
    /// Their standard errors (none on a bound, or if undetermined: the error is larger than the parameter, or for kappa than 1).
    pub errors: Vec<Vec<Option<f64>>>,
    /// Sum of squared residuals of ln f over all scans.
    pub cost: f64,
    /// The same of fits of each scan on its own.
    pub separate: f64,
    /// Samples of all scans.
    pub samples: usize,
    /// Parameters that are free.
    pub parameters: usize,
}

/// Fits each scan on its own, then all together.
///
/// With the shared parameters held, the scans have nothing to do with each other: so each of them is searched with these held where a minimum of any scan has them, and where the best joint fit so far has them, until that leads no lower.
/// `shared` tells of each of the model's parameters whether it is the same in all scans.
///
/// # Errors
/// The place of the scan that cannot be fitted, and why; [`FitError::TooFew`] of all samples comes with the number of scans.
pub fn fit(all: &[&[Sample<f64>]], shared: &[bool], options: &FitOptions) -> Result<Fitted, (usize, FitError)> {
    let (model, mut options) = (options.model, *options);
    model.hold(&mut options);
    let (both, own): (Vec<usize>, Vec<usize>) = options.free().partition(|&place| shared[place]);
    let parameters = both.len() + all.len() * own.len();
    let samples = counted(all);
    if samples < parameters {
        return Err((all.len(), FitError::TooFew(samples, parameters)));
    }
    (model.whole.joint)(all, shared, &options)
}

/// Coordinates at most, with every parameter of the largest model each scan's own.
const COORDINATES: usize = 8 * SCANS;

pub(crate) fn run<const P: usize>(
    scans: &[&Kernel<f64, P>],
    own: &[Parameter; P],
    shared: &[bool],
    options: &FitOptions,
    all: &[&[Sample<f64>]],
) -> Result<Fitted, (usize, FitError)> {
    let until = options.until;
    let watched: Vec<_> = scans.iter().map(|&scene| Watched { scene, until }).collect();
    let scans: &[&Kernel<f64, P>] = &watched.iter().map(|scan| scan as _).collect::<Vec<_>>();
    let layout = Layout::new(own, options.model);
    let one = layout.bounds::<f64>(options);
    let lm = Options::default();
    let separate: Vec<Found<f64, P>> = scans
        .par_iter()
        .map(|scan| search(single(*scan), &one, options.seed, options.starts(), &lm))
        .collect();
    let is_shared: [bool; P] = layout.places.map(|place| shared[place]);
    let problem = Joint::new(scans, is_shared);
    let bounds = problem.bounds::<f64, COORDINATES>(&one);
    let found = Together {
        scans,
        is_shared,
        one,
        bounds,
        separate: &separate,
        options,
    };
    let best = found.search(&problem);
    if until.is_over() {
        return Err((all.len(), FitError::Interrupted));
    }
    let samples = counted(all);
    let uncertainty = Uncertainty::new(&best.at, &best.x, &bounds, samples);
    let error = |s: usize, k: usize| {
        let place = problem.place(s, k);
        let value = best.x[place];
        let free = bounds.lower[place] < value && value < bounds.upper[place];
        let x = problem.of(&best.x, s);
        let error = uncertainty.held.standard_error(place) * layout.slopes(&x)[k];
        let value = layout.values(&x)[layout.places[k]];
        // kappa may be 0 where it is determined.
        let size = if own[k].is_squared() { value.max(1.0) } else { value };
        (free && error <= size).then_some(error)
    };
    let errors = |s: usize| {
        let places = 0..options.model.parameters.len();
        places
            .map(|place| layout.coordinate(place).and_then(|k| error(s, k)))
            .collect()
    };
    Ok(Fitted {
        shared: shared.to_vec(),
        scans: (0..scans.len())
            .map(|s| layout.values(&problem.of(&best.x, s)))
            .collect(),
        errors: (0..scans.len()).map(errors).collect(),
        cost: best.at.cost,
        separate: separate.iter().map(|found| found.best.at.cost).sum(),
        samples,
        parameters: (0..problem.coordinates())
            .filter(|&k| bounds.lower[k] < bounds.upper[k])
            .count(),
    })
}

/// Samples that count.
fn counted(all: &[&[Sample<f64>]]) -> usize {
    let samples = all.iter().copied().flatten();
    samples.filter(|sample| sample.weight != 0.0).count()
}

/// Minima of a scan that tell where to hold the shared parameters.
const MINIMA: usize = 4;
/// How often the joint fit is searched from its own shared parameters, at most.
const LOOPS: usize = 4;

/// Scans with what each says on its own.
struct Together<'a, const P: usize> {
    scans: &'a [&'a Kernel<'a, f64, P>],
    is_shared: [bool; P],
    one: Bounds<f64, P>,
    bounds: Bounds<f64, COORDINATES>,
    separate: &'a [Found<f64, P>],
    options: &'a FitOptions,
}

impl<'a, const P: usize> Together<'a, P> {
    /// The best joint fit.
    fn search(&self, problem: &Joint<'a, &'a Kernel<'a, f64, P>, P>) -> Fit<f64, COORDINATES> {
        let bests = || self.separate.iter().map(|found| found.best.x);
        let mean: [f64; COORDINATES] = problem.join(bests());
        let mut held = vec![problem.of(&mean, 0)];
        for found in self.separate {
            held.extend(found.minima.as_slice().iter().take(MINIMA).map(|minimum| minimum.x));
        }
        let ends = held.par_iter().map(|held| self.from(problem, held));
        let ends: Vec<Fit<f64, COORDINATES>> = ends.collect();
        let least = |fits: Vec<Fit<f64, COORDINATES>>| fits.into_iter().min_by(|a, b| a.at.cost.total_cmp(&b.at.cost));
        let mut best = least(ends).expect("the mean is a start");
        for _ in 0..LOOPS {
            let again = self.from(problem, &problem.of(&best.x, 0));
            if !(again.at.cost < best.at.cost * (1.0 - 1e-9)) {
                break;
            }
            best = again;
        }
        best
    }

    /// The joint fit from the best that each scan can do with the shared parameters held where `held` has them.
    fn from(&self, problem: &Joint<'a, &'a Kernel<'a, f64, P>, P>, held: &[f64; P]) -> Fit<f64, COORDINATES> {
        let lm = Options::default();
        let mut bounds = self.one;
        for k in (0..P).filter(|&k| self.is_shared[k]) {
            (bounds.lower[k], bounds.upper[k]) = (held[k], held[k]);
        }
        let each = self.scans.par_iter().zip(self.separate).map(|(scan, found)| {
            let known: Vec<[f64; P]> = found.minima.as_slice().iter().map(|minimum| minimum.x).collect();
            let (seed, starts) = (self.options.seed, self.options.starts());
            search_from(single(*scan), &bounds, seed, starts, &known, &lm).best.x
        });
        let each: Vec<[f64; P]> = each.collect();
        lm::fit(problem, &self.bounds, problem.join(each.into_iter()), &lm)
    }
}
