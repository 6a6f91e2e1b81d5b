//! In `f32`, C gets what the Rust host gets, to the bit, and mistakes are errors; `double` is this in `f64`.

#![allow(clippy::unnecessary_cast, clippy::useless_conversion)]

mod fit;
mod mistakes;
mod model;
mod search;
mod steps;

use std::mem::zeroed;
use std::path::Path;
use std::ptr::{null, null_mut};

use brdfit::engine::{self, FitOptions, Model, Precision, TERM_SETS, Values};
use brdfit_capi::brdfit_error as Error;
use brdfit_capi::*;
use brdfit_core::brdf::{ALL, Brdf, Params};
use brdfit_core::geometry::{Geometry, Sample};
use brdfit_core::lm::{self, Options, Problem};
use brdfit_core::lobes::{Beckmann, Distribution, Ggx};
use brdfit_core::microfacet::Microfacet;
use brdfit_core::real::Real;
use brdfit_core::residuals::{Residuals, Scan, value};
use brdfit_core::uncertainty::Uncertainty;

/// Test data 1 with noise, each sample with a weight.
fn samples() -> Vec<Sample<f64>> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/testdata1_sym_seed1.csv");
    let text = std::fs::read_to_string(file).unwrap();
    let mut samples = Vec::new();
    for (row, line) in text.lines().skip(1).enumerate() {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        samples.push(Sample {
            weight: (row % 5 + 1) as f64 / 4.0,
            ..Sample::in_plane(cells[0].to_radians(), cells[1].to_radians(), cells[2])
        });
    }
    samples
}

/// The memory of a caller.
struct Memory {
    blocks: Vec<brdfit_block<f32>>,
    scan: brdfit_scan<f32>,
}

fn with_samples() -> Memory {
    let empty = brdfit_block {
        opaque: [7.0; BRDFIT_BLOCK_NUMBERS],
    };
    let mut memory = Memory {
        blocks: vec![empty; 12],
        // SAFETY: any bits are a value of it.
        scan: unsafe { zeroed() },
    };
    let samples: Vec<brdfit_sample<f32>> = samples()
        .iter()
        .map(|sample| brdfit_sample {
            theta_i: sample.theta_i as f32,
            theta_s: sample.theta_s as f32,
            delta_phi: BRDFIT_PI as f32,
            brdf: sample.brdf as f32,
            weight: sample.weight as f32,
        })
        .collect();
    // SAFETY: the pointers are of as many objects as is said.
    unsafe {
        let blocks = memory.blocks.as_mut_ptr();
        assert_eq!(brdfit_scan_init_f32(&mut memory.scan, blocks, 12), Error::None);
        let (one, others) = samples.split_first().unwrap();
        assert_eq!(brdfit_scan_add_f32(&mut memory.scan, one, 1), Error::None);
        let done = brdfit_scan_add_f32(&mut memory.scan, others.as_ptr(), others.len());
        assert_eq!(done, Error::None);
    }
    assert_eq!(memory.scan.samples, samples.len());
    memory
}

fn usual() -> brdfit_options<f32> {
    // SAFETY: any bits are a value of it, and the pointer is of it.
    unsafe {
        let mut options = zeroed();
        assert_eq!(brdfit_options_init_f32(&mut options), Error::None);
        options
    }
}

fn same(c: brdfit_params<f32>, host: Values) {
    let bits = Params::from(c).to_array().map(|value| f64::from(value).to_bits());
    let host: Vec<u64> = host.iter().map(|value| value.to_bits()).collect();
    assert_eq!(bits.as_slice(), host);
}
