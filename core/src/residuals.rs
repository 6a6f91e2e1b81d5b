//! A scan as a least-squares problem: the residual of ln f and its gradient, by blocks of sixteen rows (Eq. 15-17).

use crate::brdf::{Brdf, Params, has, parameters, slot};
use crate::fresnel::Index;
use crate::geometry::{Block, LANES};
use crate::lm::{Bounds, Linearization, Problem};
use crate::real::Real;

/// The blocks of one scan, for a model of `TERMS` with its `P` parameters.
///
/// The solver's coordinates are those parameters in the order of [`crate::brdf::NAMES`], with kappa^2 in place of kappa: F is even in kappa, so a search in kappa can not leave 0.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Scan<'a, R, const TERMS: u8, const P: usize> {
    blocks: &'a [Block<R>],
    /// cos theta_d nearest to the peak of each lobe.
    peaks: [[R; 1]; 2],
    /// The least m that a few samples still see; dimensionless.
    pub(crate) finest: R,
}

impl<'a, R: Real, const TERMS: u8, const P: usize> Scan<'a, R, TERMS, P> {
    const MATCHES: () = assert!(P == parameters(TERMS), "P must be parameters(TERMS)");

    /// The scan whose observations are in `blocks`.
    pub fn new(blocks: &'a [Block<R>]) -> Self {
        let () = Self::MATCHES;
        let mut peaks = [[R::ONE]; 2];
        let mut finest = R::MAX;
        for lobe in 0..2 {
            // The three smallest tan^2 theta_h.
            let mut nearest = [R::MAX; 3];
            for block in blocks {
                for lane in 0..LANES {
                    let mut tan2 = block.tan2_theta_h[lobe][lane];
                    if block.weight[lane] > R::ZERO {
                        if tan2 < nearest[0] {
                            peaks[lobe] = [block.cos_theta_d[lobe][lane]];
                        }
                        for place in &mut nearest {
                            if tan2 < *place {
                                core::mem::swap(place, &mut tan2);
                            }
                        }
                    }
                }
            }
            finest = finest.min(nearest[2]);
        }
        let finest = R::of(0.3) * finest.sqrt();
        Scan { blocks, peaks, finest }
    }

    /// Its observations.
    pub fn blocks(&self) -> &'a [Block<R>] {
        self.blocks
    }

    /// Solver coordinates of `params`.
    pub fn coordinates(params: &Params<R>) -> [R; P] {
        let mut x = [R::ZERO; P];
        let mut all = params.to_array();
        all[5] *= all[5];
        for (index, value) in all.into_iter().enumerate() {
            if has(TERMS, index)
                && let Some(place) = x.get_mut(slot(TERMS, index))
            {
                *place = value;
            }
        }
        x
    }

    /// Parameters at solver coordinates; those of absent terms are 0, and n is 1.
    pub fn params(x: &[R; P]) -> Params<R> {
        let mut params = Self::expand(x);
        params.kappa = params.kappa.sqrt();
        params
    }

    /// Derivatives of the parameters by the solver's coordinates at `x`: 1, and for kappa 1 / (2 kappa), or 0 at kappa = 0, where there is none.
    pub fn slopes(x: &[R; P]) -> [R; P] {
        let mut slopes = [R::ONE; P];
        if has(TERMS, 5)
            && let (Some(slope), Some(&kappa2)) = (slopes.get_mut(slot(TERMS, 5)), x.get(slot(TERMS, 5)))
        {
            *slope = if kappa2 > R::ZERO {
                R::of(0.5) / kappa2.sqrt()
            } else {
                R::ZERO
            };
        }
        slopes
    }

    /// The bounds on the solver's coordinates.
    pub fn bounds(lower: &Params<R>, upper: &Params<R>) -> Bounds<R, P> {
        Bounds {
            lower: Self::coordinates(lower),
            upper: Self::coordinates(upper),
        }
    }

    /// Parameter `index` of [`crate::brdf::NAMES`], or `absent`.
    #[inline(always)]
    pub(crate) fn get(x: &[R; P], index: usize, absent: R) -> R {
        if has(TERMS, index) {
            x.get(slot(TERMS, index)).copied().unwrap_or(absent)
        } else {
            absent
        }
    }

    #[inline(always)]
    pub(crate) fn expand(x: &[R; P]) -> Params<R> {
        Params {
            rho_d: Self::get(x, 0, R::ZERO),
            rho_s: Self::get(x, 1, R::ZERO),
            rho_v: Self::get(x, 2, R::ZERO),
            m: Self::get(x, 3, R::ONE),
            n: Self::get(x, 4, R::ONE),
            kappa: Self::get(x, 5, R::ZERO),
        }
    }
}

