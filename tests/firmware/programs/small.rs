//! A search on the smallest part, a Cortex-M0 with 16 KB of RAM: 57 samples, diffuse and surface, `f32`.

use core::fmt::{self, Write};

use brdfit_core::brdf::{DIFFUSE, Params, SURFACE, parameters};
use brdfit_core::geometry::{Block, LANES, Observation};
use brdfit_core::lm::Options;
use brdfit_core::residuals::Scan;
use brdfit_core::search::{CANDIDATES, Search};

use super::{number, scan};

const TERMS: u8 = DIFFUSE | SURFACE;
const P: usize = parameters(TERMS);
/// Each third sample of test data 1.
const STEP: usize = 3;
const BLOCKS: usize = scan::SAMPLES.div_ceil(STEP).div_ceil(LANES);

pub fn run(out: &mut dyn Write) -> fmt::Result {
    let mut blocks = [Block::<f32>::EMPTY; BLOCKS];
    for (row, sample) in scan::samples().step_by(STEP).enumerate() {
        if let (Some(block), Ok(observation)) = (blocks.get_mut(row / LANES), Observation::new(&sample)) {
            block.set(row % LANES, &observation);
        }
    }
    let scan = Scan::<f32, TERMS, P>::new(&blocks);
    let bounds = Scan::<f32, TERMS, P>::bounds(
        &Params::from_array([0.0, 0.0, 0.0, 1e-5, 1.0, 0.0]),
        &Params::from_array([1.0, 100.0, 0.0, 10.0, 100.0, 0.0]),
    );
    let mut state = Search::<f32, P, 2, 4>::new();
    state.begin(&bounds, 0, CANDIDATES, &Options::default());
    while state.step(&scan) {}
    let best = state.best().ok_or(fmt::Error)?;
    number(out, "cost", best.at.cost)?;
    let Params { rho_d, rho_s, m, n, .. } = Scan::<f32, TERMS, P>::params(&best.x);
    for (name, value) in [("rho_d", rho_d), ("rho_s", rho_s), ("m", m), ("n", n)] {
        number(out, name, value)?;
    }
    Ok(())
}
