//! Several scans of one material fitted together, of which chosen parameters are the same.

use brdfit_core::brdf::{ALL, NAMES};
use brdfit_core::geometry::{Block, Sample};
use brdfit_core::joint::Joint;
use brdfit_core::lm::{self, Options};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::search::{CANDIDATES, search};
use brdfit_core::uncertainty::Uncertainty;
use rayon::prelude::*;

use crate::simd::{FastScan, Simd};
use crate::{FitError, FitOptions, blocks};

/// Scans at most.
pub const SCANS: usize = 8;
/// Coordinates at most: with every parameter each scan's own.
const COORDINATES: usize = 6 * SCANS;

/// A fit of several scans.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// Which of [`NAMES`] are shared.
    pub shared: [bool; 6],
    /// Parameters of each scan, with their standard errors (none on a bound, or if undetermined).
    pub scans: Vec<[(f64, Option<f64>); 6]>,
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
/// # Errors
/// The place of the scan that can not be fitted, and why.
pub fn fit(all: &[&[Sample<f64>]], shared: [bool; 6], seed: u64) -> Result<Fitted, (usize, FitError)> {
    let each = all.iter().enumerate();
    let each = each.map(|(place, samples)| blocks(samples).map_err(|error| (place, error)));
    let prepared: Vec<Vec<Block<f64>>> = each.collect::<Result<_, _>>()?;
    let simd = Simd::best();
    let each = prepared.iter().map(|blocks| FastScan {
        scan: Scan::<f64, ALL, 6>::new(blocks),
        simd,
    });
    let scans: Vec<_> = each.collect();
    let defaults = FitOptions::default();
    let one = Scan::<f64, ALL, 6>::bounds(&defaults.lower, &defaults.upper);
    let options = Options::default();
    let separate: Vec<([f64; 6], f64)> = scans
        .par_iter()
        .map(|scan| {
            let found = search(scan, &one, seed, CANDIDATES, &options);
            let best = found.minima.best().expect("a search makes at least one fit");
            (best.x, best.cost)
        })
        .collect();
    let problem = Joint::new(&scans, shared);
    let bounds = problem.bounds::<f64, COORDINATES>(&one);
    let mean: [f64; COORDINATES] = problem.join(separate.iter().map(|fit| fit.0));
    let of_each = separate.iter().map(|(x, _)| {
        let mut start = mean;
        for index in (0..6).filter(|&index| shared[index]) {
            start[problem.place(0, index)] = x[index];
        }
        start
    });
    let starts: Vec<_> = std::iter::once(mean).chain(of_each).collect();
    let fits = starts
        .into_par_iter()
        .map(|start| lm::fit(&problem, &bounds, start, &options));
    let fits: Vec<_> = fits.collect();
    let best = fits
        .into_iter()
        .min_by(|a, b| a.at.cost.total_cmp(&b.at.cost))
        .expect("there are starts");
    let samples = all.iter().copied().flatten();
    let samples = samples.filter(|sample| sample.weight != 0.0).count();
    let uncertainty = Uncertainty::new(&best.at, &best.x, &bounds, samples);
    let parameter = |s: usize, index: usize| {
        let place = problem.place(s, index);
        let value = best.x[place];
        let free = bounds.lower[place] < value && value < bounds.upper[place];
        let error = free
            .then(|| uncertainty.held.standard_error(place))
            .filter(|error| error.is_finite());
        match NAMES[index] {
            // The solver has kappa^2.
            "kappa" => {
                let kappa = Real::sqrt(value);
                (kappa, error.map(|error| error / (2.0 * kappa)))
            }
            _ => (value, error),
        }
    };
    Ok(Fitted {
        shared,
        scans: (0..scans.len())
            .map(|s| std::array::from_fn(|index| parameter(s, index)))
            .collect(),
        cost: best.at.cost,
        separate: separate.iter().map(|fit| fit.1).sum(),
        samples,
        parameters: problem.coordinates(),
    })
}
