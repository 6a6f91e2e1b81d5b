//! Finds the parameters of microfacet BRDF models from scatterometer scans.
//!
//! The mathematics is in [`brdfit_core`]; this crate reads files, chooses what to run, and reports.

pub mod engine;
pub mod paper;
pub mod plot;
pub mod simd;
