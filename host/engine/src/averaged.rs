//! A scan through an aperture: the residual of a sample is that of the mean of f over the directions that the detector sees.

use std::marker::PhantomData;

use brdfit_core::geometry::{Block, LANES, Sample};
use brdfit_core::lm::{Bounds, Linearization, Problem};
use brdfit_core::model::{GROUP, Model, Rows};
use brdfit_core::pack::Pack;
use brdfit_core::real::Real;
use brdfit_core::search::{Candidate, Region, Scene};

use crate::error::FitError;
use crate::instrument::aperture::directions;
use crate::passes::{Kernel, blocks_of};

/// Lanes that go through a model side by side, and groups of them in a block.
const GROUPS: usize = LANES / GROUP;

/// One sample: the blocks of its directions.
struct Part<const C: usize> {
    blocks: Vec<Block<f64, LANES, C>>,
    /// Of each lane; 0 for an empty one.
    shares: Vec<[f64; LANES]>,
    ln_f: f64,
    weight: f64,
}

/// A scan of model `M` through an aperture.
pub struct Averaged<'a, M, const P: usize, const C: usize> {
    /// The same scan with a point for a detector: what it proposes is a start here too.
    point: &'a Kernel<'a, f64, P>,
    parts: Vec<Part<C>>,
    model: PhantomData<M>,
}

impl<'a, M: Model<f64, P, C>, const P: usize, const C: usize> Averaged<'a, M, P, C> {
    /// Of an aperture of this half-angle, radians; `point` is the scan without it.
    pub fn new(point: &'a Kernel<'a, f64, P>, samples: &[Sample<f64>], half_angle: f64) -> Result<Self, FitError> {
        let part = |sample: &Sample<f64>| {
            let (directions, shares): (Vec<Sample<f64>>, Vec<f64>) = directions(sample, half_angle)
                .into_iter()
                .map(|(at, share)| (Sample { weight: 1.0, ..at }, share))
                .unzip();
            let shares = shares.chunks(LANES).map(|some| {
                let mut lanes = [0.0; LANES];
                lanes[..some.len()].copy_from_slice(some);
                lanes
            });
            Ok(Part {
                blocks: blocks_of::<f64, M, P, C>(&directions)?,
                shares: shares.collect(),
                ln_f: Real::portable_ln(sample.brdf),
                weight: sample.weight.abs(),
            })
        };
        Ok(Averaged {
            point,
            parts: samples.iter().map(part).collect::<Result<_, FitError>>()?,
            model: PhantomData,
        })
    }

    /// Residual of a sample, with its derivatives if `GRADIENT`.
    fn row<const GRADIENT: bool>(&self, pass: &M::Pass, part: &Part<C>) -> (f64, [f64; P]) {
        let mut rows: Vec<Rows<f64, GROUP, P>> = Vec::with_capacity(GROUPS * part.blocks.len());
        let mut top = -f64::MAX;
        for (block, shares) in part.blocks.iter().zip(&part.shares) {
            let begun = M::begin(pass, block);
            for lane in 0..GROUPS {
                let row = M::rows::<GRADIENT>(pass, block, &begun, lane);
                for (ln_f, share) in row.ln_f.0.into_iter().zip(Pack::<f64, GROUP>::gather(shares, lane).0) {
                    if share > 0.0 {
                        top = top.max(ln_f);
                    }
                }
                rows.push(row);
            }
        }
        let (mut sum, mut slopes) = (0.0, [0.0; P]);
        for (place, row) in rows.iter().enumerate() {
            let shares = Pack::<f64, GROUP>::gather(&part.shares[place / GROUPS], place % GROUPS).0;
            for half in 0..GROUP {
                if shares[half] > 0.0 {
                    let f = shares[half] * Real::portable_exp(row.ln_f.0[half] - top);
                    sum += f;
                    for k in 0..P {
                        if GRADIENT {
                            slopes[k] += f * row.gradient[k].0[half];
                        }
                    }
                }
            }
        }
        let residual = part.weight * (top + Real::portable_ln(sum) - part.ln_f);
        (residual, slopes.map(|slope| part.weight * slope / sum))
    }
}

impl<M: Model<f64, P, C>, const P: usize, const C: usize> Problem<f64, P> for Averaged<'_, M, P, C> {
    fn cost(&self, x: &[f64; P]) -> f64 {
        let pass = M::pass(x);
        let residuals = self.parts.iter().map(|part| self.row::<false>(&pass, part).0);
        residuals.map(|residual| residual * residual).sum()
    }

    fn linearize(&self, x: &[f64; P]) -> Linearization<f64, P> {
        let pass = M::pass(x);
        let mut sums = Linearization::zero();
        for part in &self.parts {
            let (residual, slopes) = self.row::<true>(&pass, part);
            sums.add(residual, &slopes);
        }
        sums
    }

    fn bend(&self, x: &[f64; P], step: &[f64; P], to: [f64; P]) -> [f64; P] {
        self.point.bend(x, step, to)
    }
}

impl<M: Model<f64, P, C>, const P: usize, const C: usize> Scene<f64, P> for Averaged<'_, M, P, C> {
    fn propose(&self, bounds: &Bounds<f64, P>, seed: u64, i: u64, region: Region<f64, P>) -> Candidate<f64, P> {
        self.point.propose(bounds, seed, i, region)
    }

    fn weigh(&self, bounds: &Bounds<f64, P>, candidate: &mut Candidate<f64, P>) {
        self.point.weigh(bounds, candidate);
    }

    fn level(&self, bounds: &Bounds<f64, P>, x: &[f64; P]) -> ([f64; P], f64) {
        let x = self.point.level(bounds, x).0;
        (x, self.cost(&x))
    }

    fn apart(&self, x: &[f64; P], y: &[f64; P], factor: f64) -> bool {
        self.point.apart(x, y, factor)
    }
}
