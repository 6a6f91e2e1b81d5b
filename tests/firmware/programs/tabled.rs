//! A fit of samples at known angles: their geometry is a table that the host computed, so the image has no trigonometry.

use core::fmt::{self, Write};

use brdfit_core::brdf::ALL;
use brdfit_core::geometry::{Block, Geometry, LANES, LobeGeometry, Observation};
use brdfit_core::lm::{self, Options};
use brdfit_core::residuals::Scan;

use super::{P, plain_start, report, scan, table_1};

/// Each how many of the samples the table has.
pub const STEP: usize = 3;
const ROWS: usize = scan::SAMPLES.div_ceil(STEP);

/// As `Debug` prints it: every third sample of the scan, in `f32`.
pub static TABLE: [Geometry<f32>; ROWS] = include!("tabled.table");

pub fn run(out: &mut dyn Write) -> fmt::Result {
    let mut blocks = [Block::empty(); ROWS.div_ceil(LANES)];
    for (row, (geometry, sample)) in TABLE.iter().zip(scan::samples::<f32>().step_by(STEP)).enumerate() {
        if let (Some(block), Ok(observation)) = (
            blocks.get_mut(row / LANES),
            Observation::at(*geometry, sample.brdf, sample.weight),
        ) {
            block.set(row % LANES, &observation);
        }
    }
    let scan = Scan::<f32, ALL, P>::new(&blocks);
    report(out, &lm::fit(&scan, &table_1(), plain_start(), &Options::default()))
}
