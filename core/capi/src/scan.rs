//! Samples -> blocks of the caller; and the model itself.

use brdfit_core::brdf::{ALL, Params};
use brdfit_core::geometry::{Block, Geometry, LANES, LobeGeometry, Observation, Sample, SampleError};
use brdfit_core::lobes::{Beckmann, Distribution};
use brdfit_core::microfacet::Microfacet;
use brdfit_core::real::Real;
use brdfit_core::residuals::{Scan, value};

use crate::Done;
use crate::memory::{changed, input, inputs, output, outputs};
use crate::options::check_params;
use crate::types::*;

/// The blocks that hold samples, and how many samples.
///
/// # Safety
/// As for `memory::input`; the scan was begun, or holds zeros.
pub unsafe fn blocks_of<'a, R: Real>(scan: *const brdfit_scan<R>) -> Result<(&'a [Block<R>], usize), brdfit_error> {
    // SAFETY: as asked of the caller.
    let scan = unsafe { input(scan) }?;
    if scan.blocks.is_null() {
        return Err(brdfit_error::NotBegun);
    }
    // SAFETY: `scan_init` was given this memory, and made blocks in it.
    let blocks = unsafe { inputs::<Block<R>>(scan.blocks.cast(), scan.capacity) }?;
    let filled = blocks.get(..scan.samples.div_ceil(LANES));
    Ok((filled.ok_or(brdfit_error::NotBegun)?, scan.samples))
}

pub unsafe fn scan_init<R: Real>(scan: *mut brdfit_scan<R>, blocks: *mut brdfit_block<R>, count: usize) -> Done {
    // SAFETY: the contract of the header; a `Block` has the size of a `brdfit_block`.
    let (scan, memory) = unsafe { (output(scan)?, outputs::<Block<R>>(blocks.cast(), count)?) };
    for block in memory {
        block.write(Block::empty());
    }
    scan.write(brdfit_scan {
        blocks,
        capacity: count,
        samples: 0,
    });
    Ok(())
}

pub unsafe fn scan_add<R: Real>(scan: *mut brdfit_scan<R>, samples: *const brdfit_sample<R>, count: usize) -> Done {
    // SAFETY: the contract of the header.
    let (scan, samples) = unsafe { (changed(scan)?, inputs(samples, count)?) };
    if scan.blocks.is_null() {
        return Err(brdfit_error::NotBegun);
    }
    for sample in samples {
        if scan.samples / LANES >= scan.capacity {
            return Err(brdfit_error::Full);
        }
        if sample.weight <= R::ZERO {
            return Err(brdfit_error::NotPositive);
        }
        let observation = Observation::new(&Sample {
            theta_i: sample.theta_i,
            theta_s: sample.theta_s,
            delta_phi: sample.delta_phi,
            brdf: sample.brdf,
            weight: sample.weight,
        })
        .map_err(of_sample)?;
        put(scan, &observation)?;
    }
    Ok(())
}

/// Puts an observation into the next lane.
fn put<R: Real>(scan: &mut brdfit_scan<R>, observation: &Observation<R>) -> Done {
    // SAFETY: the block is one of the scan's, which `scan_init` made: the callers saw that there is room.
    let block = unsafe { changed(scan.blocks.cast::<Block<R>>().add(scan.samples / LANES)) }?;
    block.set(scan.samples % LANES, observation);
    scan.samples += 1;
    Ok(())
}

pub unsafe fn scan_add_at<R: Real>(
    scan: *mut brdfit_scan<R>,
    geometry: *const brdfit_geometry<R>,
    brdf: R,
    weight: R,
) -> Done {
    // SAFETY: the contract of the header.
    let (scan, known) = unsafe { (changed(scan)?, input(geometry)?) };
    if scan.blocks.is_null() {
        return Err(brdfit_error::NotBegun);
    }
    if scan.samples / LANES >= scan.capacity {
        return Err(brdfit_error::Full);
    }
    let (angles, factors) = (known.tan2_theta_h, known.factor);
    if !known
        .cos_theta_d
        .iter()
        .chain(&angles)
        .chain(&factors)
        .all(|x| x.is_finite())
    {
        return Err(brdfit_error::NotFinite);
    }
    let steep = known.cos_theta_d.iter().any(|&cos| !(cos > R::ZERO && cos <= R::ONE));
    if steep || angles.iter().chain(&factors).any(|&x| x < R::ZERO) {
        return Err(brdfit_error::BeyondHorizon);
    }
    if weight <= R::ZERO {
        return Err(brdfit_error::NotPositive);
    }
    let lobes = core::array::from_fn(|lobe| LobeGeometry {
        tan2_theta_h: angles[lobe],
        cos_theta_d: known.cos_theta_d[lobe],
        factor: factors[lobe],
    });
    put(
        scan,
        &Observation::at(Geometry { lobes }, brdf, weight).map_err(of_sample)?,
    )
}

pub unsafe fn geometry<R: Real>(direction: [R; 3], geometry: *mut brdfit_geometry<R>) -> Done {
    // SAFETY: the contract of the header.
    let geometry = unsafe { output(geometry) }?;
    let [theta_i, theta_s, delta_phi] = direction;
    let lobes = Geometry::new(theta_i, theta_s, delta_phi).map_err(of_sample)?.lobes;
    geometry.write(brdfit_geometry {
        tan2_theta_h: lobes.map(|lobe| lobe.tan2_theta_h),
        cos_theta_d: lobes.map(|lobe| lobe.cos_theta_d),
        factor: lobes.map(|lobe| lobe.factor),
    });
    Ok(())
}

fn of_sample(error: SampleError) -> brdfit_error {
    match error {
        SampleError::NotFinite => brdfit_error::NotFinite,
        SampleError::BeyondHorizon => brdfit_error::BeyondHorizon,
        SampleError::NotPositive => brdfit_error::NotPositive,
    }
}

pub unsafe fn brdf<R: Real>(model: u32, direction: [R; 3], params: *const brdfit_params<R>, brdf: *mut R) -> Done {
    // SAFETY: the contract of the header.
    let (params, brdf) = unsafe { (input(params)?, output(brdf)?) };
    check_params(params)?;
    let [theta_i, theta_s, delta_phi] = direction;
    let geometry = Geometry::new(theta_i, theta_s, delta_phi).map_err(of_sample)?;
    let params = Params::from(*params);
    brdf.write(match model {
        BRDFIT_MODEL_BECKMANN => brdf_of::<R, Beckmann>(&params, geometry),
        #[cfg(feature = "ggx")]
        BRDFIT_MODEL_GGX => brdf_of::<R, brdfit_core::lobes::Ggx>(&params, geometry),
        _ => return Err(brdfit_error::Terms),
    });
    Ok(())
}

fn brdf_of<R: Real, D: Distribution>(params: &Params<R>, geometry: Geometry<R>) -> R {
    let x = Scan::<R, ALL, 6>::coordinates(params);
    value::<R, Microfacet<ALL, D>, 6, 6>(&x, geometry.into()).portable_exp()
}
