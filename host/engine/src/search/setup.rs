//! What a search needs to know beside samples and options, and how that is found by several.

use crate::values::MOST;

/// What one search needs to know.
#[derive(Clone, Copy, Debug)]
pub struct Setup {
    /// Standard deviation of a residual of ln f, by which priors weigh.
    pub sigma: f64,
    /// Part of each prior that counts: all of it, or for one of several scans that share the parameter the root of its share.
    pub share: [f64; MOST],
    /// The square of what is above its limit counts this much; 0 for not at all.
    pub steep: f64,
    /// The samples are shifted by an offset that is fitted.
    pub nuisance: bool,
}

impl Default for Setup {
    fn default() -> Self {
        Setup {
            sigma: 1.0,
            share: [1.0; MOST],
            steep: 0.0,
            nuisance: false,
        }
    }
}

/// How steep the wall before a limit is, over the cost without it, step by step.
pub const WALLS: [f64; 5] = [1e3, 1e5, 1e7, 1e9, 1e11];
/// Rounds for the weight of priors at most.
const ROUNDS: usize = 60;
/// Searches for it at most.
const SEARCHES: usize = 3;
/// The least standard deviation of ln f: of rounding.
pub const LEAST: f64 = 1e-12;
/// The weight of priors is settled when it changes by less than this part.
const SETTLED: f64 = 1e-7;

impl Setup {
    /// Finds the weight of the priors: the standard deviation that agrees with what is left of the residuals, over `left` degrees of freedom, in the fit with it.
    ///
    /// `fit` makes the fit, by a search if it is told so, and gives the sum of squared residuals of the samples.
    /// It begins where samples are off by 100 %, and so ends at the largest that agrees with itself: less would let any prior go that a few samples contradict.
    pub fn settle(&mut self, mut fit: impl FnMut(&Setup, bool) -> f64, left: usize) {
        let deviation = |cost: f64| (cost / left.max(1) as f64).sqrt().max(LEAST);
        for _ in 0..SEARCHES {
            let mut cost = fit(self, true);
            for _ in 0..ROUNDS {
                let sigma = deviation(cost);
                let settled = (sigma / self.sigma - 1.0).abs() < SETTLED;
                self.sigma = sigma;
                cost = fit(self, false);
                if settled {
                    break;
                }
            }
            let searched = fit(self, true);
            if (deviation(searched) / self.sigma - 1.0).abs() < 1e3 * SETTLED {
                break;
            }
        }
    }

    /// Makes the wall before a limit steeper until `fit`, which tells whether something is above, keeps it; false if none does.
    pub fn wall(&mut self, cost: f64, mut fit: impl FnMut(&Setup) -> bool) -> bool {
        let mut above = fit(self);
        for wall in WALLS {
            if !above {
                break;
            }
            self.steep = wall * cost.max(f64::MIN_POSITIVE);
            above = fit(self);
        }
        !above
    }
}
