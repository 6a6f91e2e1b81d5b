//! The shape of a lobe along an angle: where it is brightest, and where it falls to half.

use std::f64::consts::{FRAC_PI_2, LN_2};

/// The peak of a lobe is searched up to this far from the normal, radians (89.9 degrees).
pub const HORIZON: f64 = 0.9989 * FRAC_PI_2;

/// A number with its standard error, in the same unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    /// The best value.
    pub value: f64,
    /// Its standard error by the delta method; infinite where the 95 % interval is the whole range that it can have.
    pub stderr: f64,
}

impl Value {
    /// With what the difference from what the data have adds to its error.
    pub fn with(self, from_data: Option<Value>) -> Value {
        let more = from_data.map_or(0.0, |read| read.stderr);
        Value {
            stderr: libm::hypot(self.stderr, more),
            ..self
        }
    }
}

/// Whole degrees to each side of the normal at which maxima are looked for.
const DEGREES: i32 = 89;

/// Where a lobe of slope m around theta_i is brightest: the best of a grid that is dense at theta_i, then golden sections. Beside it the lobe's other maxima that are at least half as bright.
///
/// A wide lobe has a second one where the attenuation bends: up to there 1 / cos(theta_s) raises it towards the horizon.
pub fn tops(ln_f: &impl Fn(f64) -> f64, theta_i: f64, m: f64) -> (f64, Vec<f64>) {
    let with_value = |theta_s: f64| (theta_s, ln_f(theta_s));
    let degrees: Vec<(f64, f64)> = (-DEGREES..=DEGREES)
        .map(|degree| with_value(f64::from(degree).to_radians()))
        .collect();
    let dense = (-20..=20).map(|k| theta_i + 0.1 * f64::from(k) * m);
    let further = dense.chain([HORIZON, -HORIZON]);
    let further = further.filter(|theta_s| theta_s.abs() <= HORIZON).map(with_value);
    let mut grid: Vec<(f64, f64)> = degrees.iter().copied().chain(further).collect();
    grid.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best = (0..grid.len())
        .max_by(|&a, &b| grid[a].1.total_cmp(&grid[b].1))
        .unwrap_or(0);
    let (before, after) = (grid[best.saturating_sub(1)].0, grid[(best + 1).min(grid.len() - 1)].0);
    let top = highest(ln_f, before, after);
    let others = degrees.windows(3).filter(|around| {
        let [before, here, after] = [around[0], around[1], around[2]];
        here.1 > before.1 && here.1 > after.1 && here.1 > grid[best].1 - LN_2 && !(before.0 < top && top < after.0)
    });
    (
        top,
        others.map(|around| highest(ln_f, around[0].0, around[2].0)).collect(),
    )
}

/// Where a function with one maximum between `low` and `high` has it, by golden sections.
fn highest(ln_f: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    for _ in 0..60 {
        let (a, b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        if ln_f(a) < ln_f(b) {
            low = a;
        } else {
            high = b;
        }
    }
    0.5 * (low + high)
}

/// Where a function that is positive at `inside` becomes 0 on the way to `end`; `None` if it does not.
pub fn crossing(g: impl Fn(f64) -> f64, inside: f64, end: f64) -> Option<f64> {
    let (mut inside, mut outside) = (inside, end);
    if g(end).is_nan() || g(end) > 0.0 {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        if g(middle) > 0.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    Some(0.5 * (inside + outside))
}
