//! Residuals beside those of the samples: priors, and what must not be above 1.

use brdfit_core::geometry::Sample;
use brdfit_core::lm::{Bounds, Linearization, Problem};
use brdfit_core::real::Real;
use brdfit_core::search::{Candidate, Region, Scene};

use super::setup::Setup;
use crate::instrument::Limit;
use crate::layout::Layout;
use crate::material::Material;
use crate::options::FitOptions;
use crate::passes::Kernel;
use crate::values::Values;

/// Angles of incidence closer than this count as one, radians (a hundredth of a degree).
const SAME_ANGLE: f64 = 1.745e-4;
/// What is held to 1 is held to 1 less this, so that rounding does not take it above.
const MARGIN: f64 = 1e-6;

/// A parameter that is known from elsewhere.
#[derive(Clone, Copy)]
struct Known {
    coordinate: usize,
    squared: bool,
    mean: f64,
    sigma: f64,
    /// Its residual is this times its distance from the mean.
    weight: f64,
}

/// The residuals beside the samples.
pub struct Rows<'a, const P: usize> {
    layout: &'a Layout<'a, P>,
    options: &'a FitOptions,
    priors: Vec<Known>,
    limit: Option<(Limit, Vec<f64>)>,
    /// The root of this times what is above 1 is a residual.
    steep: f64,
}

impl<'a, const P: usize> Rows<'a, P> {
    /// Those that `options` ask for.
    pub fn new(layout: &'a Layout<'a, P>, options: &'a FitOptions, setup: &Setup, samples: &[Sample<f64>]) -> Self {
        let instrument = &options.instrument;
        let known = |place: usize| {
            let prior = instrument.priors[place]?;
            let coordinate = layout.coordinate(place)?;
            Some(Known {
                coordinate,
                squared: layout.squared() == Some(coordinate),
                mean: prior.mean,
                sigma: prior.sigma,
                weight: setup.sigma * setup.share[place] / prior.sigma,
            })
        };
        let limit = instrument.limit.filter(|_| setup.steep > 0.0);
        Rows {
            layout,
            options,
            priors: (0..options.model.parameters.len()).filter_map(known).collect(),
            limit: limit.map(|limit| (limit, angles(samples))),
            steep: setup.steep,
        }
    }

    pub fn is_empty(&self) -> bool {
        self.priors.is_empty() && self.limit.is_none()
    }

    /// Number of priors.
    pub fn prior_count(&self) -> usize {
        self.priors.len()
    }

    /// Adds the priors.
    pub fn add_priors(&self, x: &[f64; P], sums: &mut Linearization<f64, P>) {
        for prior in &self.priors {
            let at = x[prior.coordinate];
            let mut row = [0.0; P];
            let value = if prior.squared {
                let value = at.max(0.0).sqrt();
                // At 0 the slope has no end, and a fit could not leave.
                row[prior.coordinate] = 0.5 * prior.weight / value.max(1e-3 * prior.sigma);
                value
            } else {
                row[prior.coordinate] = prior.weight;
                at
            };
            sums.add(prior.weight * (value - prior.mean), &row);
        }
    }

    /// Adds what is above 1.
    pub fn add_limit(&self, x: &[f64; P], sums: &mut Linearization<f64, P>) {
        let Some((Limit(of), angles)) = &self.limit else {
            return;
        };
        let material = Material {
            model: self.options.model,
            values: self.layout.values(x),
        };
        let root = self.steep.sqrt();
        let slopes = self.layout.slopes(x);
        for &theta_i in angles {
            let (value, gradient) = of(&material, theta_i);
            let above = value - (1.0 - MARGIN);
            if above > 0.0 {
                let row = std::array::from_fn(|k| root * gradient[self.layout.places[k]] * slopes[k]);
                sums.add(root * above, &row);
            }
        }
    }

