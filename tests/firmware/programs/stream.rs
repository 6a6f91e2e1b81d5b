//! Samples arrive one by one as the goniometer moves; between them the fit is refined within a budget of passes.
//!
//! Part of the budget goes to one new candidate a sample: a fit of half a scan may sit where no step leads out when the other half arrives.

use core::fmt::{self, Write};

use brdfit_core::brdf::ALL;
use brdfit_core::geometry::{Block, LANES, Observation};
use brdfit_core::lm::{self, Fit, Options, Problem};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::search::{Region, Scene};

use super::{P, number, plain_start, report, scan, table_1};

/// Passes of the fit between two samples; choosing its start takes three more.
const PASSES: u32 = 3;

pub fn run(out: &mut dyn Write) -> fmt::Result {
    writeln!(out, "f64")?;
    stream::<f64>(out)?;
    writeln!(out, "f32")?;
    stream::<f32>(out)
}

fn stream<R: Real>(out: &mut dyn Write) -> fmt::Result {
    let bounds = table_1();
    let options = Options::default();
    let mut blocks = [Block::<R>::empty(); scan::BLOCKS];
    let mut x = plain_start();
    for (row, sample) in scan::samples().enumerate() {
        let (Some(block), Ok(observation)) = (blocks.get_mut(row / LANES), Observation::new(&sample)) else {
            continue;
        };
        block.set(row % LANES, &observation);
        if row < P {
            continue;
        }
        // Only the blocks that hold samples are evaluated.
        let scan = Scan::<R, ALL, P>::new(blocks.get(..row / LANES + 1).unwrap_or_default());
        let candidate = scan.candidate(&bounds, 0, row as u64, Region::Everywhere).x;
        let start = if scan.cost(&candidate) < scan.cost(&x) {
            candidate
        } else {
            x
        };
        let mut fit = Fit::begin(&scan, &bounds, start, &options);
        fit.run(&scan, &bounds, &options, PASSES);
        x = fit.x;
        if row % 16 == 15 {
            writeln!(out, " after {} samples", row + 1)?;
            number(out, "cost", fit.at.cost)?;
        }
    }
    writeln!(out, " all samples, to convergence")?;
    let scan = Scan::<R, ALL, P>::new(&blocks);
    report(out, &lm::fit(&scan, &bounds, x, &options))
}
