//! A scan through an aperture: the residual of a sample is that of the mean of f over the directions that the detector sees.

use brdfit_core::geometry::{Block, LANES, Sample};
use brdfit_core::lm::{Bounds, Linearization, Problem};
use brdfit_core::model::{GROUP, Model, Rows};
use brdfit_core::pack::Pack;
use brdfit_core::real::Real;
use brdfit_core::search::{Candidate, Region, Scene};

use crate::error::FitError;
use crate::instrument::aperture::directions;
use crate::passes::{Both, Kernel, blocks_of};
use crate::until::Until;

/// Lanes that go through a model side by side, and groups of them in a block.
const GROUPS: usize = LANES / GROUP;

/// One sample: the blocks of its directions.
struct Part<const C: usize> {
    blocks: Blocks<C>,
    /// Of each lane; 0 for an empty one.
    shares: Vec<[f64; LANES]>,
    ln_f: f64,
    weight: f64,
}

type Blocks<const C: usize> = Vec<Block<f64, LANES, C>>;

/// The model of such a scan, whatever its type.
struct Passes<const P: usize, const C: usize> {
    blocks: fn(&[Sample<f64>]) -> Result<Blocks<C>, FitError>,
    /// See [`rows`].
    rows: fn(&[f64; P], &Blocks<C>, bool) -> Vec<Rows<f64, GROUP, P>>,
}

/// A scan through an aperture.
pub struct Averaged<'a, const P: usize, const C: usize> {
    /// The same scan with a point for a detector: what it proposes is a start here too.
    point: &'a Kernel<'a, f64, P>,
    parts: Vec<Part<C>>,
    passes: Passes<P, C>,
    /// A pass over a long scan takes seconds: it ends where nobody waits for it any more.
    until: Until,
}

impl<'a, const P: usize, const C: usize> Averaged<'a, P, C> {
    /// Of model `M` and an aperture of this half-angle, radians; `point` is the scan without it.
    pub fn new<M: Both<P, C>>(
        point: &'a Kernel<'a, f64, P>,
        samples: &[Sample<f64>],
        half_angle: f64,
        until: Until,
    ) -> Result<Self, FitError> {
        let passes = Passes {
            blocks: blocks_of::<f64, M, P, C>,
            rows: rows::<M, P, C>,
        };
        Averaged::of(passes, point, samples, half_angle, until)
    }

    fn of(
        passes: Passes<P, C>,
        point: &'a Kernel<'a, f64, P>,
        samples: &[Sample<f64>],
        half_angle: f64,
        until: Until,
    ) -> Result<Self, FitError> {
        let part = |sample: &Sample<f64>| {
            if until.is_over() {
                return Err(FitError::Interrupted);
            }
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
                blocks: (passes.blocks)(&directions)?,
                shares: shares.collect(),
                ln_f: Real::portable_ln(sample.brdf),
                weight: sample.weight.abs(),
            })
        };
        Ok(Averaged {
            point,
            parts: samples.iter().map(part).collect::<Result<_, FitError>>()?,
            passes,
            until,
        })
    }

    /// The samples of a pass, until nobody waits for it any more.
    fn wanted(&self) -> impl Iterator<Item = &Part<C>> {
        self.parts.iter().take_while(|_| !self.until.is_over())
    }

    /// Residual of a sample, with its derivatives if `gradient`.
    fn row(&self, x: &[f64; P], part: &Part<C>, gradient: bool) -> (f64, [f64; P]) {
        let rows = (self.passes.rows)(x, &part.blocks, gradient);
        let shares = |place: usize| Pack::<f64, GROUP>::gather(&part.shares[place / GROUPS], place % GROUPS).0;
        let mut top = -f64::MAX;
        for (place, row) in rows.iter().enumerate() {
            for (ln_f, share) in row.ln_f.0.into_iter().zip(shares(place)) {
                if share > 0.0 {
                    top = top.max(ln_f);
                }
            }
        }
        let (mut sum, mut slopes) = (0.0, [0.0; P]);
        for (place, row) in rows.iter().enumerate() {
            let shares = shares(place);
            for half in 0..GROUP {
                if shares[half] > 0.0 {
                    let f = shares[half] * Real::portable_exp(row.ln_f.0[half] - top);
                    sum += f;
                    for k in 0..P {
                        if gradient {
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

/// The model in all lanes of some blocks, with its derivatives if `gradient`.
fn rows<M: Both<P, C>, const P: usize, const C: usize>(
    x: &[f64; P],
    blocks: &Blocks<C>,
    gradient: bool,
) -> Vec<Rows<f64, GROUP, P>> {
    let pass = <M as Model<f64, P, C>>::pass(x);
    let mut rows = Vec::with_capacity(GROUPS * blocks.len());
    for block in blocks {
        let begun = M::begin(&pass, block);
        for lane in 0..GROUPS {
            rows.push(match gradient {
                true => M::rows::<true>(&pass, block, &begun, lane),
                false => M::rows::<false>(&pass, block, &begun, lane),
            });
        }
    }
    rows
}

impl<const P: usize, const C: usize> Problem<f64, P> for Averaged<'_, P, C> {
    fn cost(&self, x: &[f64; P]) -> f64 {
        let residuals = self.wanted().map(|part| self.row(x, part, false).0);
        residuals.map(|residual| residual * residual).sum()
    }

    fn linearize(&self, x: &[f64; P]) -> Linearization<f64, P> {
        let mut sums = Linearization::zero();
        for part in self.wanted() {
            let (residual, slopes) = self.row(x, part, true);
            sums.add(residual, &slopes);
        }
        sums
    }

    fn bend(&self, x: &[f64; P], step: &[f64; P], to: [f64; P]) -> [f64; P] {
        self.point.bend(x, step, to)
    }
}

impl<const P: usize, const C: usize> Scene<f64, P> for Averaged<'_, P, C> {
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
