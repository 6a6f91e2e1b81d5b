//! What is known of the parameters at the end of a fit with an instrument.
//!
//! Its cost is that of the samples alone: how far they are off is what residuals say, and not whether a prior was right.

use brdfit_core::lm::{Bounds, Linearization, Problem};
use brdfit_core::search::{Candidate, Region, Scene};

use super::beside::Rows;
use super::nuisance::Nuisance;
use crate::passes::Kernel;

/// A scan at its optimum: its sums are those of the samples and of the residuals beside them, less what an offset that is fitted too leaves open.
pub struct Settled<'a, const P: usize> {
    pub scene: &'a Kernel<'a, f64, P>,
    pub rows: &'a Rows<'a, P>,
    pub nuisance: Option<Nuisance<P>>,
}

impl<const P: usize> Problem<f64, P> for Settled<'_, P> {
    fn cost(&self, x: &[f64; P]) -> f64 {
        self.scene.cost(x)
    }

    fn linearize(&self, x: &[f64; P]) -> Linearization<f64, P> {
        let mut sums = self.scene.linearize(x);
        let mut more = Linearization::zero();
        self.rows.add_priors(x, &mut more);
        // A limit that holds is no residual: it only takes away a direction.
        self.rows.add_limit(x, &mut more);
        for i in 0..P {
            sums.gradient[i] += more.gradient[i];
            for j in 0..P {
                sums.hessian[i][j] += more.hessian[i][j];
            }
        }
        if let Some(Nuisance { cross, square }) = &self.nuisance
            && *square > 0.0
        {
            for i in 0..P {
                for j in 0..P {
                    sums.hessian[i][j] -= cross[i] * cross[j] / square;
                }
            }
        }
        sums
    }

    fn bend(&self, x: &[f64; P], step: &[f64; P], to: [f64; P]) -> [f64; P] {
        self.scene.bend(x, step, to)
    }
}

impl<const P: usize> Scene<f64, P> for Settled<'_, P> {
    fn propose(&self, bounds: &Bounds<f64, P>, seed: u64, i: u64, region: Region<f64, P>) -> Candidate<f64, P> {
        self.scene.propose(bounds, seed, i, region)
    }

    fn weigh(&self, bounds: &Bounds<f64, P>, candidate: &mut Candidate<f64, P>) {
        self.scene.weigh(bounds, candidate);
    }

    fn level(&self, bounds: &Bounds<f64, P>, x: &[f64; P]) -> ([f64; P], f64) {
        self.scene.level(bounds, x)
    }

    fn apart(&self, x: &[f64; P], y: &[f64; P], factor: f64) -> bool {
        self.scene.apart(x, y, factor)
    }
}
