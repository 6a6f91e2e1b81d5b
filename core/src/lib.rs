//! Microfacet BRDF model, bounded Levenberg-Marquardt and global search.
//!
//! `no_std`, no allocation, no `unsafe`, no I/O, no clock; the same bits on every target.
//!
//! # Map
//! Data flows one way, through the files in this order:
//!
//! | stage | type | file | paper |
//! |---|---|---|---|
//! | scalar type, elementary functions | [`real::Real`] | `real.rs` | |
//! | numbers side by side | [`pack::Pack`] | `pack.rs` | |
//! | sample -> geometry, observation -> block | [`geometry::Sample`], [`geometry::Observation`], [`geometry::Block`] | `geometry.rs` | Eq. 7, 9, 12, 13 |
//! | F and its derivatives | [`brdf::Reflecting`] | `fresnel.rs` | |
//! | what a model is | [`model::Model`], [`model::Parameter`] | `model.rs` | |
//! | pieces of microfacet models | [`lobes::Distribution`], [`lobes::Masking`] | `lobes.rs` | Eq. 5, 8, 9 |
//! | ln f and its gradient | [`brdf::Params`], [`brdf::Brdf`] | `brdf.rs` | Eq. 3-8, 11, 14 |
//! | microfacet models | [`microfacet::Microfacet`] | `microfacet.rs`, `bend.rs` | Eq. 5, 14 |
//! | lists of a fixed capacity | [`list::List`], [`list::Lent`] | `list.rs` | |
//! | step within bounds | | `boxqp.rs` | |
//! | fit from one start | [`lm::Problem`], [`lm::Fit`], [`lm::Stop`] | `lm.rs` | |
//! | models from a formula | [`formula::Formula`], [`dual::Dual`] | `formula.rs`, `dual.rs` | |
//! | models of stray light and of paints | [`models::Abg`] and others | `models.rs` | |
//! | are derivatives right? | [`check::worst_gradient`], [`formula::worst_slope`] | `check.rs` | |
//! | residuals of a scan | [`residuals::Residuals`], [`residuals::Scan`] | `residuals.rs` | Eq. 15-17 |
//! | the same without vectors | | `scalar.rs` | |
//! | several scans together | [`joint::Joint`] | `joint.rs` | |
//! | seeded starts | [`start::uniform`] | `start.rs` | Table 1 |
//! | distinct minima | [`minima::Minima`] | `minima.rs` | Table 2, 3 |
//! | search | [`search::search`], [`search::Search`], [`search::paper`] | `search.rs` | section 3 |
//! | starts worth a fit | [`search::Scene`] | `candidate.rs`, `propose.rs` | |
//! | state to flash and back | [`saved::save`], [`saved::restore`] | `saved.rs` | |
//! | standard errors, correlations | [`uncertainty::Uncertainty`] | `uncertainty.rs` | |
//! | the usual types by short names | [`single`], [`double`] | `usual.rs` | |
#![no_std]

#[cfg(all(target_arch = "x86", not(target_feature = "sse2")))]
compile_error!(
    "x87 registers round differently, which breaks exp and changes the bits of every fit: compile with -C target-feature=+sse2, or for a target that has it, such as i686-unknown-linux-gnu"
);

mod bend;
mod boxqp;
pub mod brdf;
mod candidate;
pub mod check;
pub mod dual;
pub mod formula;
mod fresnel;
pub mod geometry;
pub mod joint;
pub mod list;
pub mod lm;
pub mod lobes;
pub mod microfacet;
pub mod minima;
pub mod model;
pub mod models;
pub mod pack;
mod propose;
pub mod real;
pub mod residuals;
pub mod saved;
mod scalar;
pub mod search;
pub mod start;
pub mod uncertainty;
mod usual;

pub use usual::{double, single};

/// The examples of the README are compiled and run as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
