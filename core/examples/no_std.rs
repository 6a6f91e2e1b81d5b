//! Samples -> observations -> block -> search -> parameters, without std, alloc or an allocator in the fit.
//!
//! `cargo run -p brdfit-core --example no_std`; only `main`, which prints, uses std.

use brdfit_core::brdf::{ABSORBING, Brdf, DIFFUSE, Params, SURFACE, parameters};
use brdfit_core::geometry::{Block, Geometry, LANES, Observation, Sample, SampleError};
use brdfit_core::lm::Options;
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::search::{CANDIDATES, search};

/// What this scene needs; what is left out costs no flash and no cycle.
const TERMS: u8 = DIFFUSE | SURFACE | ABSORBING;
const P: usize = parameters(TERMS);
/// Room for 64 samples, owned by the caller.
const BLOCKS: usize = 64 / LANES;

/// The parameters that fit `samples` best, and the sum of squared residuals of ln f; samples beyond the room are left out.
fn fit(samples: impl Iterator<Item = Sample<f32>>) -> Result<(Params<f32>, f32), SampleError> {
    let mut blocks = [Block::empty(); BLOCKS];
    for (row, sample) in samples.take(BLOCKS * LANES).enumerate() {
        blocks[row / LANES].set(row % LANES, &Observation::new(&sample)?);
    }
    let scan = Scan::<f32, TERMS, P>::new(&blocks);
    let lower = Params::from_array([0.0, 0.0, 0.0, 1e-5, 1.0, 0.0]);
    let upper = Params::from_array([1.0, 100.0, 100.0, 10.0, 100.0, 100.0]);
    let bounds = Scan::<f32, TERMS, P>::bounds(&lower, &upper);
    let found = search(&scan, &bounds, 0, CANDIDATES, &Options::default());
    Ok((Scan::<f32, TERMS, P>::params(&found.best.x), found.best.at.cost))
}

fn main() {
    // A black paint seen at 57 angles.
    let truth = Params {
        rho_d: 0.03,
        rho_s: 2.0,
        rho_v: 0.0,
        m: 0.2,
        n: 1.5,
        kappa: 0.1,
    };
    let samples = (-28..=28).filter_map(|step| {
        let (theta_i, theta_s) = (0.5, step as f32 * 0.05);
        let geometry = Geometry::new(theta_i, theta_s, core::f32::consts::PI).ok()?;
        Some(Sample::in_plane(
            theta_i,
            theta_s,
            Real::portable_exp(Brdf::<f32, TERMS>::new(&truth).ln_f(&geometry)),
        ))
    });
    match fit(samples) {
        Ok((params, cost)) => println!("cost {cost:e}\n{params:#?}"),
        Err(error) => println!("{error}"),
    }
}
