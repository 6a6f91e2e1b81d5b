//! Several scans of one material fitted together, of which chosen parameters are the same.

use brdfit_core::geometry::Sample;
use brdfit_core::joint::Joint;
use brdfit_core::lm::{self, Options};
use brdfit_core::model::Parameter;
use brdfit_core::search::search;
use brdfit_core::uncertainty::Uncertainty;
use rayon::prelude::*;

use crate::compiled::Kernel;
use crate::layout::Layout;
use crate::search::single;
use crate::{FitError, FitOptions, Values};

/// Scans at most.
pub const SCANS: usize = 8;

/// A fit of several scans.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// Which of the model's parameters are shared.
    pub shared: Vec<bool>,
    /// The parameters of each scan.
    pub scans: Vec<Values>,
    /// Their standard errors (none on a bound, or if undetermined).
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

/// Fits each scan on its own, then all together: from the mean of the shared parameters, and from those of each scan; the best counts.
///
/// `shared` tells of each of the model's parameters whether it is the same in all scans.
///
/// # Errors
/// The place of the scan that cannot be fitted, and why.
pub fn fit(all: &[&[Sample<f64>]], shared: &[bool], options: &FitOptions) -> Result<Fitted, (usize, FitError)> {
    let (model, mut options) = (options.model, *options);
    model.hold(&mut options);
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
) -> Fitted {
    let layout = Layout::new(own, options.model);
    let one = layout.bounds::<f64>(options);
    let lm = Options::default();
    let separate: Vec<([f64; P], f64)> = scans
        .par_iter()
        .map(|scan| {
            let found = search(single(*scan), &one, options.seed, options.starts(), &lm);
            let best = found.minima.best().expect("a search makes at least one fit");
            (best.x, best.cost)
        })
        .collect();
    let is_shared: [bool; P] = layout.places.map(|place| shared[place]);
    let problem = Joint::new(scans, is_shared);
    let bounds = problem.bounds::<f64, COORDINATES>(&one);
    let mean: [f64; COORDINATES] = problem.join(separate.iter().map(|fit| fit.0));
    let of_each = separate.iter().map(|(x, _)| {
        let mut start = mean;
        for k in (0..P).filter(|&k| is_shared[k]) {
            start[problem.place(0, k)] = x[k];
        }
        start
    });
    let starts: Vec<_> = std::iter::once(mean).chain(of_each).collect();
    let fits = starts
        .into_par_iter()
        .map(|start| lm::fit(&problem, &bounds, start, &lm));
    let fits: Vec<_> = fits.collect();
    let best = fits
        .into_iter()
        .min_by(|a, b| a.at.cost.total_cmp(&b.at.cost))
        .expect("there are starts");
    let samples = all.iter().copied().flatten();
    let samples = samples.filter(|sample| sample.weight != 0.0).count();
    let uncertainty = Uncertainty::new(&best.at, &best.x, &bounds, samples);
    let error = |s: usize, k: usize| {
        let place = problem.place(s, k);
        let value = best.x[place];
        let free = bounds.lower[place] < value && value < bounds.upper[place];
        let error = uncertainty.held.standard_error(place);
        let slope = layout.slopes(&problem.of(&best.x, s))[k];
        (free && error.is_finite()).then_some(error * slope)
    };
    let errors = |s: usize| {
        let places = 0..options.model.parameters.len();
        places
            .map(|place| layout.coordinate(place).and_then(|k| error(s, k)))
            .collect()
    };
    Fitted {
        shared: shared.to_vec(),
        scans: (0..scans.len())
            .map(|s| layout.values(&problem.of(&best.x, s)))
            .collect(),
        errors: (0..scans.len()).map(errors).collect(),
        cost: best.at.cost,
        separate: separate.iter().map(|fit| fit.1).sum(),
        samples,
        parameters: problem.coordinates(),
    }
}
