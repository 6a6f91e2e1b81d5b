//! Test data 1 with +-10 % noise, seed 1: 171 samples at theta_i = 45 deg.

use brdfit_core::geometry::{Block, LANES, Observation, Sample};
use brdfit_core::real::Real;

/// Columns theta_i_deg, theta_s_deg, brdf_per_sr; Rust's own reading of decimals is exact, and part of `core`.
const CSV: &str = include_str!("../../data/testdata1_sym_seed1.csv");

/// Number of samples.
pub const SAMPLES: usize = 171;
/// Number of blocks that hold them.
pub const BLOCKS: usize = SAMPLES.div_ceil(LANES);

/// The samples, in the order in which the goniometer measures them.
pub fn samples<R: Real>() -> impl Iterator<Item = Sample<R>> {
    CSV.lines().skip(1).map(|line| {
        let mut cells = line.split(',').map(|cell| cell.parse::<f64>().unwrap_or(f64::NAN));
        let mut next = || cells.next().unwrap_or(f64::NAN);
        let mut angle = || R::of(next() * (core::f64::consts::PI / 180.0));
        let (theta_i, theta_s) = (angle(), angle());
        Sample::in_plane(theta_i, theta_s, R::of(next()))
    })
}

/// All samples in blocks.
pub fn blocks<R: Real>() -> [Block<R>; BLOCKS] {
    let mut blocks = [Block::empty(); BLOCKS];
    for (row, sample) in samples().enumerate() {
        if let (Some(block), Ok(observation)) = (blocks.get_mut(row / LANES), Observation::new(&sample)) {
            block.set(row % LANES, &observation);
        }
    }
    blocks
}
