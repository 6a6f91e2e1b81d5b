//! Finds the parameters of microfacet BRDF models from scatterometer scans.
//!
//! The mathematics is in [`brdfit_core`], the searches are compiled in [`engine`]; this crate reads files, chooses what to run, and reports.
//!
//! A file becomes one or more [`input::Measurement`]s, that an [`engine::Outcome`], and that a [`report`]; [`cli`] strings them together, and every failure is an [`error::Error`].

pub use brdfit_engine as engine;

pub mod batch;
pub mod bootstrap;
pub mod choose;
pub mod cli;
pub mod compare;
pub mod converge;
pub mod derived;
pub mod error;
pub mod export;
pub mod fit;
pub mod input;
pub mod interrupt;
pub mod joint;
pub mod options;
pub mod output;
pub mod page;
pub mod paper;
pub mod plain;
pub mod plot;
pub mod profile;
pub mod reflectance;
pub mod report;
pub mod shell;
pub mod simulate;
pub mod stability;
pub mod streams;
pub mod target;
pub mod uncertainty;
