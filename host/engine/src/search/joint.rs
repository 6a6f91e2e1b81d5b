//! The search of several scans of one material together.

use brdfit_core::geometry::Sample;
use brdfit_core::joint::Joint;
use brdfit_core::lm::{self, Bounds, Fit, Options, Problem};
use brdfit_core::model::Parameter;
use brdfit_core::real::Real;
use brdfit_core::search::{Found, SETTLING, search, search_from};
use brdfit_core::uncertainty::Uncertainty;

use super::beside::{Beside, Rows, is_above};
use super::setup::Setup;
use super::single;
use crate::error::FitError;
use crate::layout::Layout;
use crate::options::FitOptions;
use crate::passes::Kernel;
use crate::threads;
use crate::until::Watched;
use crate::values::Values;

/// Scans at most.
pub const SCANS: usize = 8;

/// A fit of several scans.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct JointFit {
    /// Which of the model's parameters are shared.
    pub shared: Vec<bool>,
    /// The parameters of each scan.
    pub scans: Vec<Values>,
    /// Their standard errors by the residuals, without the calibration; none of what is held or on a bound.
    pub errors: Vec<Vec<Option<f64>>>,
    /// The same as if no bound held another parameter, linear in kappa^2: what is known only because another parameter is on its bound is not known here; none of what is held.
    pub lifted: Vec<Vec<Option<f64>>>,
    /// Standard deviation of a residual; infinite without degrees of freedom.
    pub scale: f64,
    /// Samples and priors less parameters inside their bounds.
    pub degrees_of_freedom: usize,
    /// Sum of squared residuals of ln f over all scans, and of priors.
    pub cost: f64,
    /// The part of it that is that of the samples.
    pub of_samples: f64,
    /// The same of fits of each scan on its own.
    pub separate: f64,
    /// Standard deviation of a residual by which priors were weighed, if there are any.
    pub sigma: Option<f64>,
    /// Samples of all scans.
    pub samples: usize,
    /// Parameters that are free.
    pub parameters: usize,
}

/// Priors, each of a shared parameter once and of another for each scan.
pub fn prior_rows(scans: usize, shared: &[bool], options: &FitOptions) -> usize {
    let counts = |place: usize| if shared[place] { 1 } else { scans };
    options.with_prior().map(counts).sum()
}

/// Coordinates at most, with every parameter of the largest model each scan's own.
const COORDINATES: usize = 8 * SCANS;