    /// The sum of squares of the priors alone, and of what is above 1.
    pub fn costs(&self, x: &[f64; P]) -> (f64, f64) {
        let (mut priors, mut limit) = (Linearization::zero(), Linearization::zero());
        self.add_priors(x, &mut priors);
        self.add_limit(x, &mut limit);
        (priors.cost, limit.cost)
    }
}

/// The angles of incidence of the samples, radians, ascending.
pub fn angles(samples: &[Sample<f64>]) -> Vec<f64> {
    let mut angles: Vec<f64> = samples.iter().map(|sample| sample.theta_i).collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|b, a| *b - *a < SAME_ANGLE);
    angles
}

/// The most of what is limited over the angles of incidence of the samples; 0 if nothing is.
fn most(options: &FitOptions, values: Values, samples: &[Sample<f64>]) -> f64 {
    let material = Material {
        model: options.model,
        values,
    };
    let Some(Limit(of)) = options.instrument.limit else {
        return 0.0;
    };
    let each = angles(samples).into_iter().map(|theta_i| of(&material, theta_i).0);
    each.fold(0.0, f64::max)
}

/// Is what is limited above 1 at an angle of incidence of the samples?
pub fn is_above(options: &FitOptions, values: Values, samples: &[Sample<f64>]) -> bool {
    most(options, values, samples) > 1.0
}

/// These values with weights so much lower that what is limited is at most 1.
pub fn darkened(options: &FitOptions, values: Values, samples: &[Sample<f64>]) -> Values {
    let most = most(options, values, samples).max(1.0);
    let parameters = options.model.parameters;
    Values::from_fn(values.len(), |place| {
        if parameters[place].is_weight() {
            values[place] / most
        } else {
            values[place]
        }
    })
}

/// A scan with further residuals beside it.
pub struct Beside<'a, R, const P: usize> {
    pub scene: &'a Kernel<'a, R, P>,
    pub rows: &'a Rows<'a, P>,
}

impl<R: Real, const P: usize> Beside<'_, R, P> {
    fn more(&self, x: &[R; P]) -> R {
        let (priors, limit) = self.rows.costs(&x.map(R::f64));
        R::of(priors + limit)
    }
}

impl<R: Real, const P: usize> Problem<R, P> for Beside<'_, R, P> {
    fn cost(&self, x: &[R; P]) -> R {
        let cost = self.scene.cost(x);
        if self.rows.is_empty() {
            cost
        } else {
            cost + self.more(x)
        }
    }

    fn linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        let mut sums = self.scene.linearize(x);
        if !self.rows.is_empty() {
            let mut more = Linearization::zero();
            self.rows.add_priors(&x.map(R::f64), &mut more);
            self.rows.add_limit(&x.map(R::f64), &mut more);
            sums.cost += R::of(more.cost);
            for i in 0..P {
                sums.gradient[i] += R::of(more.gradient[i]);
                for j in 0..P {
                    sums.hessian[i][j] += R::of(more.hessian[i][j]);
                }
            }
        }
        sums
    }

    fn bend(&self, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P] {
        self.scene.bend(x, step, to)
    }
}

impl<R: Real, const P: usize> Scene<R, P> for Beside<'_, R, P> {
    fn propose(&self, bounds: &Bounds<R, P>, seed: u64, i: u64, region: Region<R, P>) -> Candidate<R, P> {
        self.scene.propose(bounds, seed, i, region)
    }

    fn weigh(&self, bounds: &Bounds<R, P>, candidate: &mut Candidate<R, P>) {
        self.scene.weigh(bounds, candidate);
    }

    fn level(&self, bounds: &Bounds<R, P>, x: &[R; P]) -> ([R; P], R) {
        let (x, cost) = self.scene.level(bounds, x);
        if self.rows.is_empty() {
            (x, cost)
        } else {
            (x, cost + self.more(&x))
        }
    }

    fn apart(&self, x: &[R; P], y: &[R; P], factor: R) -> bool {
        self.scene.apart(x, y, factor)
    }
}