/// Number of partial sums that run side by side.
pub(crate) const SUMS: usize = LANES / 2;

/// Adds the products of two columns of a block to the partial sums: lane k and lane k + 8 go to sum k.
#[inline(always)]
pub(crate) fn accumulate<R: Real>(sums: &mut [R; SUMS], x: &[R; LANES], y: &[R; LANES]) {
    for k in 0..SUMS {
        sums[k] += x[k] * y[k] + x[k + SUMS] * y[k + SUMS];
    }
}

/// The total, in an order that every target keeps.
#[inline(always)]
pub(crate) fn total<R: Real>(x: &[R; SUMS]) -> R {
    ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]))
}

impl<R: Real, const TERMS: u8, const P: usize> Problem<R, P> for Scan<'_, R, TERMS, P> {
    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn cost(&self, x: &[R; P]) -> R {
        let brdf = Brdf::<R, TERMS>::with_kappa2(&Self::expand(x));
        let mut squares = [R::ZERO; SUMS];
        for block in self.blocks {
            let model = brdf.rows::<LANES, false>(block);
            let residual = residuals(block, &model.ln_f);
            accumulate(&mut squares, &residual, &residual);
        }
        total(&squares)
    }

    /// Keeps rho F at the peak of each lobe where the linear model puts it: n and kappa change F, and hardly anything else that a scan sees.
    fn bend(&self, x: &[R; P], step: &[R; P], to: [R; P]) -> [R; P] {
        if !has(TERMS, 4) {
            return to;
        }
        let (old, change, new) = (Self::expand(x), Self::expand(step), Self::expand(&to));
        let d_kappa2 = if has(TERMS, 5) { change.kappa } else { R::ZERO };
        let from = Index::new(old.n, old.kappa).lanes::<2, 1, true>(&self.peaks, 0..2);
        let there = Index::new(new.n.max(R::ONE), new.kappa.max(R::ZERO)).lanes::<2, 1, false>(&self.peaks, 0..2);
        let mut bent = to;
        for lobe in 0..2 {
            let (Some(rho), Some(&straight), Some(&before)) = (
                bent.get_mut(slot(TERMS, 1 + lobe)),
                to.get(slot(TERMS, 1 + lobe)),
                x.get(slot(TERMS, 1 + lobe)),
            ) else {
                continue;
            };
            let d_f = from.d_n[lobe][0] * change.n + from.d_kappa2[lobe][0] * d_kappa2;
            let amplitude = from.f[lobe][0] * straight + before * d_f;
            if has(TERMS, 1 + lobe) && amplitude > R::ZERO && there.f[lobe][0] > R::TINY {
                *rho = amplitude / there.f[lobe][0];
            }
        }
        bent
    }

    #[cfg_attr(not(target_os = "none"), inline(always))]
    fn linearize(&self, x: &[R; P]) -> Linearization<R, P> {
        let brdf = Brdf::<R, TERMS>::with_kappa2(&Self::expand(x));
        let mut squares = [R::ZERO; SUMS];
        let mut gradient = [[R::ZERO; SUMS]; P];
        let mut hessian = [[[R::ZERO; SUMS]; P]; P];
        for block in self.blocks {
            let model = brdf.rows::<LANES, true>(block);
            let residual = residuals(block, &model.ln_f);
            let mut rows = [[R::ZERO; LANES]; P];
            for (index, derivative) in model.gradient.iter().enumerate() {
                if has(TERMS, index)
                    && let Some(row) = rows.get_mut(slot(TERMS, index))
                {
                    *row = *derivative;
                }
            }
            accumulate(&mut squares, &residual, &residual);
            for i in 0..P {
                accumulate(&mut gradient[i], &rows[i], &residual);
                for j in 0..=i {
                    accumulate(&mut hessian[i][j], &rows[i], &rows[j]);
                }
            }
        }
        let mut sums = Linearization {
            cost: total(&squares),
            gradient: [R::ZERO; P],
            hessian: [[R::ZERO; P]; P],
        };
        for i in 0..P {
            sums.gradient[i] = total(&gradient[i]);
            for j in 0..=i {
                let sum = total(&hessian[i][j]);
                sums.hessian[i][j] = sum;
                sums.hessian[j][i] = sum;
            }
        }
        sums
    }
}

#[inline(always)]
fn residuals<R: Real>(block: &Block<R>, ln_f: &[R; LANES]) -> [R; LANES] {
    let mut residual = [R::ZERO; LANES];
    for lane in 0..LANES {
        residual[lane] = (ln_f[lane] - block.ln_f[lane]) * block.weight[lane];
    }
    residual
}