pub fn run<const P: usize>(
    scans: &[&Kernel<f64, P>],
    own: &[Parameter; P],
    shared: &[bool],
    options: &FitOptions,
    all: &[&[Sample<f64>]],
) -> Result<JointFit, (usize, FitError)> {
    let until = options.until;
    let watched: Vec<_> = scans.iter().map(|&scene| Watched { scene, until }).collect();
    let scans: &[&Kernel<f64, P>] = &watched.iter().map(|scan| scan as _).collect::<Vec<_>>();
    let layout = Layout::new(own, options.model);
    let scene = Scans {
        scans,
        layout: &layout,
        shared,
        options,
        all,
    };
    let is_shared: [bool; P] = layout.places.map(|place| shared[place]);
    let mut setup = Setup {
        sigma: options.instrument.sigma.unwrap_or(1.0),
        ..Setup::default()
    };
    for place in (0..shared.len()).filter(|&place| shared[place]) {
        setup.share[place] = (1.0 / scans.len() as f64).sqrt();
    }
    let samples = counted(all);
    let rows = samples + prior_rows(all.len(), shared, options);
    let problem = Joint::new(scans, is_shared);
    let bounds = problem.bounds::<f64, COORDINATES>(&layout.bounds(options));
    let free = (0..COORDINATES).filter(|&k| bounds.lower[k] < bounds.upper[k]).count();
    let mut found = scene.search(&setup);
    if options.prior_count() > 0 && options.instrument.sigma.is_none() {
        setup.settle(
            |setup, again| {
                if again {
                    found = scene.search(setup);
                } else {
                    found.best = scene.descend(setup, found.best.x);
                }
                scene.costs(setup, &found.best.x)[0]
            },
            rows.saturating_sub(free),
        );
    }
    if options.instrument.limit.is_some() && !until.is_over() {
        let [of_samples, priors, _] = scene.costs(&setup, &found.best.x);
        let kept = setup.wall(of_samples + priors, |setup| {
            if setup.steep > 0.0 {
                found = scene.search(setup);
            }
            scene.above(&found.best.x)
        });
        if !kept {
            return Err((all.len(), FitError::Limit));
        }
    }
    if until.is_over() {
        return Err((all.len(), FitError::Interrupted));
    }
    let best = &found.best;
    let [_, priors, limit] = scene.costs(&setup, &best.x);
    let cost = best.at.cost - limit;
    // How far the samples are off is what they say, and not whether a prior was right.
    let mut at = best.at;
    at.cost = cost - priors;
    let uncertainty = Uncertainty::new(&at, &best.x, &bounds, rows);
    let error = |s: usize, k: usize| {
        let place = problem.place(s, k);
        let value = best.x[place];
        let free = bounds.lower[place] < value && value < bounds.upper[place];
        let slope = layout.slopes(&problem.of(&best.x, s))[k];
        free.then(|| uncertainty.held.standard_error(place) * slope)
    };
    let lifted = |s: usize, k: usize| {
        let place = problem.place(s, k);
        let error = uncertainty.lifted.standard_error(place);
        // Of kappa^2 = 0 +- error the upper end says how large kappa can be.
        let error = match own[k].is_squared() && best.x[place] == 0.0 {
            true => Real::sqrt(error),
            false => error * layout.slopes(&problem.of(&best.x, s))[k],
        };
        (bounds.lower[place] < bounds.upper[place]).then_some(error)
    };
    let each = |of: &dyn Fn(usize, usize) -> Option<f64>| -> Vec<Vec<Option<f64>>> {
        let one = |s: usize, place: usize| layout.coordinate(place).and_then(|k| of(s, k));
        let of_scan = |s: usize| (0..options.model.parameters.len()).map(|place| one(s, place)).collect();
        (0..scans.len()).map(of_scan).collect()
    };
    Ok(JointFit {
        shared: shared.to_vec(),
        scans: (0..scans.len())
            .map(|s| layout.values(&problem.of(&best.x, s)))
            .collect(),
        errors: each(&error),
        lifted: each(&lifted),
        scale: uncertainty.scale,
        degrees_of_freedom: uncertainty.degrees_of_freedom,
        cost,
        of_samples: cost - priors,
        separate: found.separate,
        sigma: (options.prior_count() > 0).then_some(setup.sigma),
        samples,
        parameters: free,
    })
}

/// All scans with what stands beside them.
struct Scans<'a, const P: usize> {
    scans: &'a [&'a Kernel<'a, f64, P>],
    layout: &'a Layout<'a, P>,
    shared: &'a [bool],
    options: &'a FitOptions,
    all: &'a [&'a [Sample<f64>]],
}

/// The best joint fit.
struct Best {
    best: Fit<f64, COORDINATES>,
    /// Sum of squared residuals of the samples, each scan on its own.
    separate: f64,
}

