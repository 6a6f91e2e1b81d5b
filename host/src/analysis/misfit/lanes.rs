//! Processes side by side, one in each lane of a vector.

use brdfit_core::pack::Pack;
use brdfit_core::real::Real;

use super::process::{Process, SMOOTH};

/// Processes that go side by side.
pub const TOGETHER: usize = 8;

/// A number of each of them.
pub type Lanes = Pack<f64, TOGETHER>;

/// How the correlation of each falls.
pub struct Falls {
    length: Lanes,
    /// 1 where it is smooth, else 0.
    smooth: Lanes,
}

impl Falls {
    /// Those of up to [`TOGETHER`] processes; lanes that are left over repeat the last.
    pub fn of(processes: &[Process]) -> Self {
        Falls {
            length: each(processes, |process| process.length),
            smooth: each(processes, |process| f64::from(u8::from(process.smooth))),
        }
    }

    /// An angle in the lengths of each, and the exponential of its negative.
    #[inline(always)]
    pub fn over(&self, angle: f64) -> (Lanes, Lanes) {
        let x = self.pick(Lanes::splat(SMOOTH * angle), Lanes::splat(angle)) / self.length;
        (x, x.map(|x| -Real::min(x, 700.0)).exp())
    }

    /// Of each the number for smooth processes, or that for rough ones.
    #[inline(always)]
    pub fn pick(&self, smooth: Lanes, rough: Lanes) -> Lanes {
        Lanes::from_fn(|k| {
            if self.smooth.0[k] > 0.0 {
                smooth.0[k]
            } else {
                rough.0[k]
            }
        })
    }
}

/// A number of each of up to [`TOGETHER`] processes; lanes that are left over repeat the last.
pub fn each(processes: &[Process], of: impl Fn(Process) -> f64) -> Lanes {
    Lanes::from_fn(|k| of(processes[k.min(processes.len() - 1)]))
}