impl<const P: usize> Scans<'_, P> {
    fn is_shared(&self) -> [bool; P] {
        self.layout.places.map(|place| self.shared[place])
    }

    /// The residuals beside each scan.
    fn rows(&self, setup: &Setup) -> Vec<Rows<'_, P>> {
        let each = self.all.iter();
        each.map(|samples| Rows::new(self.layout, self.options, setup, samples))
            .collect()
    }

    /// Does `with` with the scans and what stands beside them.
    fn with<T>(&self, setup: &Setup, with: impl FnOnce(&[&Kernel<f64, P>], &[Rows<P>]) -> T) -> T {
        let rows = self.rows(setup);
        let beside: Vec<Beside<f64, P>> = self
            .scans
            .iter()
            .zip(&rows)
            .map(|(scene, rows)| Beside { scene: *scene, rows })
            .collect();
        let pairs = self.scans.iter().zip(&beside);
        let kernels: Vec<&Kernel<f64, P>> = pairs
            .map(|(scan, beside)| {
                if beside.rows.is_empty() {
                    *scan
                } else {
                    beside as &Kernel<f64, P>
                }
            })
            .collect();
        with(&kernels, &rows)
    }

    fn search(&self, setup: &Setup) -> Best {
        let lm = Options::default();
        let one = self.layout.bounds::<f64>(self.options);
        self.with(setup, |scans, rows| {
            let separate = threads::map(scans, &|scan| {
                search(single(*scan), &one, self.options.seed, starts(self.options), &lm)
            });
            let problem = Joint::new(scans, self.is_shared());
            let together = Together {
                scans,
                is_shared: self.is_shared(),
                one,
                bounds: problem.bounds::<f64, COORDINATES>(&one),
                separate: &separate,
                options: self.options,
            };
            let beside = separate.iter().zip(rows).map(|(found, rows)| {
                let (priors, limit) = rows.costs(&found.best.x);
                found.best.at.cost - priors - limit
            });
            Best {
                best: self.settled(setup, &problem, &together.bounds, together.search(&problem)),
                separate: beside.sum(),
            }
        })
    }

    fn descend(&self, setup: &Setup, x: [f64; COORDINATES]) -> Fit<f64, COORDINATES> {
        self.with(setup, |scans, _| {
            let problem = Joint::new(scans, self.is_shared());
            let bounds = problem.bounds::<f64, COORDINATES>(&self.layout.bounds(self.options));
            let fit = lm::fit(&problem, &bounds, x, &Options::default());
            self.settled(setup, &problem, &bounds, fit)
        })
    }

    /// A joint fit brought to where its gradient vanishes, so that it does not depend on its start; as it is where that is at a wall, or rounding.
    fn settled(
        &self,
        setup: &Setup,
        problem: &Joint<&Kernel<f64, P>, P>,
        bounds: &Bounds<f64, COORDINATES>,
        mut fit: Fit<f64, COORDINATES>,
    ) -> Fit<f64, COORDINATES> {
        if setup.steep == 0.0 && fit.at.cost > EXACT * counted(self.all) as f64 {
            fit.settle_within(problem, bounds, SETTLING);
        }
        fit
    }

    /// Sum of squared residuals of the samples, of priors, and of what is above its limit.
    fn costs(&self, setup: &Setup, x: &[f64; COORDINATES]) -> [f64; 3] {
        let problem = Joint::new(self.scans, self.is_shared());
        let mut sums = [problem.cost(x), 0.0, 0.0];
        for (s, rows) in self.rows(setup).iter().enumerate() {
            let (priors, limit) = rows.costs(&problem.of(x, s));
            sums[1] += priors;
            sums[2] += limit;
        }
        sums
    }

    /// Is what is limited above 1 in any scan?
    fn above(&self, x: &[f64; COORDINATES]) -> bool {
        let problem = Joint::new(self.scans, self.is_shared());
        let mut each = self.all.iter().enumerate();
        each.any(|(s, samples)| {
            let values = self.layout.values(&problem.of(x, s));
            is_above(self.options, values, samples)
        })
    }
}

/// Starts of each search; one where the fit is not wanted any more, as a hundred searches that end after their candidates take seconds.
fn starts(options: &FitOptions) -> u32 {
    if options.until.is_over() { 1 } else { options.starts() }
}

/// Samples that count.
pub fn counted(all: &[&[Sample<f64>]]) -> usize {
    let samples = all.iter().copied().flatten();
    samples.filter(|sample| sample.weight != 0.0).count()
}

/// Minima of a scan that tell where to hold the shared parameters.
const MINIMA: usize = 4;
/// How often the joint fit is searched from its own shared parameters, at most.
const LOOPS: usize = 4;

/// Below this the mean square of the residuals of ln f is rounding, and so is the gradient.
const EXACT: f64 = 1e-22;

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
        let ends = threads::map(&held, &|held| self.from(problem, held));
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
        let each = threads::each(self.scans.len(), &|s| {
            let (scan, minima) = (self.scans[s], &self.separate[s].minima);
            let known: Vec<[f64; P]> = minima.as_slice().iter().map(|minimum| minimum.x).collect();
            let (seed, starts) = (self.options.seed, starts(self.options));
            search_from(single(scan), &bounds, seed, starts, &known, &lm).best.x
        });
        lm::fit(problem, &self.bounds, problem.join(each.into_iter()), &lm)
    }
}
